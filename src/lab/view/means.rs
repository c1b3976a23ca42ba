//! The texels of one level, averaged over boxes of growing sides: what a window shows of a part that is too large for
//! single texels. Input: the level's texels. Output: grids of means, each of half the size of the one before.

use glam::DVec3;
use rayon::prelude::*;

/// A level, and which of its slices or faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    pub texture: u32,
    pub level: u32,
    pub slice: i64,
}

/// Means of the texels of a part, from halves of its size down to one.
pub struct Means {
    pub grids: Vec<Grid>,
}

/// A picture of means.
pub struct Grid {
    pub size: [i64; 2],
    colors: Vec<DVec3>,
}

impl Grid {
    pub fn at(&self, [x, y]: [i64; 2]) -> DVec3 {
        self.colors[(y * self.size[0] + x) as usize]
    }
}

impl Means {
    /// Averages texels, each by its column and row.
    pub fn new(size: [i64; 2], texel: &(dyn Fn([i64; 2]) -> DVec3 + Sync)) -> Means {
        let mut grids = vec![halved(size, texel)];
        while let Some(last) = grids.last().filter(|last| last.size != [1, 1]) {
            let next = halved(last.size, &|at| last.at(at));
            grids.push(next);
        }
        Means { grids }
    }
}

fn halved(size: [i64; 2], color: &(dyn Fn([i64; 2]) -> DVec3 + Sync)) -> Grid {
    let own = size.map(|side| (side / 2).max(1));
    let mean = |x: i64, y: i64| {
        let rows = parts(size[1], own[1], y);
        let of_row = |(row, height): (i64, f64)| {
            parts(size[0], own[0], x).map(move |(column, width)| width * height * color([column, row]))
        };
        rows.flat_map(of_row).sum()
    };
    let rows = (0..own[1]).into_par_iter();
    let colors = rows.flat_map_iter(|y| (0..own[0]).map(move |x| mean(x, y))).collect();
    Grid { size: own, colors }
}

/// Returns which of `from` texels the `i`-th of `to` equal parts covers, each with its share of the part.
fn parts(from: i64, to: i64, i: i64) -> impl Iterator<Item = (i64, f64)> {
    let width = from as f64 / to as f64;
    let (start, end) = (i as f64 * width, (i + 1) as f64 * width);
    let last = (end.ceil() as i64).min(from);
    (start.floor() as i64..last).map(move |n| {
        let (left, right) = ((n as f64).max(start), ((n + 1) as f64).min(end));
        (n, (right - left) / width)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_are_those_of_all_texels_for_every_size() {
        for size in [[1, 1], [2, 2], [8, 4], [13, 9], [1, 7], [37, 2]] {
            let texel = |[x, y]: [i64; 2]| DVec3::new(((x * 7 + y * 3) % 11) as f64, x as f64, 1.0);
            let count = (size[0] * size[1]) as f64;
            let all: DVec3 = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| texel([x, y]))).sum();
            let means = Means::new(size, &texel);
            for grid in &means.grids {
                let mean = grid.colors.iter().sum::<DVec3>() / grid.colors.len() as f64;
                assert!((mean - all / count).length() < 1e-9, "{size:?}, {:?}", grid.size);
            }
            assert_eq!(means.grids.last().unwrap().size, [1, 1]);
        }
        let means = Means::new([4, 2], &|[x, y]| DVec3::splat((10 * y + x) as f64));
        assert_eq!(means.grids[0].at([1, 0]), DVec3::splat((2 + 3 + 12 + 13) as f64 / 4.0));
    }
}
