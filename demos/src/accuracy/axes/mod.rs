//! The axes of accuracy, a file each: a study's figures become a section.

pub(super) mod grid;
