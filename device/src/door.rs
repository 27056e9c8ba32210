//! The public door: power on, plug in bus and monitor, save and restore, power off.

use crate::bitmap::Bitmap;
use crate::bus::CardBus;
use crate::bus::backplane::Backplane;
use crate::card::{Blocks, Board};
use crate::error::CardError;
use crate::frontend::Frontend;
use crate::frontend::ring::RingFetch;
use crate::hidden::systolic::Waves;
use crate::memory::MappedMemory;
use crate::pipeline::{Kernel, Pipeline, PipelineOptions};
use crate::probe::Probe;
use crate::probe::account::Account;
use crate::probe::snapshot::Snapshot;
use crate::scanout::Scanout;
use crate::scanout::monitor::{Connector, Monitor};
use crate::subpixel::map::SubpixelMap;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::Ordering::SeqCst;
use std::thread::JoinHandle;
use zga_abi::Units;
use zga_firmware::Processor;

/// What is soldered to a card, and how the host computes it.
#[derive(Clone, Copy, Debug)]
pub struct CardOptions {
    /// Video memory in bytes: a multiple of 4096 from 1 MiB to 1 GiB.
    pub video_memory: u32,
    /// Za RAM in bytes: a multiple of 4096 up to 32 MiB. Costs nothing before it is written.
    pub za_ram: u32,
    /// Host threads that draw; 0 takes all cores. The picture does not depend on it.
    pub threads: usize,
    /// Pixel code. The picture does not depend on it.
    pub kernel: Kernel,
}

impl Default for CardOptions {
    /// 64 MiB of video memory, 1 MiB of Za RAM, all cores.
    fn default() -> Self {
        CardOptions { video_memory: 64 << 20, za_ram: 1 << 20, threads: 0, kernel: Kernel::default() }
    }
}

impl CardOptions {
    /// Refuses memories that the address map has no place for.
    fn check(&self) -> Result<(), CardError> {
        let pages = |bytes: u32| bytes.is_multiple_of(4096);
        if !pages(self.video_memory) || !(1 << 20..=1 << 30).contains(&self.video_memory) {
            return Err(CardError::VideoMemory { bytes: self.video_memory });
        }
        if !pages(self.za_ram) || self.za_ram > 32 << 20 {
            return Err(CardError::ZaRam { bytes: self.za_ram });
        }
        Ok(())
    }
}

/// A card with power. Dropping it takes the power away: work ends, waiting hosts return.
#[derive(Debug)]
pub struct Card {
    backplane: Arc<Backplane>,
    thread: Option<JoinHandle<()>>,
}

impl Card {
    /// Powers a card on: memories are zero, registers at their reset values.
    ///
    /// # Errors
    /// [`CardError::VideoMemory`], [`CardError::ZaRam`] for sizes out of range;
    /// [`CardError::Thread`] when the host gives no thread.
    pub fn power_on(options: CardOptions) -> Result<Card, CardError> {
        options.check()?;
        let CardOptions { video_memory, za_ram, threads, kernel } = options;
        let (backplane, fifo, control) = Backplane::new(video_memory, za_ram);
        let backplane = Arc::new(backplane);
        let board = Board {
            backplane: Arc::clone(&backplane),
            control,
            frontend: Frontend { fifo, ring: RingFetch::default(), processor: Processor::new() },
            blocks: Blocks {
                pipeline: Pipeline::new(&PipelineOptions { threads, kernel }),
                bitmap: Bitmap::new(kernel),
                scanout: Scanout::default(),
                probe: Probe::default(),
                account: Account::default(),
                powered: Units::empty(),
            },
        };
        let power = Power(Arc::clone(&backplane));
        let thread = std::thread::Builder::new().name("zga-card".to_owned()).spawn(move || {
            let _power = power;
            board.run();
        })?;
        backplane.control.set_thread(thread.thread().clone());
        Ok(Card { backplane, thread: Some(thread) })
    }

    /// A connection for a driver; any number of them reach the same card.
    #[must_use]
    pub fn bus(&self) -> CardBus {
        CardBus::new(Arc::clone(&self.backplane))
    }

    /// A display. Frames are composed only while there is one.
    #[must_use]
    pub fn monitor(&self) -> Monitor {
        Monitor::new(Arc::clone(&self.backplane.cable))
    }

    /// Video memory as the host's own words, between two packets; the card waits for as long as the mapping lives.
    #[must_use]
    pub fn map(&self) -> MappedMemory {
        MappedMemory::new(&self.backplane.memory)
    }

    /// Where displays are plugged in, for who does so later or from another thread.
    #[must_use]
    pub fn connector(&self) -> Connector {
        Connector::new(Arc::clone(&self.backplane.cable))
    }

    /// Everything the card holds, between two packets. Work goes on afterwards.
    ///
    /// # Errors
    /// [`CardError::PoweredOff`] when the card's thread is gone.
    pub fn snapshot(&self) -> Result<Snapshot, CardError> {
        self.backplane.control.save().map(Snapshot::new)
    }

    /// Records the next scene that the clocked systolic array draws (HIDDEN_SURFACE 2, FIDELITY 1): of scan line
    /// `line` the clocks `clocks`, counted from the clock in which the line's first token enters, and the
    /// processing elements `elements`.
    ///
    /// # Errors
    /// [`CardError::PoweredOff`] when the card's thread is gone.
    pub fn record_waves(&self, line: u32, clocks: Range<u64>, elements: Range<u32>) -> Result<(), CardError> {
        self.backplane.control.record(Waves::new(line, clocks, elements))
    }

    /// The waveform recorded last, as the text of a VCD file, and given away with that; `None` when no scene
    /// was recorded since.
    ///
    /// # Errors
    /// [`CardError::PoweredOff`] when the card's thread is gone.
    pub fn take_waves(&self) -> Result<Option<Vec<u8>>, CardError> {
        self.backplane.control.take_recorded()
    }

    /// Notes which pixels the sub-pixel mask unit takes up in the next scene with a grid (SUBPIXEL_GRID), and why.
    ///
    /// # Errors
    /// [`CardError::PoweredOff`] when the card's thread is gone.
    pub fn record_subpixels(&self) -> Result<(), CardError> {
        self.backplane.control.record_subpixels()
    }

    /// The map noted last, and given away with that; `None` when no scene was noted since.
    ///
    /// # Errors
    /// [`CardError::PoweredOff`] when the card's thread is gone.
    pub fn take_subpixels(&self) -> Result<Option<SubpixelMap>, CardError> {
        self.backplane.control.take_subpixels()
    }

    /// Puts the card into the state of a snapshot and lets it go on from there. What it was doing is
    /// thrown away, as by a reset.
    ///
    /// # Errors
    /// [`CardError::OtherCard`] for a snapshot of a card with other memories,
    /// [`CardError::Impossible`] for a state that no card can be in; the card is unchanged then.
    pub fn restore(&self, snapshot: &Snapshot) -> Result<(), CardError> {
        self.backplane.control.restore(snapshot.state())
    }
}

impl Drop for Card {
    fn drop(&mut self) {
        self.backplane.control.power_off();
        if let Some(thread) = self.thread.take() {
            // A panic of the card's thread was reported when it happened.
            let _ = thread.join();
        }
    }
}

/// The card's power: it is lost when the card's thread ends, for whatever reason.
struct Power(Arc<Backplane>);

impl Drop for Power {
    fn drop(&mut self) {
        self.0.control.power_lost().store(true, SeqCst);
        self.0.interrupts.disconnect();
        self.0.cable.unplug();
        self.0.active.store(false, SeqCst);
    }
}
