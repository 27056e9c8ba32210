//! Case 60: the same scene again.

use super::{Row, Tally};
use crate::harness::scenes::fixed;
use crate::harness::{Feed, Options, Screen, State};
use zga_device::{Kernel, Snapshot};

/// Case 60.
#[must_use]
pub fn again_in_pieces_after_reset_and_restore() -> Row {
    let size = [150, 110];
    let scene = fixed(60, size, 2500, 15);
    let (early, late) = scene.split_at(scene.len() / 2);
    let state = State { gouraud: true, ..State::default() };
    let mut tally = Tally::default();
    for (kernel, threads, feed) in
        [(Kernel::Specification, 1, Feed::Ring), (Kernel::Best, 1, Feed::Fifo), (Kernel::Best, 3, Feed::Ring)]
    {
        let options = Options { kernel, threads, feed, ..Options::default() };
        let mut screen = Screen::new(size[0], size[1], &options);
        let mut check = |what: &str, found: &crate::harness::Picture, reference: &crate::harness::Picture| {
            tally.pictures += 1;
            tally.pixels += found.colour.len();
            tally.expect(found == reference, || format!("{kernel:?}, {threads} threads: {what}"));
        };
        screen.draw(&scene, &state);
        let reference = screen.read();

        screen.clear();
        screen.draw(&scene, &state);
        check("drawn twice", &screen.read(), &reference);
        for piece in [1, 3, 100, 1777] {
            screen.clear();
            screen.draw(&scene, &State { piece, ..state });
            check("in pieces", &screen.read(), &reference);
        }
        screen.clear();
        screen.draw(early, &state);
        screen.read();
        screen.draw(late, &state);
        check("in two scenes", &screen.read(), &reference);

        screen.draw(late, &state);
        screen.reset();
        screen.clear();
        screen.draw(&scene, &state);
        check("after a reset", &screen.read(), &reference);

        // Saved in the middle of the scene; the card goes on, goes back, and goes on again.
        screen.clear();
        screen.draw(early, &state);
        let snapshot = screen.snapshot();
        screen.draw(late, &state);
        check("after a snapshot", &screen.read(), &reference);
        screen.clear();
        screen.restore(&snapshot);
        screen.draw(late, &state);
        check("after save and restore", &screen.read(), &reference);

        // The same on another card, from bytes.
        let copy = Snapshot::from_bytes(&snapshot.to_bytes());
        let mut other = Screen::new(size[0], size[1], &Options { kernel: Kernel::Best, threads: 2, ..options });
        if let Ok(copy) = &copy {
            other.restore(copy);
        }
        other.draw(late, &state);
        check("restored on another card", &other.read(), &reference);
    }
    Row {
        case: 60,
        name: "card::again_in_pieces_after_reset_and_restore",
        construction: "2564 primitives with interpolated colours: again, in pieces, in two scenes, after a reset, after save and \
                       restore in mid-scene on the same and on another card; 3 ways to draw",
        property: "identical bits",
        measured: tally.to_string(),
        passed: tally.wrong == 0 && tally.pictures == 30,
    }
}
