//! Bump and normal maps do not depend on the scene's unit: camera, shapes and heights together, 128
//! times smaller or larger, give the same picture, for every map. Powers of two preserve all
//! digits, so that any difference is due to a length constant in the program.

use std::path::Path;

use glam::{DVec2, DVec3};
use moire::internal::lab::metrics::compare;
use moire::internal::oracle::appearance::{map_input, uv_gradients};
use moire::internal::oracle::camera::Ray;
use moire::internal::oracle::footprint::Footprint;
use moire::internal::oracle::geometry::rays::hit_surface;
use moire::internal::oracle::geometry::rays::nearest_hit;
use moire::internal::oracle::mapping::texture_coordinate;
use moire::internal::oracle::math::any_tangent;
use moire::internal::pack::{self, PackedScene};
use moire::internal::scene::parse;

use super::floats;
use crate::lookup::bench::{Rng, Vectors};
use crate::stage;

const MAPPINGS: [&str; 12] = [
    "kind = 'surface', scale = [3, 2]",
    "kind = 'planar', space = 'bounds'",
    "kind = 'cylindrical', space = 'bounds', scale = [3, 1]",
    "kind = 'spherical', space = 'bounds', axis = [0, 1, 1]",
    "kind = 'cube', space = 'bounds'",
    "kind = 'spherical', entity = 'centroid', scale = [2, 3]",
    "kind = 'planar', entity = 'normal'",
    "kind = 'cylindrical', entity = 'normal', axis = [0, 0, 1]",
    "kind = 'spherical', entity = 'normal', axis = [0, 1, 1]",
    "kind = 'cube', entity = 'normal'",
    "kind = 'planar', entity = 'reflection'",
    "kind = 'spherical', entity = 'reflection'",
];

const RELIEFS: [&str; 2] = ["normal_map", "bump_map"];

/// Returns materials of all mappings with all reliefs, in a unit of `k`; that of this pair is named `m`. All scenes of
/// a footprint have all of them, and so share a pipeline.
fn materials(k: f64, mapping: &str, relief: &str) -> String {
    let material = |(i, (m, r)): (usize, (&str, &str))| {
        let name = if (m, r) == (mapping, relief) { "m".into() } else { format!("unseen{i}") };
        let strength = if r == "bump_map" { 0.06 * k } else { 1.5 };
        format!(
            "[[material]]\nname = '{name}'\n{r} = 't'\nstrength = {strength:?}\nsampler = 's'\nmapping = {{ {m} }}\n"
        )
    };
    let all = MAPPINGS.iter().flat_map(|m| RELIEFS.map(|r| (*m, r)));
    all.enumerate().map(material).collect()
}

/// A ball whose poles are visible, one from within, a smooth and a flat triangle and a square, in a unit of `k`.
fn shapes(k: f64, mapping: &str, relief: &str, footprint: &str) -> PackedScene {
    let at = |v: [f64; 3]| format!("{:?}", v.map(|x| x * k));
    let surface = mapping.contains("surface");
    // The plane's coordinates count its axes, which scale with it.
    let text = format!(
        "camera = {{ eye = {}, look_at = {}, vertical_fov = 50 }}\n\
         image = {{ width = 56, height = 40 }}\nsampling = {{ pattern = 'center', footprint = '{footprint}' }}\n\
         [[texture]]\nname = 't'\nfile = 't'\n[[sampler]]\nname = 's'\nmip = 'linear'\n\
         {}\
         [[sphere]]\ncenter = {}\nradius = {:?}\nmaterial = 'm'\n\
         [[sphere]]\ncenter = {}\nradius = {:?}\nmaterial = 'm'\n\
         [[triangle]]\nvertices = [{}, {}, {}]\nnormals = [[-0.4, 0, 1], [0.4, 0, 1], [0, 0.5, 1]]\nmaterial = 'm'\n\
         [[plane]]\norigin = {}\ntangent = {}\nbitangent = {}\nhalf_extent = 1\nmaterial = 'm'\n\
         [[light]]\nkind = 'directional'\ndirection = [0.4, 0.8, 1]\nirradiance = [3, 3, 3]\n",
        at([0.1, 1.4, 3.0]),
        at([0.0, 0.3, 0.0]),
        materials(k, mapping, relief),
        at([-0.9, 0.4, 0.0]),
        0.6 * k,
        at([0.0, 0.0, 0.0]),
        20.0 * k,
        at([0.1, 0.0, 0.2]),
        at([1.5, 0.0, 0.2]),
        at([0.8, 1.3, 0.0]),
        at([0.0, -0.4, 0.0]),
        at([1.4, 0.0, 0.0]),
        at([0.0, 0.0, if surface { -1.1 } else { -1.4 }]),
    );
    let wave = |x: u32, y: u32| {
        let [a, b] = [x, y].map(|i| (std::f32::consts::TAU * i as f32 / 16.0).sin());
        [0.5 + 0.25 * a, 0.5 + 0.25 * b, 0.85, 1.0]
    };
    // Nothing is pruned.
    pack::pack(&parse(Path::new("scales.toml"), &text).unwrap(), vec![floats(16, 16, wave)], None).unwrap()
}

