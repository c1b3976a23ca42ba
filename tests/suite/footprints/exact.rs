//! The level that a ray reads against that of its pixel's exact footprint: the map from positions in the picture to
//! positions in the texture, differentiated numerically in f64. For every kind of mapping and entity, around seams and
//! poles, directly, in mirrors and through glass.

use glam::{DVec2, DVec3};
use moire::internal::oracle::appearance::map_input;
use moire::internal::oracle::bsdf::dielectric::refracted;
use moire::internal::oracle::bsdf::mirror::mirrored;
use moire::internal::oracle::camera::{Ray, camera_ray};
use moire::internal::oracle::footprint::{Footprint, camera_differential};
use moire::internal::oracle::footprint_axes::in_texture;
use moire::internal::oracle::geometry::hit::Surface;
use moire::internal::oracle::geometry::rays::hit_surface;
use moire::internal::oracle::geometry::rays::{nearest_hit, offset_origin};
use moire::internal::oracle::mapping::texture_coordinate;
use moire::internal::oracle::shade::{advance, camera_path};
use moire::internal::pack::{MapKind, PackedScene};
use moire::internal::scene::model::Model;
use moire::internal::schema::layout::{NO_MATERIAL, NO_SHAPE};

use super::bench::{level_scene, place_of};
use crate::stage;

/// The end in the texture of a ray through a position in the picture: shapes on its path and the face of a cube,
/// mapping, and the position in [0, 1].
fn end_of_ray(scene: &PackedScene, at: DVec2) -> Option<(Vec<u32>, u32, DVec3)> {
    let header = &scene.header;
    let centered = at - 0.5 * DVec2::new(header.image_size.x.into(), header.image_size.y.into());
    let direction = header.forward + centered.x * header.step_x + centered.y * header.step_y;
    let mut ray = Ray { origin: DVec3::ZERO, direction, time: 0.0 };
    let mut way = Vec::new();
    let mut skip = NO_SHAPE;
    for _ in 0..6 {
        let hit = nearest_hit(scene, &ray, skip);
        way.push(hit.shape);
        skip = hit.shape;
        let (surface, material, map) = if hit.shape == NO_SHAPE {
            let material = header.environment_material;
            (material != NO_MATERIAL).then_some((
                Surface::default(),
                material,
                header.environment_projection,
            ))?
        } else {
            let surface = hit_surface(scene, &ray, &hit);
            (surface, surface.material, surface.map)
        };
        let material = &scene.records.materials[material as usize];
        let model = material.model;
        let n = surface.geometric_normal;
        let ior = f64::from(material.ior);
        let ratio = if surface.inside { ior } else { 1.0 / ior };
        ray = match model {
            Model::Mirror => Ray {
                origin: offset_origin(surface.point, n, surface.size),
                direction: mirrored(ray.direction, surface.normal),
                time: 0.0,
            },
            Model::Dielectric => Ray {
                origin: offset_origin(surface.point, -n, surface.size),
                direction: refracted(ray.direction, surface.normal, ratio),
                time: 0.0,
            },
            _ => {
                let map_record = &scene.records.uv_projections[map as usize];
                let seen = map_input(map_record, &ray, &surface, &Footprint::default());
                let image = &scene.records.textures[material.texture_index as usize];
                let (c, face) = in_texture(image, &texture_coordinate(map_record, &seen));
                way.push(face);
                return Some((way, map, c.at));
            }
        };
    }
    None
}

