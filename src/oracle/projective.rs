//! Shapes as a pixel's rays see them: regions between lines of the picture, inverse depth that is affine there,
//! and texture coordinates as quotients of affine functions, also after plane mirrors. Perspective:
//! rays start at one point, the direction is affine in the place, inverse depth is 1 / t. Parallel: the
//! origin is affine, inverse depth is -t. Twin of `glsl/shared/projective.glsl`.

use glam::{DMat3, DVec2, DVec3, DVec4};

use super::math::{vec4, xyz};
use super::polygon::{AffineFunction, Polygon, at, middle};
use crate::pack::{LightKind, MapKind, PackedScene, ProjectionKind};
use crate::schema::layout::{Header, Light, Plane, Sphere, Triangle};

pub const MAX_LINES: usize = 6;

/// All rays of a pixel: with the columns' sum weighted by (x, y, 1), direction or origin.
#[derive(Clone, Copy, Debug)]
pub struct PixelFrustum {
    pub rays: DMat3,
    /// The other of the two, the same for all.
    pub same: DVec3,
    pub parallel: bool,
}

/// What a convex shape covers: the places where all lines are positive.
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

/// All rays of the pixels from the first to `more` columns and rows on, and of a margin around them.
pub fn frame_over(header: &Header, pixel: [u32; 2], more: f64, margin: f64) -> PixelFrustum {
    let corner = DVec2::new(
        f64::from(pixel[0]) - 0.5 * f64::from(header.image[0]),
        f64::from(pixel[1]) - 0.5 * f64::from(header.image[1]),
    );
    // The unit square stands for the pixel filter's box.
    let radius = f64::from(f32::from_bits(header.pixel_filter[1])) + margin;
    let corner = corner + (0.5 - radius);
    let (x, y, forward) = (xyz(header.step_x), xyz(header.step_y), xyz(header.forward));
    let parallel = header.size[2] == ProjectionKind::Orthographic as u32;
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

/// n · (what differs from ray to ray).
pub fn form(frame: &PixelFrustum, n: DVec3) -> AffineFunction {
    frame.rays.transpose() * n
}

/// The ray's direction, and its origin.
pub fn ray_at(frame: &PixelFrustum, place: DVec2) -> (DVec3, DVec3) {
    let own = frame.rays * place.extend(1.0);
    if frame.parallel { (frame.same, own) } else { (own, frame.same) }
}

/// Behind the mirror with unit normal n and n·p = height.
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

/// 1 / t or -t of the plane n·p = height, where it is in front positive or negative; zero where the rays
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

/// Positive where the place of that inverse depth lies in front.
pub fn in_front(frame: &PixelFrustum, inverse_depth: AffineFunction) -> AffineFunction {
    if frame.parallel { -inverse_depth } else { inverse_depth }
}

/// What coordinates on a plane of this inverse depth are divided by.
pub fn below(frame: &PixelFrustum, inverse_depth: AffineFunction) -> AffineFunction {
    if frame.parallel { AffineFunction::Z } else { inverse_depth }
}

/// row · (p, 1) times `below`, for the points p of the plane of that inverse_depth.
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

pub fn plane_region(frame: &PixelFrustum, plane: &Plane) -> ConvexRegion {
    let near = inverse_depth(frame, xyz(plane.normal), plane.normal[3]);
    let mut region = ConvexRegion { count: 0, lines: [AffineFunction::ZERO; MAX_LINES], inverse_depth: near };
    add(&mut region, in_front(frame, near));
    if let Some(half_extent) = plane.half_extent() {
        let extent = half_extent * below(frame, near);
        for row in [plane.axis_u, plane.axis_v] {
            let own = along(frame, near, vec4(row));
            add(&mut region, extent - own);
            add(&mut region, extent + own);
        }
    }
    region
}

pub fn triangle_region(frame: &PixelFrustum, triangle: &Triangle) -> ConvexRegion {
    let near = inverse_depth(frame, xyz(triangle.normal), triangle.normal[3]);
    let mut region = ConvexRegion { count: 0, lines: [AffineFunction::ZERO; MAX_LINES], inverse_depth: near };
    add(&mut region, in_front(frame, near));
    for edge in edge_forms(frame, triangle) {
        add(&mut region, edge);
    }
    region
}

/// Barycentric weights of a triangle's corners times their sum, positive within it.
pub fn edge_forms(frame: &PixelFrustum, triangle: &Triangle) -> [AffineFunction; 3] {
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(xyz);
    let way = frame.same;
    if frame.parallel {
        let side = way.dot((b - a).cross(c - a)).signum();
        let edge =
            |p: DVec3, q: DVec3| side * (form(frame, (p - q).cross(way)) + DVec3::Z * way.dot(p.cross(q)));
        return [edge(b, c), edge(c, a), edge(a, b)];
    }
    let [a, b, c] = [a - way, b - way, c - way];
    let side = a.dot(b.cross(c)).signum();
    [side * form(frame, b.cross(c)), side * form(frame, c.cross(a)), side * form(frame, a.cross(b))]
}

/// Planes first, then spheres, then triangles; spheres have no region.
pub fn shape_region(scene: &PackedScene, frame: &PixelFrustum, shape: u32) -> ConvexRegion {
    let [planes, spheres, _, _] = scene.header.counts;
    if shape < planes {
        plane_region(frame, &scene.planes[shape as usize])
    } else {
        triangle_region(frame, &scene.triangles[(shape - planes - spheres) as usize])
    }
}

/// Unit normal, and height of the plane in which a flat shape lies.
pub fn shape_plane(scene: &PackedScene, shape: u32) -> DVec4 {
    let [planes, spheres, _, _] = scene.header.counts;
    if shape < planes {
        vec4(scene.planes[shape as usize].normal)
    } else {
        vec4(scene.triangles[(shape - planes - spheres) as usize].normal)
    }
}

/// Texture coordinates on a flat shape, for maps that are affine there.
pub fn coordinates(
    scene: &PackedScene,
    frame: &PixelFrustum,
    shape: u32,
    map: u32,
    near: AffineFunction,
) -> RationalMap {
    let [planes, spheres, _, _] = scene.header.counts;
    let map = &scene.maps[map as usize];
    let under = below(frame, near);
    if map.link[0] == MapKind::VertexUv as u32 {
        let triangle = &scene.triangles[(shape - planes - spheres) as usize];
        let e = edge_forms(frame, triangle);
        let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(vec4);
        let v = vec4(triangle.v);
        return RationalMap {
            u: a.w * e[0] + b.w * e[1] + c.w * e[2],
            v: v.x * e[0] + v.y * e[1] + v.z * e[2],
            below: e[0] + e[1] + e[2],
        };
    }
    if map.link[0] == MapKind::Affine as u32 {
        let [u, v] = [map.x, map.y].map(|row| along(frame, near, vec4(row)));
        return RationalMap { u, v, below: under };
    }
    let plane = &scene.planes[shape as usize];
    // Counted from the eye.
    let own = |row: [f64; 4]| along(frame, near, xyz(row).extend(0.0));
    let (u, v) = (own(plane.axis_u), own(plane.axis_v));
    let m = vec4(map.matrix);
    let offset = vec4(map.offset);
    RationalMap {
        u: m.x * u + m.y * v + offset.x * under,
        v: m.z * u + m.w * v + offset.y * under,
        below: under,
    }
}

/// Where, on the plane of this inverse depth, a flat shape keeps a light away.
pub fn shadow_region(
    scene: &PackedScene,
    frame: &PixelFrustum,
    near: AffineFunction,
    shape: u32,
    light: &Light,
) -> ConvexRegion {
    let [planes, spheres, _, _] = scene.header.counts;
    let place = xyz(light.place);
    let point = light.link[0] == LightKind::Point as u32;
    let plane = shape_plane(scene, shape);
    let n = plane.truncate();
    // Of the light before the shape's plane, or of a way's length towards it.
    let rise = if point { plane.w - n.dot(place) } else { n.dot(place) };
    let side = if rise == 0.0 { 0.0 } else { rise.signum() };
    let mut region = ConvexRegion { count: 0, lines: [AffineFunction::ZERO; MAX_LINES], inverse_depth: near };
    // Beyond the plane, seen from the light.
    let beyond = if point { side * n.extend(-plane.w) } else { -side * n.extend(-plane.w) };
    add(&mut region, along(frame, near, beyond));
    if shape < planes {
        let record = &scene.planes[shape as usize];
        let Some(extent) = record.half_extent() else { return region };
        // A place's distance below the light, in |rise|, or its own height.
        let depth = if point { side * n.extend(-n.dot(place)) } else { DVec4::W * rise.abs() };
        for row in [record.axis_u, record.axis_v].map(vec4) {
            let axis = row.truncate();
            let own = if point {
                // u of light + (p - light) rise / (n·(p - light)), times the depth.
                (axis.dot(place) + row.w) * depth + rise.abs() * axis.extend(-axis.dot(place))
            } else {
                // u of p + way (height - n·p) / rise, times |rise|.
                rise.abs() * row + side * axis.dot(place) * (-n).extend(plane.w)
            };
            add(&mut region, along(frame, near, extent * depth - own));
            add(&mut region, along(frame, near, extent * depth + own));
        }
        return region;
    }
    let triangle = &scene.triangles[(shape - planes - spheres) as usize];
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(xyz);
    let turn =
        if point { (a - place).dot((b - place).cross(c - place)) } else { place.dot((b - a).cross(c - a)) };
    for (p, q) in [(b, c), (c, a), (a, b)] {
        let row = if point {
            let m = (p - place).cross(q - place);
            m.extend(-m.dot(place))
        } else {
            (p - q).cross(place).extend(place.dot(p.cross(q)))
        };
        add(&mut region, along(frame, near, turn.signum() * row));
    }
    region
}

/// False where no ray of the polygon can meet the sphere.
pub fn may_meet_sphere(frame: &PixelFrustum, polygon: &Polygon, sphere: &Sphere) -> bool {
    let (way, origin) = ray_at(frame, middle(polygon));
    let unit = way.normalize();
    let to = xyz(sphere.ball) - origin;
    let radius = sphere.ball[3];
    let along = to.dot(unit);
    if to.length_squared() <= radius * radius {
        return true;
    }
    if along <= -radius {
        return false;
    }
    // The tangent of the widest angle to a corner, or the farthest of the parallel rays.
    let mut wide = 0.0f64;
    for &corner in &polygon.corners[..polygon.count] {
        let (w, o) = ray_at(frame, corner);
        let away = if frame.parallel { (o - origin).length() } else { w.cross(unit).length() / w.dot(unit) };
        wide = wide.max(away);
    }
    let away = (to - along * unit).length();
    let reach = if frame.parallel {
        radius + wide
    } else {
        radius * (1.0 + wide * wide).sqrt() + along.max(0.0) * wide
    };
    away <= 1.0001 * reach
}

/// The point of the plane of that inverse depth which a place shows.
pub fn point_at(frame: &PixelFrustum, inverse_depth: AffineFunction, place: DVec2) -> DVec3 {
    let (way, origin) = ray_at(frame, place);
    let near = at(inverse_depth, place);
    origin + way * if frame.parallel { -near } else { 1.0 / near }
}
