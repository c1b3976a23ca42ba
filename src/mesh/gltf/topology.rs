//! Which corners form triangles. Input: the mode of a primitive and how many corners it has. Output: the places of the
//! three corners of each triangle in the list of corners, counter-clockwise as seen from the front.

use glam::DVec3;

/// The area, relative to the square of its longest edge, under which a triangle counts as having none.
const LEAST_AREA: f64 = 1e-14;

/// How a primitive's corners form triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Mode {
    Triangles,
    Strip,
    Fan,
}

impl Mode {
    /// Returns the number of triangles of a number of corners.
    pub(super) fn triangle_count(self, corners: usize) -> usize {
        match self {
            Mode::Triangles => corners / 3,
            Mode::Strip | Mode::Fan => corners.saturating_sub(2),
        }
    }

    /// Returns the corners of a triangle.
    pub(super) fn corners(self, i: usize) -> [usize; 3] {
        match self {
            Mode::Triangles => [3 * i, 3 * i + 1, 3 * i + 2],
            // Every other triangle of a strip would run the other way.
            Mode::Strip => [i, i + 1 + i % 2, i + 2 - i % 2],
            Mode::Fan => [i + 1, i + 2, 0],
        }
    }
}

/// Returns whether a triangle has an area.
pub(super) fn has_area([a, b, c]: [DVec3; 3]) -> bool {
    let edges = [b - a, c - a, c - b];
    let longest = edges.iter().map(|edge| edge.length_squared()).fold(0.0, f64::max);
    // Not true for a triangle of size 0 either.
    edges[0].cross(edges[1]).length() > LEAST_AREA * longest
}