/// log2 of the longer axis of the pixel's footprint, in texels of the last hit's texture.
fn exact_level(scene: &PackedScene, at: DVec2) -> Option<f64> {
    const STEP: f64 = 1e-4;
    let here = end_of_ray(scene, at)?;
    let image = &scene.records.textures[0];
    let size = DVec3::new(image.size.x.into(), image.size.y.into(), image.size.z.into());
    let mut changes = [DVec3::ZERO; 2];
    for (change, axis) in changes.iter_mut().zip([DVec2::X, DVec2::Y]) {
        let [a, b] = [axis, -axis].map(|d| end_of_ray(scene, at + STEP * d));
        let (a, b) = (a?, b?);
        if a.0 != here.0 || b.0 != here.0 {
            return None;
        }
        let mut d = a.2 - b.2;
        let kind = scene.records.uv_projections[here.1 as usize].kind;
        if matches!(kind, MapKind::Cylindrical | MapKind::Spherical) {
            d -= d.round();
        }
        *change = d / (2.0 * STEP);
        // Faces of a box, the pole itself, and footprints wider than the texture.
        if change.abs().max_element() > 0.4 {
            return None;
        }
        *change *= size;
    }
    let [x, y] = changes;
    let (xx, yy, xy) = (x.dot(x), y.dot(y), x.dot(y));
    let squared = 0.5 * (xx + yy) + (0.25 * (xx - yy).powi(2) + xy * xy).sqrt();
    Some((0.5 * squared.log2()).clamp(0.0, f64::from(image.levels - 1)))
}

/// (level read by the oracle's ray, exact one) of pixels all over the picture.
fn levels(scene: &PackedScene) -> Vec<(f64, f64, DVec2)> {
    let [width, height] = scene.header.image_size.to_array();
    let mut all = Vec::new();
    for pixel in (0..width * height).step_by(3).map(|i| [i % width, i / width]) {
        let at = DVec2::new(f64::from(pixel[0]) + 0.5, f64::from(pixel[1]) + 0.5);
        let Some(exact) = exact_level(scene, at) else { continue };
        let ray = camera_ray(&scene.header, pixel, DVec2::splat(0.5));
        // Without points every random choice has its middle value: glass with a reflectance below one half refracts.
        let mut path = camera_path(ray, camera_differential(&scene.header, &ray), [0; 2]);
        let mut read = DVec3::ZERO;
        while path.is_alive {
            read += advance(scene, &mut path);
        }
        all.push((read.x, exact, at));
    }
    all
}

/// Where a cone, which is round, stays within half a level of the footprint's major axis.
#[derive(Clone, Copy, PartialEq)]
enum Cone {
    Everywhere,
    /// In half of the pixels: curved surfaces stretch it towards their silhouettes.
    Mostly,
}

/// Differentials are exact up to the rounding of packed values.
fn check(what: &str, text: &str, cone: Cone) {
    for (footprint, allowed) in [("differentials", 0.01), ("cone", 0.5)] {
        let scene = level_scene(text, footprint);
        let mut all = levels(&scene);
        assert!(all.len() > 60, "{what}: only {} pixels count", all.len());
        let wide = all.iter().filter(|l| l.1 > 0.0).count();
        assert!(
            wide * 4 > all.len(),
            "{what}: only {wide} of {} footprints are wider than a texel",
            all.len()
        );
        all.sort_by(|a, b| (a.0 - a.1).abs().total_cmp(&(b.0 - b.1).abs()));
        let most = footprint == "cone" && cone == Cone::Mostly;
        let (read, exact, at) = all[if most { all.len() / 2 } else { all.len() - 1 }];
        assert!((read - exact).abs() <= allowed, "{what}, {footprint}: level {read} for {exact} at {at}");
    }
}

const KINDS: [&str; 6] = ["planar", "cylindrical", "spherical", "cube", "box", "solid"];
const SPHERE: &str = "[[sphere]]\ncenter = [0.2, -0.1, 0.3]\nradius = 1.4\nmaterial = 'm'\n";
const PLANE: &str = "[[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0.8]\nbitangent = [0, 1, -0.5]\nhalf_extent = 2\nmaterial = 'm'\n";

#[test]
fn every_mapping_of_every_entity_on_a_sphere_with_pole_and_seam_in_sight() {
    for kind in KINDS {
        for entity in ["position", "normal", "centroid", "reflection"] {
            let place = place_of(kind, entity);
            check(&format!("{kind} {entity}"), &format!("{place}{SPHERE}"), Cone::Everywhere);
        }
    }
    check("surface", &format!("{}{SPHERE}", place_of("surface", "")), Cone::Everywhere);
}

