//! Cases 27, 28, 30 and 31: blocks, cleared and at the edges.

use super::{both, point, quad, screen};
use crate::hard::{Row, Tally, compare_on};
use crate::harness::scenes::fixed;
use crate::harness::{Hidden, Options, Prediction, Random, Screen, State};
use crate::oracle::{DepthFormat, DepthFunction};

/// Case 27.
#[must_use]
pub fn one_pixel_in_a_cleared_block() -> Row {
    let (mut tally, mut random) = (Tally::default(), Random::new(27));
    let size = [96, 12];
    for hidden in [[32, 1], [16, 2], [8, 4], [8, 8]].into_iter().flat_map(|block| both(Hidden::za(block))) {
        let mut screen = screen(size, hidden);
        let [width, height] = hidden.block.map(|side| side as i32);
        for number in 0..width * height {
            screen.clear_planes(Some(0x0030_2010), Some(777), None);
            // What lies in memory must not matter.
            screen.flush();
            screen.garble(|_, _| Some([random.bits() as u32, random.bits() as u32]));
            let [x, y] = [width + number % width, height * i32::from(height < 5) + number / width];
            screen.draw_raw(
                crate::harness::Topology::Points,
                &[crate::harness::screen::raw(&crate::oracle::Vertex::at(x * 256, y * 256, 5), 24, 0x0000_00FF)],
                None,
                &State::default(),
            );
            let initialised = screen.za_words().iter().filter(|&&word| word >= 0).count();
            let place = (y * size[0] as i32 + x) as usize;
            let expected = |drawn: u32, clear: u32| {
                let mut all = vec![clear; (size[0] * size[1]) as usize];
                all[place] = drawn;
                all
            };
            let holds = screen.shown() == expected(0xFFFF_0000, 0xFF10_2030) && screen.depths() == expected(5, 777);
            tally.pictures += 1;
            tally.pixels += (size[0] * size[1]) as usize;
            tally.expect(holds && initialised == 1, || format!("{hidden:?}, pixel {number}, {initialised} blocks"));
        }
    }
    Row {
        case: 27,
        name: "za::one_pixel_in_a_cleared_block",
        construction: "clear, random words over all of frame and Z buffer, one point; each pixel of a block, 4 shapes, both \
                       fidelities",
        property: "one block is initialised; all other pixels and depths read as clear",
        measured: tally.to_string(),
        passed: tally.wrong == 0,
    }
}

/// Case 28.
#[must_use]
pub fn largest_depth() -> Row {
    let mut tally = Tally::default();
    for (bits, hidden) in [16, 24, 31].into_iter().flat_map(|bits| both(Hidden::za([32, 1])).map(|way| (bits, way))) {
        let format = DepthFormat { bits, fraction: 24 };
        let mut screen = Screen::new(64, 2, &Options { depth: format, hidden, ..Options::default() });
        let greatest = format.greatest();
        screen.clear();
        screen.draw_ids(&quad([0, 0, 64, 2], greatest), &State::with(DepthFunction::LessEqual));
        let words = screen.za_words();
        tally.expect(words == [greatest as i32; 4], || format!("{bits} bits: words {words:x?}"));
        let shown = screen.shown();
        tally.expect(shown.iter().all(|&pixel| pixel != 0xFF00_0000), || format!("{bits} bits: background shown"));
        screen.clear_counts();
        let nearer = crate::harness::depth::survivor(greatest - 1, bits);
        let passes = if nearer < greatest { 128 } else { 0 };
        screen.draw_ids(&quad([0, 0, 64, 2], nearer), &State::default());
        let events = screen.events();
        tally.expect(events["za.blocks_initialised"] == 0 && events["z.writes"] == passes, || {
            format!("{bits} bits: {events:?}")
        });
        tally.pictures += 2;
        tally.pixels += 256;
    }
    Row {
        case: 28,
        name: "za::largest_depth",
        construction: "blocks drawn at the largest depth of 16, 24 and 31 bits, then one step nearer; both fidelities",
        property: "the word is that depth, the block is shown and compared, never taken for cleared",
        measured: tally.to_string(),
        passed: tally.wrong == 0,
    }
}

