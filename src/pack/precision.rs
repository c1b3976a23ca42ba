//! Scene and sizes of its textures → whether geometry in f32 is good enough, by first-order analysis of
//! rounding (Higham 2002, chapter 3) at rays all over the picture. Two things count: rays and outlines, in
//! pixels; and places in textures, in texels. And the rounding itself, of a scene that needs no f64.

use glam::{DVec2, DVec3};

use super::header::{camera_basis, half_height};
use super::mapping::uv_matrix;
use super::{PackedScene, shapes};
use crate::scene::model::{Entity, Mapping, MappingKind, Material, Plane, Scene, Sphere, Triangle};
use crate::schema::layout::{self, Record};

/// Unit roundoff of f32.
const U: f64 = 1.0 / 16_777_216.0;
/// Rounding errors of a ray's direction, a dot product with it and a product by t, as they add up where their
/// signs are random.
const RAY: f64 = 2.0;
/// The same for the vector from a sphere's centre, and for an edge function of a triangle.
const SPHERE: f64 = 2.5;
const EDGE: f64 = 3.0;
/// A ray or an outline of a sphere may be off by this part of a pixel.
const PART_OF_PIXEL: f64 = 1.0 / 32.0;
/// An edge of a triangle by this one.
const PART_FOR_EDGES: f64 = 0.25;
/// Triangles smaller than this part of a pixel have no outline that could be seen.
const MIN_PART: f64 = 0.25;
/// A look-up may be off by this part of a texel ...
const PART_OF_TEXEL: f64 = 1.0 / 256.0;
/// ... but in this part of the picture: towards a horizon texels are far smaller than pixels.
const PART_OF_PICTURE: f64 = 1.0 / 3.0;
/// Texels that a unit of a procedural texture is held to have.
const PROCEDURAL_TEXELS: f64 = 16.0;
/// Beyond these numbers squares and cubes leave the range of f32.
const RANGE: [f64; 2] = [1e-12, 1e12];
/// Rays along each side of the picture.
const RAYS: u32 = 16;

/// What f32 would misplace.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Need {
    /// Rays and outlines, by pixels that can be seen.
    pub outlines: bool,
    /// Look-ups, by texels.
    pub texels: bool,
}

struct Camera {
    eye: DVec3,
    forward: DVec3,
    /// A pixel's side: at distance 1, or of parallel rays.
    pixel: f64,
    parallel: bool,
    rays: Vec<[DVec3; 2]>,
}

impl Camera {
    fn new(scene: &Scene) -> Camera {
        let [right, up, forward] = camera_basis(scene);
        let (half, parallel) = half_height(scene);
        let pixel = 2.0 * half / f64::from(scene.height);
        let rays = (0..RAYS * RAYS).map(|i| {
            let part =
                |k: u32, pixels: u32| ((f64::from(k) + 0.5) / f64::from(RAYS) - 0.5) * f64::from(pixels);
            let (x, y) = (part(i % RAYS, scene.width), part(i / RAYS, scene.height));
            let aside = pixel * (x * right - y * up);
            if parallel { [aside, forward] } else { [DVec3::ZERO, forward + aside] }
        });
        Camera { eye: scene.camera.eye, forward, pixel, parallel, rays: rays.collect() }
    }

    /// A pixel's side at that distance.
    fn pixel_at(&self, distance: f64) -> f64 {
        if self.parallel { self.pixel } else { self.pixel * distance }
    }
}

/// Look-ups that were asked about, and those that f32 misplaces.
#[derive(Default)]
struct Count {
    all: u32,
    wrong: u32,
}

impl Count {
    fn add(&mut self, texels: f64) {
        self.all += 1;
        self.wrong += u32::from(texels > PART_OF_TEXEL || texels.is_nan());
    }

    fn too_many(&self) -> bool {
        f64::from(self.wrong) > PART_OF_PICTURE * f64::from(self.all)
    }
}

/// `sizes` of the scene's textures in texels.
pub fn need(scene: &Scene, sizes: &[[u32; 3]]) -> Need {
    let camera = Camera::new(scene);
    let rays_merge = !camera.parallel && RAY * U > camera.pixel * PART_OF_PIXEL;
    let outlines = rays_merge
        || scene.spheres.iter().any(|s| misses_sphere(&camera, s))
        || scene.triangles.iter().any(|t| misses_triangle(&camera, t))
        || scene.shape_extents(camera.eye).any(|size| !(RANGE[0]..=RANGE[1]).contains(&size));
    let texels = |material: usize| {
        let material = &scene.materials[material];
        texels_per_tile(scene, sizes, material).map(|texels| (material, texels))
    };
    let [mut seen, mut triangles] = [Count::default(), Count::default()];
    for plane in &scene.planes {
        let Some((material, texels)) = texels(plane.material) else { continue };
        for &ray in &camera.rays {
            if let Some(tiles) = plane_error(&camera, plane, &material.mapping, ray) {
                seen.add(tiles * texels);
            }
        }
    }
    for sphere in &scene.spheres {
        let Some((material, texels)) = texels(sphere.material) else { continue };
        for &ray in &camera.rays {
            if let Some(tiles) = sphere_error(&camera, sphere, &material.mapping, ray) {
                seen.add(tiles * texels);
            }
        }
    }
    for triangle in &scene.triangles {
        let Some((material, texels)) = texels(triangle.material) else { continue };
        for tiles in triangle_errors(&camera, triangle, &material.mapping) {
            triangles.add(tiles * texels);
        }
    }
    Need { outlines, texels: seen.too_many() || triangles.too_many() }
}

