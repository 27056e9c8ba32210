//! Draw state: what the next draw uses. Only what differs from the card's registers is sent, at the draw.

use glam::DMat4;
use zga_abi::Effects;
use zga_abi::bus::Bus;
use zga_abi::format::{DepthFormat, DepthFunction, Topology};
use zga_abi::packet::DrawFlags;
use zga_abi::registers::Reg;

use crate::antialias::AntialiasState;
use crate::effects::EffectState;
use crate::hidden::HiddenState;
use crate::view::{Camera, Corners, Decal, FitInfo, FitView, FittedDecal, Marking, Matrix, camera, finite};
use crate::{DecalInfo, Driver, DriverError, Target, Warning};

/// The whole target.
const NO_SCISSOR: [u32; 2] = [0, 0x7FFF_7FFF];
/// Bit 8 of DEPTH_CONTROL: a passing fragment's depth is stored.
const DEPTH_WRITE: u32 = 1 << 8;

/// A rectangle of pixels: `x`, `y` inclusive, `right`, `bottom` exclusive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rectangle {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// First column beyond.
    pub right: u32,
    /// First row beyond.
    pub bottom: u32,
}

/// How what is drawn is moved.
#[derive(Clone, Debug)]
pub(crate) enum DecalState {
    /// By a slope.
    Slope(f64),
    /// By what surfaces need, as far as the slope allows.
    Fitted { slope: f64, surfaces: Vec<Corners> },
}

/// What matrices depend on of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ComposedFor {
    pub size: [u32; 2],
    pub depth: Option<DepthFormat>,
    pub subpixel_bits: u32,
}

/// What the user has set.
#[derive(Debug)]
pub(crate) struct State {
    pub camera: Camera,
    pub object: DMat4,
    pub decal: Option<DecalState>,
    pub depth_function: DepthFunction,
    pub depth_write: bool,
    pub hidden: HiddenState,
    pub antialias: AntialiasState,
    pub effects: EffectState,
    pub subpixel_bits: u32,
    pub scissor: [u32; 2],
    pub material: u32,
    pub tag: u32,
    /// Scene that the matrices were composed for.
    pub composed_for: Option<ComposedFor>,
    /// Camera, object, decal or target size changed since the matrices were composed.
    matrices_due: bool,
    /// What a fitted decal was composed for.
    composed_marking: Option<Marking>,
}

impl State {
    pub fn new() -> State {
        State {
            camera: Camera::Screen,
            object: DMat4::IDENTITY,
            decal: None,
            depth_function: DepthFunction::Less,
            depth_write: true,
            hidden: HiddenState::new(),
            antialias: AntialiasState::new(),
            effects: EffectState::new(),
            subpixel_bits: 8,
            scissor: NO_SCISSOR,
            material: u32::MAX,
            tag: 0,
            composed_for: None,
            matrices_due: true,
            composed_marking: None,
        }
    }

    /// The matrices must be composed again.
    pub const fn matrices_changed(&mut self) {
        self.matrices_due = true;
    }

    /// What decals are fitted in; bits of coordinates are the scene's, or those of the next one.
    fn fit_view(&self, size: [u32; 2], depth: Option<DepthFormat>) -> FitView<'_> {
        let (object, format) = (camera::narrow(self.object), depth.unwrap_or_default());
        let subpixel_bits = self.composed_for.map_or(self.subpixel_bits, |scene| scene.subpixel_bits);
        FitView { camera: &self.camera, object, size, format, subpixel_bits }
    }
}

impl<B: Bus> Driver<B> {
    /// Sets the camera for the draws that follow.
    ///
    /// # Errors
    /// [`crate::ViewError`]: names the number that has no meaning. The camera stays as it was.
    pub fn set_camera(&mut self, camera: Camera) -> Result<(), DriverError> {
        camera.check()?;
        self.state.camera = camera;
        self.state.matrices_changed();
        self.state.effects.camera_changed();
        Ok(())
    }

    /// The camera.
    #[must_use]
    pub const fn camera(&self) -> &Camera {
        &self.state.camera
    }

