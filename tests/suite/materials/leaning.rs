//! Shading normals that deviate from the geometric normal: reflected rays stay above the surface,
//! refracted ones go below, for smooth and rough surfaces, on device and oracle, by samples and
//! cones.

use glam::DVec3;
use moire::internal::core::film::Film;
use moire::internal::oracle::appearance::map_input;
use moire::internal::oracle::bsdf::dielectric::refracted;
use moire::internal::oracle::bsdf::mirror::mirrored;
use moire::internal::oracle::camera::Ray;
use moire::internal::oracle::footprint::Footprint;
use moire::internal::oracle::geometry::hit::Surface;
use moire::internal::oracle::shading_normal::{consistent_normal, on_its_side};
use moire::internal::pack::{EntityKind, MapKind, PackedScene};
use moire::internal::schema::layout::UvProjection;

use super::{floats, scene};
use crate::lookup::bench::{Rng, Vectors};
use crate::stage;

fn surface(geometric_normal: DVec3, normal: DVec3) -> Surface {
    Surface { geometric_normal, normal, ..Surface::default() }
}

fn both(scene: &PackedScene) -> [(Film, &'static str); 2] {
    [(stage::render(scene), "device"), (stage::render_on_oracle(scene), "oracle")]
}

#[test]
fn mirrored_rays_stay_above_and_refracted_ones_go_below() {
    let mut rng = Rng::new(41);
    let (mut turned, mut kept) = (0, 0);
    for _ in 0..20_000 {
        let g = rng.direction();
        let n = (g + 2.0 * rng.direction()).normalize();
        let direction = rng.direction() * rng.between(0.1, 10.0);
        let direction = if direction.dot(g) > 0.0 { -direction } else { direction };
        let mut settled = surface(g, n);
        consistent_normal(direction, &mut settled);
        let view = -direction.normalize();
        let way = mirrored(direction, settled.normal);
        let least = f64::min(0.9 * view.dot(g), 0.01);
        let rise = way.normalize().dot(g);
        assert!(rise >= least - 1e-12, "{rise} above {g}, {least} wanted");
        assert!(settled.normal.dot(view) > 0.0 && (settled.normal.length() - 1.0).abs() < 1e-12);
        // No more than needed: directions above the surface are unchanged.
        let own = mirrored(direction, n).normalize().dot(g);
        if own >= least {
            assert!(settled.normal == n || settled.normal == -n, "{own} was above already");
            kept += 1;
        } else {
            assert!((rise - least).abs() < 1e-9, "{rise}, just {least} wanted");
            turned += 1;
        }
        for ratio in [1.0 / 1.5, 1.0, 1.5] {
            let way = refracted(direction, settled.normal, ratio);
            if way == direction {
                continue; // everything is reflected
            }
            let below = on_its_side(direction, way, -settled.normal, -g);
            assert!(below.dot(g) < 0.0, "{below} is above {g}");
            assert!((below.length() / direction.length() - 1.0).abs() < 1e-9);
        }
    }
    assert!(turned > 2000 && kept > 2000, "{turned} turned, {kept} kept");
}

#[test]
fn rays_of_a_surface_that_does_not_lean_keep_every_bit() {
    let mut rng = Rng::new(42);
    for _ in 0..20_000 {
        let n = rng.direction();
        let direction = rng.direction();
        let direction = if direction.dot(n) > 0.0 { -direction } else { direction };
        let mut settled = surface(n, n);
        consistent_normal(direction, &mut settled);
        assert_eq!(settled.normal, n);
        let way = mirrored(direction, n);
        assert_eq!(on_its_side(direction, way, n, n), way);
        for ratio in [1.0 / 1.5, 1.5] {
            let way = refracted(direction, n, ratio);
            if way != direction {
                assert_eq!(on_its_side(direction, way, -n, -n), way);
            }
        }
    }
}

/// From straight above, a triangle at z = 0 before a red plane at z = -1 and a green background.
fn over_red(view: &str, normals: &str, material: &str) -> String {
    format!(
        "camera = {{ {view} }}\nimage = {{ width = 24, height = 24 }}\nbackground = {{ color = [0, 1, 0] }}\n\
         [[material]]\nname = 'm'\n{material}\n\
         [[triangle]]\nvertices = [[-3, -3, 0], [9, -3, 0], [-3, 9, 0]]\n{normals}\nmaterial = 'm'\n\
         [[material]]\nname = 'red'\nmodel = 'unlit'\ncolor = [1, 0, 0]\n\
         [[plane]]\norigin = [0, 0, -1]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'red'\n"
    )
}

const LEANING: &str = "normals = [[0.8, 0, 0.6], [-0.9, 0.1, 0.3], [0.1, -0.9, 0.2]]";
const VIEWS: [&str; 3] = [
    "eye = [0, 0, 3], look_at = [0, 0, 0], up = [0, 1, 0], orthographic_height = 5",
    "eye = [3, 1, 1.5], look_at = [0, 0, 0], vertical_fov = 40",
    "eye = [6, -2, 0.4], look_at = [0, 0, 0], vertical_fov = 20",
];

fn tilted() -> moire::internal::texture::data::TextureData {
    floats(4, 4, |x, y| [if x % 2 == 0 { 0.05 } else { 0.95 }, if y % 2 == 0 { 0.1 } else { 0.9 }, 0.6, 1.0])
}

/// The same mirror with interpolated normals and with a normal map.
fn leaning(view: &str, material: &str) -> [PackedScene; 2] {
    let mapped = format!(
        "normal_map = 't'\nsampler = 's'\nmapping = {{ kind = 'planar', scale = [0.7, 0.7] }}\n{material}\n\
         [[texture]]\nname = 't'\nfile = 't'\n[[sampler]]\nname = 's'\nfilter = 'nearest'"
    );
    [
        scene(&over_red(view, LEANING, material), Vec::new()),
        scene(&over_red(view, "", &mapped), vec![tilted()]),
    ]
}

#[test]
fn a_mirror_never_shows_what_lies_behind_it() {
    for view in VIEWS {
        for footprint in ["none", "cone", "differentials"] {
            let material =
                format!("model = 'mirror'\n[sampling]\npattern = 'center'\nfootprint = '{footprint}'");
            for scene in leaning(view, &material) {
                for (film, who) in both(&scene) {
                    // Beside the triangle the red plane is seen.
                    let direct = if view.contains("eye = [0") { 0 } else { film.pixels.len() };
                    let red = film.pixels.iter().filter(|p| p[0] > 0.0).count();
                    assert!(red <= direct, "{who}, {footprint}: {red} pixels see through the mirror, {view}");
                }
            }
        }
    }
}

/// Rough mirrors lose some light to their facets; none of it comes from below.
#[test]
fn a_rough_mirror_never_shows_what_lies_behind_it() {
    for roughness in [0.1, 0.4, 0.8] {
        let material = format!(
            "model = 'mirror'\nroughness = {roughness}\n[sampling]\npattern = 'sobol-owen'\nspp = 64"
        );
        for scene in leaning(VIEWS[0], &material) {
            for (film, who) in both(&scene) {
                assert!(
                    film.pixels.iter().all(|p| p[0] == 0.0),
                    "{who}, roughness {roughness}: red from below"
                );
                let mean =
                    film.pixels.iter().map(|p| f64::from(p[1])).sum::<f64>() / film.pixels.len() as f64;
                assert!(mean > 0.4, "{who}, roughness {roughness}: {mean} of the light is left");
            }
        }
    }
}

/// Every sample sees one of the two sides, and the single middle sample the likelier one: below.
#[test]
fn glass_lets_through_what_lies_behind_it_and_mirrors_what_lies_before_it() {
    for scene in
        leaning(VIEWS[0], "model = 'dielectric'\nior = 1.5\n[sampling]\npattern = 'sobol-owen'\nspp = 64")
    {
        for (film, who) in both(&scene) {
            let off = film.pixels.iter().map(|p| (p[0] + p[1] - 1.0).abs()).fold(0.0, f32::max);
            assert!(off < 1e-6, "{who}: {off} of the light is lost or made");
        }
    }
    for scene in leaning(VIEWS[0], "model = 'dielectric'\nior = 1.05\n[sampling]\npattern = 'center'") {
        for (film, who) in both(&scene) {
            let through = film.pixels.iter().filter(|p| p[0] == 1.0).count();
            // Grazing facets of the normal map reflect more than half.
            assert!(through * 10 > film.pixels.len() * 6, "{who}: {through} pixels see through the glass");
        }
    }
}

/// From within glass of index 1.5, below the triangle: refracted rays leave upwards.
#[test]
fn rays_that_leave_glass_go_above_its_surface() {
    let mut rng = Rng::new(43);
    let mut lowered = 0;
    for _ in 0..20_000 {
        let g = DVec3::Z;
        let n = (g + 0.8 * rng.direction()).normalize();
        let direction = rng.direction();
        let direction = if direction.z > 0.0 { -direction } else { direction };
        let mut settled = surface(g, n);
        consistent_normal(direction, &mut settled);
        let way = refracted(direction, settled.normal, 1.5);
        if way != direction && way.z > 0.0 {
            lowered += 1;
            let below = on_its_side(direction, way, -settled.normal, -g);
            assert!(below.z < 0.0 && below.z > -0.0101, "{below}, just below wanted");
        }
    }
    assert!(lowered > 100, "{lowered} rays needed it");
}

#[test]
fn cones_mirror_by_the_same_normal() {
    let material = "model = 'mirror'\n[sampling]\nalgorithm = 'cone'";
    for scene in leaning(VIEWS[0], material) {
        for (film, who) in both(&scene) {
            let red = film.pixels.iter().map(|p| p[0]).fold(0.0, f32::max);
            assert!(red < 0.05, "{who}: {red} of red behind the mirror");
        }
    }
}

/// `entity = "reflection"` is the direction of a mirror's ray.
#[test]
fn a_map_of_the_reflection_looks_where_a_mirror_does() {
    let map =
        UvProjection { kind: MapKind::Solid, entity: EntityKind::Reflection, ..UvProjection::default() };
    let mut rng = Rng::new(44);
    for _ in 0..2000 {
        let g = rng.direction();
        let leaning = surface(g, (g + 1.5 * rng.direction()).normalize());
        let direction = rng.direction();
        let direction = if direction.dot(g) > 0.0 { -direction } else { direction };
        let ray = Ray { origin: DVec3::ZERO, direction, time: 0.0 };
        let mut settled = leaning;
        consistent_normal(direction, &mut settled);
        let seen = map_input(&map, &ray, &leaning, &Footprint::default());
        assert!((seen.entity - mirrored(direction, settled.normal)).length() < 1e-12); // a few roundings
        assert!(seen.entity.dot(g) > 0.0);
    }
}
