//! The texels of a level by the charts that cover them. Input: triangles in texture coordinates, each of a chart. Output: the
//! texels that several charts cover, or that one chart reads and another covers.

use glam::DVec2;

/// No chart covers the cell, or several do; others have the number of their chart.
pub const EMPTY: u32 = u32::MAX;
const SEVERAL: u32 = u32::MAX - 1;

/// How far from a point along both axes the linear filter reads texels, by their centres, less what roundings add.
const REACH: f64 = 1.0 - 1e-6;

/// The chart of each texel of a level.
pub struct Grid {
    size: [usize; 2],
    pub cells: Vec<u32>,
}

impl Grid {
    pub fn new(size: [usize; 2]) -> Grid {
        Grid { size, cells: vec![EMPTY; size[0] * size[1]] }
    }

    /// Returns the number of texels that several charts cover.
    pub fn shared(&self) -> u64 {
        self.cells.iter().filter(|cell| **cell == SEVERAL).count() as u64
    }

    fn put(&mut self, x: usize, y: usize, chart: u32) {
        let cell = &mut self.cells[y * self.size[0] + x];
        *cell = joined(*cell, chart);
    }

    /// Marks the texels whose centres lie in the triangle, at least that of its middle.
    pub fn fill(&mut self, triangle: &[DVec2; 3], chart: u32) {
        let size = DVec2::new(self.size[0] as f64, self.size[1] as f64);
        let [a, b, c] = triangle.map(|uv| uv * size);
        let last = self.size.map(|n| n as f64 - 1.0);
        let cell = |at: f64, axis: usize| at.floor().clamp(0.0, last[axis]) as usize;
        let middle = (a + b + c) / 3.0;
        self.put(cell(middle.x, 0), cell(middle.y, 1), chart);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let area = (b - a).perp_dot(c - a);
        for y in cell(low.y, 1)..=cell(high.y, 1) {
            for x in cell(low.x, 0)..=cell(high.x, 0) {
                let p = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let sides =
                    [(a, b), (b, c), (c, a)].map(|(from, to)| (to - from).perp_dot(p - from) * area.signum());
                if sides.iter().all(|side| *side >= 0.0) {
                    self.put(x, y, chart);
                }
            }
        }
    }

    /// Returns the number of texels that the linear filter reads within one chart and that show another. It reads those whose
    /// centres are less than a texel away along both axes, beyond an edge that repeats those of the other side.
    pub fn foreign(&self, triangles: &[[DVec2; 3]], charts: &[u32], repeats: [bool; 2]) -> u64 {
        let mut is_foreign = vec![false; self.cells.len()];
        let size = DVec2::new(self.size[0] as f64, self.size[1] as f64);
        let inside = |at: i64, axis: usize| {
            let count = self.size[axis] as i64;
            let is_inside = (0..count).contains(&at);
            (is_inside || repeats[axis]).then(|| at.rem_euclid(count) as usize)
        };
        for (triangle, &chart) in triangles.iter().zip(charts) {
            let corners = triangle.map(|uv| uv * size);
            let [a, b, c] = corners;
            let (low, high) = (a.min(b).min(c) - REACH - 0.5, a.max(b).max(c) + REACH - 0.5);
            for y in low.y.ceil() as i64..=high.y.floor() as i64 {
                for x in low.x.ceil() as i64..=high.x.floor() as i64 {
                    let (Some(column), Some(row)) = (inside(x, 0), inside(y, 1)) else { continue };
                    let cell = row * self.size[0] + column;
                    let center = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                    let shows_other = self.cells[cell] != EMPTY && self.cells[cell] != chart;
                    if shows_other && !is_foreign[cell] && reaches(corners, center) {
                        is_foreign[cell] = true;
                    }
                }
            }
        }
        is_foreign.iter().filter(|foreign| **foreign).count() as u64
    }

    /// Returns the next level.
    pub fn halved(&self) -> Grid {
        let mut next = Grid::new(self.size.map(|n| (n / 2).max(1)));
        for y in 0..self.size[1] {
            for x in 0..self.size[0] {
                let [column, row] = [(x / 2).min(next.size[0] - 1), (y / 2).min(next.size[1] - 1)];
                next.put(column, row, self.cells[y * self.size[0] + x]);
            }
        }
        next
    }
}

fn joined(a: u32, b: u32) -> u32 {
    match (a, b) {
        (EMPTY, other) | (other, EMPTY) => other,
        (a, b) if a == b => a,
        _ => SEVERAL,
    }
}

/// Returns true if a point of the triangle is within reach of a texel's centre: no side of the triangle, seen from it, has the
/// square of that reach on its other side. Sides of the square are left to the caller.
fn reaches([a, b, c]: [DVec2; 3], center: DVec2) -> bool {
    let turn = (b - a).perp_dot(c - a).signum();
    [(a, b), (b, c), (c, a)].iter().all(|(from, to)| {
        let side = *to - *from;
        turn * side.perp_dot(center - *from) + REACH * (side.x.abs() + side.y.abs()) >= 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_two_texels_apart_mix_where_a_texel_holds_both() {
        let mut grid = Grid::new([16, 16]);
        let square = |x: f64| [DVec2::new(x, 0.0), DVec2::new(x + 0.25, 0.0), DVec2::new(x, 0.5)];
        // Texels 0 to 3, and 6 to 9.
        grid.fill(&square(0.0), 1);
        grid.fill(&square(6.0 / 16.0), 2);
        let shared: Vec<bool> =
            std::iter::successors(Some(grid), |g| Some(g.halved())).take(4).map(|g| g.shared() > 0).collect();
        assert_eq!(shared, [false, false, false, true]);
    }
}