/// Of the finest texture that the material reads.
fn texels_per_tile(scene: &Scene, sizes: &[[u32; 3]], material: &Material) -> Option<f64> {
    let textures = [material.texture, material.bump.map(|r| r.texture)];
    let texels = |texture: usize| {
        let procedural = scene.textures[texture].content.procedural().is_some();
        if procedural { PROCEDURAL_TEXELS } else { f64::from(sizes[texture].into_iter().max().unwrap_or(1)) }
    };
    textures.into_iter().flatten().map(texels).reduce(f64::max)
}

fn misses_sphere(camera: &Camera, sphere: &Sphere) -> bool {
    let center = sphere.center - camera.eye;
    let far = center.length();
    // From outside the outline is seen along tangents; from within there is none.
    let tangent = (far * far - sphere.radius * sphere.radius).max(0.0).sqrt();
    let error = SPHERE * U * (far + sphere.radius);
    far > sphere.radius && error > camera.pixel_at(tangent) * PART_OF_PIXEL
}

/// An edge function is the volume d·(p × q); it is off by a part of |d| |p| |q|, and vanishes along the edge.
fn misses_triangle(camera: &Camera, triangle: &Triangle) -> bool {
    let corners = triangle.vertices.map(|v| v - camera.eye);
    if corners.iter().all(|v| v.dot(camera.forward) <= 0.0) {
        return false;
    }
    let edges = [[1, 2], [2, 0], [0, 1]].map(|[i, j]| {
        let (p, q) = (corners[i], corners[j]);
        let seen = if camera.parallel { camera.forward.cross(q - p) } else { p.cross(q) }.length();
        // Its length in pixels, and the error of its place.
        let reach = if camera.parallel { 1.0 } else { p.length() * q.length() };
        let error = EDGE * U * p.length() * q.length() / seen;
        (seen / reach / camera.pixel, error / camera.pixel)
    });
    let size = edges.iter().map(|e| e.0).fold(0.0, f64::max);
    size > MIN_PART && edges.iter().any(|e| e.1 > PART_FOR_EDGES)
}

/// Error of a plane's texture coordinate where the ray meets it, in tiles.
fn plane_error(camera: &Camera, plane: &Plane, mapping: &Mapping, [origin, way]: [DVec3; 2]) -> Option<f64> {
    let normal = plane.tangent.cross(plane.bitangent).normalize();
    let slope = normal.dot(way);
    let t = normal.dot(plane.origin - camera.eye - origin) / slope;
    let p = origin + t * way;
    let [u, v] = shapes::plane_rows(plane, camera.eye);
    let own = DVec2::new(u.dot(p.extend(1.0)), v.dot(p.extend(1.0)));
    let outside = plane.half_extent.is_some_and(|extent| own.abs().max_element() > extent);
    if t.is_nan() || t <= 0.0 || t.is_infinite() || outside {
        return None;
    }
    // Of t, and so of the point along the ray.
    let along = RAY * U * (1.0 + way.length() / slope.abs());
    let matrix = uv_matrix(mapping);
    let tiles = match mapping.kind {
        MappingKind::Surface => {
            let own = matrix.x_axis.abs() * u.truncate().dot(p).abs()
                + matrix.y_axis.abs() * v.truncate().dot(p).abs();
            let steep =
                matrix.x_axis.abs() * u.truncate().length() + matrix.y_axis.abs() * v.truncate().length();
            own.max_element() * along + steep.max_element() * RAY * U * p.length()
        }
        _ => tiles_a_unit(mapping, p + camera.eye, normal) * p.length() * (along + RAY * U),
    };
    Some(tiles)
}

