//! Tile culling of scenes with many shapes: no list lacks a shape that a ray of its tile
//! hits, so that pictures are bitwise equal, and uniform tiles begin with fewer samples.

use glam::DVec3;
use moire::internal::core::film::Film;
use moire::internal::core::progress::NoProgress;
use moire::internal::core::range::Rect;
use moire::internal::integrators::adaptive::Goal;
use moire::internal::oracle::tile_culling::shapes_of;
use moire::internal::pack::PackedScene;
use moire::internal::render::{self, Session, Tuning};
use moire::internal::scene::model::{Algorithm, Disc, Model, Pattern, Projection, Scene, Sphere, Triangle};
use moire::internal::schema::layout::{
    CELL_BUSY, CELL_EMPTY, CELL_HEAD, CELL_UNIFORM, CELL_WORDS, MAX_LISTED,
};

use crate::lookup::bench::Rng;
use crate::stage::{assert_same_bits, device, packed, render, render_with, small};

/// Random triangles before a mirror, a checkered ground and a background: far and near, some behind the eye, some
/// through the plane of the eye, every fifth a needle.
fn soup(count: usize, side: u32) -> Scene {
    let mut scene = small("s2", side, 4);
    let mut rng = Rng::new(11);
    let first = scene.shapes.triangles[0];
    let eye = scene.camera.eye;
    let mut place = |reach: f64| DVec3::from_array([0; 3].map(|_| reach * (2.0 * rng.unit() - 1.0)));
    scene.shapes.triangles = (0..count)
        .map(|i| {
            let middle = if i % 7 == 0 { eye + place(0.5) } else { DVec3::new(0.0, 0.6, 0.0) + place(1.2) };
            let reach = if i % 3 == 0 { 0.4 } else { 0.1 };
            let mut vertices = [0; 3].map(|_| middle + place(reach));
            if i % 5 == 0 {
                vertices[2] = vertices[0] + 1e-4 * place(1.0);
            }
            Triangle { vertices, ..first }
        })
        .collect();
    scene
}

/// The soup with spheres and discs of all sizes in it, some around the eye, beside its triangles.
fn mixed_soup(triangles: usize, round: usize, side: u32) -> Scene {
    let mut scene = soup(triangles, side);
    let mut rng = Rng::new(12);
    let eye = scene.camera.eye;
    let mut place = |reach: f64| DVec3::from_array([0; 3].map(|_| reach * (2.0 * rng.unit() - 1.0)));
    let (material, from) = (scene.shapes.spheres[0].material, DVec3::new(0.0, 0.6, 0.0));
    for i in 0..round {
        let center = if i % 7 == 0 { eye + place(0.5) } else { from + place(1.5) };
        let radius = if i % 5 == 0 { 0.3 } else { 0.05 };
        if i % 2 == 0 {
            scene.shapes.spheres.push(Sphere { material, ..Sphere::new(center, radius) });
        } else {
            scene.shapes.discs.push(Disc { material, ..Disc::new(center, place(1.0), radius) });
        }
    }
    scene
}

pub fn without(scene: &PackedScene) -> PackedScene {
    let mut scene = scene.clone();
    scene.header.cell_side = 0;
    scene
}

pub fn assert_same(scene: &PackedScene, what: &str) {
    assert!(scene.culls_tiles(), "{what} is not culls_tiles");
    assert_same_bits(&render(scene), &render(&without(scene)), what);
}

#[test]
fn pictures_are_the_same_with_and_without() {
    let mut scene = soup(60, 70);
    assert_same(&packed(scene.clone(), None), "perspective");
    assert_same(&packed(scene.clone(), Some(Rect { x: 13, y: 7, width: 41, height: 50 })), "a crop");
    scene.camera.projection = Projection::Orthographic(2.5);
    assert_same(&packed(scene.clone(), None), "parallel rays");
    scene.pixel_filter.radius = 2.25;
    assert_same(&packed(scene, None), "a wide box");
}

#[test]
fn pictures_with_spheres_and_discs_are_the_same_with_and_without() {
    for triangles in [1, 60] {
        let mut scene = mixed_soup(triangles, 60, 70);
        assert_same(&packed(scene.clone(), None), "perspective");
        scene.camera.projection = Projection::Orthographic(2.5);
        assert_same(&packed(scene.clone(), None), "parallel rays");
        scene.shapes.triangles.clear();
        assert_same(&packed(scene.clone(), None), "no triangle");
        scene.shapes.spheres.clear();
        assert_same(&packed(scene.clone(), None), "discs alone");
    }
    assert_same(&packed(mixed_soup(60, 900, 40), None), "crowded cells");
    let scene = packed(mixed_soup(20, 40, 24), None);
    let (kept, _) = render_with(&scene, true, &Tuning::default());
    assert_same_bits(&render(&scene), &kept, "with everything kept");
}

#[test]
fn crowded_cells_fall_back_to_all_triangles() {
    let scene = packed(soup(900, 40), None);
    let (_, words) = culls_tiles(&scene);
    assert!(words.chunks(CELL_WORDS as usize).any(|cell| cell[0] > MAX_LISTED), "no cell is crowded");
    assert_same(&scene, "900 triangles");
}

