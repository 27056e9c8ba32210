//! Proof of the card's compositions against the real libpixman: random pictures, every bit of every pixel.
//!
//! All operators, formats, masks, repeats and transforms that the X.Org module gives the card, with edges that lie over each other,
//! through the module's own engine. Ends with code 1 if a pixel differs, or if the engine refuses one of these.
//!
//! The bits that no channel has, the unused byte of xrgb8888 and xbgr8888, are not compared: libpixman leaves there what the
//! way it takes happens to leave (a copied alpha, a computed one, 0), and nothing reads them but as 255.
//!
//! libpixman has fast ways for many combinations beside the general one. PIXMAN_DISABLE="fast mmx sse2 ssse3 wholeops" in the
//! environment leaves the general one alone; `ddx-shim/test.sh` runs this both ways, and all of them come to the same pixels.

#[expect(unsafe_code, reason = "calls of a C library; each block has its proof")]
mod ffi;
#[path = "../x_suite/random.rs"]
mod random;

use std::process::ExitCode;

use clap::Parser;
use zga_abi::format::{BitmapFormat, ComposeOperator, PictureFormat, Repeat};
use zga_ddx_shim::engine::compose::{Cover, Ink, Request, Sampled, Surface, finds_pixels};
use zga_ddx_shim::engine::{Engine, EngineOptions, Wanted};
use zga_driver::{ClipBox, ListRectangle, Transform};

use ffi::{Colour, Image, Reading};
use random::Random;

/// The card's compositions against libpixman's
#[derive(Debug, Parser)]
struct Cli {
    /// Seed of the first composition
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Compositions
    #[arg(long, default_value_t = 20_000)]
    cases: u64,
    /// Differences that are told before it ends
    #[arg(long, default_value_t = 5)]
    most: u64,
}

/// libpixman's numbers for filters.
const NEAREST: u32 = 3;
const BILINEAR: u32 = 4;
/// One in 16.16.
const ONE: i32 = 1 << 16;

/// libpixman's number for a format: bits a pixel, kind, bits of alpha, red, green, blue.
const fn code(format: PictureFormat) -> u32 {
    match format {
        PictureFormat::Xrgb8888 => 0x2002_0888,
        PictureFormat::Argb8888 => 0x2002_8888,
        PictureFormat::Xbgr8888 => 0x2003_0888,
        PictureFormat::Abgr8888 => 0x2003_8888,
        PictureFormat::Rgb565 => 0x1002_0565,
        PictureFormat::Alpha8 => 0x0801_8000,
    }
}

/// Bits of a stored pixel that belong to a channel.
const fn meaningful(format: PictureFormat) -> u32 {
    match format {
        PictureFormat::Xrgb8888 | PictureFormat::Xbgr8888 => 0x00FF_FFFF,
        PictureFormat::Argb8888 | PictureFormat::Abgr8888 => u32::MAX,
        PictureFormat::Rgb565 => 0xFFFF,
        PictureFormat::Alpha8 => 0xFF,
    }
}

/// Pixels in rows of whole words.
#[derive(Clone, Debug)]
struct Pixels {
    format: PictureFormat,
    size: [u32; 2],
    stride: usize,
    words: Vec<u32>,
}

