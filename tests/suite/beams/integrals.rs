//! Integrals of textures over fragments: every address mode, filter and texel centre, near and far,
//! against means of very many lookups; checkers against closed forms.

use glam::DVec2;
use moire::internal::oracle::beam::beam;
use moire::internal::oracle::grid::checker_grid;
use moire::internal::oracle::polygon::unit_square;
use moire::internal::oracle::prefix_sums::mean_over;
use moire::internal::oracle::projective::RationalMap;
use moire::internal::oracle::render::sample;
use moire::internal::pack::PackedScene;
use moire::internal::scene::model::{Pattern, Scene};
use moire::internal::texture::sampler_spec::{Address, Filter, TexelCenter};

use super::{beams, rmse, with_beams};
use crate::stage::{packed, render, render_on_oracle, small};

/// Returns the pixel as the mean of a grid of look-ups with this many per side.
fn by_grid(scene: &PackedScene, place: [u32; 2], side: u32) -> f64 {
    let sum: f64 = (0..side * side).map(|s| sample(scene, &scene.header, place, 0, s).0.x).sum();
    sum / f64::from(side * side)
}

/// Returns pixels across a textured ground, with a sampler altered by `change`.
fn assert_grid_meets_beams(what: &str, bound: f64, change: impl Fn(&mut Scene)) {
    let mut scene = small("s1b", 12, 4);
    change(&mut scene);
    let beamed = with_beams(scene.clone());
    let side = 150;
    scene.sampling.pattern = Pattern::Grid;
    scene.sampling.spp = side * side;
    let scene = packed(scene, None);
    let mut told = 0;
    for place in [[1, 11], [7, 9], [4, 7], [10, 5]] {
        // Beams do not resolve a clamped texture from afar.
        let Some(color) = beam(&beamed, place) else { continue };
        told += 1;
        let beam = color.x;
        let grid = by_grid(&scene, place, side);
        assert!((beam - grid).abs() < bound, "{what}: {beam} at {place:?}, by look-ups {grid}");
    }
    assert!(told >= 3, "{what}");
}

#[test]
fn every_address_mode_filter_and_centre() {
    for address in [Address::Repeat, Address::MirroredRepeat, Address::ClampToEdge] {
        for filter in [Filter::Nearest, Filter::Linear] {
            for center in [TexelCenter::Half, TexelCenter::Integer] {
                // Texels as large as some pixels, so that edges of tiles lie within them.
                for scale in [0.003, 0.05] {
                    let what = format!("{address} {filter} {center} scale {scale}");
                    // A grid of 150² misses an edge by less than 1 / 300 of the pixel, times a texel's
                    // contrast.
                    assert_grid_meets_beams(&what, 1.5e-3, |scene| {
                        let sampler = &mut scene.samplers[0];
                        sampler.address = [address; 2];
                        (sampler.mag, sampler.texel_center) = (filter, center);
                        for material in &mut scene.materials {
                            material.mapping.scale = DVec2::new(scale, 0.7 * scale);
                            material.mapping.rotate = 25.0;
                        }
                    });
                }
            }
        }
    }
}

#[test]
fn each_axis_has_its_own_address_mode() {
    assert_grid_meets_beams("mirrored beside clamped", 1.5e-3, |scene| {
        scene.samplers[0].address = [Address::MirroredRepeat, Address::ClampToEdge];
        for material in &mut scene.materials {
            material.mapping.scale = DVec2::splat(0.04);
            material.mapping.rotate = 40.0;
        }
    });
}

/// A square of w cells from (x, y): the mean of a checker is known in closed form.
#[test]
fn a_checker_has_its_exact_mean() {
    // ∫₀ˣ of a square wave that is -1 in even cells, 1 in odd ones.
    let wave = |x: f64| {
        let (cell, rest) = (x.floor(), x - x.floor());
        if cell.rem_euclid(2.0) == 0.0 { -rest } else { rest - 1.0 }
    };
    let square = unit_square();
    for (x, y, w, h) in
        [(0.2, 0.3, 0.5, 0.4), (0.7, -1.4, 3.3, 2.9), (-5.1, 8.2, 40.7, 0.3), (100.5, 3.0, 1.0, 7.5)]
    {
        let quotient = RationalMap {
            u: glam::DVec3::new(w, 0.0, x),
            v: glam::DVec3::new(0.0, h, y),
            below: glam::DVec3::Z,
        };
        let mean = mean_over(&checker_grid(), &square, &quotient, false, &mut 0).x;
        let product = (wave(x + w) - wave(x)) / w * ((wave(y + h) - wave(y)) / h);
        let expected = 0.5 - 0.5 * product;
        assert!((mean - expected).abs() < 1e-12, "{mean} for {expected}");
    }
}

/// Clamped textures have no mip chain beyond their edges.
#[test]
fn distant_clamped_textures_are_left_to_samples() {
    let mut scene = small("s1b", 32, 4);
    scene.samplers[0].address = [Address::ClampToEdge; 2];
    let (_, sampled) = beams(&with_beams(scene));
    assert!(sampled > 0);
}

/// Odd sizes halve with remainder; grey textures have one channel.
#[test]
fn textures_of_any_size_and_format() {
    for file in ["rgb16.png", "grey16.png", "rgba8.png", "ramp.exr"] {
        let mut scene = small("s1b", 32, 4);
        let texture = &mut scene.textures[0];
        texture.content = moire::internal::scene::model::TextureContent::File(
            crate::support::data().join("textures").join(file),
        );
        super::assert_meets_samples(&scene, file);
        let beamed = with_beams(scene);
        let apart = rmse(&render(&beamed), &render_on_oracle(&beamed));
        assert!(apart < 1e-4, "{file}: RMSE {apart:e}"); // texels of at most 4
    }
}
