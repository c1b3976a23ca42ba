//! Rays of the camera: w + r·X·T·(width/height) + u·Y·T, with r, u and w of unit length and exact.

use glam::{DVec2, Vec2Swizzles};
use moire::internal::lab::verify::queries::Rng;
use moire::internal::oracle::camera::{Ray, camera_ray};
use moire::internal::scene::model::{Projection, Scene};
use moire::internal::schema::layout::Header;

use super::numbers::{Q, V, approx, degrees, frac, q, tan, v};
use super::scenes::packed_as;
use super::{U, Worst};

/// (camera, width, height): ordinary, far from the origin, close to its target, steeply up, with narrow and
/// wide angles, other projections, long and thin pictures.
const VIEWS: [(&str, u32, u32); 12] = [
    ("eye = [2.0, 1.5, 2.0]\nlook_at = [0.0, 0.5, 0.0]\nvertical_fov = 53.13", 512, 512),
    ("eye = [1e9, 0.3, -7e8]\nlook_at = [1e9, 0.7, -7.1e8]\nvertical_fov = 40", 640, 360),
    ("eye = [0.1, 0.2, 0.3]\nlook_at = [0.100001, 0.2000007, 0.3]\nvertical_fov = 60", 64, 48),
    ("eye = [0, 5, 0]\nlook_at = [0, 0, 1e-6]\nvertical_fov = 60", 64, 48),
    ("eye = [0, 5, 0]\nlook_at = [3, 0, 1]\nup = [-3, 5.0001, -1]\nvertical_fov = 60", 48, 64),
    ("eye = [0, 0, 0]\nlook_at = [0.3, -0.4, -1]\nvertical_fov = 1e-6", 64, 48),
    ("eye = [0, 0, 0]\nlook_at = [0.3, -0.4, -1]\nvertical_fov = 179.9999", 64, 48),
    ("eye = [1, 2, 3]\nlook_at = [0, 0, 0]\ncamera_constant = 1e-3", 3, 7),
    ("eye = [1, 2, 3]\nlook_at = [0, 0, 0]\ncamera_constant = 1234.5", 1, 1),
    ("eye = [1, 2, 3]\nlook_at = [0, 0, 0]\northographic_height = 1e-9", 100, 10),
    ("eye = [1, 2, 3]\nlook_at = [0, 0, 0]\northographic_height = 7e9", 33, 77),
    ("eye = [1, 2, 3]\nlook_at = [0, 0, 0]\nvertical_fov = 90", 16384, 1),
];

struct Exact {
    origin: V,
    direction: V,
    /// Returns the first-order errors of origin and direction, by component.
    bounds: [f64; 2],
}

fn exact_ray(scene: &Scene, pixel: [u32; 2], inside: DVec2) -> Exact {
    let c = &scene.camera;
    let w = v(c.look_at).minus(&v(c.eye)).unit();
    let across = w.cross(&v(c.up));
    let r = across.unit();
    let u = r.cross(&w);
    let side = |i: usize, size: u32| {
        frac(2, 1) * (frac(pixel[i].into(), 1) + q(inside[i])) / frac(size.into(), 1) - frac(1, 1)
    };
    let (x, y) = (side(0, scene.width), -side(1, scene.height));
    let aspect = frac(scene.width.into(), scene.height.into());
    // Relative errors of T: of 2 products before the tangent, times its condition x (1 + T²) / T, and its ulp.
    let (t, t_error) = match c.projection {
        Projection::VerticalFov(fov) => {
            let half = degrees(fov) / frac(2, 1);
            let t = tan(&half);
            let condition = approx(&half) * (approx(&t) + 1.0 / approx(&t));
            (t, 2.0 * condition + 2.0)
        }
        Projection::CameraConstant(constant) => (frac(1, 2) / q(constant), 1.0),
        Projection::Orthographic(height) => (q(height) / frac(2, 1), 1.0),
    };
    let point = r.times(&(x * &t * aspect)).plus(&u.times(&(y * &t)));
    let sine = approx(&across.length()) / c.up.length();
    // A unit vector has 4 roundings; r two more and w's, over the sine; u both; 4 of place, step and product.
    let aside = U * approx(&point.length()) * (10.0 / sine + t_error + 10.0);
    let ahead = 4.0 * U;
    match c.projection {
        Projection::Orthographic(_) => Exact { origin: point, direction: w, bounds: [aside, ahead] },
        _ => {
            let length = approx(&point.length());
            let sum = U * (1.0 + length);
            let origin = V([0, 0, 0].map(|n| frac(n, 1)));
            Exact { origin, direction: w.plus(&point), bounds: [0.0, aside + ahead + sum] }
        }
    }
}

fn compare(shoot: impl Fn(&Header, [u32; 2], DVec2) -> Ray) -> Worst {
    let mut worst = Worst::default();
    let mut rng = Rng::new(11);
    for (camera, width, height) in VIEWS {
        let rest = format!("[image]\nwidth = {width}\nheight = {height}\n[sampling]\nprecision = 'double'\n");
        let (scene, packed) = packed_as(&format!("[camera]\n{camera}\n"), &rest);
        for i in 0..12 {
            let pixel = match i {
                0 => [0, 0],
                1 => [width - 1, height - 1],
                _ => [(rng.unit() * f64::from(width)) as u32, (rng.unit() * f64::from(height)) as u32],
            };
            let inside = if i < 4 { DVec2::splat(0.5) } else { DVec2::new(rng.unit(), rng.unit()) };
            let exact = exact_ray(&scene, pixel, inside);
            let ray = shoot(&packed.header, pixel, inside);
            for k in 0..3 {
                worst.add(ray.origin[k], &exact.origin.0[k], exact.bounds[0]);
                worst.add(ray.direction[k], &exact.direction.0[k], exact.bounds[1]);
            }
        }
    }
    worst
}

#[test]
fn rays_of_the_camera_are_exact_to_their_condition() {
    compare(camera_ray).holds("camera rays");
}

#[test]
fn planted_errors_of_the_camera_are_told() {
    compare(|h, p, i| camera_ray(h, p, i + 1e-9)).fails("a billionth of a pixel");
    compare(|h, p, i| camera_ray(h, p, i.yx())).fails("swapped axes");
    compare(|h, p, i| camera_ray(h, p, DVec2::new(i.x, 1.0 - i.y))).fails("y upwards");
    let sideways = |h: &Header, p, i| {
        let turned = Header { step_x: h.step_x.map(|x| -x), ..*h };
        camera_ray(&turned, p, i)
    };
    compare(sideways).fails("a left-handed camera");
}

/// The exact answers are for the numbers in the scene's file.
#[test]
fn the_scene_file_keeps_every_bit_of_its_numbers() {
    let eye = glam::DVec3::new(0.1 + 1e9, 1.0 / 3.0, -1e-17);
    let (scene, packed) = super::scenes::packed(&super::scenes::from(eye));
    assert_eq!(scene.camera.eye.to_array().map(f64::to_bits), eye.to_array().map(f64::to_bits));
    let forward: [Q; 3] = std::array::from_fn(|i| q(packed.header.forward[i]));
    assert_eq!(forward.map(|x| approx(&x)), [0.0, 0.0, -1.0]);
}
