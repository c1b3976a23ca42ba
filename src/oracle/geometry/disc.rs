//! Discs. A disc is a unit circle in its own coordinates, which are quotients of affine functions of a place in a cone or
//! a beam; beams know no outline of it and ask only whether it may lie in the way. Twin of
//! `glsl/shared/geometry/disc.glsl`.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3, DVec4};

use super::hit::{FAR, Hit, Surface, surface};
use super::kinds::{Form, Round, Search, Shape};
use super::plane::{distance_to_plane, own_place};
use super::sphere::Circle;
use crate::oracle::camera::Ray;
use crate::oracle::cone::{Cone, flat_in};
use crate::oracle::coverage::{Covered, Cuts, ball_overlap, circle_line};
use crate::oracle::polygon::{AffineFunction, Polygon, range};
use crate::oracle::projective::{PixelFrustum, along, below, region_of_plane};
use crate::pack::PackedScene;
use crate::schema::layout::{Disc, Header, Light, Sphere};

/// An own coordinate as an affine function.
fn own_row(disc: &Disc, axis: DVec3) -> DVec4 {
    axis.extend(-axis.dot(disc.center))
}

/// A disc in the cone: the own coordinates of the place met at u are (x·(u, 1), y·(u, 1)) / w·(u, 1), so that its
/// outline is a conic. Where that is about round or no end of it is near, it is the circle; where it is a strip across
/// the cone, lines.
#[derive(Clone, Copy, Debug)]
struct Conic {
    circle: Circle,
    is_strip: bool,
    has_lines: bool,
    /// Positive where the plane lies before the cone.
    front: DVec3,
    w: DVec3,
    /// Numerator of the own coordinate along which the strip is thin.
    across: DVec3,
    /// Tangent of the outline at the point radially outwards of the axis.
    tangent: DVec3,
}

fn conic_of(cone: &Cone, disc: &Disc) -> Conic {
    let seen = flat_in(cone, disc.normal, disc.distance);
    let [x, y] = [disc.axis_u, disc.axis_v].map(|axis| own_place(cone, &seen, own_row(disc, axis)));
    let w = (cone.spread * seen.tilt).extend(seen.facing);
    let front = (-cone.width * seen.tilt).extend(seen.height);
    // The centre, and squares of the inverse semi-axes times the denominator there.
    let area = x.x * y.y - x.y * y.x;
    let divisor = if area == 0.0 { 1e-30 } else { area };
    let mut middle = DVec2::new(x.y * y.z - y.y * x.z, y.x * x.z - x.x * y.z) / divisor;
    let under = w.truncate().dot(middle) + w.z;
    let (a, b, c) =
        (x.truncate().length_squared(), x.truncate().dot(y.truncate()), y.truncate().length_squared());
    let mean = 0.5 * (a + c);
    let apart = (0.25 * (a - c) * (a - c) + b * b).sqrt();
    let thin = if a >= c { DVec2::new(mean + apart - c, b) } else { DVec2::new(b, mean + apart - a) };
    let thin = thin.try_normalize().unwrap_or(DVec2::X);
    let squared = under * under;
    // The longer semi-axis is at least 1 and twice the shorter one, which is at most 2.
    let is_long = mean - apart <= squared && 5.0 * apart >= 3.0 * mean && 4.0 * (mean + apart) >= squared;
    let is_strip = under.is_nan() || under <= 0.0 || is_long;
    let distance = x.z.hypot(y.z);
    let side = if w.z < 0.0 { -distance } else { distance };
    let outward = if distance > 0.0 { DVec2::new(x.z, y.z) / side } else { DVec2::X };
    let tangent = w - outward.x * x - outward.y * y;
    let radius = under / divisor.abs().sqrt();
    let mut edge = radius - middle.length();
    if radius >= 2.0 {
        let scale = 1.0 / tangent.truncate().length_squared().max(1e-30).sqrt();
        edge = tangent.z * scale;
        middle = (radius - edge) * scale * tangent.truncate();
    }
    let across = thin.x * x + thin.y * y;
    let circle = Circle { middle, radius, edge };
    Conic { circle, is_strip, has_lines: is_strip || radius >= 1.0, front, w, across, tangent }
}

