//! No seam where the world has none: across the edges and corners of cubes, and across the poles and the date line of
//! equirectangular environments.

use std::path::Path;

use glam::{DVec2, DVec3};
use moire::internal::lab::probe::LookupQuery;
use moire::internal::oracle::mapping::{face_uv, on_cube_face};
use moire::internal::oracle::texture::{fetch_texel, level_at};
use moire::internal::pack::{self, PackedScene};
use moire::internal::scene::model::Footprint;
use moire::internal::scene::parse;
use moire::internal::texture::data::{Dimension, TexelFormat};
use moire::internal::texture::sampler_spec::{Filter, SamplerSpec};

use super::bench::{answers, coordinate, expected, narrow, pairs_of, solid};
use crate::lookup::bench::{Rng, Vectors, query};

const SIZE: u32 = 8;

fn cube(filter: Filter) -> PackedScene {
    let spec = SamplerSpec { mag: filter, min: filter, ..Default::default() };
    let texture = solid(Dimension::Cube, [SIZE, SIZE, 6], TexelFormat::GreyFloat);
    pairs_of(Footprint::None, vec![texture], &[spec], &[(0, 0)])
}

/// Directions in pairs, `gap` apart, on both sides of an edge; every fourth pair at a corner.
fn pairs_of_directions(rng: &mut Rng, count: usize, gap: f64) -> Vec<DVec3> {
    let mut all = Vec::new();
    for i in 0..count {
        let sign = |rng: &mut Rng| if rng.unit() < 0.5 { -1.0 } else { 1.0 };
        // Two or three equal components: an edge or a corner.
        let third = if i % 4 == 0 { sign(rng) } else { rng.between(-1.0, 1.0) };
        let mut on = [sign(rng), sign(rng), third];
        on.rotate_left(i % 3);
        let on = DVec3::from_array(on);
        let across = rng.direction() * (0.5 * gap);
        all.extend([on + across, on - across]);
    }
    all
}

fn read(scene: &PackedScene, directions: &[DVec3]) -> (Vec<LookupQuery>, Vec<f64>) {
    let one = query(scene, 0, [0.0; 2]);
    let queries: Vec<LookupQuery> =
        directions.iter().map(|&d| LookupQuery { uv: narrow(d), ..one }).collect();
    let read = answers(scene, &queries).iter().map(|a| a[0].into()).collect();
    (queries, read)
}

#[test]
fn linear_is_continuous_across_all_edges_and_corners_of_a_cube() {
    let scene = cube(Filter::Linear);
    let gap = 1e-4;
    let directions = pairs_of_directions(&mut Rng::new(51), 4000, gap);
    let (_, values) = read(&scene, &directions);
    let mut faces = std::collections::BTreeSet::new();
    // A texel is 2 / SIZE wide at distance 1; on each of two axes the value changes by at most the
    // range, 8, a texel; and 1e-5 for rounding.
    let allowed = 8.0 * 2.0 * gap * f64::from(SIZE) / 2.0 + 1e-5;
    for (d, v) in directions.chunks(2).zip(values.chunks(2)) {
        let [a, b] = [d[0], d[1]].map(|d| on_cube_face(d).1);
        faces.insert((a.min(b), a.max(b)));
        assert!((v[0] - v[1]).abs() <= allowed, "{} and {} at {} and {}", v[0], v[1], d[0], d[1]);
    }
    let edges = faces.iter().filter(|(a, b)| a != b).count();
    assert_eq!(edges, 12, "edges that were crossed");
}

#[test]
fn nearest_reads_the_texel_that_a_direction_meets_on_its_face() {
    let scene = cube(Filter::Nearest);
    let mut rng = Rng::new(52);
    let mut directions = pairs_of_directions(&mut rng, 1000, 1e-3);
    directions.extend((0..2000).map(|_| rng.direction()));
    let (_, values) = read(&scene, &directions);
    let level = level_at(&scene, &scene.records.textures[0], 0);
    for (d, value) in directions.iter().zip(values) {
        let (stm, face) = on_cube_face(*d);
        let texel = face_uv(stm) * f64::from(SIZE);
        // f32 cannot distinguish the sides of a border between texels or faces.
        let sure = |x: f64| (x - x.round()).abs() > 1e-5;
        if sure(texel.x) && sure(texel.y) {
            let at = [texel.x as i64, texel.y as i64, i64::from(face)];
            assert_eq!(value, fetch_texel(&scene, &scene.records.textures[0], &level, at).x, "at {d}");
        }
    }
}

