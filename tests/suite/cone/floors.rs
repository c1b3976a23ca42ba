//! Cones that leave flat surfaces, as reflections or towards a light: shapes behind the surface are
//! not hit, and shapes standing on it are hit down to their base.

use moire::internal::core::film::Film;
use moire::internal::scene::model::Scene;

use super::{central, exact_film, film, parallel, with_samples};

fn by_device_and_oracle(scene: Scene) -> [(Film, &'static str); 2] {
    [(film(scene.clone()), "device"), (exact_film(scene), "oracle")]
}

const GROUND: &str = "
[[plane]]\norigin = [0, -0.4, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0.1, -1]\nmaterial = 'ground'
[[material]]\nname = 'red'\nmodel = 'unlit'\ncolor = [1, 0, 0]\n";

/// Blades below a ground that fills the picture, up to just beneath it, across all directions in which rays leave it.
fn blades() -> String {
    let blade = |k: i32| {
        let x = 0.1 * f64::from(k);
        format!(
            "[[triangle]]\nvertices = [[{x}, -0.9, 2], [{x}, -1.3, -4], [{}, -0.45, 0]]\nmaterial = 'red'\n",
            x + 0.05
        )
    };
    (-9..9).map(blade).collect()
}

fn from_above(scene: &mut Scene) {
    scene.camera.eye = glam::DVec3::new(0.2, 0.5, 1.5);
    scene.camera.look_at = glam::DVec3::new(0.0, -0.5, 0.0);
}

#[test]
fn what_lies_behind_a_mirror_is_not_in_its_reflection() {
    let text = format!("{GROUND}{}[[material]]\nname = 'ground'\nmodel = 'mirror'\n", blades());
    for mut scene in [parallel(12, &text), central(12, &text)] {
        from_above(&mut scene);
        scene.background.color = glam::DVec3::new(0.0, 1.0, 0.0);
        for (film, who) in by_device_and_oracle(scene) {
            let off = film.pixels.iter().map(|p| p[0].max((p[1] - 1.0).abs())).fold(0.0, f32::max);
            assert!(off < 1e-4, "{who}: {off} of red");
        }
    }
}

#[test]
fn what_lies_behind_a_surface_keeps_no_light_from_it() {
    let light = "[[light]]\nkind = 'directional'\ndirection = [1, 0.2, 0.3]\nirradiance = [9, 9, 9]
[[material]]\nname = 'ground'\nmodel = 'lambert'\n";
    let lit = |more: &str| {
        let text = format!("{GROUND}{light}{more}");
        let mut scene = central(12, &text);
        from_above(&mut scene);
        by_device_and_oracle(scene)
    };
    for ((with, who), (without, _)) in lit(&blades()).into_iter().zip(lit("")) {
        for (a, b) in with.pixels.iter().zip(&without.pixels) {
            assert!(b[0] > 0.1 && (a[0] - b[0]).abs() < 1e-4 * b[0], "{who}: {a:?} in place of {b:?}");
        }
    }
}

/// A wall that ends at a mirror: no light passes between the two.
#[test]
fn what_stands_on_a_mirror_is_mirrored_down_to_its_foot() {
    let wall =
        "[[plane]]\norigin = [0, 0, -1]\ntangent = [1, 0, 0.3]\nbitangent = [0, 1, 0]\nmaterial = 'white'
[[material]]\nname = 'ground'\nmodel = 'mirror'\n";
    let mut scene = central(24, &format!("{GROUND}{wall}"));
    from_above(&mut scene);
    scene.background.color = glam::DVec3::ZERO;
    for (film, who) in by_device_and_oracle(scene.clone()) {
        let truth = super::film(with_samples(scene.clone(), 1024));
        let off = film.pixels.iter().zip(&truth.pixels).map(|(p, q)| (p[0] - q[0]).abs()).fold(0.0, f32::max);
        assert!(off < 1e-3, "{who}: {off}");
    }
}

/// Two coplanar triangles do not appear in each other's reflection or shadow, whatever the rounding.
#[test]
fn triangles_in_one_plane_do_not_see_each_other() {
    let quad = |material: &str| {
        format!(
            "[[triangle]]\nvertices = [[-3, -2.9, 0.1], [3, -3.1, 0.4], [3, 3, 1.03]]\nmaterial = 'side'
[[triangle]]\nvertices = [[-3, -2.9, 0.1], [3, 3, 1.03], [-3, 3.2, 0.73]]\nmaterial = 'side'
[background]\ncolor = [1, 1, 1]\n[[material]]\nname = 'side'\ncolor = [0.5, 0.5, 0.5]\n{material}"
        )
    };
    let mirror = "model = 'mirror'\n";
    let lit = "model = 'lambert'
[[light]]\nkind = 'directional'\ndirection = [1, 0.3, 0.2]\nirradiance = [9, 9, 9]\n";
    for material in [mirror, lit] {
        for scene in [parallel(24, &quad(material)), central(24, &quad(material))] {
            for (film, who) in by_device_and_oracle(scene) {
                let first = film.pixels[0][0];
                let off = film.pixels.iter().map(|p| (p[0] - first).abs()).fold(0.0, f32::max);
                // Reflections below 1/1024 are dropped.
                assert!(first > 0.1 && off < 1e-3, "{who}, {material}: {off} of {first}");
            }
        }
    }
}