#[test]
fn every_mapping_of_the_entities_that_vary_over_a_plane() {
    for kind in KINDS {
        for entity in ["position", "centroid"] {
            check(
                &format!("{kind} {entity}"),
                &format!("{}{PLANE}", place_of(kind, entity)),
                Cone::Everywhere,
            );
        }
    }
    check("surface", &format!("{}{PLANE}", place_of("surface", "")), Cone::Everywhere);
}

/// The shapes that a camera ray may meet before the texture.
const BEHIND: &str =
    "[[plane]]\norigin = [0, 0, -3]\ntangent = [4, 0, 0.8]\nbitangent = [0, 4, 0]\nmaterial = 'm'\n";
const FLOOR: &str =
    "[[plane]]\norigin = [0, -3, 0]\ntangent = [4, 0, 0]\nbitangent = [0, 0, 4]\nmaterial = 'm'\n";

fn with(model: &str, shape: &str, seen: &str) -> String {
    let place = place_of("surface", "");
    format!("{place}[[material]]\nname = 'n'\nmodel = '{model}'\n{shape}\nmaterial = 'n'\n{seen}")
}

#[test]
fn through_mirrors_and_glass() {
    let ball = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1.1";
    let pane = "[[plane]]\norigin = [0, 0, 1]\ntangent = [1, 0, 0.4]\nbitangent = [0, 1, 0.2]";
    let wall = "[[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0.1]\nbitangent = [0, 1, 0.8]";
    check("a mirror", &with("mirror", wall, FLOOR), Cone::Everywhere);
    check("a mirror ball", &with("mirror", ball, FLOOR), Cone::Mostly);
    check("a pane of glass", &with("dielectric", pane, BEHIND), Cone::Everywhere);
    check("a ball of glass", &with("dielectric", ball, BEHIND), Cone::Mostly);
}

#[test]
fn environments_directly_and_in_a_mirror_ball() {
    let ball = "[[material]]\nname = 'n'\nmodel = 'mirror'\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1.1\nmaterial = 'n'\n";
    for kind in ["planar", "cube"] {
        let background = "[background]\nenvironment = 't'\nsampler = 's'\nrotate = 37\n";
        let place = place_of(kind, "position");
        check(&format!("{kind} environment"), &format!("{place}{background}"), Cone::Everywhere);
        check(&format!("{kind} environment in a ball"), &format!("{place}{background}{ball}"), Cone::Mostly);
    }
}

/// Everything on the device: the picture of levels equals the oracle's.
#[test]
fn the_device_reads_the_levels_of_the_oracle() {
    let ball = "[[sphere]]\ncenter = [-0.6, 0, 0]\nradius = 0.7";
    let more = "[[sphere]]\ncenter = [0.9, 0.2, 0.3]\nradius = 0.6\nmaterial = 'm'\n";
    for footprint in ["differentials", "cone"] {
        for text in [
            with("mirror", ball, &format!("{FLOOR}{more}")),
            format!("{}{SPHERE}", place_of("spherical", "reflection")),
            format!("{}{SPHERE}", place_of("box", "normal")),
        ] {
            let scene = level_scene(&text, footprint);
            let (device, oracle) = (stage::render(&scene), stage::render_on_oracle(&scene));
            let mut off: Vec<f32> =
                device.pixels.iter().zip(&oracle.pixels).map(|(a, b)| (a[0] - b[0]).abs()).collect();
            off.sort_by(f32::total_cmp);
            // Silhouettes and the pole move by rounding; elsewhere a level is log2 of a few roundings.
            let most = off[off.len() * 98 / 100];
            assert!(most < 2e-3, "{footprint}: levels off by {most} in one of 50 pixels, {text}");
        }
    }
}
