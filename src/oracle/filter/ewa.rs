//! Filter `ewa`, the elliptical weighted average (Heckbert 1989). Twin of `glsl/shared/filter/ewa.glsl`.

use glam::{DVec2, DVec3, DVec4};

use super::levels::Reader;
use crate::oracle::address::reduced_coordinate;
use crate::oracle::footprint_axes::FootprintEllipse;
use crate::oracle::mapping::Coordinate;
use crate::oracle::texture::{add_weighted, addresses, level_at};
use crate::schema::layout::Sampler;
use crate::texture::sampler_spec::TexelCenter;

/// On the selected level, the minor axis has a full width between 2^-ELLIPSE_LEVEL texels and twice that.
const ELLIPSE_LEVEL: f64 = 0.0;
const MAX_ELLIPSE_STEPS: u32 = 8192;
/// Largest area over π: including its rows, fewer texels than steps.
const MAX_ELLIPSE: f64 = 2048.0;

/// Returns exp(-2 r²) - exp(-2) for r² in [0, 1], as a polynomial.
pub fn ellipse_weight(squared: f64) -> f64 {
    let r = 1.0 - squared;
    r * (0.2643662 + r * (0.3266478 + r * (0.0257909 + r * 0.2473448)))
}

/// Returns the level on which an ellipse of this minor axis, squared in texels of level 0, is averaged.
pub fn ellipse_level(minor: f64, last: u32) -> u32 {
    (0.5 * minor.max(1e-30).log2() + ELLIPSE_LEVEL).floor().clamp(0.0, last.into()) as u32
}

/// Returns the squared minor axis, at least as long as the maximum anisotropy allows.
pub fn widened_minor(how: &Sampler, spread: &FootprintEllipse) -> f64 {
    let most = f64::from(how.max_anisotropy);
    spread.minor.max(spread.major / (most * most))
}

/// Returns the average of all texels in the footprint's ellipse, weighted by a Gaussian.
pub fn ellipse(reader: &Reader<'_>, c: &Coordinate, spread: &FootprintEllipse) -> DVec4 {
    let (image, how) = (reader.image, reader.how);
    let most = f64::from(how.max_anisotropy);
    let minor = widened_minor(how, spread);
    let level = level_at(reader.scene, image, ellipse_level(minor, image.levels - 1));
    let size = DVec2::new(level.size[0] as f64, level.size[1] as f64);
    let [x, y] = c.change.map(|d| d.truncate() * size);
    let scale = (size.x / f64::from(image.size.x)).powi(2);
    let mut m = DVec3::new(x.x * x.x + y.x * y.x, x.x * x.y + y.x * y.y, x.y * x.y + y.y * y.y);
    let gap = spread.major - spread.minor;
    let widen = if gap > 0.0 { (minor - spread.minor) / gap } else { 0.0 };
    m += widen * (DVec3::new(spread.major * scale, 0.0, spread.major * scale) - m);
    m *= (16.0 * most * most / (m.x + m.z).max(1e-30)).min(1.0);
    m *= (MAX_ELLIPSE / (m.x * m.z - m.y * m.y).max(1.0).sqrt()).min(1.0);
    m += DVec3::new(1.0, 0.0, 1.0);
    let determinant = m.x * m.z - m.y * m.y;
    let (a, b, d) = (m.z / determinant, -m.y / determinant, m.x / determinant);

    let [u, v, _] = addresses(how);
    let shift = if how.texel_center == TexelCenter::Integer { 0.0 } else { 0.5 };
    let center =
        DVec2::new(reduced_coordinate(u, c.at.x, size.x), reduced_coordinate(v, c.at.y, size.y)) - shift;
    let reach = m.z.sqrt();
    let mut sum = DVec4::ZERO;
    let mut weights = 0.0;
    let mut steps = 0;
    let mut row = (center.y - reach).ceil();
    while row <= (center.y + reach).floor() {
        let h = row - center.y;
        let half_width = (a - (a * d - b * b) * h * h).max(0.0).sqrt() / a;
        let middle = center.x - b * h / a;
        let mut column = (middle - half_width).ceil();
        steps += 1;
        while column <= (middle + half_width).floor() && steps < MAX_ELLIPSE_STEPS {
            let offset = DVec2::new(column, row) - center;
            let squared = a * offset.x * offset.x + 2.0 * b * offset.x * offset.y + d * offset.y * offset.y;
            let weight = ellipse_weight(squared.clamp(0.0, 1.0));
            sum = add_weighted(weight, reader.flat(&level, column, row), sum);
            weights += weight;
            column += 1.0;
            steps += 1;
        }
        row += 1.0;
    }
    sum / weights.max(1e-20)
}
