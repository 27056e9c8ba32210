//! Textures: video memory for their levels, texels into it, and how draws read them.

use std::ops::Range;

use zga_abi::Effects;
use zga_abi::bus::{Bus, MEMORY_BASE};
use zga_abi::format::{TextureFilter, TextureFormat, TextureFunction};
use zga_abi::registers::Reg;

use super::mip_map::{self, Level};
use super::texels::{self, Palette, TooManyColours};
use crate::memory::{Alignment, Allocation};
use crate::{Driver, DriverError};

/// Largest width and height of a texture, texels.
const MOST_TEXELS: u32 = 16384;
/// Steps of TEXTURE_BIAS in a level.
const BIAS_STEPS: f64 = 256.0;

/// What a texture is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureOptions {
    /// Texels, 1..=16384.
    pub width: u32,
    /// Texels, 1..=16384.
    pub height: u32,
    /// How texels are stored.
    pub format: TextureFormat,
    /// With smaller levels for what is far away, down to one texel; a third more memory.
    pub mip_map: bool,
}

impl TextureOptions {
    /// 32 bits a texel, MIP-mapped.
    #[must_use]
    pub const fn new(width: u32, height: u32) -> TextureOptions {
        TextureOptions { width, height, format: TextureFormat::Rgba8888, mip_map: true }
    }

    /// Width and height.
    const fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Levels in memory.
    fn levels(&self) -> u32 {
        if self.mip_map { mip_map::levels(self.size()) } else { 1 }
    }

    /// Bytes of each level from the texture's first byte on; each begins at a multiple of 64.
    fn layout(&self) -> Vec<Range<u64>> {
        let mut begin = 0_u64;
        let level = |level| {
            let [width, height] = self.size().map(|side| mip_map::side(side, level));
            let end = begin + 4 * u64::from(texels::row_words(self.format, width)) * u64::from(height);
            let bytes = begin..end;
            begin = end.next_multiple_of(64);
            bytes
        };
        (0..self.levels()).map(level).collect()
    }
}

/// A texture in video memory. Given back with [`Driver::free_texture`].
#[derive(Debug, PartialEq, Eq)]
#[must_use = "a texture that is dropped keeps its video memory until the driver is gone"]
pub struct Texture {
    id: u32,
    options: TextureOptions,
}

impl Texture {
    /// Texels.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.options.width
    }

    /// Texels.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.options.height
    }

    /// How texels are stored.
    #[must_use]
    pub const fn format(&self) -> TextureFormat {
        self.options.format
    }

    /// Levels in memory.
    #[must_use]
    pub fn levels(&self) -> u32 {
        self.options.levels()
    }

    /// Bytes of video memory that its levels take, without a palette.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.options.layout().last().map_or(0, |level| level.end)
    }
}

/// How draws read a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureState<'a> {
    /// The texture.
    pub texture: &'a Texture,
    /// How it is read between texels. Without levels trilinear is bilinear.
    pub filter: TextureFilter,
    /// How it is combined with the colour of what is drawn.
    pub function: TextureFunction,
    /// Repeated in x and y; else its edge goes on.
    pub repeat: [bool; 2],
    /// Repeated in x and y, every other time mirrored.
    pub mirror: [bool; 2],
    /// First texel in use, x and y, of level 0.
    pub offset: [u32; 2],
    /// Texels in use, across and down, of level 0: the coordinates 0 to 1. `None`: from the offset to the end.
    pub window: Option<[u32; 2]>,
    /// Levels, -128 to 127 and 255/256: added to the level of detail; above 0 is coarser.
    pub bias: f64,
    /// Constant colour of [`TextureFunction::Blend`].
    pub colour: [u8; 4],
}

