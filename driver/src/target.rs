//! Targets, scenes and presenting.

use zga_abi::bus::Bus;
use zga_abi::format::{DepthFormat, HiddenSurface, PixelFormat};
use zga_abi::packet::{CLEAR_COLOUR, CLEAR_DEPTH, CLEAR_STENCIL, CLEAR_STENCIL_SHIFT, Opcode, header};
use zga_abi::registers::Reg;

use crate::hidden::ZaAreas;
use crate::memory::{Alignment, Allocation};
use crate::state::ComposedFor;
use crate::{Driver, DriverError};

/// Largest width and height in pixels.
pub(crate) const MOST_PIXELS: u32 = 16384;

/// What a target is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TargetOptions {
    /// Pixels, 1..=16384.
    pub width: u32,
    /// Pixels, 1..=16384.
    pub height: u32,
    /// Format of a pixel.
    pub pixel_format: PixelFormat,
    /// Number format of depth; `None` for no Z buffer.
    pub depth: Option<DepthFormat>,
    /// Two frame buffers: one is drawn to while the other is shown.
    pub double_buffered: bool,
    /// A stencil plane.
    pub stencil: bool,
}

impl TargetOptions {
    /// XRGB8888 with a Z buffer of 24 bits and one frame buffer.
    #[must_use]
    pub fn new(width: u32, height: u32) -> TargetOptions {
        let (pixel_format, depth) = (PixelFormat::Xrgb8888, Some(DepthFormat::default()));
        TargetOptions { width, height, pixel_format, depth, double_buffered: false, stencil: false }
    }
}

/// A place to draw to. Given back with [`Driver::destroy_target`].
#[derive(Debug, PartialEq, Eq)]
#[must_use = "a target that is dropped keeps its video memory until the driver is gone"]
pub struct Target {
    id: u32,
    width: u32,
    height: u32,
}

impl Target {
    /// Pixels.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.width
    }

    /// Pixels.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.height
    }
}

/// What the driver knows of a target.
#[derive(Debug)]
pub(crate) struct TargetState {
    pub options: TargetOptions,
    buffers: Vec<Allocation>,
    /// Which of them is drawn to.
    back: usize,
    pitch: u32,
    pub depth: Option<Allocation>,
    pub depth_pitch: u32,
    pub stencil: Option<Allocation>,
    pub stencil_pitch: u32,
    pub za: ZaAreas,
    /// The path of the last scene, if that scene left no depths behind.
    pub depth_lost: Option<HiddenSurface>,
}

impl TargetState {
    /// Number of frame buffers.
    pub const fn frames(&self) -> usize {
        self.buffers.len()
    }

    /// First byte and pitch of the frame buffer that is drawn to.
    pub fn frame_surface(&self) -> (u32, u32) {
        (self.buffers[self.back].address(), self.pitch)
    }
}

/// The scene that is open.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scene {
    pub id: u32,
    pub width: u32,
    pub height: u32,
    pub depth: Option<DepthFormat>,
    pub path: HiddenSurface,
    /// Its pixels have samples.
    pub grid: bool,
    /// It has a stencil plane.
    pub stencil: bool,
    /// It has a Z buffer, or all depth was cleared in it.
    pub depth_known: bool,
    /// Its begin was refused: nothing can be drawn until it ends.
    pub lost: bool,
}

/// Bytes from a row to the next for rows of `bytes` bytes: a multiple of 64, and never of 4096.
///
/// The same columns of rows a multiple of 4096 apart fall into the same set of a host's first-level cache
/// (64 sets of 64 bytes): a tile of more rows than the set has ways would evict itself.
pub(crate) const fn pitch_of(bytes: u32) -> u32 {
    let pitch = bytes.next_multiple_of(64);
    if pitch.is_multiple_of(4096) { pitch + 64 } else { pitch }
}

/// Width and height as TARGET_SIZE and SCANOUT_SIZE hold them.
pub(crate) const fn size_word(width: u32, height: u32) -> u32 {
    width | height << 16
}