    /// Sets the transform from object to world space for the draws that follow: row-major, for row vectors.
    ///
    /// # Errors
    /// [`crate::ViewError::BadNumber`] if an entry is not finite. The transform stays as it was.
    pub fn set_object_transform(&mut self, matrix: &Matrix) -> Result<(), DriverError> {
        for &entry in matrix {
            finite("object transform", entry.into())?;
        }
        self.state.object = camera::wide(matrix);
        self.state.matrices_changed();
        Ok(())
    }

    /// Sets the comparison of a fragment's depth with the stored one; "less" after opening.
    ///
    /// With "always" and depth write off the effect `depth` is not called.
    pub const fn set_depth_function(&mut self, function: DepthFunction) {
        self.state.depth_function = function;
    }

    /// Whether a passing fragment's depth is stored; true after opening.
    pub const fn set_depth_write(&mut self, write: bool) {
        self.state.depth_write = write;
    }

    /// Sets the bits of a pixel that coordinates are snapped to, 4 or 8, from the next begin scene on; 8
    /// after opening.
    ///
    /// # Errors
    /// [`DriverError::BadOption`] for other numbers.
    pub fn set_subpixel_bits(&mut self, bits: u32) -> Result<(), DriverError> {
        if bits != 4 && bits != 8 {
            let found = bits.to_string();
            return Err(DriverError::BadOption { name: "subpixel bits", found, expected: "4 or 8" });
        }
        self.state.subpixel_bits = bits;
        Ok(())
    }

    /// Pixels that clears and draws may change; `None` for the whole target. What lies outside the target
    /// is cut off; an empty rectangle protects everything.
    pub fn set_scissor(&mut self, scissor: Option<Rectangle>) {
        let corner = |x: u32, y: u32| x.min(0x7FFF) | y.min(0x7FFF) << 16;
        self.state.scissor = scissor.map_or(NO_SCISSOR, |r| [corner(r.x, r.y), corner(r.right, r.bottom)]);
    }

    /// Sets the RGBA colour of what is drawn from positions without colours; white after opening.
    pub const fn set_material_colour(&mut self, colour: [u8; 4]) {
        self.state.material = u32::from_le_bytes(colour);
    }

    /// Sets the number that the probe shows for the draws that follow; 0 after opening.
    pub const fn set_tag(&mut self, tag: u32) {
        self.state.tag = tag;
    }

    /// Draws surface markings: what `draw` draws is moved toward the viewer, far enough for surfaces up to
    /// `slope` (|dz/dx|, |dz/dy| in eye space; 8 serves well). Only depth is moved; see [`Decal`] for the
    /// matrix. Negative slopes move away. An inner decal replaces the outer one.
    ///
    /// # Errors
    /// [`crate::ViewError::BadNumber`] if the slope is not finite, [`crate::ViewError::SlopeTooLarge`] if
    /// S/2K is 1 or more in perspective (inside a scene; outside, the first draw tells); else those of `draw`.
    pub fn decal<T>(
        &mut self,
        slope: f64,
        draw: impl FnOnce(&mut Driver<B>) -> Result<T, DriverError>,
    ) -> Result<T, DriverError> {
        finite("decal slope", slope)?;
        if let Some(scene) = &self.scene {
            Decal::new(&self.state.camera, scene.width, slope, scene.depth.unwrap_or_default())?;
        }
        self.moved(DecalState::Slope(slope), draw)
    }

