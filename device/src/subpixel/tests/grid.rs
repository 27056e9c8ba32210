//! Samples, bits and places.

use crate::subpixel::grid::{Grid, Offset};

#[test]
fn grid_bits_go_by_rows_from_the_most_significant() {
    assert_eq!(Grid::G4X4.bit(0, 0), 0x8000);
    assert_eq!(Grid::G4X4.bit(3, 1), 0x0100);
    assert_eq!(Grid::G4X4.bit(3, 3), 0x0001);
    assert_eq!(Grid::G8X4.bit(0, 0), 0x8000_0000);
    assert_eq!(Grid::G8X4.bit(4, 1) | Grid::G8X4.bit(5, 2), 0x0008_0400);
    assert_eq!(Grid::G8X8.bit(0, 0), 1 << 63);
    assert_eq!(Grid::G8X8.bit(7, 7), 1);
    assert_eq!(Grid::ALL.map(Grid::samples), [16, 32, 64]);
    assert_eq!(Grid::ALL.map(Grid::index), [0, 1, 2]);
    assert_eq!(Grid::ALL.map(Grid::full), [0xFFFF, 0xFFFF_FFFF, u64::MAX]);
}

#[test]
fn grid_rows_and_columns_hold_their_samples() {
    for grid in Grid::ALL {
        for column in 0..grid.columns() {
            let samples = (0..grid.rows()).map(|row| grid.bit(column, row));
            assert_eq!(grid.column_mask(column), samples.sum::<u64>(), "{grid:?} {column}");
        }
        for row in 0..grid.rows() {
            let samples = (0..grid.columns()).map(|column| grid.bit(column, row));
            assert_eq!(grid.row_mask(row), samples.sum::<u64>(), "{grid:?} {row}");
        }
    }
}

#[test]
fn grid_places_are_the_centres_of_the_sub_pixels() {
    let columns = |grid: Grid| (0..grid.columns()).map(|column| grid.sample(column, 0)).collect::<Vec<_>>();
    let rows = |grid: Grid| (0..grid.rows()).map(|row| grid.sample(0, row)).collect::<Vec<_>>();
    let x = |grid: Grid| columns(grid).iter().map(|&sample| grid.offset(sample).x).collect::<Vec<_>>();
    let y = |grid: Grid| rows(grid).iter().map(|&sample| grid.offset(sample).y).collect::<Vec<_>>();
    let (four, eight) = ([-6, -2, 2, 6], [-7, -5, -3, -1, 1, 3, 5, 7]);
    assert_eq!((x(Grid::G4X4), y(Grid::G4X4)), (four.to_vec(), four.to_vec()));
    assert_eq!((x(Grid::G8X4), y(Grid::G8X4)), (eight.to_vec(), four.to_vec()));
    assert_eq!((x(Grid::G8X8), y(Grid::G8X8)), (eight.to_vec(), eight.to_vec()));
    assert_eq!(Grid::G4X4.position(Grid::G4X4.sample(1, 3)), [96, 224]);
    assert_eq!(Grid::G8X4.position(Grid::G8X4.sample(1, 3)), [48, 224]);
    assert_eq!(Grid::G8X8.position(Grid::G8X8.sample(1, 3)), [48, 112]);
}

#[test]
fn grid_corner_offset_bounds_every_sample() {
    assert_eq!(Grid::ALL.map(Grid::corner_offset), [(6, 6), (7, 6), (7, 7)].map(|(x, y)| Offset { x, y }));
    for grid in Grid::ALL {
        let corner = grid.corner_offset();
        for sample in 0..grid.samples() {
            let Offset { x, y } = grid.offset(sample);
            assert!(x.abs() <= corner.x && y.abs() <= corner.y, "{grid:?} {sample}");
        }
    }
}
