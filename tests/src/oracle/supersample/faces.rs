//! What a primitive drawn with masks is: triangles.

use super::super::{Primitive, Vertex};

/// The triangles of a primitive: its own, two for a line of some length, two for a point. Widths in u.
#[must_use]
pub fn faces(primitive: &Primitive, line_width: u32, point_size: u32) -> Vec<[Vertex; 3]> {
    match primitive {
        Primitive::Triangle(vertices) => vec![*vertices],
        Primitive::Line(ends) => line(ends, line_width),
        Primitive::Point(vertex) => point(vertex, point_size).to_vec(),
    }
}

/// A rectangle along the line, with the corners on the grid of u; depths are those of the ends.
fn line([from, to]: &[Vertex; 2], width: u32) -> Vec<[Vertex; 3]> {
    let [dx, dy] = [f64::from(to.x) - f64::from(from.x), f64::from(to.y) - f64::from(from.y)];
    if dx == 0.0 && dy == 0.0 {
        return Vec::new();
    }
    // Sums and products of these integers are exact in an f64; root and quotient are rounded once each.
    let length = (dx * dx + dy * dy).sqrt();
    let across = |along: f64| (along * f64::from(width) / (2.0 * length)).round_ties_even() as i32;
    let (nx, ny) = (across(-dy), across(dx));
    let beside = |v: &Vertex, side: i32| Vertex { x: v.x + side * nx, y: v.y + side * ny, ..*v };
    let corners = [beside(from, 1), beside(from, -1), beside(to, 1), beside(to, -1)];
    vec![[corners[0], corners[1], corners[2]], [corners[2], corners[1], corners[3]]]
}

/// A square about the point.
fn point(vertex: &Vertex, size: u32) -> [[Vertex; 3]; 2] {
    let [left, top] = [vertex.x, vertex.y].map(|c| c - (size >> 1) as i32);
    let (right, bottom) = (left + size as i32, top + size as i32);
    let at = |x: i32, y: i32| Vertex { x, y, ..*vertex };
    [[at(left, top), at(right, top), at(left, bottom)], [at(right, top), at(right, bottom), at(left, bottom)]]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(triangles: &[[Vertex; 3]]) -> Vec<[(i32, i32); 3]> {
        triangles.iter().map(|t| t.map(|v| (v.x, v.y))).collect()
    }

    #[test]
    fn line_3_4_5_is_a_rectangle_along_it() {
        // 3, 4 px long; half of 2.5 px across: (-4, 3) / 5 of it.
        let ends = [Vertex::at(0, 0, 1), Vertex::at(768, 1024, 2)];

        let faces = faces(&Primitive::Line(ends), 640, 1);

        let corners = [(-256, 192), (256, -192), (512, 1216), (1024, 832)];
        assert_eq!(places(&faces), [[corners[0], corners[1], corners[2]], [corners[2], corners[1], corners[3]]]);
        assert_eq!(faces.concat().iter().map(|v| v.z).collect::<Vec<_>>(), [1, 1, 2, 2, 1, 2]);
    }

    #[test]
    fn line_half_a_unit_goes_to_the_even_one() {
        let wide = |width| places(&faces(&Primitive::Line([Vertex::at(0, 0, 0), Vertex::at(512, 0, 0)]), width, 1))[0];

        // 1/2 goes to 0, 3/2 and 5/2 to 2.
        assert_eq!([1, 3, 5].map(|width| wide(width)[0]), [(0, 0), (0, 2), (0, 2)]);
    }

    #[test]
    fn line_of_no_length_has_no_face() {
        assert_eq!(
            faces(&Primitive::Line([Vertex::at(7, 7, 1), Vertex::at(7, 7, 2)]), 256, 256),
            Vec::<[Vertex; 3]>::new()
        );
    }

    #[test]
    fn point_of_odd_size_is_longer_to_the_right_and_down() {
        let faces = faces(&Primitive::Point(Vertex::at(100, -20, 9)), 1, 5);

        assert_eq!(places(&faces), [[(98, -22), (103, -22), (98, -17)], [(103, -22), (103, -17), (98, -17)]]);
        assert!(faces.concat().iter().all(|v| v.z == 9));
    }
}
