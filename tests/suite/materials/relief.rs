//! Bump and normal maps: a flat normal map changes nothing; a tilted one and a bump map of a ramp
//! tilt the normal by a known angle, whatever the orientation of the coordinates.

use std::f64::consts::PI;

use glam::DVec2;
use moire::internal::texture::data::TextureData;

use super::{floats, scene};
use crate::stage;

/// A plane z = 0 seen from above and lit along `light` with E = π: its value is the cosine between the light
/// and the shading normal.
fn cosine(keys: &str, texture: TextureData, light: [f64; 3], mapping: &str) -> [f64; 2] {
    let text = format!(
        "camera = {{ eye = [0, 0, 3], look_at = [0, 0, 0], orthographic_height = 0.01 }}\n\
         image = {{ width = 1, height = 1 }}\nsampling = {{ pattern = 'center' }}\n\
         [[texture]]\nname = 't'\nfile = 't'\n[[sampler]]\nname = 's'\n\
         [[material]]\nname = 'm'\n{keys}\nsampler = 's'\nmapping = {{ kind = 'surface', {mapping} }}\n\
         [[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm'\n\
         [[light]]\nkind = 'directional'\ndirection = {light:?}\nirradiance = [{PI}, {PI}, {PI}]\n"
    );
    let packed = scene(&text, vec![texture]);
    [stage::render(&packed), stage::render_on_oracle(&packed)].map(|film| film.pixels[0][0].into())
}

#[test]
fn a_flat_normal_map_changes_nothing() {
    let flat = || floats(4, 4, |_, _| [0.5, 0.5, 1.0, 1.0]);
    for strength in [1.0, 7.0] {
        let keys = format!("normal_map = 't'\nstrength = {strength:?}");
        for value in cosine(&keys, flat(), [0.0, 0.6, 0.8], "offset = [0.4, 0.4]") {
            assert!((value - 0.8).abs() < 1e-6, "{value}"); // a few roundings
        }
    }
}

/// (3, 0, 4) / 5 as 2 rgb - 1: tilted towards growing u.
#[test]
fn a_normal_map_tilts_towards_growing_u_and_v() {
    let tilted = |x: f32, y: f32| floats(2, 2, move |_, _| [0.5 + 0.3 * x, 0.5 + 0.3 * y, 0.9, 1.0]);
    let expect = |map: [f32; 2], light: [f64; 3], mapping: &str, right: f64| {
        for value in cosine("normal_map = 't'", tilted(map[0], map[1]), light, mapping) {
            assert!((value - right).abs() < 1e-5, "{map:?} {light:?} {mapping}: {value}, by hand {right}");
        }
    };
    expect([1.0, 0.0], [0.6, 0.0, 0.8], "offset = [0.3, 0.3]", 1.0);
    expect([1.0, 0.0], [-0.6, 0.0, 0.8], "offset = [0.3, 0.3]", 0.28); // 0.64 - 0.36
    expect([0.0, 1.0], [0.0, 0.6, 0.8], "offset = [0.3, 0.3]", 1.0);
    // u grows towards -x, and u towards +y.
    expect([1.0, 0.0], [-0.6, 0.0, 0.8], "scale = [-1, 1]", 1.0);
    expect([1.0, 0.0], [0.0, 0.6, 0.8], "rotate = -90", 1.0);
    // Independently of the texture's scale.
    expect([1.0, 0.0], [0.6, 0.0, 0.8], "scale = [0.1, 10]", 1.0);
}

/// The same tilt if green points the other way: u is unchanged, v is reversed.
#[test]
fn green_downwards_reverses_v_alone() {
    let tilted = |x: f32, y: f32| floats(2, 2, move |_, _| [0.5 + 0.3 * x, 0.5 + 0.3 * y, 0.9, 1.0]);
    let expect = |green: &str, map: [f32; 2], light: [f64; 3], mapping: &str, right: f64| {
        let keys = format!("normal_map = 't'\ngreen = '{green}'");
        for value in cosine(&keys, tilted(map[0], map[1]), light, mapping) {
            assert!(
                (value - right).abs() < 1e-5,
                "{green} {map:?} {light:?} {mapping}: {value}, by hand {right}"
            );
        }
    };
    expect("up", [0.0, 1.0], [0.0, 0.6, 0.8], "offset = [0.3, 0.3]", 1.0);
    expect("down", [0.0, 1.0], [0.0, -0.6, 0.8], "offset = [0.3, 0.3]", 1.0);
    expect("down", [0.0, 1.0], [0.0, 0.6, 0.8], "offset = [0.3, 0.3]", 0.28); // 0.64 - 0.36
    expect("down", [1.0, 0.0], [0.6, 0.0, 0.8], "offset = [0.3, 0.3]", 1.0);
    // v grows towards -y: green is upwards in the picture, in which v points down.
    expect("down", [0.0, 1.0], [0.0, 0.6, 0.8], "scale = [1, -1]", 1.0);
}

/// Heights k / 16 over 16 texels a unit of u: a slope of 1 a unit of u, times strength and scale.
#[test]
fn a_ramp_of_heights_tilts_by_its_slope() {
    let along_u = || floats(16, 4, |x, _| [x as f32 / 16.0; 4]);
    let along_v = || floats(4, 16, |_, y| [y as f32 / 16.0; 4]);
    let tan_30 = 1.0 / 3f64.sqrt();
    let cases: [(TextureData, DVec2, f64, &str); 4] = [
        (along_u(), DVec2::X, tan_30, "offset = [0.5, 0.5]"),
        (along_v(), DVec2::Y, tan_30, "offset = [0.5, 0.5]"),
        (along_u(), DVec2::X, tan_30 / 2.0, "scale = [2, 1], offset = [0.5, 0.5]"),
        // u runs along +y: rotated by -90 degrees u' = v.
        (along_u(), DVec2::Y, tan_30, "rotate = -90, offset = [0.5, 0.5]"),
    ];
    for (texture, up, strength, mapping) in cases {
        let keys = format!("bump_map = 't'\nstrength = {strength:?}");
        // Heights grow along `up`: the normal leans back by 30 degrees.
        let back = [-0.5 * up.x, -0.5 * up.y, 0.75f64.sqrt()];
        for value in cosine(&keys, texture.clone(), back, mapping) {
            assert!((value - 1.0).abs() < 1e-5, "{mapping}: {value}");
        }
        for value in cosine(&keys, texture, [0.0, 0.0, 1.0], mapping) {
            assert!((value - 0.75f64.sqrt()).abs() < 1e-5, "{mapping}: {value}, cos 30° expected");
        }
    }
}
