//! Convex polygons in the picture plane, and affine functions of the position in it ("forms"): clipping by a
//! line, area, centre. Twin of `glsl/shared/polygon.glsl`.

use glam::{DVec2, DVec3};

/// f(x, y) = f.x x + f.y y + f.z.
pub type AffineFunction = DVec3;

pub const MAX_CORNERS: usize = 12;

/// Smaller areas are dropped, in pixels².
pub const MIN_AREA: f64 = 1e-7;

/// Corners in order; fewer than three have no area.
#[derive(Clone, Copy, Debug, Default)]
pub struct Polygon {
    pub count: usize,
    pub corners: [DVec2; MAX_CORNERS],
}

pub fn at(form: AffineFunction, place: DVec2) -> f64 {
    form.dot(place.extend(1.0))
}

/// Returns the whole pixel.
pub fn unit_square() -> Polygon {
    let mut square = Polygon { count: 4, ..Default::default() };
    square.corners[..4].copy_from_slice(&[DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y]);
    square
}

fn push(polygon: &mut Polygon, corner: DVec2) {
    if polygon.count < MAX_CORNERS {
        polygon.corners[polygon.count] = corner;
    }
    polygon.count += 1;
}

/// Returns the parts where the form is positive, and where it is negative. A part with more than
/// `MAX_CORNERS` corners has lost some.
pub fn split(polygon: &Polygon, form: AffineFunction) -> [Polygon; 2] {
    let mut sides = [Polygon::default(); 2];
    for k in 0..polygon.count {
        let a = polygon.corners[k];
        let b = polygon.corners[(k + 1) % polygon.count];
        let (fa, fb) = (at(form, a), at(form, b));
        if fa >= 0.0 {
            push(&mut sides[0], a);
        }
        if fa <= 0.0 {
            push(&mut sides[1], a);
        }
        if fa * fb < 0.0 {
            let cut = a + (b - a) * (fa / (fa - fb));
            push(&mut sides[0], cut);
            push(&mut sides[1], cut);
        }
    }
    sides
}

/// Returns the signed area by the shoelace formula, relative to the first corner.
pub fn area(polygon: &Polygon) -> f64 {
    let first = polygon.corners[0];
    let mut twice = 0.0;
    for k in 1..polygon.count.saturating_sub(1) {
        twice += (polygon.corners[k] - first).perp_dot(polygon.corners[k + 1] - first);
    }
    0.5 * twice
}

/// Returns the mean of the corners.
pub fn middle(polygon: &Polygon) -> DVec2 {
    polygon.corners[..polygon.count].iter().sum::<DVec2>() / polygon.count as f64
}

/// Returns the least and the greatest value of a form on a polygon.
pub fn range(polygon: &Polygon, form: AffineFunction) -> (f64, f64) {
    let values = polygon.corners[..polygon.count].iter().map(|&c| at(form, c));
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
}
