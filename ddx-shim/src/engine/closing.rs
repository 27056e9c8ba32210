//! Closed figures of thin lines: whether the last pixel is drawn a second time.

use zga_driver::{ClipBox, Point};

/// Whether the server's renderer leaves a polyline's last pixel out because the figure is closed: it does so when there is
/// one clip box only and neither end of the last segment is outside of it, and draws the pixel a second time otherwise.
///
/// The test for "outside" is the renderer's own, on two coordinates packed into 32 bits, so that coordinates whose
/// differences leave 16 bits come out the same.
pub(super) fn closes(points: &[Point], origin: [i32; 2], clips: &[ClipBox]) -> bool {
    let ([clip], [first, .., before, last]) = (clips, points) else {
        // Of two points that are one the renderer takes the fast way, too.
        if let ([clip], [first, last]) = (clips, points) {
            return first == last && inside(*first, origin, *clip);
        }
        return false;
    };
    first == last && inside(*before, origin, *clip) && inside(*last, origin, *clip)
}

/// The renderer's test whether a point is in its clip box.
fn inside(point: Point, [x, y]: [i32; 2], clip: ClipBox) -> bool {
    let pack = |x: i32, y: i32| (y << 16) | (x & 0xFFFF);
    let upper_left = pack(i32::from(clip.x1) - x, i32::from(clip.y1) - y);
    let lower_right = pack(i32::from(clip.x2) - x - 1, i32::from(clip.y2) - y - 1);
    let point = pack(point.x.into(), point.y.into());
    let outside = point.wrapping_sub(upper_left) | lower_right.wrapping_sub(point);
    outside.cast_unsigned() & 0x8000_8000 == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLIP: ClipBox = ClipBox { x1: 10, y1: 20, x2: 110, y2: 220 };

    fn points(list: &[(i16, i16)]) -> Vec<Point> {
        list.iter().map(|&(x, y)| Point { x, y }).collect()
    }

    #[test]
    fn closes_figure_inside_one_box() {
        let figure = points(&[(0, 0), (50, 3), (20, 90), (0, 0)]);
        assert!(closes(&figure, [10, 20], &[CLIP]));
        assert!(!closes(&figure, [9, 20], &[CLIP]), "the last point is left of the box");
        assert!(!closes(&figure, [10, 20], &[CLIP, ClipBox { x1: 300, x2: 310, ..CLIP }]));
        assert!(!closes(&figure[..3], [10, 20], &[CLIP]), "the figure is open");
    }

    #[test]
    fn closes_only_the_last_segment_counts() {
        let figure = points(&[(30, 30), (500, 30), (40, 40), (30, 30)]);
        assert!(closes(&figure, [0, 0], &[CLIP]));
        let figure = points(&[(30, 30), (40, 40), (500, 30), (30, 30)]);
        assert!(!closes(&figure, [0, 0], &[CLIP]));
    }

    #[test]
    fn closes_point_of_two_ends() {
        assert!(closes(&points(&[(30, 30), (30, 30)]), [0, 0], &[CLIP]));
        assert!(!closes(&points(&[(30, 30), (31, 30)]), [0, 0], &[CLIP]));
    }

    #[test]
    fn inside_is_inclusive_of_the_box_and_exclusive_of_its_end() {
        for (x, y, expected) in [(10, 20, true), (109, 219, true), (9, 20, false), (110, 20, false), (10, 220, false)] {
            assert_eq!(inside(Point { x, y }, [0, 0], CLIP), expected, "{x} {y}");
        }
    }
}