#[test]
fn pictures_do_not_depend_on_the_unit() {
    for mapping in MAPPINGS {
        for relief in RELIEFS {
            for footprint in ["none", "differentials"] {
                let what = format!("{mapping}, {relief}, footprint {footprint}");
                let pictures = |k: f64| {
                    let scene = shapes(k, mapping, relief, footprint);
                    [stage::render(&scene), stage::render_on_oracle(&scene)]
                };
                let [device, oracle] = pictures(1.0);
                let apart = compare(&device, &oracle).unwrap();
                // Errors of f32: where a pole is within a pixel, and at edges.
                assert!(apart.over_1_255 < 0.01, "{what}: device and oracle differ in {}", apart.over_1_255);
                for k in [1.0 / 128.0, 128.0] {
                    let scaled = pictures(k);
                    for (film, right, who) in
                        [(&scaled[0], &device, "device"), (&scaled[1], &oracle, "oracle")]
                    {
                        let rmse = compare(film, right).unwrap().rmse;
                        // Digits that do not scale: squares of lengths that leave the range of f32, none here.
                        assert!(rmse < 1e-6, "{what}: {who} differs by {rmse:e} at {k}");
                    }
                }
            }
        }
    }
}

/// Central differences of the coordinates along two tangents, on small and large shapes and up to the poles.
#[test]
fn gradients_are_those_of_the_coordinates() {
    let mut rng = Rng::new(31);
    for mapping in MAPPINGS.iter().filter(|m| !m.contains("reflection")) {
        for k in [1e-3, 1.0, 1e3] {
            let scene = shapes(k, mapping, "normal_map", "none");
            let mut tried = 0;
            while tried < 60 {
                let near_pole = DVec3::new(rng.between(-1e-3, 1e-3), 1.0, rng.between(-1e-3, 1e-3));
                let out = if tried % 4 == 0 { near_pole.normalize() } else { rng.direction() };
                // Towards the first ball's middle.
                let center = scene.records.spheres[0].center;
                let ray = Ray { origin: center + 0.9 * k * out, direction: -out, time: 0.0 };
                let meet = |ray: &Ray| hit_surface(&scene, ray, &nearest_hit(&scene, ray, u32::MAX));
                let surface = meet(&ray);
                let map = &scene.records.uv_projections[surface.map as usize];
                let coordinate = |ray: &Ray| {
                    texture_coordinate(map, &map_input(map, ray, &meet(ray), &Footprint::default())).at
                };
                let gradients = uv_gradients(map, &ray, &surface);
                tried += 1;
                let first = any_tangent(surface.geometric_normal);
                for along in [first, surface.geometric_normal.cross(first)] {
                    let step = 1e-7 * k;
                    let moved = |by: f64| Ray { origin: ray.origin + by * along, ..ray };
                    let difference = coordinate(&moved(step)) - coordinate(&moved(-step));
                    let found = DVec2::from_array(gradients.map(|g| g.dot(along)));
                    let right = difference.truncate() / (2.0 * step);
                    // A seam or an edge of a cube lies between the two.
                    if (right * step).abs().max_element() > 1e-3 {
                        continue;
                    }
                    let error = (found - right).length() / right.length().max(1.0 / k);
                    // Rounding of coordinates over the step, and its square over the way to the pole.
                    assert!(error < 1e-4, "{mapping}, unit {k}: {found}, by differences {right}, at {out}");
                }
            }
        }
    }
}