impl<B: Bus> Driver<B> {
    /// Takes video memory for a target. Its contents are what was there before: clear it.
    ///
    /// # Errors
    /// [`DriverError::BadOption`] for a size out of range, [`DriverError::Memory`] if there is no room.
    pub fn create_target(&mut self, options: TargetOptions) -> Result<Target, DriverError> {
        let TargetOptions { width, height, .. } = options;
        for (name, pixels) in [("target width", width), ("target height", height)] {
            if !(1..=MOST_PIXELS).contains(&pixels) {
                return Err(DriverError::BadOption { name, found: pixels.to_string(), expected: "1 to 16384 pixels" });
            }
        }
        let (pitch, depth_pitch) = (pitch_of(width * options.pixel_format.bytes()), pitch_of(4 * width));
        let stencil_pitch = if options.stencil { pitch_of(width) } else { 0 };
        let surfaces = [
            Some(pitch),
            options.double_buffered.then_some(pitch),
            options.depth.map(|_| depth_pitch),
            options.stencil.then_some(stencil_pitch),
        ];
        let mut taken = Vec::new();
        for pitch in surfaces.into_iter().flatten() {
            match self.allocate(u64::from(pitch) * u64::from(height), Alignment::Line) {
                Ok(surface) => taken.push(surface),
                Err(refused) => {
                    for surface in taken {
                        self.free(surface)?;
                    }
                    return Err(refused);
                }
            }
        }
        let stencil = if options.stencil { taken.pop() } else { None };
        let depth = options.depth.and_then(|_| taken.pop());
        let depth_pitch = if depth.is_some() { depth_pitch } else { 0 };
        let id = self.next_target;
        self.next_target = id.wrapping_add(1);
        let (za, depth_lost) = (ZaAreas::default(), None);
        let state = TargetState {
            options,
            buffers: taken,
            back: 0,
            pitch,
            depth,
            depth_pitch,
            stencil,
            stencil_pitch,
            za,
            depth_lost,
        };
        self.targets.insert(id, state);
        Ok(Target { id, width, height })
    }

    /// Gives a target's memory back. If one of its frames is shown, the screen goes dark.
    ///
    /// # Errors
    /// [`DriverError::UnknownTarget`]; [`DriverError::InsideScene`] if it is being drawn to.
    #[expect(clippy::needless_pass_by_value, reason = "destroying takes the handle away from its holder")]
    pub fn destroy_target(&mut self, target: Target) -> Result<(), DriverError> {
        let state = self.target_state(&target)?;
        let shown = self.registers.wanted(Reg::ScanoutBase);
        let is_shown = self.shown.is_some() && state.buffers.iter().any(|buffer| buffer.address() == shown);
        if self.scene.is_some_and(|scene| scene.id == target.id) {
            return Err(DriverError::InsideScene { call: "destroy_target" });
        }
        if is_shown {
            self.registers.want(Reg::ScanoutSize, &[0]);
            self.shown = None;
            self.send_registers()?;
        }
        if let Some(state) = self.targets.remove(&target.id) {
            self.free_za_words(state.za)?;
            for surface in state.buffers.into_iter().chain(state.depth).chain(state.stencil) {
                self.free(surface)?;
            }
        }
        Ok(())
    }

