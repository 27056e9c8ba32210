//! What can go wrong between a program and its card, beside what a driver sees over the bus.

/// Why a card could not be powered on, saved or restored.
#[derive(Debug, thiserror::Error)]
pub enum CardError {
    /// `CardOptions::video_memory` is out of range.
    #[error("video memory of {bytes} bytes: expected a multiple of 4096 from 1048576 to 1073741824")]
    VideoMemory {
        /// Bytes asked for.
        bytes: u32,
    },
    /// `CardOptions::za_ram` is out of range.
    #[error("Za RAM of {bytes} bytes: expected a multiple of 4096 up to 33554432")]
    ZaRam {
        /// Bytes asked for.
        bytes: u32,
    },
    /// The host did not give the card a thread.
    #[error("no thread for the card: {0}")]
    Thread(#[from] std::io::Error),
    /// The card's thread is gone.
    #[error("the card has no power")]
    PoweredOff,
    /// The bytes are not a snapshot, or they were changed.
    #[error("damaged snapshot at byte {at}: {what}")]
    Damaged {
        /// Byte offset of the field that does not hold.
        at: usize,
        /// What was expected there.
        what: &'static str,
    },
    /// The snapshot is of a card with other memories.
    #[error("snapshot of a card with {found} bytes of {memory}, this card has {expected}")]
    OtherCard {
        /// Which memory.
        memory: &'static str,
        /// Bytes in the snapshot.
        found: u32,
        /// Bytes on this card.
        expected: u32,
    },
    /// The card is in the middle of a scene whose parts it has sorted, not drawn, or keeps for the sub-pixel unit: a
    /// snapshot has no place for them.
    #[error(
        "no snapshot in the middle of a scene on the systolic or tile path or with a sub-pixel grid: end the scene first"
    )]
    HeldScene,
    /// The snapshot is whole, but no card can be in this state.
    #[error("impossible state in the snapshot: {what}")]
    Impossible {
        /// What does not hold.
        what: String,
    },
}
