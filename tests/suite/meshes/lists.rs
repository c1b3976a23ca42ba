//! Lists of a mesh's triangles for cells of the picture: pictures are the same with and without them, to the bit, also
//! where lists are full, where a cell sees past what its probes met, and beside other shapes.

use glam::DVec3;
use moire::internal::core::range::Rect;
use moire::internal::gpu::DeviceKind;
use moire::internal::lab::metrics::compare;
use moire::internal::pack::features::bounces;
use moire::internal::render::Tuning;
use moire::internal::scene::model::{Algorithm, Lens, Light, Model, Pattern, Precision, Projection, Scene};
use moire::internal::schema::layout::{CELL_DIVIDED, CELL_WORDS, MAX_LISTED_WITH_MESHES, MAX_MORE_LISTED};

use crate::stage::{
    assert_same_bits, device, packed, render, render_with, small, sums_apart, unequal_batches,
};
use crate::tile_culling::{assert_same, culls_tiles, without};

/// A knot of 2304 triangles on a plane beside a sign, with lights.
fn knot(side: u32, spp: u32) -> Scene {
    let mut scene = small("models", side, spp);
    scene.sampling.precision = Precision::Single;
    scene
}

#[test]
fn pictures_are_the_same_with_and_without_lists() {
    let mut scene = knot(96, 4);
    assert_same(&packed(scene.clone(), None), "perspective");
    assert_same(&packed(scene.clone(), Some(Rect { x: 13, y: 7, width: 41, height: 50 })), "a crop");
    scene.camera.projection = Projection::Orthographic(2.5);
    assert_same(&packed(scene.clone(), None), "parallel rays");
    scene.pixel_filter.radius = 2.25;
    assert_same(&packed(scene.clone(), None), "a wide box");
    scene.camera.projection = Projection::VerticalFov(100.0);
    scene.camera.eye = DVec3::new(0.9, 0.75, 0.5);
    assert_same(&packed(scene, None), "from within");
}

/// From far away many triangles lie in each cell; what a list has no room for is found by the tree.
#[test]
fn full_lists_say_up_to_which_depth_they_are_complete() {
    let mut scene = knot(64, 16);
    let away = scene.camera.eye - scene.camera.look_at;
    scene.camera.eye = scene.camera.look_at + 12.0 * away;
    let scene = packed(scene, None);
    let (film, words) = culls_tiles(&scene);
    let cells: Vec<&[u32]> = words.chunks(CELL_WORDS as usize).collect();
    let listed = |cell: &&[u32]| cell[0] + cell[2];
    let is_full = |cell: &&&[u32]| listed(cell) >= MAX_LISTED_WITH_MESHES && f32::from_bits(cell[3]) < 1e30;
    assert!(cells.iter().filter(is_full).count() > 0, "no list is full");
    assert!(cells.iter().any(|cell| listed(cell) > MAX_LISTED_WITH_MESHES), "no cell has room for more");
    let is_cpu = device().info().kind == DeviceKind::Cpu;
    assert!(!is_cpu || cells.iter().any(|cell| cell[1] == CELL_DIVIDED), "no cell is divided");
    assert_same_bits(&film, &render(&without(&scene)), "full lists");
}

/// Tiles at the edges are not whole; samples are no whole number of turns of a workgroup; long sums are in blocks.
#[test]
fn any_number_of_samples_is_the_same_with_and_without_lists() {
    let mut scene = knot(70, 16);
    scene.lights.clear();
    for material in &mut scene.materials {
        material.model = Model::Unlit;
    }
    for spp in [4, 5, 16, 70, 97] {
        scene.sampling.pattern = Pattern::SobolOwen;
        scene.sampling.spp = spp;
        let packed = packed(scene.clone(), Some(Rect { x: 3, y: 5, width: 51, height: 37 }));
        assert!(packed.culls_tiles() && !bounces(&packed));
        assert_same_bits(&render(&packed), &render(&without(&packed)), &format!("{spp} samples"));
    }
}