    /// Begins a scene: the draws that follow go to `target`, to the frame buffer that is not shown.
    ///
    /// # Errors
    /// [`DriverError::InsideScene`], [`DriverError::UnknownTarget`], [`DriverError::ZaRamTooSmall`] on the Za
    /// path, or as [`Driver::flush`].
    pub fn begin_scene(&mut self, target: &Target) -> Result<(), DriverError> {
        if self.scene.is_some() {
            return Err(DriverError::InsideScene { call: "begin_scene" });
        }
        self.adopt_recovered();
        let frame = self.target_state(target)?.back;
        self.want_path(target.id, frame)?;
        let (path, uses_z_buffer) = (self.state.hidden.surface, self.state.hidden.uses_z_buffer());
        let state = self.targets.get_mut(&target.id).ok_or(DriverError::UnknownTarget { id: target.id })?;
        state.depth_lost = (!uses_z_buffer).then_some(path);
        let TargetOptions { width, height, pixel_format, depth, .. } = state.options;
        let base = state.buffers[frame].address();
        self.registers.want(Reg::TargetSize, &[size_word(width, height)]);
        self.registers.want(Reg::ColourBase, &[base]);
        self.registers.want(Reg::ColourPitch, &[state.pitch]);
        self.registers.want(Reg::ColourFormat, &[pixel_format.code()]);
        self.registers.want(Reg::DepthPitch, &[if uses_z_buffer { state.depth_pitch } else { 0 }]);
        if let (Some(format), Some(surface)) = (depth, &state.depth) {
            if uses_z_buffer {
                self.registers.want(Reg::DepthBase, &[surface.address()]);
            }
            self.registers.want(Reg::DepthFormat, &[format.code()]);
        }
        let stencil = state.stencil.is_some();
        self.registers.want(Reg::StencilPitch, &[state.stencil_pitch]);
        if let Some(plane) = &state.stencil {
            self.registers.want(Reg::StencilBase, &[plane.address()]);
        }
        self.registers.want(Reg::SubpixelBits, &[self.state.subpixel_bits]);
        let grid = self.want_antialias();
        let composed_for = Some(ComposedFor { size: [width, height], depth, subpixel_bits: self.state.subpixel_bits });
        if self.state.composed_for != composed_for {
            self.state.composed_for = composed_for;
            self.state.matrices_changed();
        }
        let (id, depth_known) = (target.id, uses_z_buffer);
        self.scene = Some(Scene { id, width, height, depth, path, grid, stencil, depth_known, lost: false });
        let registers = self.send_registers();
        registers.and(self.encode(Opcode::BeginScene, &[]))
    }

    /// Clears frame buffer and Z buffer inside the scissor: RGBA and depth (0 near to 1 far), `None` leaves as is.
    ///
    /// # Errors
    /// [`DriverError::OutsideScene`]; [`DriverError::NoDepthBuffer`] for a depth where there is none;
    /// [`DriverError::BadOption`] for a depth outside 0..=1; or as [`Driver::flush`].
    pub fn clear(&mut self, colour: Option<[u8; 4]>, depth: Option<f32>) -> Result<(), DriverError> {
        self.clear_with_stencil(colour, depth, None)
    }

    /// Clears frame buffer, Z buffer and stencil plane inside the scissor, as [`Driver::clear`]; `None` leaves as is. No
    /// mask counts.
    ///
    /// # Errors
    /// As [`Driver::clear`], and [`DriverError::NoStencilPlane`] for a stencil value where there is no plane.
    pub fn clear_with_stencil(
        &mut self,
        colour: Option<[u8; 4]>,
        depth: Option<f32>,
        stencil: Option<u8>,
    ) -> Result<(), DriverError> {
        let scene = self.open_scene("clear")?;
        let mut planes = if colour.is_some() { CLEAR_COLOUR } else { 0 };
        let mut value = 0;
        if let Some(depth) = depth {
            let format = scene.depth.ok_or(DriverError::NoDepthBuffer { id: scene.id })?;
            if !(0.0..=1.0).contains(&depth) {
                let found = depth.to_string();
                return Err(DriverError::BadOption { name: "clear depth", found, expected: "0 (near) to 1 (far)" });
            }
            planes |= CLEAR_DEPTH;
            value = (f64::from(depth) * f64::from(format.maximum()) + 0.5).floor() as u32;
        }
        if let Some(stencil) = stencil {
            if !scene.stencil {
                return Err(DriverError::NoStencilPlane { id: scene.id });
            }
            planes |= CLEAR_STENCIL | u32::from(stencil) << CLEAR_STENCIL_SHIFT;
        }
        if planes == 0 {
            return Ok(());
        }
        let clears_all = self.scissor_leaves_all(scene.width, scene.height);
        if let (Some(open), true) = (&mut self.scene, clears_all && planes & CLEAR_DEPTH != 0) {
            open.depth_known = true;
        }
        let colour = u32::from_le_bytes(colour.unwrap_or_default());
        let state = self.prepare_clear();
        self.encode_in_scene("clear", state, Opcode::Clear, &[&[planes, colour, value]])
    }

