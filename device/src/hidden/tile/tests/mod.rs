//! Tests of the unit as a whole: the worked example, and random scenes against the plain Z buffer and
//! against the functional model.

mod example;
mod random;
mod scenes;
