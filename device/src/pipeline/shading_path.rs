//! Shading's way through the pipeline: what the colours of a draw go through, from its checked state.
//!
//! Duties: finds the texels of a draw's texture, reads its lights, and puts together what its pixels and vertices need; charges
//! light at vertices. Nothing of this is made for a draw that calls for interpolated colours alone.

use super::{Pipeline, sorted};
use crate::built::{Called, Key, ShadingKey, TextureKey};
use crate::geometry::GeometryRegisters;
use crate::geometry::fetch::VertexLight;
use crate::geometry::transform::Transform;
use crate::hidden::stencil;
use crate::memory::VideoMemory;
use crate::probe::account::{Account, Clocks};
use crate::shading::fog::FogMixer;
use crate::shading::light::{Lights, normal_matrix};
use crate::shading::parameters::ParameterTransform;
use crate::shading::pixel::{PixelShading, Textured};
use std::ops::Range;
use std::sync::Arc;
use zga_abi::{Counter, Effects};
use zga_firmware::Stopped;
use zga_firmware::checked::{Draw, DrawState, Target};

/// Most bytes of texels that a scene decodes for what is held back until it ends.
const HELD_TEXELS: u64 = 1 << 30;

impl Pipeline {
    /// What the interpolated colours of a draw go through; none where it calls for nothing of that kind.
    #[expect(clippy::too_many_arguments, reason = "the unit's inputs; a struct would only be taken apart again")]
    pub(super) fn shading(
        &mut self,
        memory: &mut VideoMemory,
        target: &Target,
        geometry: &GeometryRegisters,
        transform: &Transform,
        state: &DrawState,
        draw: &Draw<'_>,
        account: &mut Account,
    ) -> Result<Option<Arc<PixelShading>>, Stopped> {
        let light = state.light.filter(|light| light.per_pixel);
        let called = state.texture.is_some() || state.fog.is_some() || light.is_some();
        if ShadingKey::built().filter(|_| called).is_none() {
            return Ok(None);
        }
        let mut texture = None;
        if let (Some(called), Some(_)) = (&state.texture, TextureKey::built()) {
            let (texels, decoded) = self.textures.texels(memory, called);
            if decoded {
                account.maximum(Counter::TextureDecodedBytes, self.textures.bytes());
                self.held_texels += if self.waits(target, state) { texels.bytes() } else { 0 };
            }
            if self.held_texels > HELD_TEXELS {
                return Err(Stopped::SceneFull);
            }
            let punch_through = state.punch_through.and_then(|alpha| Called::new(|| alpha));
            texture = Called::new(|| Textured { texture: texels, punch_through });
        }
        Ok(Some(Arc::new(PixelShading {
            transform: parameter_transform(geometry, transform, state, draw),
            light: light.and_then(|light| Called::new(|| Lights::read(memory.words(), &light))),
            texture,
            fog: state.fog.as_ref().and_then(|fog| Called::new(|| FogMixer::new(fog))),
        })))
    }

    /// Whether primitives of a draw, or some of them, wait until the scene ends.
    fn waits(&self, target: &Target, state: &DrawState) -> bool {
        sorted::is_held(target) || target.subpixel.is_some() || state.effects.contains(Effects::BLEND)
    }
}

/// The frame was drawn to: textures that lie in it may have changed.
pub(super) fn drawn_to(memory: &mut VideoMemory, target: &Target) {
    let words = |bytes: Range<u64>| (bytes.start / 4) as usize..bytes.end.div_ceil(4) as usize;
    memory.changed(words(target.colour.bytes()));
    if let Some(depth) = target.depth {
        let bytes = u64::from(depth.pitch) * u64::from(target.colour.height);
        memory.changed(words(u64::from(depth.base)..u64::from(depth.base) + bytes));
    }
    if target.stencil.is_some() {
        memory.changed(stencil::words(target));
    }
}

/// What the parameters of a draw's vertices go through.
pub(super) fn parameter_transform(
    geometry: &GeometryRegisters,
    transform: &Transform,
    state: &DrawState,
    draw: &Draw<'_>,
) -> ParameterTransform {
    let m = geometry.object_eye.map(f64::from);
    ParameterTransform {
        screen: transform.clone(),
        eye: [0, 1, 2, 3].map(|row| [0, 1, 2, 3].map(|column| m[4 * row + column])),
        normal: normal_matrix(&geometry.object_eye),
        perspective: state.effects.contains(Effects::PERSPECTIVE),
        topology: draw.topology,
    }
}

/// Charges the light of so many vertices: 4 clocks for each light.
pub(super) fn charge_light(light: Option<&VertexLight>, vertices: u64, account: &mut Account) {
    if let Some(light) = light {
        let lights = light.lights.count() as u64 * vertices;
        account.add(Counter::ShadingLights, lights);
        account.charge(Counter::CyclesShading, Clocks(4 * lights));
    }
}
