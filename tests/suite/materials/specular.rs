//! Maps of what the surface of `metallic-roughness` reflects: alpha of one multiplies its weight, colours of the other one
//! its tint; the values are those of the same factors, and those worked out by hand.

use std::f64::consts::PI;

use glam::DVec3;
use moire::internal::pack::PackedScene;

use super::physical::{both, plane};
use super::{floats, scene};

/// Light and eye at 60° on the two sides of the normal.
const LIGHT: &str =
    "[[light]]\nkind = 'directional'\ndirection = [-1.7320508075688772, 0, 1]\nirradiance = [1, 1, 1]\n";

/// A surface with these keys, and with maps of one texel each.
fn mapped(keys: &str, maps: &[(&str, [f32; 4])]) -> PackedScene {
    let mut material = format!("model = 'metallic-roughness'\nroughness = 0.5\nsampler = 's'\n{keys}\n");
    let mut rest = format!("{LIGHT}[[sampler]]\nname = 's'\n");
    for (key, _) in maps {
        material += &format!("{key} = '{key}'\n");
        rest += &format!("[[texture]]\nname = '{key}'\nfile = '{key}.exr'\n");
    }
    let textures = maps.iter().map(|(_, texel)| floats(1, 1, |_, _| *texel)).collect();
    scene(&plane(60.0, 1, &material, &rest), textures)
}

fn plain(keys: &str) -> PackedScene {
    let material = format!("model = 'metallic-roughness'\nroughness = 0.5\n{keys}");
    scene(&plane(60.0, 1, &material, LIGHT), Vec::new())
}

fn assert_equal(found: [DVec3; 2], wanted: [DVec3; 2], what: &str) {
    for (found, wanted) in found.into_iter().zip(wanted) {
        // Rounding of f32.
        assert!((found - wanted).abs().max_element() < 1e-6, "{what}: {found}, not {wanted}");
    }
}

const WEIGHT: &str = "specular_weight_map";
const TINT: &str = "specular_tint_map";

#[test]
fn maps_of_one_texel_are_factors() {
    let color = "color = [0.3, 0.2, 0.1]\nior = 2";
    // No channel but alpha counts, and none but the colours.
    let (weight, tint) = ([0.9, 0.1, 0.3, 0.25], [0.8, 0.5, 0.1, 0.2]);
    let found = both(&mapped(color, &[(WEIGHT, weight)]));
    assert_equal(found, both(&plain(&format!("{color}\nspecular_weight = 0.25"))), "weight");
    let found = both(&mapped(color, &[(TINT, tint)]));
    assert_equal(found, both(&plain(&format!("{color}\nspecular_tint = [0.8, 0.5, 0.1]"))), "tint");
    let factors = format!("{color}\nspecular_weight = 0.5\nspecular_tint = [0.5, 1, 2]");
    let found = both(&mapped(&factors, &[(WEIGHT, weight), (TINT, tint)]));
    let product = format!("{color}\nspecular_weight = 0.125\nspecular_tint = [0.4, 0.5, 0.2]");
    assert_equal(found, both(&plain(&product)), "all");
}

/// Of a metal the maps change nothing.
#[test]
fn metals_have_no_weight_and_no_tint() {
    let keys = "metallic = 1\ncolor = [0.9, 0.5, 0.2]";
    let found = both(&mapped(keys, &[(WEIGHT, [0.0; 4]), (TINT, [0.0; 4])]));
    assert_equal(found, both(&plain(keys)), "metal");
}

/// A reflectance above 1 is 1 before the weight, whichever of factor and texture brings it there.
#[test]
fn what_is_reflected_head_on_is_bounded_by_the_weight() {
    let keys = "color = [0, 0, 0]\nior = 2";
    let factors = format!("{keys}\nspecular_tint = [3, 6, 20]");
    let found = both(&mapped(&factors, &[(WEIGHT, [1.0, 1.0, 1.0, 0.5]), (TINT, [2.0, 2.0, 0.1, 1.0])]));
    // Head-on 1/9 of the light; after the tint 6/9, 12/9 and 2/9.
    let wanted = plain(&format!("{keys}\nspecular_weight = 0.5\nspecular_tint = [6, 9, 2]"));
    assert_equal(found, both(&wanted), "bounded");
}

/// Without any reflectance head-on Schlick's term is left: weight · (1 − cos)⁵ times the lobe, whose half vector is the
/// normal: D = 1 / (π α²), V = 1 / (4 cos √(cos² + α² sin²)).
#[test]
fn a_black_tint_leaves_the_grazing_term_worked_out_by_hand() {
    let (cos, alpha, weight): (f64, f64, f64) = (0.5, 0.25, 0.75);
    let lobe = 0.25 / (cos * (cos * cos + alpha * alpha * 0.75).sqrt()) / (PI * alpha * alpha);
    let wanted = weight * (1.0 - cos).powi(5) * lobe * cos;
    let maps = [(WEIGHT, [0.2, 0.3, 0.4, weight as f32]), (TINT, [0.0, 0.0, 0.0, 1.0])];
    for seen in both(&mapped("color = [0, 0, 0]", &maps)) {
        assert!((seen / wanted - 1.0).abs().max_element() < 1e-4, "{seen}, by hand {wanted}");
    }
}
