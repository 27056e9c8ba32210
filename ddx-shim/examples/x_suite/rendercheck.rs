//! rendercheck: the X.Org project's own tests of RENDER, in selections that pass on the server's own renderer.

use clap::Args;
use zga_ddx_shim::session::Session;

use super::{Fault, Held, Tested, output};

#[derive(Args, Debug)]
pub struct Rendercheck {
    #[command(flatten)]
    tested: Tested,
    /// The short selections alone
    #[arg(long)]
    quick: bool,
    /// The server's own driver beside it
    #[arg(long)]
    beside: bool,
}

/// Name, arguments, in the quick run.
const SELECTIONS: [(&str, &[&str], bool); 8] = [
    (
        "fills, coordinates, clients",
        &["-t", "fill,dcoords,scoords,mcoords,tscoords,tmcoords,bug7366,gtk_argb_xbgr,libreoffice_xrgb"],
        true,
    ),
    ("repeat", &["-t", "repeat", "-o", "Src,Over,Add"], true),
    ("blend", &["-t", "blend", "-o", "Src,Over,Add"], true),
    (
        "formats, four operators",
        &["-t", "composite,cacomposite", "-f", "a8r8g8b8,r5g6b5,a8", "-o", "Over,InReverse,Atop,Add"],
        true,
    ),
    ("formats", &["-t", "composite,cacomposite,blend", "-f", "a8r8g8b8,x8r8g8b8,a8"], false),
    ("gradients", &["-t", "gradients", "-o", "Src,Over", "-f", "a8r8g8b8"], true),
    ("all operators, a8r8g8b8 x8r8g8b8 r5g6b5 a8", &["-t", "composite", "-f", "a8r8g8b8,x8r8g8b8,r5g6b5,a8"], false),
    ("component alpha, all operators", &["-t", "cacomposite", "-f", "a8r8g8b8,x8r8g8b8,r5g6b5,a8"], false),
];

/// What a run said of itself: "17 tests passed of 17 total".
fn summary(text: &str) -> Option<(u64, u64)> {
    text.lines().rev().find_map(|line| {
        let (passed, rest) = line.trim().split_once(" tests passed of ")?;
        Some((passed.parse().ok()?, rest.strip_suffix(" total")?.parse().ok()?))
    })
}

impl Rendercheck {
    pub fn run(&self) -> Held {
        let size = [1024, 768];
        let mut tested = Session::start(&self.tested.options(size, None)?)?;
        let mut right = if self.beside { Some(Session::start(&self.tested.right(size))?) } else { None };
        std::fs::create_dir_all(&self.tested.out)
            .map_err(|reason| Fault::File(self.tested.out.clone(), reason.to_string()))?;
        let mut held = true;
        for (number, (name, arguments, _)) in
            SELECTIONS.iter().enumerate().filter(|(_, (_, _, quick))| *quick || !self.quick)
        {
            let one = |session: &mut Session, of: &str| -> Result<(u64, u64), Fault> {
                let log = self.tested.out.join(format!("rendercheck-{number}-{of}.log"));
                let text = output(session, "rendercheck", arguments, &log)?;
                session.check()?;
                summary(&text).ok_or_else(|| Fault::File(log, "rendercheck has no summary".to_owned()))
            };
            let (passed, total) = one(&mut tested, &self.tested.driver)?;
            let beside = match &mut right {
                Some(right) => {
                    let (passed, total) = one(right, "right")?;
                    format!("; dummy {passed} of {total}")
                }
                None => String::new(),
            };
            held &= passed == total && total > 0;
            println!("rendercheck: {name}: {passed} of {total}{beside}");
        }
        tested.end()?;
        Ok(held)
    }
}
