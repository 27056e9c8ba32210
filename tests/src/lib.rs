//! Exact oracle, hard cases, differential and register-level tests, and fuzzing of the ZGA card.

pub mod fuzz;
pub mod hard;
pub mod harness;
pub mod oracle;
pub mod script;
pub mod study;