/// Cuts the disc of the cone by the lines of a strip, or by a line that leaves about as much as the circle.
fn cut_by_conic(cuts: &mut Cuts, conic: &Conic) {
    if !conic.is_strip {
        cuts.by(circle_line(conic.circle.middle, conic.circle.radius, conic.circle.edge));
        return;
    }
    cuts.by(conic.front);
    cuts.by(conic.w);
    cuts.by(conic.w - conic.across);
    cuts.by(conic.w + conic.across);
    cuts.by(conic.tangent);
}

impl Shape for Disc {
    fn links(&self) -> [u32; 2] {
        [self.material, self.uv_projection]
    }

    fn distance_to(&self, _: &PackedScene, ray: &Ray, _: f64, _: Search) -> (f64, DVec2) {
        let (t, p) = distance_to_plane(self.normal, self.distance, ray);
        let own = p - self.center;
        let local = DVec2::new(self.axis_u.dot(own), self.axis_v.dot(own));
        (if local.length_squared() <= 1.0 { t } else { -1.0 }, local)
    }

    fn surface_of(&self, _: &PackedScene, point: DVec3, local: DVec2) -> Surface {
        const CENTER: f64 = 1e-6;
        let (axis_u, axis_v) = (self.axis_u, self.axis_v);
        let mut own_uv = 0.5 * local + 0.5;
        let mut own_gradients = [0.5 * axis_u, 0.5 * axis_v];
        if self.is_polar {
            let turn = local.y.atan2(local.x) / TAU;
            let across = local.length();
            own_uv = DVec2::new(if turn < 0.0 { turn + 1.0 } else { turn }, across);
            let outward = across.max(CENTER);
            let unit = local / outward;
            let around = (unit.x * axis_v - unit.y * axis_u) / (TAU * outward);
            own_gradients = [around, unit.x * axis_u + unit.y * axis_v];
        }
        let normal = self.normal.normalize();
        Surface { own_uv, own_gradients, ..surface(point, normal, normal, self.links()) }
    }

    /// False for a disc that no line stands for: smaller than the cone.
    fn cut_by_shape(&self, cuts: &mut Cuts, cone: &Cone) -> bool {
        let conic = conic_of(cone, self);
        cut_by_conic(cuts, &conic);
        conic.has_lines
    }

    fn complete(&self, scene: &PackedScene, ray: &Ray, hit: &mut Hit) {
        hit.local = self.distance_to(scene, ray, FAR, Search::Nearest).1;
    }

    fn tangent_plane(&self, _: &Cone, _: f64) -> DVec4 {
        self.normal.extend(self.distance)
    }

    /// False where no ray of the polygon can meet the square around the disc.
    fn may_meet(&self, _: &Header, frame: &PixelFrustum, polygon: &Polygon) -> bool {
        let region = region_of_plane(frame, self.normal.extend(self.distance));
        let under = below(frame, region.inverse_depth);
        let sides = [self.axis_u, self.axis_v].into_iter().flat_map(|axis| {
            let own = along(frame, region.inverse_depth, own_row(self, axis));
            [under - own, under + own]
        });
        sides.chain(region.lines[..region.count].iter().copied()).all(|line| range(polygon, line).1 > 0.0)
    }

    fn plane_of(&self) -> Option<DVec4> {
        Some(self.normal.extend(self.distance))
    }

    fn form(&self) -> Form<'_> {
        Form::Round(self)
    }
}

impl Round for Disc {
    fn covered_by(&self, _: &PackedScene, cone: &Cone) -> Covered {
        let conic = conic_of(cone, self);
        if !conic.is_strip {
            return ball_overlap(conic.circle.middle, conic.circle.radius, conic.circle.edge);
        }
        let mut cuts = Cuts::default();
        cut_by_conic(&mut cuts, &conic);
        cuts.covered()
    }

    /// False where no way from the polygon to the light can pass the sphere around the disc.
    fn may_shade(&self, surface: (&PixelFrustum, AffineFunction), polygon: &Polygon, light: &Light) -> bool {
        Sphere { center: self.center, radius: self.radius, ..Default::default() }
            .may_shade(surface, polygon, light)
    }
}
