//! `zga list`: the demonstrations, a line each.

use clap::Args;

use super::{Verdict, print};
use crate::demos::DEMOS;
use crate::error::Result;
use crate::table::columns;

/// List the demos, a line each
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  zga list")]
pub(super) struct List {}

impl List {
    pub(super) fn run(&self) -> Result<Verdict> {
        let rows = DEMOS.iter().map(|demo| vec![demo.name.to_owned(), demo.description.to_owned()]);
        print(&columns("", &[], &rows.collect::<Vec<_>>()))?;
        Ok(Verdict::Good)
    }
}