    /// Draws surface markings that lie on surfaces which are known: what `draw` draws is moved toward the viewer by what
    /// these surfaces need where they are seen, which buries nothing and shows as little as possible through what lies in
    /// front. `slope` is the limit: where a surface is steeper than that as a whole, markings on it are moved no farther
    /// than that slope needs. The bound and its proof: `view/fitted.rs`.
    ///
    /// `surfaces` are triangles in object space, under the object transform of the draws. One is enough for markings on a
    /// flat surface of any outline; the two faces beside an edge for a marking along it, and all faces round an end for one that ends at
    /// a corner of a hollow. Markings should lie in the box round the surfaces' corners: from there the rounding of positions is taken.
    /// With several surfaces the one that needs most decides, so markings on different ones are best drawn each in a scope of its own.
    /// Anti-aliased lines and points are moved as their widths need; the bound is that of samples with depths of their own.
    ///
    /// ```
    /// # use zga_device::{Card, CardOptions};
    /// # use zga_driver::{Driver, TargetOptions, Vertex};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// # let card = Card::power_on(CardOptions::default())?;
    /// # let mut driver = Driver::open(card.bus())?;
    /// let target = driver.create_target(TargetOptions::new(64, 48))?;
    /// let surface = [[4.0, 4.0, 0.2], [60.0, 24.0, 0.8], [4.0, 44.0, 0.2]];
    /// driver.begin_scene(&target)?;
    /// driver.clear(Some([0, 0, 64, 255]), Some(1.0))?;
    /// driver.draw_triangle(surface.map(|corner| Vertex::new(corner, [255, 0, 0, 255])))?;
    /// driver.decal_on(8.0, &[surface], |driver| {
    ///     driver.draw_line([Vertex::new([4.5, 24.5, 0.206], [255; 4]), Vertex::new([56.5, 24.5, 0.763], [255; 4])])
    /// })?;
    /// driver.end_scene()?;
    /// driver.present(&target)?;
    /// assert_eq!(driver.capture()?.pixels[24 * 64 + 20], 0xFFFF_FFFF);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// [`crate::ViewError::BadNumber`] if the slope is below 0 or a number is not finite,
    /// [`crate::ViewError::NoSurface`] without a surface or if one has no plane (inside a scene; outside, the first draw
    /// tells); else those of `draw`.
    pub fn decal_on<T>(
        &mut self,
        slope: f64,
        surfaces: &[Corners],
        draw: impl FnOnce(&mut Driver<B>) -> Result<T, DriverError>,
    ) -> Result<T, DriverError> {
        if let Some(scene) = &self.scene {
            let view = self.state.fit_view([scene.width, scene.height], scene.depth);
            FittedDecal::new(&view, slope, surfaces, Marking::Lines)?;
        }
        self.moved(DecalState::Fitted { slope, surfaces: surfaces.to_vec() }, draw)
    }

    fn moved<T>(
        &mut self,
        decal: DecalState,
        draw: impl FnOnce(&mut Driver<B>) -> Result<T, DriverError>,
    ) -> Result<T, DriverError> {
        let outer = self.state.decal.replace(decal);
        self.state.matrices_changed();
        let result = draw(self);
        self.state.decal = outer;
        self.state.matrices_changed();
        result
    }

    /// What a decal of this slope does on `target` with the present camera.
    ///
    /// # Errors
    /// As [`Driver::decal`], and [`DriverError::UnknownTarget`].
    pub fn decal_info(&self, target: &Target, slope: f64) -> Result<DecalInfo, DriverError> {
        let options = self.target_state(target)?.options;
        let format = options.depth.unwrap_or_default();
        Ok(Decal::new(&self.state.camera, options.width, slope, format)?.info)
    }

    /// What a decal fitted to these surfaces does to markings of a kind on `target`, with the present camera and object
    /// transform and no anti-aliasing.
    ///
    /// # Errors
    /// As [`Driver::decal_on`], and [`DriverError::UnknownTarget`].
    pub fn decal_on_info(
        &self,
        target: &Target,
        slope: f64,
        surfaces: &[Corners],
        topology: Topology,
    ) -> Result<FitInfo, DriverError> {
        let options = self.target_state(target)?.options;
        let view = FitView {
            subpixel_bits: self.state.subpixel_bits,
            ..self.state.fit_view([options.width, options.height], options.depth)
        };
        Ok(FittedDecal::new(&view, slope, surfaces, Marking::of(topology, None))?.info)
    }

    /// Whether the scissor leaves all of a target of this size in reach.
    pub(crate) const fn scissor_leaves_all(&self, width: u32, height: u32) -> bool {
        let [minimum, maximum] = self.state.scissor;
        minimum == 0 && maximum & 0xFFFF >= width && maximum >> 16 >= height
    }

    /// Sends the state a clear needs.
    pub(crate) fn prepare_clear(&mut self) -> Result<(), DriverError> {
        self.adopt_recovered();
        self.registers.want(Reg::ScissorMinimum, &self.state.scissor);
        self.send_registers()
    }