fn sphere_error(
    camera: &Camera,
    sphere: &Sphere,
    mapping: &Mapping,
    [origin, way]: [DVec3; 2],
) -> Option<f64> {
    let center = sphere.center - camera.eye - origin;
    let unit = way.normalize();
    let ahead = center.dot(unit);
    let aside = (center - ahead * unit).length();
    if aside >= sphere.radius || ahead <= 0.0 {
        return None;
    }
    let error = SPHERE * U * (center.length() + sphere.radius);
    let normal = (ahead * unit - center).normalize();
    let tiles = match mapping.kind {
        MappingKind::Surface => mapping.scale.abs().max_element() / (2.0 * sphere.radius),
        _ => tiles_a_unit(mapping, sphere.center + sphere.radius * normal, normal),
    };
    Some(error * tiles * if mapping.entity.is_direction() { 1.0 / sphere.radius } else { 1.0 })
}

/// At four points of the triangle.
fn triangle_errors(camera: &Camera, triangle: &Triangle, mapping: &Mapping) -> [f64; 4] {
    let [a, b, c] = triangle.vertices;
    let doubled = (b - a).cross(c - a);
    let normal = doubled.normalize();
    let third = 1.0 / 3.0;
    let weights = [[third; 3], [0.8, 0.1, 0.1], [0.1, 0.8, 0.1], [0.1, 0.1, 0.8]];
    weights.map(|w| {
        let place = w[0] * a + w[1] * b + w[2] * c;
        let p = place - camera.eye;
        let way = if camera.parallel { camera.forward } else { p };
        if way.dot(camera.forward) <= 0.0 {
            return 0.0;
        }
        // Rays that graze see no texels.
        let slope = (normal.dot(way) / way.length()).abs().max(1e-3);
        let reach = [a, b, c].map(|v| (v - camera.eye).length()).into_iter().fold(0.0, f64::max);
        let error = RAY * U * (p.length() * (1.0 + 1.0 / slope) + reach);
        let tiles = match mapping.kind {
            MappingKind::Surface => {
                let uvs = triangle.uvs.map(|uv| uv_matrix(mapping) * uv);
                let longest = (uvs[1] - uvs[0]).length().max((uvs[2] - uvs[0]).length());
                let longest = longest.max((uvs[2] - uvs[1]).length());
                // Over the least height.
                longest * (b - a).length().max((c - a).length()).max((c - b).length()) / doubled.length()
            }
            _ => tiles_a_unit(mapping, place, normal),
        };
        error * tiles
    })
}

/// How fast a projecting map's coordinate changes at a place with that normal, at most.
fn tiles_a_unit(mapping: &Mapping, place: DVec3, normal: DVec3) -> f64 {
    let scale = mapping.scale.abs().max_element().max(if mapping.kind == MappingKind::Solid {
        mapping.scale_w.abs()
    } else {
        0.0
    });
    let entity = match mapping.entity {
        Entity::Position => place - mapping.origin,
        Entity::Centroid => DVec3::ONE,
        Entity::Normal | Entity::Reflection => normal,
    };
    match mapping.kind {
        MappingKind::Planar | MappingKind::Solid => scale,
        _ => scale / entity.length().max(f64::MIN_POSITIVE),
    }
}

impl Scene {
    /// The largest number that each shape has, seen from the eye.
    fn shape_extents(&self, eye: DVec3) -> impl Iterator<Item = f64> {
        let reach = move |p: DVec3| (p - eye).abs().max_element();
        let planes = self.planes.iter().map(move |p| {
            let normal = p.tangent.cross(p.bitangent).normalize();
            normal.dot(p.origin - eye).abs().max(RANGE[0])
        });
        let spheres = self.spheres.iter().map(move |s| reach(s.center) + s.radius);
        let triangles =
            self.triangles.iter().map(move |t| t.vertices.map(reach).into_iter().fold(0.0, f64::max));
        planes.chain(spheres).chain(triangles)
    }
}

impl PackedScene {
    /// Without f64 on the device all is of f32, and a person should know.
    pub fn suit_device(&mut self, float64: bool) -> Option<String> {
        if !self.double || float64 {
            return None;
        }
        self.round_reals();
        Some(
            "the device has no f64 in shaders: geometry is of f32, which misplaces outlines or texels here; \
             --precision single says that this is meant"
                .into(),
        )
    }

    /// The numbers that a device reads as f32.
    pub fn round_reals(&mut self) {
        fn round<R: Record>(list: &mut [R]) {
            list.iter_mut().for_each(|record| *record = record.quantize_f32());
        }
        self.header = self.header.quantize_f32();
        for plane in &mut self.planes {
            let extent = plane.half_extent();
            plane.link[2..].copy_from_slice(&layout::Plane::extent_words(extent, false));
        }
        round(&mut self.planes);
        round(&mut self.spheres);
        round(&mut self.triangles);
        round(&mut self.lights);
        round(&mut self.maps);
        round(&mut self.procedurals);
        round(&mut self.motions);
        self.double = false;
    }
}
