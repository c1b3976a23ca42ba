//! `dielectric`: Fresnel reflectance, Snell's angle, total internal reflection, and the mean of
//! many samples, which is the reflectance-weighted mean of reflection and transmission.

use glam::DVec3;
use moire::internal::oracle::bsdf::dielectric::{fresnel_dielectric, refracted};

use super::scene;
use crate::stage;

const ROOT_3: f64 = 1.732_050_807_568_877_2;

/// The unit direction that meets the normal +z at this angle from in front.
fn meeting(degrees: f64) -> DVec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    DVec3::new(sin, 0.0, -cos)
}

#[test]
fn shares_of_fresnel_worked_out_by_hand() {
    let at = |degrees, ratio| fresnel_dielectric(meeting(degrees), DVec3::Z, ratio);
    // ((n - 1) / (n + 1))² = 1/25 at right angles, from either side.
    assert!((at(0.0, 1.0 / 1.5) - 0.04).abs() < 1e-15);
    assert!((at(0.0, 1.5) - 0.04).abs() < 1e-15);
    // n = √3: 60° is Brewster's angle, refracted to 30°: p is 0 and s is ((1/2 - √3 √3/2) / (1/2 + √3 √3/2))² = 1/4.
    assert!((at(60.0, 1.0 / ROOT_3) - 0.125).abs() < 1e-12);
    // And the way back: 30° inside.
    assert!((at(30.0, ROOT_3) - 0.125).abs() < 1e-12);
    // n = 1.5 at 45°: refracted to cos t = √7 / 3; the two polarisations by themselves.
    let (ci, ct) = (0.5f64.sqrt(), 7f64.sqrt() / 3.0);
    let s = ((ci - 1.5 * ct) / (ci + 1.5 * ct)).powi(2);
    let p = ((1.5 * ci - ct) / (1.5 * ci + ct)).powi(2);
    assert!((at(45.0, 1.0 / 1.5) - 0.5 * (s + p)).abs() < 1e-12);
    assert!((at(45.0, 1.0 / 1.5) - 0.050_240).abs() < 1e-6);
    // No reflection if both sides are equal; total reflection at grazing angles.
    assert!(at(50.0, 1.0).abs() < 1e-15);
    assert!(at(90.0, 1.0 / 1.5) > 0.999_999);
}

#[test]
fn the_critical_angle_divides_refraction_from_total_reflection() {
    let critical = (1.0f64 / 1.5).asin().to_degrees();
    assert_eq!(fresnel_dielectric(meeting(critical + 1e-3), DVec3::Z, 1.5), 1.0);
    assert!(fresnel_dielectric(meeting(critical - 1.0), DVec3::Z, 1.5) < 0.5);
}

#[test]
fn directions_follow_snell_and_keep_their_length() {
    let straight = refracted(meeting(0.0), DVec3::Z, 1.0 / 1.5);
    assert!(straight.distance(-DVec3::Z) < 1e-15);
    // sin 60° / √3 = 1/2.
    let bent = refracted(2.0 * meeting(60.0), DVec3::Z, 1.0 / ROOT_3);
    assert!(bent.distance(2.0 * meeting(30.0)) < 1e-12, "{bent}");
    let back = refracted(meeting(30.0), DVec3::Z, ROOT_3);
    assert!(back.distance(meeting(60.0)) < 1e-12, "{back}");
}

/// Parallel rays that meet the plane z = 0 at an angle, from either side; the reflected world is red, the world behind
/// is green.
fn pane(degrees: f64, side: f64, spp: u32) -> String {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let eye = [-3.0 * sin, 0.0, 3.0 * cos * side];
    format!(
        "camera = {{ eye = {eye:?}, look_at = [0, 0, 0], up = [0, 1, 0], orthographic_height = 0.1 }}\n\
         image = {{ width = 4, height = 4 }}\nsampling = {{ pattern = 'random', spp = {spp} }}\n\
         [[material]]\nname = 'glass'\nmodel = 'dielectric'\nior = 1.5\n\
         [[material]]\nname = 'red'\nmodel = 'unlit'\ncolor = [1, 0, 0]\n\
         [[material]]\nname = 'green'\nmodel = 'unlit'\ncolor = [0, 1, 0]\n\
         [[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'glass'\n\
         [[plane]]\norigin = [0, 0, {}]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'red'\n\
         [[plane]]\norigin = [0, 0, {}]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'green'\n",
        5.0 * side,
        -5.0 * side,
    )
}

#[test]
fn means_of_many_samples_are_the_shares_on_device_and_oracle() {
    const SAMPLES: u32 = 4096;
    for (degrees, side, ratio) in
        [(0.0, 1.0, 1.0 / 1.5), (45.0, 1.0, 1.0 / 1.5), (75.0, 1.0, 1.0 / 1.5), (35.0, -1.0, 1.5)]
    {
        let packed = scene(&pane(degrees, side, SAMPLES), Vec::new());
        let right = fresnel_dielectric(meeting(degrees), DVec3::Z, ratio);
        let count = f64::from(SAMPLES) * 16.0;
        let sigma = (right * (1.0 - right) / count).sqrt();
        for (film, who) in [(stage::render(&packed), "device"), (stage::render_on_oracle(&packed), "oracle")]
        {
            let sum =
                film.pixels.iter().fold(DVec3::ZERO, |sum, p| sum + glam::Vec3::from_array(*p).as_dvec3());
            let mean = sum / 16.0;
            // Noise of random choices, 5 sigma; light that is not reflected is transmitted.
            assert!(
                (mean.x - right).abs() < 5.0 * sigma,
                "{who}, {degrees}°: {mean}, share {right}, sigma {sigma}"
            );
            assert!((mean.x + mean.y - 1.0).abs() < 1e-6 && mean.z == 0.0, "{who}, {degrees}°: {mean}");
        }
    }
}

#[test]
fn beyond_the_critical_angle_every_sample_is_mirrored() {
    let packed = scene(&pane(50.0, -1.0, 64), Vec::new());
    for film in [stage::render(&packed), stage::render_on_oracle(&packed)] {
        assert!(film.pixels.iter().all(|p| *p == [1.0, 0.0, 0.0]), "{:?}", film.pixels);
    }
}
