//! A script on the card.

use super::{Between, Command, Scene, Script};
use crate::harness::events::NAMES;
use crate::harness::{Events, Hidden, Options, Screen, State};
use zga_device::Kernel;

/// A way to draw: the picture does not depend on it.
#[derive(Clone, Debug)]
pub struct Way {
    /// Who decides visibility, scene by scene; begins anew at the end.
    pub hidden: Vec<Hidden>,
    /// There is a Z buffer. Without one each scene starts with the farthest depths.
    pub depth_buffer: bool,
    /// Stands for a card without a Z buffer: each scene starts with a clear of all depths.
    pub forgets: bool,
    /// Pixel code.
    pub kernel: Kernel,
    /// Host threads.
    pub threads: usize,
    /// Most primitives of a packet; 0 puts in all that fit.
    pub piece: usize,
}

impl Way {
    /// One path for all scenes, with a Z buffer, drawn by the specification.
    #[must_use]
    pub fn plain(hidden: Hidden) -> Self {
        Self {
            hidden: vec![hidden],
            depth_buffer: true,
            forgets: false,
            kernel: Kernel::Specification,
            threads: 1,
            piece: 0,
        }
    }
}

/// What a script came to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// Both frames as scan-out shows them after each scene.
    pub shown: Vec<[Vec<u32>; 2]>,
    /// Looks in mid-scene, in order; `None` on paths that hold the scene back.
    pub looks: Vec<Option<Vec<u32>>>,
    /// Depths at the end; none without a Z buffer that lasts.
    pub depths: Option<Vec<u32>>,
    /// Stencil values at the end; none without a plane.
    pub stencils: Option<Vec<u8>>,
    /// The frame drawn to last, as it is stored; not where nobody knows it.
    pub stored: Option<Vec<u32>>,
    /// Words of memory outside the target that changed.
    pub strays: usize,
    /// What the units counted.
    pub events: Events,
}

impl Outcome {
    /// Where the pictures differ, if they do. Looks and depths count where both have them.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Option<String> {
        let width = |of: &[u32]| of.len();
        let first = |a: &[u32], b: &[u32]| {
            let place = a.iter().zip(b).position(|(a, b)| a != b)?;
            Some(format!("at {place} of {}: {:08x} and {:08x}", width(a), a[place], b[place]))
        };
        if self.shown.len() != other.shown.len() || self.strays + other.strays > 0 {
            return Some(format!("strays {} and {}", self.strays, other.strays));
        }
        for (scene, (mine, others)) in self.shown.iter().zip(&other.shown).enumerate() {
            for frame in 0..2 {
                if let Some(what) = first(&mine[frame], &others[frame]) {
                    return Some(format!("frame {frame} after scene {scene} {what}"));
                }
            }
        }
        if self.looks.len() != other.looks.len() {
            return Some(format!("looks {} and {}", self.looks.len(), other.looks.len()));
        }
        for (number, looks) in self.looks.iter().zip(&other.looks).enumerate() {
            if let (Some(mine), Some(others)) = looks
                && let Some(what) = first(mine, others)
            {
                return Some(format!("look {number} {what}"));
            }
        }
        let what = self.depths.as_ref().zip(other.depths.as_ref()).and_then(|(mine, others)| first(mine, others));
        if let Some(what) = what {
            return Some(format!("depth {what}"));
        }
        if let Some((mine, others)) = self.stencils.as_ref().zip(other.stencils.as_ref())
            && let Some(place) = mine.iter().zip(others).position(|(a, b)| a != b)
        {
            return Some(format!("stencil value {place}: {} and {}", mine[place], others[place]));
        }
        let what = self.stored.as_ref().zip(other.stored.as_ref()).and_then(|(mine, others)| first(mine, others));
        what.map(|what| format!("stored pixel {what}"))
    }
}

