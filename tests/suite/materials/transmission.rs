//! Light through bodies of `metallic-roughness` (KHR_materials_transmission): of a background of one colour the share that
//! factor and texture say, by Snell's way, in place of diffuse light and beside the same highlight; white bodies keep all.

use glam::DVec3;
use moire::internal::pack::PackedScene;

use super::physical::{WHITE_SKY, both, mean, plane};
use super::{floats, scene};
use crate::stage;

const BACKGROUND: DVec3 = DVec3::new(0.2, 0.4, 0.8);
const BEFORE: &str = "[background]\ncolor = [0.2, 0.4, 0.8]\n";
const COLOR: DVec3 = DVec3::new(0.9, 0.6, 0.3);
const COLORED: &str = "model = 'metallic-roughness'\ncolor = [0.9, 0.6, 0.3]";

fn assert_seen(packed: &PackedScene, wanted: DVec3, tolerance: f64, what: &str) {
    for seen in both(packed) {
        assert!((seen - wanted).abs().max_element() <= tolerance, "{what}: {seen}, by hand {wanted}");
    }
}

/// A plane whose texture of transmission has these texels along u, before the background.
fn textured(samples: u32, keys: &str, texels: &[f32]) -> PackedScene {
    let material = format!("{COLORED}\nsampler = 's'\ntransmission_texture = 't'\n{keys}");
    let rest = "[[sampler]]\nname = 's'\nfilter = 'nearest'\n[[texture]]\nname = 't'\nfile = 't.exr'\n";
    // No channel but red counts.
    let texture = floats(texels.len() as u32, 1, |x, _| [texels[x as usize], 0.9, 0.1, 0.7]);
    scene(&plane(30.0, samples, &material, &format!("{BEFORE}{rest}")), vec![texture])
}

/// Nothing is mirrored: the half of the light that is scattered meets no light, the other one is the background's.
#[test]
fn half_a_texel_lets_half_of_the_background_through() {
    let packed = textured(16, "specular_weight = 0", &[0.5]);
    assert_seen(&packed, 0.5 * COLOR * BACKGROUND, 1e-6, "texture alone");
    let packed = textured(16, "specular_weight = 0\ntransmission = 0.5", &[0.5]);
    assert_seen(&packed, 0.25 * COLOR * BACKGROUND, 1e-6, "times its factor");
    let packed = textured(16, "specular_weight = 0", &[0.0]);
    assert_seen(&packed, DVec3::ZERO, 0.0, "none");
}

#[test]
fn each_texel_has_its_own_share() {
    let mut packed = textured(1, "specular_weight = 0", &[0.25, 0.75]);
    // The picture shows a texture's width: both texels.
    packed.header.step_x *= 100.0;
    let film = stage::render(&packed);
    let shares: Vec<f64> = film.pixels.iter().map(|p| f64::from(p[0]) / (COLOR.x * BACKGROUND.x)).collect();
    for share in [0.25, 0.75] {
        assert_eq!(shares.iter().filter(|seen| (*seen - share).abs() < 1e-5).count(), 8, "{shares:?}");
    }
}

/// What the surface mirrors is the background as well, Schlick's share of it at 30°, in white; the body has the rest, a
/// metal nothing.
#[test]
fn the_surface_mirrors_before_the_body_lets_light_through() {
    let mirrored = 0.04 + 0.96 * (1.0 - 30f64.to_radians().cos()).powi(5);
    let body = BACKGROUND * (mirrored + 0.5 * COLOR * (1.0 - mirrored));
    assert_seen(&textured(256, "", &[0.5]), body, 4e-3, "body");
    let metal = BACKGROUND * COLOR;
    assert_seen(&textured(256, "metallic = 0.75", &[0.5]), 0.25 * body + 0.75 * metal, 4e-3, "alloy");
    assert_seen(&textured(256, "metallic = 1", &[1.0]), metal, 4e-3, "metal");
}

