//! What `moire inspect` says of textures: densities, levels, texels that are never read, charts, and the advice.

use moire::internal::lab::inspect::advice::{Facts, advice};
use moire::internal::lab::inspect::density::Wanted;
use moire::internal::lab::inspect::survey::{Survey, survey};
use moire::internal::lab::inspect::{Charts, charts, readers};
use moire::internal::render::Options;
use moire::internal::render::layers::packed_at_centres;
use moire::internal::scene::model::Scene;

use super::{DOWN, with_scene};
use crate::stage::scene;

fn surveyed(scene: &Scene) -> Survey {
    survey(scene, &packed_at_centres(scene, &Options::default()).unwrap())
}

#[test]
fn the_histograms_and_the_pixels_without_texture_are_all_pixels() {
    for name in ["lecture", "mappings", "environment"] {
        let mut scene = scene(name);
        (scene.width, scene.height) = (40, 30);
        moire::internal::scene::prune::prune(&mut scene);
        let found = surveyed(&scene);
        let bins = found.views.iter().flat_map(|view| view.density.histogram());
        let sum: u64 = bins.map(|bin| bin.pixels).sum();
        assert_eq!((found.pixels, sum + found.untextured), (1200, 1200), "{name}");
    }
}

#[test]
fn a_plane_seen_straight_has_one_bin_and_one_level() {
    with_scene(DOWN, |scene| {
        let view = surveyed(&scene).views.remove(0);
        assert_eq!(view.density.histogram().len(), 1);
        let quarter = Wanted { octaves: -2, is_capped: false };
        assert_eq!(view.density.wanted(view.size), quarter, "four texels a pixel");
        assert_eq!(view.level_pixels, [0, 0, 256, 0, 0, 0, 0]);
        assert_eq!((view.minified, view.elongated), (256, 0), "twice as long is not more than twice");
    });
}

#[test]
fn texels_beyond_what_is_seen_are_never_read() {
    // Two units in u are the whole texture; the plane shows half of it in v.
    with_scene(DOWN, |scene| {
        let never = surveyed(&scene).views[0].never_read.unwrap();
        assert_eq!((never.all, never.side), (64 * 64, 1));
        // Half of the rows, but for those that filters reach beyond the edge.
        assert!((64 * 28..=64 * 32).contains(&never.cells), "{never:?}");
    });
    let whole = DOWN.replace("scale = [0.5, 0.25]", "scale = [0.5, 0.5]");
    with_scene(&whole, |scene| assert_eq!(surveyed(&scene).views[0].never_read.unwrap().cells, 0));
}

/// Two triangles whose charts are a part of the texture's width apart.
fn two_charts(gap: f64) -> String {
    let triangle = |x: f64| {
        format!(
            "[[triangle]]\nvertices = [[{x}, 0, 0], [{x}, 0, 1], [{}, 0, 0]]\nuvs = [[{x}, 0], [{x}, 1], [{}, 0]]\nmaterial = \"m\"\n",
            x + 0.25,
            x + 0.25
        )
    };
    let scene = DOWN.split("[[plane]]").next().unwrap().replace("scale = [0.5, 0.25]", "scale = [1.0, 1.0]");
    scene + &triangle(0.0) + &triangle(0.25 + gap)
}

/// Of the first texture, at its size.
fn charts_of(scene: &Scene) -> Option<Charts> {
    charts(scene, &readers(scene, &[0]), [64, 64], 7)
}

#[test]
fn charts_four_texels_apart_bleed_where_a_texel_reaches_over_the_gap() {
    with_scene(&two_charts(4.0 / 64.0), |scene| {
        let found = charts_of(&scene).unwrap();
        assert_eq!((found.count, found.overlap), (2, false));
        // Columns 0 to 15 and 20 to 35: of texels of 4 columns the linear filter reads the empty 16 to 19 beside the first
        // chart, of 8 those from 16 to 23.
        assert_eq!(found.bleeds_from(), Some(3));
    });
}

#[test]
fn charts_that_meet_at_half_of_the_texture_bleed_where_the_filter_reaches_over() {
    let apart =
        two_charts(0.25).replace("[0.5, 0], [0.5, 1], [0.75, 0]", "[0.53125, 0], [0.53125, 1], [0.9375, 0]");
    let meeting = apart.replace("[0, 0], [0, 1], [0.25, 0]", "[0.0625, 0], [0.0625, 1], [0.46875, 0]");
    // Columns 4 to 29 and 34 to 59: no texel but the last one holds both.
    with_scene(&meeting, |scene| assert_eq!(charts_of(&scene).unwrap().bleeds_from(), Some(3)));
}

#[test]
fn charts_at_opposite_edges_bleed_where_the_texture_repeats() {
    let edges = two_charts(0.25).replace("[0.5, 0], [0.5, 1], [0.75, 0]", "[1.0, 0], [1.0, 1], [0.75, 0]");
    let edges = edges.replace("[0, 0], [0, 1], [0.25, 0]", "[0.0, 0], [0.0, 1], [0.25, 0]");
    let bleeds = |address: &str| {
        let scene = edges.replace("[[sampler]]", &format!("[[sampler]]\naddress = '{address}'"));
        let mut found = None;
        with_scene(&scene, |scene| found = charts_of(&scene).unwrap().bleeds_from());
        found
    };
    assert_eq!(bleeds("repeat"), Some(0));
    // Columns 0 to 15 and 48 to 63 end at the centres of texels of 32 columns.
    assert_eq!(bleeds("clamp-to-edge"), Some(6));
}

#[test]
fn charts_over_each_other_are_said_to_overlap_and_repeated_textures_have_none() {
    let overlapping = two_charts(0.25)
        .replace("uvs = [[0.5, 0], [0.5, 1], [0.75, 0]]", "uvs = [[0.01, 0], [0.01, 1], [0.26, 0]]");
    with_scene(&overlapping, |scene| assert!(charts_of(&scene).unwrap().overlap));
    with_scene(&two_charts(1.0), |scene| assert_eq!(charts_of(&scene), None));
    with_scene(DOWN, |scene| assert_eq!(charts_of(&scene), None, "a plane has no charts"));
}

#[test]
fn the_advice_names_the_settings_that_suit_what_is_seen() {
    with_scene(DOWN, |scene| {
        let options = |facts: Facts| advice(&scene, &facts).options.join(" ");
        let minified = Facts { textured: 1.0, minified: 0.5, elongated: 0.5, edges: 0.1, ..Facts::default() };
        assert_eq!(
            options(minified),
            "--filter anisotropic --mip linear --footprint differentials --algorithm adaptive --spp 16"
        );
        let round = Facts { elongated: 0.1, edges: 0.0, ..minified };
        assert_eq!(options(round), "--filter linear --mip linear --footprint differentials --spp 4");
        let close = Facts { textured: 1.0, magnified: 0.9, edges: 0.5, ..Facts::default() };
        assert_eq!(options(close), "--filter cubic --mip none --footprint none --spp 16");
        assert_eq!(options(Facts { is_noisy: true, ..Facts::default() }), "--algorithm adaptive --spp 64");
    });
}
