//! Every layer on the device against the oracle, for all kinds of shapes, maps and textures; and that pipelines of
//! ordinary pictures know nothing of layers.

use moire::internal::core::layer::Layer;
use moire::internal::pack::features::Features;
use moire::internal::render::On;
use moire::internal::render::layers::Aov;
use moire::internal::scene::model::{Pattern, Quantity};
use moire::internal::scene::prune::prune;

use super::layers;
use crate::stage::{device_name, packed, small};

/// Layers of one ray a pixel, or of few samples.
const WANTED: &[Aov] = &[
    Aov::Texels,
    Aov::Magnification,
    Aov::Level,
    Aov::Anisotropy,
    Aov::Uv,
    Aov::Normal,
    Aov::Depth,
    Aov::Instance,
    Aov::Material,
    Aov::Albedo,
    Aov::Surfaces,
];

/// Share of pixels whose first channels differ by more than rounding: rays on the other side of an edge or a seam.
fn apart(a: &Layer, b: &Layer) -> f64 {
    let pixels = a.present.len();
    let differs = |i: usize| {
        let far = |(a, b): (f32, f32)| (a - b).abs() > 2e-3 * a.abs().max(b.abs()).max(1.0);
        let values = a.channels.iter().zip(&b.channels).map(|(a, b)| (a.values[i], b.values[i]));
        a.present[i] != b.present[i] || values.into_iter().any(far)
    };
    (0..pixels).filter(|&i| differs(i)).count() as f64 / pixels as f64
}

fn agrees(name: &str, share: f64) {
    let mut scene = small(name, 40, 4);
    prune(&mut scene);
    let device = On::parse(&device_name()).unwrap();
    let [found, wanted] = [device, On::Oracle].map(|on| layers(&scene, on, WANTED));
    for (found, wanted) in found.iter().zip(&wanted) {
        assert_eq!(found.name, wanted.name);
        let apart = apart(found, wanted);
        assert!(apart <= share, "{name}, {}: {apart:.4} of the pixels differ", found.name);
    }
}

#[test]
fn device_and_oracle_agree_on_planes_spheres_and_triangles() {
    agrees("lecture", 0.01);
}

#[test]
fn device_and_oracle_agree_on_every_mapping() {
    // At poles and seams footprints change from pixel to pixel.
    agrees("mappings", 0.05);
}

#[test]
fn device_and_oracle_agree_on_every_filter() {
    agrees("filters", 0.02);
}

#[test]
fn device_and_oracle_agree_on_meshes() {
    agrees("meshes", 0.02);
}

#[test]
fn device_and_oracle_agree_on_discs() {
    agrees("discs", 0.02);
}

#[test]
fn device_and_oracle_agree_on_environments_of_cubes() {
    agrees("environment_cube", 0.02);
}

#[test]
fn device_and_oracle_agree_on_bump_maps() {
    agrees("normal", 0.02);
}

#[test]
fn device_and_oracle_agree_on_what_moves_and_is_out_of_focus() {
    agrees("motion", 0.02);
    agrees("lens", 0.02);
}

#[test]
fn a_planted_difference_is_seen() {
    let layer = |values: [f32; 2], present: [bool; 2]| Layer {
        name: "x",
        channels: vec![moire::internal::core::layer::Channel { name: "Y", values: values.into() }],
        present: present.into(),
    };
    let one = layer([1.0, 2.0], [true; 2]);
    assert_eq!(apart(&one, &one), 0.0);
    assert_eq!(apart(&one, &layer([1.0, 2.01], [true; 2])), 0.5);
    assert_eq!(apart(&one, &layer([1.0, 2.0], [true, false])), 0.5);
}

#[test]
fn pipelines_of_pictures_measure_radiance_alone_and_others_never_radiance() {
    let radiance = 1 << Quantity::Radiance as u32;
    for &quantity in Quantity::ALL {
        let mut scene = small("lecture", 8, 1);
        scene.sampling.pattern = Pattern::Center;
        scene.sampling.quantity = quantity;
        for everything in [false, true] {
            let mask = Features::new(&packed(scene.clone(), None), false, everything).quantities;
            assert!(mask >> quantity as u32 & 1 == 1, "{quantity}: {mask:b}");
            assert_eq!(mask & radiance != 0, quantity == Quantity::Radiance, "{quantity}: {mask:b}");
            assert!(quantity != Quantity::Radiance || mask == radiance, "{mask:b}");
        }
    }
}
