//! Motion blur: the length of streaks against geometry, instants against static scenes, and the
//! gain by sample patterns.

use glam::DVec3;
use moire::internal::core::film::Film;
use moire::internal::core::progress::NoProgress;
use moire::internal::lab::metrics::compare;
use moire::internal::oracle::backend::render as on_oracle;
use moire::internal::pack::PackedScene;
use moire::internal::scene::model::Scene;
use moire::internal::scene::parse;
use moire::internal::texture::load::load;

use super::lens::{VIEW, spread};
use super::{assert_patterns_gain, packed, parsed};
use crate::stage::render;

fn flat(text: &str) -> Scene {
    parsed(&format!(
        "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\northographic_height = 2\n[image]\nwidth = 32\nheight = 32
[sampling]\npattern = 'sobol-owen'\nspp = 256\n[[material]]\nname = 'white'\nmodel = 'unlit'\n{text}"
    ))
}

fn row(film: &Film) -> Vec<f64> {
    film.pixels[16 * 32..17 * 32].iter().map(|p| f64::from(p[0])).collect()
}

/// An edge that moves by 1 from x = -0.5: it covers x for 1 - (x + 0.5) of the time.
#[test]
fn an_edge_on_its_way_covers_each_place_for_its_share_of_the_time() {
    for (shape, shutter) in [
        (
            "[[plane]]\norigin = [-2.5, 0, 0]\ntangent = [2, 0, 0]\nbitangent = [0, 2, 0]\nhalf_extent = 1",
            [0.0, 1.0],
        ),
        ("[[triangle]]\nvertices = [[-0.5, -90, 0], [-0.5, 90, 0], [-90, 0, 0]]", [0.0, 1.0]),
        ("[[triangle]]\nvertices = [[-0.5, -90, 0], [-0.5, 90, 0], [-90, 0, 0]]", [0.25, 0.75]),
    ] {
        let mut scene = flat(&format!("{shape}\nmaterial = 'white'\nmotion = [1, 0, 0]\n"));
        scene.camera.shutter = shutter;
        for (i, found) in row(&render(&packed(&scene))).into_iter().enumerate() {
            let x = (i as f64 + 0.5) / 16.0 - 1.0;
            // The edge passes at this time.
            let expected = ((shutter[1] - (x + 0.5)) / (shutter[1] - shutter[0])).clamp(0.0, 1.0);
            assert!((found - expected).abs() < 0.02, "{shape} at {x}: {found}, expected {expected}");
        }
    }
}

/// A streak of length d adds d²/12 to a ball's variance along its way, and nothing across.
#[test]
fn a_ball_leaves_a_streak_as_long_as_its_way() {
    let still = flat("[[sphere]]\ncenter = [-0.3, 0.1, 0]\nradius = 0.2\nmaterial = 'white'\n");
    let mut moving = still.clone();
    moving.shapes.spheres[0].motion = DVec3::new(0.7, 0.0, 0.0);
    let ([x, y], [own_x, own_y]) = (spread(&render(&packed(&moving))), spread(&render(&packed(&still))));
    let streak = (0.7f64 * 16.0).powi(2) / 12.0;
    assert!(((x - own_x) / streak - 1.0).abs() < 0.02, "{}, expected {streak}", x - own_x);
    assert!((y - own_y).abs() < 0.02 * streak, "{y} and {own_y} across");
}

/// Everything that can move, lit and reflected, with a texture at its own position on a ball.
const CROWD: &str = "
[[light]]\nkind = 'point'\nposition = [2, 4, 5]\nintensity = [40, 35, 30]
[[texture]]\nname = 'checker'\nprocedural = 'checker'
[[material]]\nname = 'checked'\ntexture = 'checker'\nmapping = { kind = 'solid', scale = 3.0 }
[[material]]\nname = 'mirror'\nmodel = 'mirror'
[[plane]]\norigin = [0, -1, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, 1]\nhalf_extent = 3\nmotion = [0, 0.2, 0]
[[sphere]]\ncenter = [-0.6, 0, 1]\nradius = 0.5\nmaterial = 'checked'\nmotion = [0.3, 0.2, -0.4]
[[sphere]]\ncenter = [0.6, 0, 0]\nradius = 0.7\nmaterial = 'mirror'\nmotion = [0.1, 0.1, 0.2]
[[triangle]]\nvertices = [[-1, 1, 2], [0, 1, 2], [-0.4, 1.7, 1.6]]\nmaterial = 'white'\nmotion = [0.5, -0.3, 0.1]
";

fn textured(scene: &Scene) -> PackedScene {
    let textures = scene.textures.iter().map(|t| load(t).unwrap()).collect();
    moire::internal::pack::pack(scene, textures, None).unwrap()
}