impl<'a> TextureState<'a> {
    /// The whole texture, repeated, trilinear, multiplied by the colour of what is drawn.
    #[must_use]
    pub const fn new(texture: &'a Texture) -> TextureState<'a> {
        TextureState {
            texture,
            filter: TextureFilter::Trilinear,
            function: TextureFunction::Modulate,
            repeat: [true; 2],
            mirror: [false; 2],
            offset: [0; 2],
            window: None,
            bias: 0.0,
            colour: [0; 4],
        }
    }

    /// Checks the numbers; as the registers hold them.
    fn check(&self) -> Result<TextureSetting, DriverError> {
        let bad = |name, found: String, expected| Err(DriverError::BadOption { name, found, expected });
        let TextureState { texture, filter, function, repeat, mirror, offset, window, bias, colour } = *self;
        let (size, levels) = (texture.options.size(), texture.levels());
        let pair = |[x, y]: [u32; 2]| format!("{x}, {y}");
        if offset[0] >= size[0] || offset[1] >= size[1] {
            return bad("texture offset", pair(offset), "a texel of the texture");
        }
        if let Some(window) = window {
            let fits = |axis: usize| (1..=size[axis] - offset[axis]).contains(&window[axis]);
            if !(fits(0) && fits(1)) {
                return bad("texture window", pair(window), "at least 1, 1 and from the offset to the end at most");
            }
        }
        let steps = (bias * BIAS_STEPS).round();
        if !(f64::from(i16::MIN)..=f64::from(i16::MAX)).contains(&steps) {
            return bad("texture bias", bias.to_string(), "-128 to 32767/256 levels");
        }
        let flags = [repeat[0], repeat[1], mirror[0], mirror[1]];
        let flags = (12..).zip(flags).fold(0, |word, (bit, flag)| word | u32::from(flag) << bit);
        let control = texture.format().code() | filter.code() << 4 | function.code() << 8 | flags | levels << 16;
        let word = |[x, y]: [u32; 2]| x | y << 16;
        Ok(TextureSetting {
            id: texture.id,
            size: word(size),
            control,
            offset: word(offset),
            window: window.map_or(0, word),
            bias: u32::from(steps as i16 as u16),
            colour: (function == TextureFunction::Blend).then_some(u32::from_le_bytes(colour)),
            levels,
            may_have_holes: texture.format() != TextureFormat::Rgb565,
        })
    }
}

/// What the user has set, as the registers hold it.
#[derive(Clone, Copy, Debug)]
pub(super) struct TextureSetting {
    id: u32,
    size: u32,
    control: u32,
    offset: u32,
    window: u32,
    bias: u32,
    /// Only where the function uses it.
    colour: Option<u32>,
    levels: u32,
    /// Texels can have an alpha below 255.
    may_have_holes: bool,
}

/// What the driver knows of a texture.
#[derive(Debug)]
pub(crate) struct TextureRecord {
    levels: Allocation,
    palette: Option<Allocation>,
    /// A draw has called for it since its memory was taken.
    in_use: bool,
}

impl<B: Bus> Driver<B> {
    /// Takes video memory for a texture. Its texels are what was there before: see [`Driver::upload_texture`].
    ///
    /// # Errors
    /// [`DriverError::Unsupported`] on a card without a texture unit; [`DriverError::BadOption`] for a size out of
    /// range; [`DriverError::Memory`] if there is no room.
    pub fn create_texture(&mut self, options: &TextureOptions) -> Result<Texture, DriverError> {
        for (name, found) in [("texture width", options.width), ("texture height", options.height)] {
            if !(1..=MOST_TEXELS).contains(&found) {
                return Err(DriverError::BadOption { name, found: found.to_string(), expected: "1 to 16384 texels" });
            }
        }
        self.has_effect(Effects::TEXTURE, "textures")?;
        if options.levels() > 1 {
            self.has_effect(Effects::MIP_MAP, "MIP-mapped textures")?;
        }
        let record = self.take_texture(options)?;
        let id = self.next_texture;
        self.next_texture = id.wrapping_add(1);
        self.textures.insert(id, record);
        Ok(Texture { id, options: *options })
    }