/// Neighbouring threads take different numbers of samples, by several passes on some devices.
#[test]
fn batches_of_unequal_counts_are_the_same_with_and_without_lists() {
    let mut scene = knot(32, 64);
    scene.lights.clear();
    for material in &mut scene.materials {
        material.model = Model::Unlit;
    }
    scene.sampling.pattern = Pattern::SobolOwen;
    scene.sampling.algorithm = Algorithm::Adaptive;
    let packed = packed(scene, None);
    assert!(packed.culls_tiles() && !bounces(&packed));
    let batches = unequal_batches(&packed);
    let tuning = Tuning::default();
    let [listed, unlisted] =
        [packed.clone(), without(&packed)].map(|scene| sums_apart(&scene, &batches, &tuning));
    for (i, (a, b)) in listed.iter().zip(&unlisted).enumerate() {
        assert_eq!(a.map(f32::to_bits), b.map(f32::to_bits), "{:?}: {a:?}, {b:?}", batches[i]);
    }
}

/// A knot alone shades itself: of the triangles that may shade a pixel some are found once, others by the tree.
#[test]
fn shadows_are_the_same_with_and_without_lists() {
    let mut scene = knot(128, 16);
    scene.shapes.planes.clear();
    scene.shapes.meshes.retain(|mesh| mesh.triangle_count() > 1000);
    let middle = DVec3::new(0.9, 0.75, 0.0);
    let mut shaded = 0;
    for (k, direction) in
        [[-0.5, 1.0, 0.8], [1.0, 0.02, 0.1], [0.3, -0.2, 1.0], [0.1, 0.2, -1.0]].into_iter().enumerate()
    {
        let direction = DVec3::from(direction);
        scene.lights = vec![Light::Directional { direction, irradiance: DVec3::splat(3.0) }];
        scene.camera.look_at = middle;
        scene.camera.eye = middle + [1.6, 2.5, 4.0, 9.0][k] * DVec3::new(0.3, 0.4, 0.85);
        let lit = packed(scene.clone(), None);
        assert!(!bounces(&lit) && lit.records.lights.len() == 1 && lit.records.meshes.len() == 1);
        assert!(lit.records.planes.is_empty() && lit.records.triangles.is_empty() && lit.culls_tiles());
        let picture = render(&lit);
        assert_same_bits(&picture, &render(&without(&lit)), &format!("light {k}"));
        let mut bright = lit.clone();
        bright.records.lights[0].direction = -bright.records.lights[0].direction;
        shaded += usize::from(compare(&picture, &render(&bright)).unwrap().rmse > 0.01);
    }
    assert_eq!(shaded, 4, "the light does not matter");
}

#[test]
fn depths_of_cells_end_behind_what_hides_the_rest() {
    let (_, words) = culls_tiles(&packed(knot(192, 1), None));
    let mut hidden = 0;
    for cell in words.chunks(CELL_WORDS as usize) {
        let depth = f32::from_bits(cell[3]);
        let most = MAX_LISTED_WITH_MESHES + MAX_MORE_LISTED;
        assert!(depth > 0.0 && depth <= 1e30 && cell[0] + cell[2] <= most, "{depth}, {:?}", &cell[..4]);
        hidden += usize::from(depth < 1e30 && cell[2] > 0);
    }
    assert!(hidden > 20, "{hidden} cells end behind a surface");
}

#[test]
fn nothing_depends_on_what_is_left_out_or_on_the_schedule() {
    let mut scene = knot(48, 16);
    let whole = packed(scene.clone(), None);
    let (kept, _) = render_with(&whole, true, &Tuning::default());
    assert_same_bits(&render(&whole), &kept, "with everything kept");
    scene.sampling.algorithm = Algorithm::Adaptive;
    scene.sampling.pattern = Pattern::SobolOwen;
    let adaptive = packed(scene, None);
    // Cells of the background alone begin with fewer samples.
    let apart = compare(&render(&adaptive), &render(&without(&adaptive))).unwrap().rmse;
    assert!(apart < 0.02, "{apart}");
}

#[test]
fn lenses_motion_and_f64_do_without_lists() {
    let mut scene = knot(16, 1);
    scene.sampling.precision = Precision::Double;
    assert!(!packed(scene.clone(), None).culls_tiles());
    scene.sampling.precision = Precision::Single;
    assert!(packed(scene.clone(), None).culls_tiles());
    scene.camera.lens = Some(Lens { radius: 0.1, focus_distance: 3.0 });
    assert!(!packed(scene, None).culls_tiles());
}