    /// Sends the state that a draw of such vertices needs. `gouraud`: their colours differ within a primitive.
    ///
    /// # Errors
    /// Outer: nothing can be drawn. Inner: of the sending only; the draw must follow.
    pub(crate) fn prepare_draw(
        &mut self,
        call: &'static str,
        flags: DrawFlags,
        gouraud: bool,
    ) -> Result<Result<(), DriverError>, DriverError> {
        // May wait for memory, and so meet a fault: before anything is wanted.
        let met = self.place_lights(flags)?;
        self.adopt_recovered();
        let scene = match self.open_scene(call) {
            Ok(scene) => scene,
            Err(lost) => return Err(met.err().unwrap_or(lost)),
        };
        self.check_stencil(&scene)?;
        let depth = scene.depth;
        let masks = self.want_masks(&scene);
        let AntialiasState { line_width, point_size, .. } = self.state.antialias;
        let marking = Marking::of(flags.topology, (!masks.is_empty()).then_some([line_width, point_size]));
        self.compose_matrices([scene.width, scene.height], depth, marking)?;
        let mut effects = masks | self.want_effects(flags, gouraud);
        let state = &self.state;
        let tests_depth = depth.is_some() && (state.depth_function != DepthFunction::Always || state.depth_write);
        let begins_far = tests_depth && !scene.depth_known;
        effects.set(Effects::DEPTH, tests_depth);
        effects.set(Effects::DECAL, state.decal.is_some());
        let control = state.depth_function.code() | if state.depth_write { DEPTH_WRITE } else { 0 };
        let [minimum, maximum] = state.scissor;
        let words = [effects.bits(), control, state.material, state.tag, minimum, maximum];
        // EFFECTS to SCISSOR_MAXIMUM are neighbours.
        for (register, word) in DRAW_STATE.into_iter().zip(words) {
            self.registers.want(register, &[word]);
        }
        if begins_far {
            self.warn(Warning::DepthBeginsFar { path: scene.path });
        }
        Ok(met.and(self.send_registers()))
    }

    /// Composes the matrices if they are due: a fitted decal also for other markings than before.
    fn compose_matrices(
        &mut self,
        [width, height]: [u32; 2],
        depth: Option<DepthFormat>,
        marking: Marking,
    ) -> Result<(), DriverError> {
        let state = &self.state;
        let fitted = matches!(state.decal, Some(DecalState::Fitted { .. }));
        let other_marking = fitted && state.composed_marking != Some(marking);
        if !(state.matrices_due || other_marking) {
            return Ok(());
        }
        let format = depth.unwrap_or_default();
        let matrices = state.camera.matrices(width, height)?;
        let object_eye = camera::narrow(state.camera.view()? * state.object);
        let (decal, info) = match &state.decal {
            Some(DecalState::Slope(slope)) => {
                let decal = Decal::new(&state.camera, width, *slope, format)?;
                (Some(decal.matrix), Some(decal.info))
            }
            Some(DecalState::Fitted { slope, surfaces }) => {
                let view = state.fit_view([width, height], depth);
                (Some(FittedDecal::new(&view, *slope, surfaces, marking)?.matrix), None)
            }
            None => (None, None),
        };
        if let (Some(info), Some(depth)) = (info, depth)
            && let Some(distance) = info.one_step_distance
        {
            let (slope, steps_far) = (info.slope, info.depth_steps_far);
            self.warn(Warning::DecalUnderOneStep { slope, depth_bits: depth.bits(), steps_far, distance });
        }
        self.registers.want(Reg::ObjectEye, &object_eye.map(f32::to_bits));
        // Outside a decal scope the matrix is not in use: what is there can stay.
        if let Some(matrix) = decal {
            self.registers.want(Reg::Decal, &matrix.map(f32::to_bits));
        }
        self.registers.want(Reg::EyeClip, &matrices.eye_clip.map(f32::to_bits));
        self.registers.want(Reg::Viewport, &matrices.viewport.map(f32::to_bits));
        self.state.matrices_due = false;
        self.state.composed_marking = Some(marking);
        Ok(())
    }
}

/// The registers of a draw's state, in order.
const DRAW_STATE: [Reg; 6] =
    [Reg::Effects, Reg::DepthControl, Reg::MaterialColour, Reg::ObjectTag, Reg::ScissorMinimum, Reg::ScissorMaximum];
