//! Flat surfaces in a pixel's projection: regions bounded by lines, inverse depth that is affine, and texture
//! coordinates as quotients of affine functions, also after reflection in plane mirrors. Perspective: rays start at one
//! point, the direction is affine in the position, inverse depth is 1 / t. Parallel: the origin is affine, inverse
//! depth is -t. The shapes are in `geometry/beams.rs`. Twin of `glsl/shared/projective.glsl`.

use glam::{DMat3, DVec2, DVec3, DVec4};

use super::polygon::{AffineFunction, at};
use crate::pack::ProjectionKind;
use crate::schema::layout::Header;

pub const MAX_LINES: usize = 6;

/// All rays of a pixel: the sum of the columns weighted by (x, y, 1) is the direction or the origin.
#[derive(Clone, Copy, Debug)]
pub struct PixelFrustum {
    pub rays: DMat3,
    /// The other of the two, the same for all rays.
    pub same: DVec3,
    pub parallel: bool,
}

/// The projection of a convex shape: the positions where all lines are positive.
#[derive(Clone, Copy, Debug)]
pub struct ConvexRegion {
    pub count: usize,
    pub lines: [AffineFunction; MAX_LINES],
    pub inverse_depth: AffineFunction,
}

/// (u, v) = (u, v) / below.
#[derive(Clone, Copy, Debug)]
pub struct RationalMap {
    pub u: AffineFunction,
    pub v: AffineFunction,
    pub below: AffineFunction,
}

pub fn pixel_frame(header: &Header, pixel: [u32; 2]) -> PixelFrustum {
    frame_over(header, pixel, 0.0, 0.0)
}

/// Returns the rays of the pixels from the first one to `more` columns and rows on, with a margin around them.
pub fn frame_over(header: &Header, pixel: [u32; 2], more: f64, margin: f64) -> PixelFrustum {
    let corner = DVec2::new(
        f64::from(pixel[0]) - 0.5 * f64::from(header.image_size.x),
        f64::from(pixel[1]) - 0.5 * f64::from(header.image_size.y),
    );
    // The unit square represents the pixel filter's box.
    let radius = f64::from(header.filter_radius) + margin;
    let corner = corner + (0.5 - radius);
    let (x, y, forward) = (header.step_x, header.step_y, header.forward);
    let parallel = header.projection == ProjectionKind::Orthographic;
    let (base, wide) = (corner.x * x + corner.y * y, 2.0 * radius + more);
    if parallel {
        PixelFrustum { rays: DMat3::from_cols(wide * x, wide * y, base), same: forward, parallel }
    } else {
        PixelFrustum {
            rays: DMat3::from_cols(wide * x, wide * y, base + forward),
            same: DVec3::ZERO,
            parallel,
        }
    }
}

/// Returns n · (the part that differs from ray to ray).
pub fn form(frame: &PixelFrustum, n: DVec3) -> AffineFunction {
    frame.rays.transpose() * n
}

/// Returns the ray's direction, and its origin.
pub fn ray_at(frame: &PixelFrustum, place: DVec2) -> (DVec3, DVec3) {
    let own = frame.rays * place.extend(1.0);
    if frame.parallel { (frame.same, own) } else { (own, frame.same) }
}

/// Reflects the frustum in the mirror with unit normal n and n·p = height.
pub fn mirrored_frame(frame: &PixelFrustum, n: DVec3, height: f64) -> PixelFrustum {
    let turn = |v: DVec3| v - 2.0 * n.dot(v) * n;
    let [x, y, base] = [frame.rays.x_axis, frame.rays.y_axis, frame.rays.z_axis].map(turn);
    let shift = 2.0 * height * n;
    if frame.parallel {
        PixelFrustum { rays: DMat3::from_cols(x, y, base + shift), same: turn(frame.same), ..*frame }
    } else {
        PixelFrustum { rays: DMat3::from_cols(x, y, base), same: turn(frame.same) + shift, ..*frame }
    }
}

/// Returns the inverse depth 1 / t or -t of the plane n·p = height, positive or negative in front; zero if the rays
/// never meet it.
pub fn inverse_depth(frame: &PixelFrustum, n: DVec3, height: f64) -> AffineFunction {
    let across = n.dot(frame.same);
    if frame.parallel {
        if across == 0.0 { AffineFunction::ZERO } else { (form(frame, n) - DVec3::Z * height) / across }
    } else if height == across {
        AffineFunction::ZERO
    } else {
        form(frame, n) / (height - across)
    }
}

/// Returns a function that is positive where a point of that inverse depth is in front.
pub fn in_front(frame: &PixelFrustum, inverse_depth: AffineFunction) -> AffineFunction {
    if frame.parallel { -inverse_depth } else { inverse_depth }
}

/// Returns the denominator of coordinates on a plane of this inverse depth.
pub fn below(frame: &PixelFrustum, inverse_depth: AffineFunction) -> AffineFunction {
    if frame.parallel { AffineFunction::Z } else { inverse_depth }
}

/// Returns row · (p, 1) times `below`, for the points p of the plane of that inverse depth.
pub fn along(frame: &PixelFrustum, inverse_depth: AffineFunction, row: DVec4) -> AffineFunction {
    let n = row.truncate();
    let same = n.dot(frame.same);
    if frame.parallel {
        form(frame, n) - same * inverse_depth + row.w * AffineFunction::Z
    } else {
        form(frame, n) + (same + row.w) * inverse_depth
    }
}

pub(super) fn add(region: &mut ConvexRegion, line: AffineFunction) {
    region.lines[region.count] = line;
    region.count += 1;
}

/// Returns the region in which a plane is in front.
pub fn region_of_plane(frame: &PixelFrustum, plane: DVec4) -> ConvexRegion {
    let near = inverse_depth(frame, plane.truncate(), plane.w);
    let mut region = ConvexRegion { count: 0, lines: [AffineFunction::ZERO; MAX_LINES], inverse_depth: near };
    add(&mut region, in_front(frame, near));
    region
}

/// Returns the point of the plane of that inverse depth at a position in the picture.
pub fn point_at(frame: &PixelFrustum, inverse_depth: AffineFunction, place: DVec2) -> DVec3 {
    let (way, origin) = ray_at(frame, place);
    let near = at(inverse_depth, place);
    origin + way * if frame.parallel { -near } else { 1.0 / near }
}