    /// Gives a texture texels: RGBA, `width` times `height`, row by row from the top. Smaller levels are made of them:
    /// each by a box filter from the one before, over the exact area that a texel covers, also of odd sides; red,
    /// green, blue and alpha alike, halves up.
    ///
    /// Texels are stored as the nearest that the format can tell. A format with a palette takes the colours of the
    /// picture for one, exactly; smaller levels take the nearest of them, and colours of their own where there is room.
    ///
    /// Draws that were encoded before still read the texels from before.
    ///
    /// ```
    /// # use zga_abi::{Reg, format::Topology};
    /// # use zga_driver::{Driver, DriverError, TargetOptions, TextureOptions, TextureState, Vertices, bus::MockBus};
    /// # let mut bus = MockBus::new(1 << 20);
    /// # bus.set_register(Reg::CapabilityEffects, 0xFFF);
    /// let mut driver = Driver::open(bus)?;
    /// let squares: Vec<[u8; 4]> = (0..64 * 64)
    ///     .map(|at| if (at / 8 + at / 512) % 2 == 0 { [255; 4] } else { [160, 32, 32, 255] })
    ///     .collect();
    /// let texture = driver.create_texture(&TextureOptions::new(64, 64))?;
    /// driver.upload_texture(&texture, &squares)?;
    /// driver.set_texture(Some(&TextureState::new(&texture)))?;
    ///
    /// // The texture twice across and once down.
    /// let corners = [[0.0, 0.0, 0.5], [60.0, 0.0, 0.5], [0.0, 40.0, 0.5]];
    /// let coordinates = [[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]];
    /// let target = driver.create_target(TargetOptions::new(64, 48))?;
    /// driver.begin_scene(&target)?;
    /// driver.draw_vertices(Topology::Triangles, &Vertices::new(&corners).coordinates(&coordinates), None)?;
    /// driver.end_scene()?;
    /// driver.free_texture(texture)?;
    /// # Ok::<(), DriverError>(())
    /// ```
    ///
    /// # Errors
    /// [`DriverError::UnknownTexture`]; [`DriverError::TexelCount`]; [`DriverError::TooManyColours`] if a palette
    /// cannot hold those of the picture: see [`Driver::upload_texture_with_palette`]; [`DriverError::Memory`] if draws
    /// under way still read the texels from before and there is no room beside them, or as [`Driver::wait`] where
    /// memory is waited for. The texture stays as it was.
    pub fn upload_texture(&mut self, texture: &Texture, texels: &[[u8; 4]]) -> Result<(), DriverError> {
        let levels = make_levels(texture, texels)?;
        let palette = match texture.format().palette() as usize {
            0 => None,
            most => Some(Palette::of(&levels, most).map_err(|TooManyColours { .. }| DriverError::TooManyColours {
                format: texture.format().name(),
                most,
            })?),
        };
        self.write_texture(texture, &levels, palette)
    }

    /// Gives a texture with a palette texels and these colours to choose from, 1 to 256 or 1 to 16: each texel, those
    /// of smaller levels too, takes the nearest (least sum of squares of the four differences), the first of equals.
    ///
    /// # Errors
    /// As [`Driver::upload_texture`]; [`DriverError::BadOption`] for more or fewer colours, or a format without a
    /// palette.
    pub fn upload_texture_with_palette(
        &mut self,
        texture: &Texture,
        texels: &[[u8; 4]],
        palette: &[[u8; 4]],
    ) -> Result<(), DriverError> {
        let expected = match texture.format() {
            TextureFormat::Palette8 => "1 to 256 colours",
            TextureFormat::Palette4 => "1 to 16 colours",
            _ => "none: the format of the texture has no palette",
        };
        if palette.is_empty() || palette.len() > texture.format().palette() as usize {
            let found = format!("{} colours", palette.len());
            return Err(DriverError::BadOption { name: "texture palette", found, expected });
        }
        let levels = make_levels(texture, texels)?;
        self.write_texture(texture, &levels, Some(Palette::new(palette)))
    }

    /// Gives a texture's memory back when the card has drawn what was encoded before. If it is the texture set, none
    /// is set from now on.
    ///
    /// # Errors
    /// [`DriverError::UnknownTexture`].
    #[expect(clippy::needless_pass_by_value, reason = "freeing takes the handle away from its holder")]
    pub fn free_texture(&mut self, texture: Texture) -> Result<(), DriverError> {
        let id = texture.id;
        let record = self.textures.remove(&id).ok_or(DriverError::UnknownTexture { id })?;
        if self.state.effects.texture.is_some_and(|setting| setting.id == id) {
            self.state.effects.texture = None;
        }
        self.free_record(record)
    }

    /// Sets the texture of the draws that follow, and how it is read; `None` for no texture, as after opening. Draws
    /// whose vertices have texture coordinates are textured, others are not.
    ///
    /// # Errors
    /// [`DriverError::UnknownTexture`]; [`DriverError::BadOption`] names the field that has no meaning. The setting
    /// stays as it was.
    pub fn set_texture(&mut self, state: Option<&TextureState<'_>>) -> Result<(), DriverError> {
        self.state.effects.texture = match state {
            None => None,
            Some(state) => {
                let id = state.texture.id;
                if !self.textures.contains_key(&id) {
                    return Err(DriverError::UnknownTexture { id });
                }
                Some(state.check()?)
            }
        };
        Ok(())
    }