#[test]
fn a_moment_shows_everything_where_it_is_then() {
    let camera =
        "vertical_fov = 40\nlens_radius = 0.1\nmotion = { eye = [0.5, 0.2, -0.3], look_at = [-0.2, 0.1, 0] }";
    let moving = parsed(&format!("{}{CROWD}", VIEW.replace("vertical_fov = 40", camera)));
    for time in [0.0, 0.4, 1.0] {
        let mut frozen = moving.clone();
        frozen.camera.shutter = [time; 2];
        let mut still = moving.clone();
        let [eye, look_at] = still.camera.motion;
        (still.camera.eye, still.camera.look_at) =
            (still.camera.eye + time * eye, still.camera.look_at + time * look_at);
        still.camera.motion = [DVec3::ZERO; 2];
        // The ball's texture goes with it.
        still.materials.iter_mut().for_each(|m| m.mapping.origin += time * still.shapes.spheres[0].motion);
        for plane in &mut still.shapes.planes {
            plane.origin += time * std::mem::take(&mut plane.motion);
        }
        for sphere in &mut still.shapes.spheres {
            sphere.center += time * std::mem::take(&mut sphere.motion);
        }
        for triangle in &mut still.shapes.triangles {
            let by = time * std::mem::take(&mut triangle.motion);
            triangle.vertices.iter_mut().for_each(|v| *v += by);
        }
        let [frozen, still] = [textured(&frozen), textured(&still)];
        assert!(still.records.motions.is_empty());
        let [a, b] = [&frozen, &still].map(|s| on_oracle(s, &NoProgress).unwrap());
        let apart = compare(&a, &b).unwrap();
        assert!(apart.rmse < 2e-3, "oracle at {time}: {:e}", apart.rmse);
        let [a, b] = [&frozen, &still].map(render);
        let apart = compare(&a, &b).unwrap();
        // Samples at edges of texture and shapes.
        assert!(apart.rmse < 5e-3, "device at {time}: {:e}", apart.rmse);
    }
}

#[test]
fn a_camera_that_moves_sees_what_shapes_moving_the_other_way_show() {
    let way = DVec3::new(0.4, -0.2, 0.3);
    let mut camera = parsed(&format!("{VIEW}{CROWD}"));
    camera.lights.clear();
    camera
        .materials
        .iter_mut()
        .filter(|m| m.name == "default")
        .for_each(|m| m.model = moire::internal::scene::model::Model::Unlit);
    let mut shapes = camera.clone();
    camera.camera.motion = [way; 2];
    for motion in camera
        .shapes
        .planes
        .iter_mut()
        .map(|s| &mut s.motion)
        .chain(camera.shapes.spheres.iter_mut().map(|s| &mut s.motion))
    {
        *motion = DVec3::ZERO;
    }
    camera.shapes.triangles.iter_mut().for_each(|t| t.motion = DVec3::ZERO);
    shapes.shapes.planes.iter_mut().for_each(|s| s.motion = -way);
    shapes.shapes.spheres.iter_mut().for_each(|s| s.motion = -way);
    shapes.shapes.triangles.iter_mut().for_each(|s| s.motion = -way);
    let [a, b] = [&camera, &shapes].map(|s| on_oracle(&textured(s), &NoProgress).unwrap());
    assert!(compare(&a, &b).unwrap().rmse < 2e-3, "{:e}", compare(&a, &b).unwrap().rmse);
    let [a, b] = [&camera, &shapes].map(|s| render(&textured(s)));
    assert!(compare(&a, &b).unwrap().rmse < 5e-3, "{:e}", compare(&a, &b).unwrap().rmse);
}

#[test]
fn streaks_are_sampled_better_by_patterns_than_by_chance() {
    let scene = flat(
        "[[sphere]]\ncenter = [-0.5, -0.3, 0]\nradius = 0.3\nmaterial = 'white'\nmotion = [1, 0.6, 0]\n",
    );
    assert_patterns_gain("motion", &scene, 0.35);
}

#[test]
fn motions_that_make_no_sense_are_refused_by_line_and_key() {
    let fov = "vertical_fov = 40";
    for (line, words) in [
        ("shutter = [0.5, 0.4]", ["camera.shutter", "closes before"]),
        ("shutter = [0, 2]", ["camera.shutter", "from 0 to 1"]),
        ("motion = { eye = [0, 0, -8] }", ["camera.motion", "passes through"]),
        ("motion = { look_at = [0, 8, 8] }", ["camera.motion", "parallel to up"]),
        ("motion = { up = [0, 8, 8] }", ["\"up\"", "allowed: eye, look_at"]),
    ] {
        let text = VIEW.replace(fov, &format!("{fov}\n{line}"));
        let told = parse("a.toml".as_ref(), &text).unwrap_err().to_string();
        assert!(told.starts_with("a.toml:6:"), "{told}");
        words.iter().for_each(|word| assert!(told.contains(word), "{word} is not in: {told}"));
    }
    let text = format!("{VIEW}[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmotion = [1, 0]\n");
    let told = parse("a.toml".as_ref(), &text).unwrap_err().to_string();
    assert!(told.contains("sphere.motion") && told.contains("3 finite numbers"), "{told}");
}