impl Pixels {
    fn random(random: &mut Random) -> Pixels {
        let format = random.of(PictureFormat::ALL);
        let side = |random: &mut Random| {
            let most = random.of(&[1, 2, 9, 33, 70]);
            random.below(most) + 1
        };
        let size = [side(random), side(random)];
        let stride = (size[0] * format.bytes()).div_ceil(4) as usize;
        let mut words = vec![0_u32; stride * size[1] as usize];
        bytemuck::cast_slice_mut(&mut words).copy_from_slice(&random.bytes(4 * stride * size[1] as usize));
        // Half of the time many bytes are 0 or 255, which fast ways look for.
        if random.once_in(2) {
            let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut words);
            bytes.iter_mut().for_each(|byte| *byte = random.of(&[0, 255, *byte, *byte]));
        }
        Pixels { format, size, stride, words }
    }

    /// The stored pixel, without bits that no channel has.
    fn pixel(&self, x: usize, y: usize) -> u32 {
        let bits = 8 * self.format.bytes() as usize;
        let word = self.words[y * self.stride + x * bits / 32];
        word >> (x * bits % 32) & meaningful(self.format)
    }

    fn bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.words)
    }

    /// The same pixels in the card's memory.
    fn pixmap(&self, engine: &mut Engine) -> Result<usize, String> {
        let [width, height] = self.size;
        let bytes = self.format.bytes();
        let pixmap = engine.create_pixmap((width, height), 8 * bytes, Wanted::Anywhere);
        match engine.upload(pixmap, (0, 0), (width * bytes, height), self.bytes(), 4 * self.stride) {
            true => Ok(pixmap),
            false => Err(format!("no pixmap of {width} x {height} pixels")),
        }
    }
}

/// Something that is read.
#[derive(Clone, Debug)]
enum Read {
    Colour(Colour),
    Image { pixels: Pixels, repeat: Repeat, filter: u32, transform: Option<Transform> },
}

/// Something that is read, where, and whether by components.
#[derive(Clone, Debug)]
struct Part {
    read: Read,
    at: [i32; 2],
    components: bool,
}

/// A composition.
#[derive(Clone, Debug)]
struct Case {
    operator: ComposeOperator,
    source: Part,
    mask: Option<Part>,
    onto: Pixels,
    at: [i32; 2],
    size: [i32; 2],
}

fn transform(random: &mut Random) -> Option<Transform> {
    let still = Transform { xx: ONE, xy: 0, x0: 0, yx: 0, yy: ONE, y0: 0 };
    let moved = |random: &mut Random| random.between(-30, 60) * ONE;
    // Places between pixels, and those where a pixel ends and the next begins.
    let aside = |random: &mut Random| match random.below(4) {
        0 => random.between(-60, 60) * ONE / 2,
        1 => random.between(-60, 60) * ONE / 2 + random.between(-1, 1),
        _ => random.between(-30 * ONE, 60 * ONE),
    };
    let (kind, x, y) = (random.below(12), moved(random), moved(random));
    let (x0, y0) = (aside(random), aside(random));
    let mut scale = || match random.below(3) {
        0 => random.between(1, 6) * ONE / 2,
        _ => random.between(-3 * ONE, 3 * ONE),
    };
    match kind {
        0..=4 => None,
        5 => Some(Transform { x0: x, y0: y, ..still }),
        6 => Some(Transform { x0, y0, ..still }),
        7 => Some(Transform { xx: scale(), yy: scale(), x0, y0, ..still }),
        8 => Some(Transform { xx: -ONE, yy: -ONE, x0, y0, ..still }),
        9 => Some(Transform { xx: 0, xy: -ONE, x0, yx: ONE, yy: 0, y0 }),
        10 => Some(Transform { xx: 0, xy: ONE, x0, yx: -ONE, yy: 0, y0 }),
        _ => Some(Transform { xx: scale(), xy: scale(), x0, yx: scale(), yy: scale(), y0 }),
    }
}

impl Part {
    fn random(random: &mut Random, components: bool) -> Part {
        if random.once_in(5) {
            let mut channel = || match random.below(4) {
                0 => 0,
                1 => 0xFFFF,
                _ => random.below(1 << 16) as u16,
            };
            let colour = Colour { red: channel(), green: channel(), blue: channel(), alpha: channel() };
            return Part { read: Read::Colour(colour), at: [0; 2], components };
        }
        let pixels = Pixels::random(random);
        let transform = transform(random);
        let filter = if finds_pixels(transform.as_ref()) { random.of(&[NEAREST, BILINEAR]) } else { NEAREST };
        let at = match random.below(3) {
            0 => [random.between(-20, 60), random.between(-20, 60)],
            _ => [random.between(-2, 4), random.between(-2, 4)],
        };
        Part { read: Read::Image { pixels, repeat: random.of(Repeat::ALL), filter, transform }, at, components }
    }

