//! Procedural textures: the device against the oracle, patterns computed by hand, filters against
//! means of many points, noise's range, mean and continuity, and the keys of scene files.

mod device;
mod filter;
mod noise;
mod points;
mod text;

use glam::DVec3;
use moire::internal::oracle::procedural::{figure_share, procedural_color};
use moire::internal::pack;
use moire::internal::schema::layout;
use moire::internal::texture::procedural::{Procedural, ProceduralKind};

use crate::lookup::bench::Rng;

const HARD_EDGED: [ProceduralKind; 4] =
    [ProceduralKind::Checker, ProceduralKind::Stripes, ProceduralKind::Grid, ProceduralKind::Brick];

/// A record with the defaults of its kind, except as set by `change`.
fn record(kind: ProceduralKind, change: impl Fn(&mut Procedural)) -> layout::Procedural {
    let mut texture = Procedural::new(kind);
    change(&mut texture);
    pack::procedural(&texture)
}

fn default_record(kind: ProceduralKind) -> layout::Procedural {
    record(kind, |_| {})
}

/// The figure's share at one point.
fn share_at(what: &layout::Procedural, at: DVec3) -> f64 {
    figure_share(what, at, DVec3::ZERO, DVec3::ZERO)
}

/// The mean of n × n points, one at random in each cell of the parallelogram's division.
fn mean_of_points(what: &layout::Procedural, at: DVec3, dx: DVec3, dy: DVec3, n: u32, rng: &mut Rng) -> f64 {
    let mut sum = 0.0;
    for i in 0..n * n {
        let s = (f64::from(i % n) + rng.unit()) / f64::from(n) - 0.5;
        let t = (f64::from(i / n) + rng.unit()) / f64::from(n) - 0.5;
        sum += share_at(what, at + s * dx + t * dy);
    }
    sum / f64::from(n * n)
}

#[test]
fn colors_blend_from_background_to_figure() {
    let what = record(ProceduralKind::Checker, |t| t.colors = [[0.25, 0.5, 2.0], [1.0, 0.0, 4.0]]);
    let color = |x: f64| procedural_color(&what, DVec3::new(x, 0.5, 0.5), DVec3::ZERO, DVec3::ZERO);
    assert_eq!(color(0.5), DVec3::new(0.25, 0.5, 2.0));
    assert_eq!(color(1.5), DVec3::new(1.0, 0.0, 4.0));
    let half = procedural_color(&what, DVec3::new(1.0, 0.5, 0.5), DVec3::X, DVec3::ZERO);
    assert_eq!(half, DVec3::new(0.625, 0.25, 3.0));
}