    /// Ends the scene: when what follows is executed, everything drawn is in memory.
    ///
    /// # Errors
    /// [`DriverError::OutsideScene`], or as [`Driver::flush`].
    pub fn end_scene(&mut self) -> Result<(), DriverError> {
        self.adopt_recovered();
        let scene = self.scene.take().ok_or(DriverError::OutsideScene { call: "end_scene" })?;
        let ended = if scene.lost {
            Ok(())
        } else {
            let registers = if scene.stencil {
                self.want_shadow();
                self.send_registers()
            } else {
                Ok(())
            };
            registers.and(self.encode(Opcode::EndScene, &[]))
        };
        let freed = self.free_scene_memory();
        ended.and(freed)
    }

    /// Shows what was drawn to `target` from the next vertical blank on. With two frame buffers the next
    /// scene goes to the other one.
    ///
    /// # Errors
    /// [`DriverError::InsideScene`], [`DriverError::UnknownTarget`], or as [`Driver::flush`].
    pub fn present(&mut self, target: &Target) -> Result<(), DriverError> {
        if self.scene.is_some() {
            return Err(DriverError::InsideScene { call: "present" });
        }
        self.adopt_recovered();
        let state = self.targets.get_mut(&target.id).ok_or(DriverError::UnknownTarget { id: target.id })?;
        let base = state.buffers[state.back].address();
        state.back = (state.back + 1) % state.buffers.len();
        let TargetOptions { width, height, pixel_format, .. } = state.options;
        self.registers.want(Reg::ScanoutPitch, &[state.pitch]);
        self.registers.want(Reg::ScanoutFormat, &[pixel_format.code()]);
        self.registers.want(Reg::ScanoutSize, &[size_word(width, height)]);
        self.shown = Some((width, height));
        let registers = self.send_registers();
        self.registers.follow(&[header(Opcode::Present, 1), base]);
        registers.and(self.encode(Opcode::Present, &[&[base]]))
    }

    /// Where a target's surfaces are, for packets that the driver has no method for: first byte and pitch of
    /// the frame buffer that is drawn to, and of the Z buffer.
    ///
    /// # Errors
    /// [`DriverError::UnknownTarget`].
    pub fn target_surfaces(&self, target: &Target) -> Result<[Option<(u32, u32)>; 2], DriverError> {
        let state = self.target_state(target)?;
        Ok([Some(state.frame_surface()), state.depth.as_ref().map(|surface| (surface.address(), state.depth_pitch))])
    }

    /// What is known of a target.
    pub(crate) fn target_state(&self, target: &Target) -> Result<&TargetState, DriverError> {
        self.targets.get(&target.id).ok_or(DriverError::UnknownTarget { id: target.id })
    }

    /// Number of a target.
    pub(crate) const fn target_id(target: &Target) -> u32 {
        target.id
    }

    /// The open scene, unless it was lost.
    pub(crate) fn open_scene(&self, call: &'static str) -> Result<Scene, DriverError> {
        self.scene.filter(|scene| !scene.lost).ok_or(DriverError::OutsideScene { call })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pitch_of_is_a_multiple_of_64_but_not_of_4096() {
        assert_eq!([1, 64, 65, 2560, 4096, 4095, 8192].map(pitch_of), [64, 64, 128, 2560, 4160, 4160, 8256]);
    }
}