/// Where nothing passes, the picture is the one without the keys, to the bit.
#[test]
fn no_transmission_and_metals_change_no_bit() {
    let lit = format!(
        "{WHITE_SKY}[[light]]\nkind = 'directional'\ndirection = [1, 1, 2]\nirradiance = [1, 2, 3]\n"
    );
    let film = |keys: &str| {
        let material = format!("{COLORED}\nroughness = 0.4\n{keys}");
        stage::render(&scene(&plane(50.0, 16, &material, &lit), Vec::new()))
    };
    assert_eq!(film("transmission = 0").pixels, film("").pixels);
    let [metal, other] = ["", "\ntransmission = 0.9"].map(|more| mean(&film(&format!("metallic = 1{more}"))));
    assert!((metal - other).abs().max_element() < 1e-6, "{metal} {other}");
}

#[test]
fn a_white_furnace_stays_white() {
    for transmission in [0.3, 1.0] {
        for (metallic, roughness) in [(0.0, 0.0), (0.5, 0.0), (0.0, 0.2)] {
            for degrees in [0.0, 50.0, 80.0] {
                let material = format!(
                    "model = 'metallic-roughness'\ntransmission = {transmission}\nmetallic = {metallic}\n\
                     roughness = {roughness}"
                );
                let seen = both(&scene(&plane(degrees, 256, &material, WHITE_SKY), Vec::new()));
                for seen in seen {
                    let error = (seen - 1.0).abs().max_element();
                    assert!(error < 0.01, "{transmission}, {metallic}, {roughness}, {degrees}°: {seen}");
                }
            }
        }
    }
}

/// A ball in the furnace: in by one surface and out by another, with what each mirrors.
#[test]
fn a_white_ball_cannot_be_seen_in_a_white_furnace() {
    let text = |transmission: f64| {
        format!(
            "camera = {{ eye = [0, 0, 5], look_at = [0, 0, 0], orthographic_height = 1.9 }}\n\
             image = {{ width = 8, height = 8 }}\n\
             sampling = {{ pattern = 'sobol-owen', spp = 256, max_depth = 24 }}\n\
             [[material]]\nname = 'm'\nmodel = 'metallic-roughness'\ntransmission = {transmission}\n\
             [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'm'\n{WHITE_SKY}"
        )
    };
    for seen in both(&scene(&text(1.0), Vec::new())) {
        assert!((seen - 1.0).abs().max_element() < 0.01, "{seen}");
    }
}

/// Rough and smooth balls over a checker, under a sky that lights: pixel by pixel the same samples.
#[test]
fn device_and_oracle_let_the_same_light_through() {
    for roughness in [0.0, 0.4] {
        let text = format!(
            "camera = {{ eye = [0, 1, 5], look_at = [0, 0.3, 0], vertical_fov = 40 }}\n\
             image = {{ width = 24, height = 18 }}\nsampling = {{ pattern = 'sobol-owen', spp = 16 }}\n\
             [[texture]]\nname = 't'\nfile = 't.exr'\n[[sampler]]\nname = 's'\nfilter = 'nearest'\n\
             [[material]]\nname = 'floor'\ntexture = 't'\nsampler = 's'\n\
             [[material]]\nname = 'ball'\nmodel = 'metallic-roughness'\nroughness = {roughness}\ncolor = [1, 0.8, 0.6]\n\
             sampler = 's'\ntransmission_texture = 't'\n\
             [[plane]]\norigin = [0, -0.5, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, 1]\nmaterial = 'floor'\n\
             [[sphere]]\ncenter = [0, 0.4, 0]\nradius = 0.9\nmaterial = 'ball'\n{WHITE_SKY}\
             [[light]]\nkind = 'point'\nposition = [2, 4, 3]\nintensity = [40, 30, 30]\n"
        );
        let checker = floats(2, 2, |x, y| if x == y { [0.9, 0.9, 0.9, 1.0] } else { [0.2, 0.3, 0.1, 1.0] });
        let packed = scene(&text, vec![checker]);
        let [device, oracle] = [stage::render(&packed), stage::render_on_oracle(&packed)];
        let differs =
            |(a, b): &(&[f32; 3], &[f32; 3])| (0..3).any(|i| (a[i] - b[i]).abs() > 1e-3 * b[i].max(1.0));
        let apart = device.pixels.iter().zip(&oracle.pixels).filter(differs).count();
        // Rays at the edge of a texel, or of a choice, fall to its other side.
        assert!(apart <= 22, "roughness {roughness}: {apart} of 432 pixels differ");
        let off = (mean(&device) - mean(&oracle)).abs().max_element();
        assert!(off < 2e-3, "roughness {roughness}: the means differ by {off}");
    }
}