#[test]
fn a_corner_of_a_cube_is_the_mean_of_its_three_texels() {
    let scene = cube(Filter::Linear);
    let corners: Vec<DVec3> = (0..8)
        .map(|k| DVec3::from_array([0, 1, 2].map(|i| if k >> i & 1 == 0 { -1.0 } else { 1.0 })))
        .collect();
    let (_, values) = read(&scene, &corners);
    let nearest = cube(Filter::Nearest);
    for (corner, value) in corners.iter().zip(values) {
        // Just inside each of the three faces.
        let inside = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| *corner * (DVec3::ONE + 1e-3 * axis));
        let (_, three) = read(&nearest, &inside);
        let mean = three.iter().sum::<f64>() / 3.0;
        assert!((value - mean).abs() < 1e-5, "{value} at {corner}, the three {three:?}"); // a few roundings of 8
    }
}

/// Rows continue across the poles half a turn away: the path across a pole is smooth, with every filter that is.
#[test]
fn environments_are_smooth_over_their_poles_and_around() {
    let (width, height) = (16, 8);
    for filter in ["linear", "cubic"] {
        let text = format!(
            "camera = {{ eye = [0, 0, 1], look_at = [0, 0, 0], vertical_fov = 60 }}\nimage = {{ width = 1, height = 1 }}\n\
             [sampling]\nfootprint = 'cone'\n[background]\nenvironment = 'e'\nsampler = 's'\n\
             [[texture]]\nname = 'e'\nfile = 'e'\n[[sampler]]\nname = 's'\nmip = 'linear'\nfilter = '{filter}'\n"
        );
        let scene = parse(Path::new("environment.toml"), &text).unwrap();
        let texture = solid(Dimension::Two, [width, height, 1], TexelFormat::GreyFloat);
        let scene = pack::pack(&scene, vec![texture], None).unwrap();
        let mut rng = Rng::new(53);
        let gap = 1e-4;
        let one = query(&scene, scene.header.environment_material as usize, [0.0; 2]);
        let mut queries = Vec::new();
        for i in 0..600 {
            let (u, v) = (rng.unit(), rng.unit());
            let [a, b] = match i % 4 {
                0 => [DVec2::new(u, gap), DVec2::new(u + 0.5, gap)],
                1 => [DVec2::new(u, 1.0 - gap), DVec2::new(u - 0.5, 1.0 - gap)],
                2 => [DVec2::new(gap, v), DVec2::new(1.0 - gap, v)],
                _ => [DVec2::new(u, v), DVec2::new(u, v + 0.1 * gap)],
            };
            let wide = [0.02, 0.2][i / 4 % 2];
            let (dx, dy) = ([wide, 0.0, 0.0, 0.0], [0.0, wide, 0.0, 0.0]);
            queries.extend([a, b].map(|uv| LookupQuery { uv: narrow(uv.extend(0.0)), dx, dy, ..one }));
        }
        let read = answers(&scene, &queries);
        for (i, (query, value)) in queries.iter().zip(&read).enumerate() {
            let right = expected(&scene, query, i, &coordinate(query))[0];
            // 16 texels · 2⁻²² of the range of 8, times 1.9 for the slope of Catmull-Rom.
            let off = (right - f64::from(value[0])).abs();
            assert!(off < 1e-4, "{filter}: {value:?}, oracle {right} at {query:?}");
        }
        // The range, 8, times the slope of Catmull-Rom, 1.9, a texel.
        let allowed = 8.0 * 1.9 * 2.0 * gap as f32 * width as f32;
        for (query, v) in queries.chunks(2).zip(read.chunks(2)) {
            let apart = (v[0][0] - v[1][0]).abs();
            assert!(apart <= allowed, "{filter}: {v:?} at {:?} and {:?}", query[0].uv, query[1].uv);
        }
    }
}
