//! The lecture's formulas at points worked out by hand, through the oracle and through the device.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use glam::{DVec2, DVec3};
use moire::internal::core::film::Film;
use moire::internal::core::progress::NoProgress;
use moire::internal::lab::probe::{self, RayQuery};
use moire::internal::oracle::bsdf::mirror::mirrored;
use moire::internal::oracle::camera::camera_ray;
use moire::internal::oracle::mapping::{MapInput, texture_coordinate};
use moire::internal::oracle::math::atan_unit_f32;
use moire::internal::pack::PackedScene;
use moire::internal::render::{self, Tuning};
use moire::internal::schema::layout::NO_SHAPE;
use moire::internal::texture::data::{ColorSpace, TexelFormat};

use crate::lookup::bench::texture;
use crate::stage::device;

mod texels;

const HEAD: &str = "image = { width = 1, height = 1 }
[camera]
eye = [0.0, 0.0, 0.0]
look_at = [0.0, 0.0, -1.0]
vertical_fov = 90.0
[[texture]]
name = \"t\"
file = \"t.png\"
[[sampler]]
name = \"s\"
address = \"clamp-to-edge\"
";

fn packed(text: &str) -> PackedScene {
    let scene = moire::internal::scene::parse(std::path::Path::new("lecture.toml"), text).unwrap();
    let white = |_| texture(1, 1, TexelFormat::Grey8, ColorSpace::Linear, 1);
    let textures = scene.textures.iter().map(white).collect();
    moire::internal::pack::pack(&scene, textures, None).unwrap()
}

/// Returns (point, its texture coordinate) by mapping 0 of the oracle; and on the device for a ray along `way` that
/// meets the scene at that point.
fn assert_mapped(scene: &PackedScene, way: impl Fn(DVec3) -> DVec3, cases: &[(DVec3, DVec2)]) {
    let query = |&(point, _): &(DVec3, DVec2)| {
        let way = way(point);
        RayQuery {
            origin: (point - way).as_vec3().extend(0.0).to_array(),
            direction: way.as_vec3().extend(1.0).to_array(),
        }
    };
    let queries: Vec<RayQuery> = cases.iter().map(query).collect();
    for keep_everything in [false, true] {
        let answers = probe::rays(&device(), scene, keep_everything, &queries).unwrap();
        for (&(point, uv), answer) in cases.iter().zip(&answers) {
            let own =
                scene.records.planes.first().map_or(DVec2::ZERO, |plane| {
                    DVec2::new(plane.axis_u.dot(point), plane.axis_v.dot(point))
                });
            let oracle = texture_coordinate(
                &scene.records.uv_projections[0],
                &MapInput { entity: point, own, ..Default::default() },
            );
            let oracle = oracle.at.truncate();
            assert!(oracle.distance(uv) < 1e-6, "oracle: {point} maps to {oracle}, by hand {uv}"); // packed rows are f32
            assert_ne!(answer.shape, NO_SHAPE, "{point} is not met");
            let got = DVec2::new(answer.uv[0].into(), answer.uv[1].into());
            assert!(got.distance(uv) < 4e-6, "device: {point} maps to {got}, by hand {uv}"); // 32 ulp of 1: t, point, angle
        }
    }
}

/// tangent (−1, 0, 0), bitangent (0, 0, 1): u = −x/5, v = z/5 by the scale of 0.2.
#[test]
fn the_ground_plane_maps_by_its_orthonormal_basis() {
    let scene = packed(&format!(
        "{HEAD}[[material]]\nname = \"m\"\ntexture = \"t\"\nsampler = \"s\"\nmapping = {{ kind = \"surface\", scale = [0.2, 0.2] }}
[[plane]]\norigin = [0.0, 0.0, 0.0]\ntangent = [-1.0, 0.0, 0.0]\nbitangent = [0.0, 0.0, 1.0]\nmaterial = \"m\"\n"
    ));
    // tangent × bitangent = (−1,0,0) × (0,0,1) = (0·1 − 0·0, 0·0 − (−1)·1, 0) = (0, 1, 0).
    assert_eq!(scene.records.planes[0].normal, DVec3::Y);
    assert_mapped(
        &scene,
        |_| DVec3::NEG_Y,
        &[
            (DVec3::new(0.0, 0.0, 0.0), DVec2::new(0.0, 0.0)),
            (DVec3::new(1.0, 0.0, 0.0), DVec2::new(-0.2, 0.0)),
            (DVec3::new(-5.0, 0.0, 5.0), DVec2::new(1.0, 1.0)),
            (DVec3::new(2.0, 0.0, -3.0), DVec2::new(-0.4, -0.6)),
            (DVec3::new(-0.25, 0.0, 1.75), DVec2::new(0.05, 0.35)),
        ],
    );
}