    /// As libpixman has it.
    fn image<'w>(&self, words: &'w mut Vec<u32>) -> Image<'w> {
        let (mut image, repeat, filter, transform) = match &self.read {
            Read::Colour(colour) => (Image::solid(*colour), Repeat::None, NEAREST, None),
            Read::Image { pixels, repeat, filter, transform } => {
                words.clone_from(&pixels.words);
                (Image::bits(code(pixels.format), pixels.size, words, pixels.stride), *repeat, *filter, *transform)
            }
        };
        let matrix = transform.map(|Transform { xx, xy, x0, yx, yy, y0 }| [[xx, xy, x0], [yx, yy, y0], [0, 0, ONE]]);
        image.read_as(&Reading { repeat: repeat.code(), filter, components: self.components, matrix });
        image
    }

    /// As the engine has it, for a composition at this place of the destination.
    fn ink(&self, engine: &mut Engine, to: [i32; 2], made: &mut Vec<usize>) -> Result<Ink, String> {
        match &self.read {
            Read::Colour(colour) => {
                let upper = [colour.alpha, colour.red, colour.green, colour.blue].map(|channel| (channel >> 8) as u8);
                Ok(Ink::Colour(u32::from_be_bytes(upper)))
            }
            Read::Image { pixels, repeat, transform, .. } => {
                let pixmap = pixels.pixmap(engine)?;
                made.push(pixmap);
                let surface = Surface { pixmap, size: pixels.size, format: pixels.format };
                let offset = [self.at[0] - to[0], self.at[1] - to[1]];
                Ok(Ink::Sampled(Sampled { surface, offset, repeat: *repeat, transform: *transform }))
            }
        }
    }
}

impl Case {
    fn random(seed: u64) -> Case {
        let mut random = Random::new(seed);
        let operator = random.of(ComposeOperator::ALL);
        let source = Part::random(&mut random, false);
        let mask = match random.below(3) {
            0 => None,
            kind => Some(Part::random(&mut random, kind == 2)),
        };
        let onto = Pixels::random(&mut random);
        let [width, height] = onto.size.map(|side| side as i32);
        let at = [random.between(-5, width), random.between(-5, height)];
        let size = [random.between(1, width + 9), random.between(1, height + 9)];
        Case { operator, source, mask, onto, at, size }
    }

    /// What libpixman makes of it.
    fn right(&self) -> Pixels {
        let mut onto = self.onto.clone();
        let (mut source_words, mut mask_words) = (Vec::new(), Vec::new());
        let source = self.source.image(&mut source_words);
        let mask = self.mask.as_ref().map(|mask| (mask.image(&mut mask_words), mask.at));
        let mut image = Image::bits(code(onto.format), onto.size, &mut onto.words, onto.stride);
        let mask = mask.as_ref().map(|(mask, at)| (mask, *at));
        image.compose(self.operator.code(), (&source, self.source.at), mask, self.at, self.size);
        drop(image);
        onto
    }

    /// What the card makes of it.
    fn found(&self, engine: &mut Engine) -> Result<Pixels, String> {
        let mut made = Vec::new();
        let source = self.source.ink(engine, self.at, &mut made)?;
        let mask = match &self.mask {
            None => Cover::None,
            Some(mask) => match (mask.ink(engine, self.at, &mut made)?, mask.components) {
                (ink, false) => Cover::Unified(ink),
                (ink, true) => Cover::Components(ink),
            },
        };
        let pixmap = self.onto.pixmap(engine)?;
        made.push(pixmap);
        let onto = Surface { pixmap, size: self.onto.size, format: self.onto.format };
        let clips = &[ClipBox::ALL];
        let request = Request { operator: self.operator, source, mask, onto, clips, moved: [0; 2] };
        let [x, y] = self.at.map(|place| place as i16);
        let [width, height] = self.size.map(|side| side as u16);
        let drawn = engine.compose(&request, ListRectangle { x, y, width, height });
        let pitch = engine.pitch(pixmap) as usize / 4;
        let address = engine.access(pixmap).ok_or("a pixmap has no pixels")?;
        let words = ffi::words(address, pitch * self.onto.size[1] as usize);
        engine.finish();
        made.into_iter().for_each(|pixmap| engine.destroy_pixmap(pixmap));
        match drawn {
            true => Ok(Pixels { words, stride: pitch, ..self.onto }),
            false => Err("the engine refuses it".to_owned()),
        }
    }

