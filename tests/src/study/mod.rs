//! What accuracy costs: figures that are measured, not only held.

pub mod coverage;
pub mod decal;
pub mod order;