    /// Wants the registers of the texture that is set; the effects that it calls for.
    pub(super) fn want_texture(&mut self) -> Effects {
        let Some(setting) = self.state.effects.texture else { return Effects::empty() };
        let Some(record) = self.textures.get_mut(&setting.id) else { return Effects::empty() };
        record.in_use = true;
        let words = [
            (Reg::TextureBase, Some(record.levels.address())),
            (Reg::TextureSize, Some(setting.size)),
            (Reg::TextureControl, Some(setting.control)),
            (Reg::TextureOffset, Some(setting.offset)),
            (Reg::TextureWindow, Some(setting.window)),
            (Reg::TextureColour, setting.colour),
            (Reg::TextureBias, Some(setting.bias)),
            (Reg::PaletteBase, record.palette.as_ref().map(Allocation::address)),
        ];
        for (register, word) in words {
            if let Some(word) = word {
                self.registers.want(register, &[word]);
            }
        }
        let mut effects = Effects::TEXTURE;
        effects.set(Effects::MIP_MAP, setting.levels > 1);
        // No texel has an alpha below 0.
        let reference = self.state.effects.punch_through.filter(|&reference| reference > 0 && setting.may_have_holes);
        if let Some(reference) = reference {
            self.registers.want(Reg::PunchThrough, &[reference.into()]);
            effects |= Effects::PUNCH_THROUGH;
        }
        effects
    }

    /// Takes memory for levels and palette.
    fn take_texture(&mut self, options: &TextureOptions) -> Result<TextureRecord, DriverError> {
        let bytes = options.layout().last().map_or(0, |level| level.end);
        let levels = self.allocate(bytes, Alignment::Line)?;
        let palette = match options.format.palette() {
            0 => None,
            colours => match self.allocate(4 * u64::from(colours), Alignment::Line) {
                Ok(palette) => Some(palette),
                Err(refused) => {
                    self.free(levels)?;
                    return Err(refused);
                }
            },
        };
        Ok(TextureRecord { levels, palette, in_use: false })
    }

    /// Writes levels and palette: into the texture's memory, or into fresh memory while draws may still read it.
    fn write_texture(
        &mut self,
        texture: &Texture,
        levels: &[Level],
        mut palette: Option<Palette>,
    ) -> Result<(), DriverError> {
        let id = texture.id;
        let in_use = self.textures.get(&id).ok_or(DriverError::UnknownTexture { id })?.in_use;
        if in_use && (self.scene.is_some() || !self.queue.is_idle()) {
            let fresh = self.take_texture(&texture.options)?;
            if let Some(before) = self.textures.insert(id, fresh) {
                self.free_record(before)?;
            }
        }
        let record = self.textures.get_mut(&id).ok_or(DriverError::UnknownTexture { id })?;
        record.in_use = false;
        let base = MEMORY_BASE + record.levels.address();
        for (level, bytes) in levels.iter().zip(texture.options.layout()) {
            // All levels lie in an allocation of video memory, so the cast is exact.
            let words = texels::words(texture.format(), level, palette.as_mut());
            self.bus.write_burst(base + bytes.start as u32, &words);
        }
        if let (Some(block), Some(palette)) = (&record.palette, palette) {
            self.bus.write_burst(MEMORY_BASE + block.address(), &palette.words(texture.format().palette()));
        }
        Ok(())
    }

    fn free_record(&mut self, record: TextureRecord) -> Result<(), DriverError> {
        let TextureRecord { levels, palette, .. } = record;
        self.free_after_scene(levels)?;
        palette.map_or(Ok(()), |palette| self.free_after_scene(palette))
    }
}

/// Level 0 of a picture, and what the texture has of smaller ones.
fn make_levels(texture: &Texture, texels: &[[u8; 4]]) -> Result<Vec<Level>, DriverError> {
    let (width, height) = (texture.width(), texture.height());
    if texels.len() as u64 != u64::from(width) * u64::from(height) {
        return Err(DriverError::TexelCount { texels: texels.len(), width, height });
    }
    let first = Level { size: [width, height], texels: texels.to_vec() };
    let levels = std::iter::successors(Some(first), Level::next);
    Ok(levels.take(texture.levels() as usize).collect())
}
