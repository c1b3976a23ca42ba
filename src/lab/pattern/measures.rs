//! Measures of a point set in the unit square: its discrepancy from the area of boxes, the
//! distances between neighbours, the number of occupied strata.

/// Returns sup over boxes [0, a) × [0, b) of |fraction of points in the box − ab| (Niederreiter
/// 1992, definition 2.1), exactly: the supremum is attained where a and b are coordinates of
/// points, or 1.
pub fn star_discrepancy(points: &[[f64; 2]]) -> f64 {
    let mut by_x = points.to_vec();
    by_x.sort_by(|p, q| p[0].total_cmp(&q[0]));
    let mut ys: Vec<f64> = points.iter().map(|p| p[1]).chain([1.0]).collect();
    ys.sort_by(f64::total_cmp);
    let share = 1.0 / points.len() as f64;
    let mut left: Vec<f64> = Vec::new(); // y of the points further left than a, rising
    let mut largest = 0.0f64;
    let mut next = 0;
    while next <= by_x.len() {
        let a = by_x.get(next).map_or(1.0, |p| p[0]);
        // Boxes that exclude the points at a contain too few points, those that include them too
        // many.
        largest = largest.max(largest_lack(&left, &ys, a, share));
        let same = by_x[next..].iter().take_while(|p| p[0] == a).count();
        for p in &by_x[next..next + same] {
            left.insert(left.partition_point(|&y| y <= p[1]), p[1]);
        }
        largest = largest.max(largest_excess(&left, a, share));
        next += same.max(1);
    }
    largest
}

/// Returns the largest deficit of open boxes [0, a) × [0, y).
fn largest_lack(left: &[f64], ys: &[f64], a: f64, share: f64) -> f64 {
    let mut below = 0;
    let lack = |y: &f64| {
        while left.get(below).is_some_and(|l| l < y) {
            below += 1;
        }
        a * y - below as f64 * share
    };
    ys.iter().map(lack).fold(0.0, f64::max)
}

/// Returns the largest excess of closed boxes [0, a] × [0, y], where y is that of a point inside.
fn largest_excess(left: &[f64], a: f64, share: f64) -> f64 {
    left.iter().zip(1..).map(|(y, count)| f64::from(count) * share - a * y).fold(0.0, f64::max)
}

/// Returns the mean distance from a point to its nearest neighbour; `None` for a single point.
pub fn mean_nearest_distance(points: &[[f64; 2]]) -> Option<f64> {
    let squared = |p: &[f64; 2], q: &[f64; 2]| (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2);
    let nearest = |(i, p): (usize, &[f64; 2])| {
        let others = points.iter().enumerate().filter(|&(j, _)| j != i);
        others.map(|(_, q)| squared(p, q)).fold(f64::INFINITY, f64::min).sqrt()
    };
    let sum: f64 = points.iter().enumerate().map(nearest).sum();
    (points.len() > 1).then(|| sum / points.len() as f64)
}

/// Returns the number of `columns` × `rows` equal cells that contain a point.
pub fn occupied(points: &[[f64; 2]], columns: u32, rows: u32) -> u32 {
    // Positions are rounded down to multiples of 2⁻²⁴, and so is the lower bound of each cell.
    let step = 1.0 / f64::from(1 << 24);
    let cell = |x: f64, cells: u32| ((x + step) * f64::from(cells)).ceil() as usize - 1;
    let mut held = vec![false; columns as usize * rows as usize];
    points.iter().for_each(|p| held[cell(p[1], rows) * columns as usize + cell(p[0], columns)] = true);
    held.iter().filter(|h| **h).count() as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Evaluates every box that ends at coordinates of points, including and excluding them.
    fn by_all_boxes(points: &[[f64; 2]]) -> f64 {
        let ends = |axis: usize| points.iter().map(move |p| p[axis]).chain([1.0]);
        let mut largest = 0.0f64;
        for a in ends(0) {
            for b in ends(1) {
                let open = points.iter().filter(|p| p[0] < a && p[1] < b).count() as f64;
                let closed = points.iter().filter(|p| p[0] <= a && p[1] <= b).count() as f64;
                let n = points.len() as f64;
                largest = largest.max(a * b - open / n).max(closed / n - a * b);
            }
        }
        largest
    }

    #[test]
    fn discrepancy_is_that_of_all_boxes() {
        assert!((star_discrepancy(&[[0.5, 0.5]]) - 0.75).abs() < 1e-12);
        assert!((star_discrepancy(&[[0.0, 0.0]]) - 1.0).abs() < 1e-12);
        for n in [2, 7, 40] {
            let points: Vec<[f64; 2]> =
                (0..n).map(|i| [(i * 37 % 16) as f64 / 16.0, (i * 11 % 13) as f64 / 13.0]).collect();
            let (fast, all) = (star_discrepancy(&points), by_all_boxes(&points));
            assert!((fast - all).abs() < 1e-12, "{n}: {fast} and {all}");
        }
    }

    #[test]
    fn distances_and_cells() {
        let points = [[0.1, 0.1], [0.4, 0.5], [0.9, 0.9]];
        let mean = (0.5 + 0.5 + (0.25f64 + 0.16).sqrt()) / 3.0;
        assert!((mean_nearest_distance(&points).unwrap_or(0.0) - mean).abs() < 1e-12);
        assert_eq!(mean_nearest_distance(&points[..1]), None);
        assert_eq!((occupied(&points, 2, 2), occupied(&points, 1, 10), occupied(&points, 2, 1)), (3, 3, 2));
    }
}