#[test]
fn nothing_is_left_out_without_a_difference() {
    let scene = packed(soup(40, 24), None);
    let (kept, _) = render_with(&scene, true, &Tuning::default());
    assert_same_bits(&render(&scene), &kept, "with everything kept");
    let (kept, _) = render_with(&without(&scene), true, &Tuning::default());
    assert_same_bits(&render(&scene), &kept, "with everything kept but tile culling");
}

#[test]
fn few_triangles_lenses_motion_and_other_filters_are_not_culled_by_tiles() {
    assert!(!packed(small("lecture", 32, 4), None).culls_tiles());
    let mut scene = soup(40, 32);
    scene.camera.motion[0] = DVec3::X;
    assert!(!packed(scene, None).culls_tiles());
}

/// The film, and the lists of tile culling.
pub fn culls_tiles(scene: &PackedScene) -> (Film, Vec<u32>) {
    let device = device();
    let session = Session::open(&device, scene.clone(), false, &Tuning::default()).unwrap();
    let (film, report) = session.prepare().unwrap().render(&NoProgress).unwrap();
    assert!(report.device_culling_seconds.is_some());
    (film, session.tile_list_words().unwrap().unwrap())
}

/// In f64, with few extra ones: tolerance and margin are small.
#[test]
fn lists_hold_what_float64_says() {
    assert_lists(packed(soup(60, 70), None));
    assert_lists(packed(mixed_soup(40, 40, 70), None));
}

fn assert_lists(scene: PackedScene) {
    let (_, words) = culls_tiles(&scene);
    let side = scene.header.cell_side;
    let (mut listed, mut exact) = (0, 0);
    let across = 70u32.div_ceil(side);
    for (k, cell) in (0..).zip(words.chunks(CELL_WORDS as usize)) {
        let found = &cell[CELL_HEAD as usize..][..cell[0] as usize];
        assert!(found.is_sorted(), "ties are for the lowest number: {found:?}");
        let expected = shapes_of(&scene, [k % across * side, k / across * side]);
        for shape in &expected {
            assert!(found.contains(shape), "cell {k} lacks shape {shape}");
        }
        listed += found.len();
        exact += expected.len();
    }
    assert!(exact > 100 && listed < exact + exact / 10, "{listed} listed, {exact} needed");
}

fn to_goal(scene: &Scene, goal: Goal) -> (Film, moire::internal::integrators::adaptive::Outcome) {
    let mut scene = scene.clone();
    scene.sampling.algorithm = Algorithm::Adaptive;
    scene.sampling.pattern = Pattern::SobolOwen;
    let scene = packed(scene, None);
    let (film, report) =
        render::render_to_goal(&device(), scene, false, &Tuning::default(), Some(goal), &NoProgress).unwrap();
    (film, report.outcome.unwrap())
}

/// Returns the numbers of empty, uniform and busy cells.
fn contents(scene: Scene) -> [usize; 3] {
    let (_, words) = culls_tiles(&packed(scene, None));
    [CELL_EMPTY, CELL_UNIFORM, CELL_BUSY]
        .map(|class| words.chunks(CELL_WORDS as usize).filter(|cell| cell[1] == class).count())
}

/// A ground alone is uniform where it is near enough for its texels to span a pixel, and if untextured wherever it
/// fills the cell; if it is lit, another shape may shadow it.
#[test]
fn ground_is_uniform_by_its_texels_and_its_light() {
    let mut lit = soup(20, 128);
    lit.shapes.spheres.clear();
    let mut unlit = lit.clone();
    unlit.materials.iter_mut().for_each(|m| m.model = Model::Unlit);
    let mut fine = unlit.clone();
    fine.materials.iter_mut().for_each(|m| m.mapping.scale *= 1e3);
    let mut coarse = unlit.clone();
    coarse.materials.iter_mut().for_each(|m| m.mapping.scale *= 1e-3);
    let mut plain = unlit.clone();
    plain.materials.iter_mut().for_each(|m| m.texture = None);
    let [lit, fine, coarse, plain] = [lit, fine, coarse, plain].map(contents);
    assert_eq!([lit[1], fine[1]], [0, 0], "shaded, minified");
    assert!(coarse[1] > 20 && plain[1] >= coarse[1], "{coarse:?} {plain:?}");
    for counts in [fine, coarse, plain] {
        assert!(counts[0] == lit[0] && counts[0] > 0 && counts[2] > 0, "{counts:?}");
    }
}

/// Needles of a hundredth of a pixel before an empty background: the cells that they cross are not empty.
#[test]
fn uniform_cells_begin_with_fewer_samples_and_nothing_thin_is_missed() {
    let mut scene = soup(40, 128);
    scene.shapes.planes.clear();
    scene.shapes.spheres.clear();
    let (film, outcome) = to_goal(&scene, Goal::Error(2e-3));
    assert!(outcome.reached && outcome.least_samples == 2, "{outcome:?}");
    let mut converged = scene.clone();
    (converged.sampling.pattern, converged.sampling.spp) = (Pattern::SobolOwen, 4096);
    let reference = render(&packed(converged, None));
    let error = moire::internal::lab::metrics::compare(&film, &reference).unwrap().rmse;
    assert!(error < 1.1 * 2e-3, "{error:e}");
}