/// Case 30.
#[must_use]
pub fn widths_beside_blocks() -> Row {
    let mut tally = Tally::default();
    let sizes = [[33, 3], [9, 9], [17, 5], [41, 17], [65, 33], [1, 1], [31, 7], [32, 8]];
    for (size, block) in
        sizes.into_iter().flat_map(|size| [[32, 1], [8, 4], [8, 8], [16, 2]].map(|block| (size, block)))
    {
        for hidden in both(Hidden::za(block)) {
            // Row ends, and what lies behind the last row, hold canaries: as depths they would be far behind.
            let mut screen = screen(size, hidden);
            let [width, height] = size.map(|side| side as i32);
            screen.draw_ids(&quad([0, 0, width, height], 100), &State::default());
            let words = screen.za_words();
            tally.expect(words.iter().all(|&word| word == 100), || format!("{size:?}, {hidden:?}: {words:?}"));
            screen.clear_counts();
            screen.draw_ids(&quad([0, 0, width, height], 101), &State::default());
            let events = screen.events();
            let pixels = u64::from(size[0] * size[1]);
            let bypassed = (events["za.pixels_bypassed"], events["za.blocks_compared"], events["z.reads"]);
            tally.expect(bypassed == (pixels, 0, 0), || format!("{size:?}, {hidden:?}: {bypassed:?}"));
            // One block, and then one row of pixels, in the corner.
            screen.clear();
            screen.clear_counts();
            screen.draw_ids(&[point(width - 1, height - 1, 40)], &State::default());
            let clipped = |side: u32, block: u32| (side - 1) % block + 1;
            let corner = u64::from(clipped(size[0], block[0]) * clipped(size[1], block[1]));
            let events = screen.events();
            tally.expect(events["z.writes"] == corner && events["colour.writes"] == corner, || {
                format!("{size:?}, {hidden:?}: corner of {corner} pixels, {events:?}")
            });
            let picture = screen.read();
            tally.note(picture.strays, || format!("{size:?}, {hidden:?}: {} words outside", picture.strays));
            tally.pictures += 2;
            tally.pixels += 2 * pixels as usize;
        }
    }
    Row {
        case: 30,
        name: "za::widths_beside_blocks",
        construction: "targets of 33, 8k + 1 and other widths and heights, canaries in row ends; a layer, one behind it, a point \
                       in the last block; 4 block shapes, both fidelities",
        property: "words count pixels on the screen only, all is bypassed, nothing outside is written",
        measured: tally.to_string(),
        passed: tally.wrong == 0,
    }
}

/// Case 31.
#[must_use]
pub fn every_block_shape() -> Row {
    let (mut tally, mut bypassed) = (Tally::default(), [u64::MAX, 0]);
    let size = [150, 110];
    let scene = fixed(31, size, 1500, 15);
    let shapes = [[32, 1], [16, 2], [8, 4], [8, 8], [1, 1], [64, 1], [2, 32], [7, 3], [150, 110], [16384, 16384]];
    for block in shapes {
        for (prediction, bypass) in
            Prediction::ALL.into_iter().flat_map(|prediction| [(prediction, true), (prediction, false)])
        {
            for hidden in both(Hidden { prediction, bypass, ..Hidden::za(block) }) {
                let mut screen = screen(size, hidden);
                screen.clear_counts();
                tally.add(&compare_on(&mut screen, &scene, DepthFunction::Less));
                let found = screen.events()["za.blocks_bypassed"];
                tally.expect(bypass || found == 0, || format!("{hidden:?}: {found} blocks bypassed"));
                if bypass {
                    bypassed = [bypassed[0].min(found), bypassed[1].max(found)];
                }
            }
        }
    }
    Row {
        case: 31,
        name: "za::every_block_shape",
        construction: "1564 primitives, 10 block shapes, 3 predictions, bypass on and off, both fidelities",
        property: "identical images, = oracle",
        measured: format!("{tally}; {} to {} blocks bypassed", bypassed[0], bypassed[1]),
        passed: tally.wrong == 0 && bypassed[1] > 0,
    }
}