    /// Pixels that libpixman changes; an error says where the two differ first, and in how many pixels.
    fn compare(&self, engine: &mut Engine) -> Result<usize, String> {
        let (right, found) = (self.right(), self.found(engine)?);
        let [width, height] = self.onto.size.map(|side| side as usize);
        let places = || (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let odd: Vec<_> = places().filter(|&(x, y)| found.pixel(x, y) != right.pixel(x, y)).collect();
        let Some(&(x, y)) = odd.first() else {
            return Ok(places().filter(|&(x, y)| right.pixel(x, y) != self.onto.pixel(x, y)).count());
        };
        Err(format!(
            "{} pixels differ, the first at ({x}, {y}): {:08x}, expected {:08x}, before {:08x}",
            odd.len(),
            found.pixel(x, y),
            right.pixel(x, y),
            self.onto.pixel(x, y)
        ))
    }

    /// Everything but the pixels.
    fn told(&self) -> String {
        let part = |part: &Part| match &part.read {
            Read::Colour(colour) => format!("{colour:x?}"),
            Read::Image { pixels, repeat, filter, transform } => format!(
                "{:?} {:?} at {:?}, repeat {}, filter {filter}, {transform:?}",
                pixels.format,
                pixels.size,
                part.at,
                repeat.name()
            ),
        };
        let mask = self.mask.as_ref().map_or("none".to_owned(), |mask| {
            format!("{} {}", if mask.components { "components" } else { "unified" }, part(mask))
        });
        format!(
            "{} onto {:?} {:?} at {:?}, {:?} pixels\n    source {}\n    mask {mask}",
            self.operator.name(),
            self.onto.format,
            self.onto.size,
            self.at,
            self.size,
            part(&self.source)
        )
    }
}

/// Compositions that differ, and pixels that were changed by the others.
fn run(cli: &Cli) -> Result<(u64, usize), String> {
    let options = EngineOptions {
        video_memory: 8 << 20,
        threads: 1,
        accel: true,
        frame: (64, 64),
        format: BitmapFormat::Xrgb8888,
        cpu_limit: 0,
    };
    let mut engine = Engine::new(&options, Box::new(|_, text| eprintln!("{text}")))?;
    let (mut differ, mut changed) = (0, 0);
    for seed in cli.seed..cli.seed + cli.cases {
        let case = Case::random(seed);
        match case.compare(&mut engine) {
            Ok(pixels) => changed += pixels,
            Err(told) => {
                differ += 1;
                println!("--seed {seed} --cases 1: {told}\n  {}", case.told());
            }
        }
        if differ == cli.most {
            break;
        }
    }
    Ok((differ, changed))
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let off = std::env::var("PIXMAN_DISABLE").ok().filter(|off| !off.is_empty());
    let ways = off.map_or("as it is".to_owned(), |off| format!("without {off}"));
    match run(&cli) {
        Ok((differ, changed)) => {
            println!(
                "pixman: {} compositions (libpixman {ways}): {changed} pixels changed, {differ} differ",
                cli.cases
            );
            // Where nothing changes nothing is proved.
            ExitCode::from(u8::from(differ > 0 || changed == 0))
        }
        Err(reason) => {
            eprintln!("error: {reason}");
            ExitCode::from(2)
        }
    }
}