/// Of light from a lamp the highlight is the same however much passes, and the diffuse part is what does not.
#[test]
fn a_lamp_lights_what_does_not_pass_and_the_highlight_stays() {
    let lamp =
        "[[light]]\nkind = 'directional'\ndirection = [-1.7320508075688772, 0, 1]\nirradiance = [1, 1, 1]";
    let seen = |keys: &str| {
        let material = format!("model = 'metallic-roughness'\nroughness = 0.5\n{keys}");
        both(&scene(&plane(60.0, 1, &material, lamp), Vec::new()))
    };
    let [none, half, all] =
        [0.0, 0.5, 1.0].map(|share| seen(&format!("color = [0.9, 0.6, 0.3]\ntransmission = {share}")));
    let highlight = seen("color = [0, 0, 0]");
    for i in 0..2 {
        assert!((all[i] - highlight[i]).abs().max_element() < 1e-6, "{} {}", all[i], highlight[i]);
        let between = 0.5 * (none[i] + all[i]);
        assert!((half[i] - between).abs().max_element() < 1e-6, "{} {between}", half[i]);
        assert!((none[i] - all[i]).min_element() > 0.02, "{} {}", none[i], all[i]);
    }
}

/// Behind the pane a wall at distance 1 whose red grows with x from -2 to 2; at 60° and index √3 the ray goes on at 30° and
/// meets it tan 30° further on. From the other side it would leave at more than 90°: it is mirrored as a whole.
#[test]
fn what_passes_is_bent_by_snell_or_mirrored_as_a_whole() {
    let behind = |ior: &str| {
        let pane =
            format!("model = 'metallic-roughness'\nspecular_weight = 0\ntransmission = 1\nior = {ior}");
        let wall = "[background]\ncolor = [0, 0.5, 0]\n[[sampler]]\nname = 's'\n\
                    [[texture]]\nname = 't'\nfile = 't.exr'\n\
                    [[material]]\nname = 'wall'\nmodel = 'unlit'\ntexture = 't'\nsampler = 's'\n\
                    [[plane]]\norigin = [-4, 0, -1]\ntangent = [8, 0, 0]\nbitangent = [0, 8, 0]\nmaterial = 'wall'\n";
        // Linear between the middles of two texels, which are at x = -2 and 2.
        let ramp = floats(2, 1, |x, _| [x as f32, 0.0, 0.0, 1.0]);
        scene(&plane(60.0, 4, &pane, wall), vec![ramp])
    };
    // The eye is at +x, so that the ray goes on towards -x.
    let met = 0.5 - 30f64.to_radians().tan() / 4.0;
    assert_seen(&behind("1.7320508075688772"), DVec3::new(met, 0.0, 0.0), 2e-3, "bent");
    let straight = 0.5 - 60f64.to_radians().tan() / 4.0;
    assert_seen(&behind("1"), DVec3::new(straight, 0.0, 0.0), 2e-3, "straight");
    assert_seen(&behind("0.8"), DVec3::new(0.0, 0.5, 0.0), 1e-6, "mirrored");
}