/// u' = R(90°)·(s∘uv) + o: scaled by (2, 3), (u, v) = (1, 1) is (2, 3); turned a quarter it is
/// (−3, 2); moved by (0.5, 0.25) it is (−2.5, 2.25). Any other order gives another point.
#[test]
fn scale_then_rotation_then_offset() {
    let scene = packed(&format!(
        "{HEAD}[[material]]\nname = \"m\"\ntexture = \"t\"\nsampler = \"s\"
mapping = {{ kind = \"surface\", scale = [2.0, 3.0], rotate = 90.0, offset = [0.5, 0.25] }}
[[plane]]\norigin = [0.0, 0.0, 0.0]\ntangent = [1.0, 0.0, 0.0]\nbitangent = [0.0, 1.0, 0.0]\nmaterial = \"m\"\n"
    ));
    assert_mapped(
        &scene,
        |_| DVec3::NEG_Z,
        &[
            (DVec3::new(0.0, 0.0, 0.0), DVec2::new(0.5, 0.25)),
            (DVec3::new(1.0, 0.0, 0.0), DVec2::new(0.5, 2.25)),
            (DVec3::new(0.0, 1.0, 0.0), DVec2::new(-2.5, 0.25)),
            (DVec3::new(1.0, 1.0, 0.0), DVec2::new(-2.5, 2.25)),
        ],
    );
}

fn unit_sphere(mapping: &str) -> PackedScene {
    packed(&format!(
        "{HEAD}[[material]]\nname = \"m\"\ntexture = \"t\"\nsampler = \"s\"\nmapping = {{ {mapping} }}
[[sphere]]\ncenter = [0.0, 0.0, 0.0]\nradius = 1.0\nmaterial = \"m\"\n"
    ))
}

const S: f64 = FRAC_1_SQRT_2;

/// u = θ/π from +y, v = φ/2π from +x towards +z.
#[test]
fn the_sphere_maps_by_its_angles() {
    // At 30° from the pole, θ/π = 1/6: y = cos 30° = √3/2, distance from the axis ½.
    let high = 0.75f64.sqrt();
    let cases = [
        (DVec3::X, DVec2::new(0.5, 0.0)),
        (DVec3::Z, DVec2::new(0.5, 0.25)),
        (DVec3::NEG_X, DVec2::new(0.5, 0.5)),
        (DVec3::NEG_Z, DVec2::new(0.5, 0.75)),
        (DVec3::Y, DVec2::new(0.0, 0.0)), // poles: φ of (0, 0) is 0
        (DVec3::NEG_Y, DVec2::new(1.0, 0.0)),
        (DVec3::new(S, 0.0, S), DVec2::new(0.5, 0.125)),
        (DVec3::new(S, S, 0.0), DVec2::new(0.25, 0.0)),
        (DVec3::new(0.0, -S, -S), DVec2::new(0.75, 0.75)),
        (DVec3::new(0.0, high, 0.5), DVec2::new(1.0 / 6.0, 0.25)),
    ];
    for kind in ["kind = \"surface\"", "kind = \"spherical\""] {
        assert_mapped(&unit_sphere(kind), |p| -p, &cases);
    }
}

/// u = φ/2π, v = height over the frame's origin: here y + 1.
#[test]
fn the_cylinder_maps_by_angle_and_height() {
    let cases = [
        (DVec3::X, DVec2::new(0.0, 1.0)),
        (DVec3::Z, DVec2::new(0.25, 1.0)),
        (DVec3::NEG_X, DVec2::new(0.5, 1.0)),
        (DVec3::NEG_Z, DVec2::new(0.75, 1.0)),
        (DVec3::Y, DVec2::new(0.0, 2.0)),
        (DVec3::NEG_Y, DVec2::new(0.0, 0.0)),
        (DVec3::new(S, S, 0.0), DVec2::new(0.0, 1.0 + S)),
        (DVec3::new(0.0, -S, S), DVec2::new(0.25, 1.0 - S)),
    ];
    assert_mapped(&unit_sphere("kind = \"cylindrical\", origin = [0.0, -1.0, 0.0]"), |p| -p, &cases);
}

/// The axis +x is reached from +y by a quarter turn about −z, which takes the frame's x to −y: a
/// point (x, y, z) has the frame coordinates (−y, x, z).
#[test]
fn the_planar_map_projects_on_the_frames_x_and_y() {
    let cases = [
        (DVec3::X, DVec2::new(0.0, 1.0)),
        (DVec3::Y, DVec2::new(-1.0, 0.0)),
        (DVec3::Z, DVec2::new(0.0, 0.0)),
        (DVec3::new(S, S, 0.0), DVec2::new(-S, S)),
    ];
    assert_mapped(&unit_sphere("kind = \"planar\", axis = [1.0, 0.0, 0.0]"), |p| -p, &cases);
    let upright = [(DVec3::X, DVec2::new(1.0, 0.0)), (DVec3::new(0.0, S, S), DVec2::new(0.0, S))];
    assert_mapped(&unit_sphere("kind = \"planar\""), |p| -p, &upright);
}

fn camera(projection: &str, width: u32, height: u32) -> PackedScene {
    packed(&format!(
        "image = {{ width = {width}, height = {height} }}\n[camera]\neye = [1.0, 2.0, 3.0]\nlook_at = [1.0, 2.0, 2.0]\n{projection}\n"
    ))
}

/// The eye looks along −z, so right is +x and up +y. `offset` is in units of 2⁻²⁴ pixels.
fn assert_rays(scene: &PackedScene, cases: &[([u32; 2], [u32; 2], DVec3, DVec3)]) {
    for &(pixel, position, origin, direction) in cases {
        let inside = DVec2::from_array(position.map(|p| f64::from(p) / f64::from(1 << 24)));
        let ray = camera_ray(&scene.header, pixel, inside);
        assert!(ray.origin.distance(origin) < 1e-6, "{pixel:?}: origin {}, by hand {origin}", ray.origin); // f32 steps
        assert!(
            ray.direction.distance(direction) < 1e-6,
            "{pixel:?}: {}, by hand {direction}",
            ray.direction
        );
    }
}

const HALF: u32 = 1 << 23;

/// fov 90°: T = 1. Pixel (0,0) of 4 × 2: its corner is X = −1, Y = 1, scaled by 4/2 across; its
/// centre X = 2·0.5/4 − 1 = −0.75, Y = 1 − 2·0.5/2 = 0.5.
#[test]
fn camera_rays_by_the_field_of_view() {
    let rays = [
        ([0, 0], [0, 0], DVec3::ZERO, DVec3::new(-2.0, 1.0, -1.0)),
        ([0, 0], [HALF, HALF], DVec3::ZERO, DVec3::new(-1.5, 0.5, -1.0)),
        ([2, 1], [0, 0], DVec3::ZERO, DVec3::NEG_Z), // the middle of the picture
        ([3, 1], [HALF, HALF], DVec3::ZERO, DVec3::new(1.5, -0.5, -1.0)),
        ([3, 0], [HALF, 0], DVec3::ZERO, DVec3::new(1.5, 1.0, -1.0)),
    ];
    assert_rays(&camera("vertical_fov = 90.0", 4, 2), &rays);
    // 2·atan(1/2) = 53.130102°: T = ½, as a camera constant of 1 has it.
    let halved: Vec<_> = rays.map(|(p, s, o, d)| (p, s, o, DVec3::new(0.5 * d.x, 0.5 * d.y, d.z))).to_vec();
    assert_rays(&camera("vertical_fov = 53.13010235415598", 4, 2), &halved);
    assert_rays(&camera("camera_constant = 1.0", 4, 2), &halved);
    // Constant 0.25: the plane of height 1 subtends T = 0.5 / 0.25 = 2.
    let doubled: Vec<_> = rays.map(|(p, s, o, d)| (p, s, o, DVec3::new(2.0 * d.x, 2.0 * d.y, d.z))).to_vec();
    assert_rays(&camera("camera_constant = 0.25", 4, 2), &doubled);
}

/// Height 6 over 2 pixels: 3 units a pixel, parallel to −z.
#[test]
fn parallel_camera_rays() {
    assert_rays(
        &camera("orthographic_height = 6.0", 4, 2),
        &[
            ([0, 0], [0, 0], DVec3::new(-6.0, 3.0, 0.0), DVec3::NEG_Z),
            ([0, 0], [HALF, HALF], DVec3::new(-4.5, 1.5, 0.0), DVec3::NEG_Z),
            ([2, 1], [0, 0], DVec3::ZERO, DVec3::NEG_Z),
            ([3, 1], [HALF, HALF], DVec3::new(4.5, -1.5, 0.0), DVec3::NEG_Z),
        ],
    );
}

/// Returns the only pixel of a picture, by oracle and by device, with lean and full pipelines.
fn assert_radiance(what: &str, text: &str, by_hand: DVec3) {
    let scene = packed(text);
    let mut films: Vec<(&str, Film)> =
        vec![("oracle", moire::internal::oracle::backend::render(&scene, &NoProgress).unwrap())];
    for (name, keep_everything) in [("device", false), ("device, everything kept", true)] {
        let film = render::render(&device(), scene.clone(), keep_everything, &Tuning::default(), &NoProgress)
            .unwrap()
            .0;
        films.push((name, film));
    }
    for (who, film) in films {
        let got = DVec3::from_array(film.pixels[0].map(f64::from));
        let off = (got - by_hand).abs().max_element();
        assert!(off <= 2e-6 * by_hand.max_element(), "{what}, {who}: {got}, by hand {by_hand}"); // 32 ulp
    }
}

/// The centre ray goes along −z and meets the plane z = −2 at (0, 0, −2).
const WALL: &str = "sampling = { pattern = \"center\" }
image = { width = 1, height = 1 }
camera = { eye = [0.0, 0.0, 0.0], look_at = [0.0, 0.0, -1.0], vertical_fov = 90.0 }
background = { color = [0.25, 0.5, 1.0] }
[[material]]
name = \"half\"
color = [0.5, 0.25, 1.0]
[[material]]
name = \"mirror\"
model = \"mirror\"
color = [0.5, 1.0, 0.25]
";

const PLANE: &str =
    "[[plane]]\norigin = [0.0, 0.0, -2.0]\ntangent = [1.0, 0.0, 0.0]\nbitangent = [0.0, 1.0, 0.0]\n";

/// albedo/π · I · cos θ / r².
#[test]
fn lambert_under_a_point_light() {
    let light = |position: &str| {
        format!(
            "{WALL}{PLANE}material = \"half\"\n[[light]]\nkind = \"point\"\nposition = {position}\nintensity = [8.0, 4.0, 2.0]\n"
        )
    };
    // Straight above at distance 2: cos = 1, r² = 4: albedo · I / 4π.
    let straight = DVec3::new(0.5 * 8.0, 0.25 * 4.0, 1.0 * 2.0) / (4.0 * PI);
    assert_radiance("straight", &light("[0.0, 0.0, 0.0]"), straight);
    // At (2, 0, 0) as far to the side as in front: r² = 8, cos = 1/√2.
    assert_radiance("aslant", &light("[2.0, 0.0, 0.0]"), straight * 4.0 / 8.0 * S);
    // Behind the wall: nothing.
    assert_radiance("behind", &light("[0.0, 0.0, -5.0]"), DVec3::ZERO);
}

/// albedo/π · E · cos θ; (0, 3, 4) has cos θ = 4/5 with the wall's normal +z.
#[test]
fn lambert_under_a_directional_light() {
    let text = format!(
        "{WALL}{PLANE}material = \"half\"\n[[light]]\nkind = \"directional\"\ndirection = [0.0, 3.0, 4.0]\nirradiance = [5.0, 10.0, 20.0]\n"
    );
    assert_radiance("directional", &text, DVec3::new(0.5 * 5.0, 0.25 * 10.0, 20.0) * 0.8 / PI);
}

/// A mirror returns its colour times the radiance of the reflected ray; black beyond the last bounce.
#[test]
fn mirrors_reflect_and_end() {
    // d − 2 (d·n) n: (1, −1, 0) at n = (0, 1, 0) goes on as (1, 1, 0); at n = (0.6, 0.8, 0),
    // d·n = −0.2, so (1.24, −0.68, 0).
    assert_eq!(mirrored(DVec3::new(1.0, -1.0, 0.0), DVec3::Y), DVec3::new(1.0, 1.0, 0.0));
    let slanted = mirrored(DVec3::new(1.0, -1.0, 0.0), DVec3::new(0.6, 0.8, 0.0));
    assert!(slanted.distance(DVec3::new(1.24, -0.68, 0.0)) < 1e-15);
    // The ray comes straight back and sees the background: (0.5, 1, 0.25) ∘ (0.25, 0.5, 1).
    let text = format!("{WALL}{PLANE}material = \"mirror\"\n");
    assert_radiance("one mirror", &text, DVec3::new(0.125, 0.5, 0.25));
    let text = text.replace("pattern = \"center\"", "pattern = \"center\", max_depth = 0");
    assert_radiance("no bounce left", &text, DVec3::ZERO);
}

/// The shader's polynomial in f32, step by step, against atan in f64.
#[test]
fn the_arctangent_is_good_to_2e_7() {
    let mut worst = (0.0, 0.0);
    for i in 1..=1_000_000u32 {
        let x = f64::from(i) / 1e6;
        let exact = f64::from(x as f32).atan();
        let relative = (f64::from(atan_unit_f32(x as f32)) - exact).abs() / exact;
        worst = if relative > worst.0 { (relative, x) } else { worst };
    }
    assert!(worst.0 < 2e-7, "off by {:e} at {}", worst.0, worst.1); // 2e-8 of the polynomial, 3 ulp of rounding
    assert_eq!(atan_unit_f32(0.0), 0.0);
}