/// Runs a script on a new card.
#[must_use]
pub fn run(script: &Script, way: &Way) -> Outcome {
    let [width, height] = script.size;
    let options = Options {
        depth: script.format,
        pixels: script.pixels,
        kernel: way.kernel,
        threads: way.threads,
        hidden: way.hidden[0],
        subpixel: script.subpixel,
        depth_buffer: way.depth_buffer,
        stencil: script.stencil,
        frames: 2,
        ..Options::default()
    };
    let mut screen = Screen::new(width, height, &options);
    screen.set_frame(1);
    screen.fill([0, 0, width, height], 0);
    screen.set_frame(0);
    screen.clear_counts();
    let mut runner = Runner {
        script,
        way,
        screen,
        events: Events([0; NAMES.len()]),
        place: 0,
        shown: Vec::new(),
        looks: Vec::new(),
    };
    for (scene, hidden) in script.scenes.iter().zip(way.hidden.iter().cycle()) {
        runner.scene(scene, *hidden);
    }
    runner.finish()
}

struct Runner<'a> {
    script: &'a Script,
    way: &'a Way,
    screen: Screen,
    /// Events before the last reset.
    events: Events,
    /// Draws so far.
    place: u64,
    shown: Vec<[Vec<u32>; 2]>,
    looks: Vec<Option<Vec<u32>>>,
}

impl Runner<'_> {
    fn scene(&mut self, scene: &Scene, hidden: Hidden) {
        if hidden != self.screen.options().hidden {
            self.screen.set_hidden(hidden, self.way.depth_buffer);
        }
        self.screen.set_frame(scene.frame);
        self.screen.open();
        if self.way.forgets {
            self.screen.clear_planes(None, Some(self.script.format.greatest()), None);
        }
        for command in &scene.commands {
            match command {
                Command::Clear { colour, depth, stencil, scissor } => {
                    self.screen.clear_all_planes(*colour, *depth, *stencil, *scissor);
                }
                Command::Draw { pieces, state } => {
                    let primitives = self.script.primitives(self.place, pieces);
                    self.place += 1;
                    self.screen.draw(&primitives, &State { piece: self.way.piece, ..*state });
                }
                Command::Memory(between) => self.between(between),
                Command::Look => {
                    let look = (!hidden.path.keeps_depths()).then(|| self.screen.shown());
                    self.looks.push(look);
                }
            }
        }
        if self.script.stencil {
            self.screen.set_shadow(scene.shadow.as_ref());
        }
        self.screen.end();
        scene.after.iter().for_each(|between| self.between(between));
        let (mine, other) = (self.screen.shown(), self.screen.other_shown());
        self.shown.push(if scene.frame == 0 { [mine, other] } else { [other, mine] });
    }

    fn between(&mut self, between: &Between) {
        let screen = &mut self.screen;
        match between {
            Between::Fill(area, value) => screen.fill(*area, *value),
            Between::FillDepth(area, value) => screen.fill_depth(*area, *value),
            Between::Copy(area, to) => screen.copy(*area, *to),
            Between::Upload(row, words) => screen.upload(*row, words),
            Between::UploadDepths(row, words) => screen.upload_depths(*row, words),
            Between::Depths => drop(screen.depths()),
            Between::Reset => {
                let events = screen.events();
                add(&mut self.events, &events);
                screen.reset();
            }
            Between::Restore => {
                let snapshot = screen.snapshot();
                screen.restore(&snapshot);
            }
        }
    }

    fn finish(mut self) -> Outcome {
        let lasting = self.way.depth_buffer && !self.way.forgets;
        let depths = lasting.then(|| self.screen.depths());
        add(&mut self.events, &self.screen.events());
        let picture = self.screen.read();
        Outcome {
            shown: self.shown,
            looks: self.looks,
            depths,
            stencils: self.script.stencil.then_some(picture.stencil),
            stored: Some(picture.colour),
            strays: picture.strays,
            events: self.events.of_units(),
        }
    }
}

fn add(sum: &mut Events, events: &Events) {
    sum.0.iter_mut().zip(events.0).for_each(|(sum, value)| *sum += value);
}
