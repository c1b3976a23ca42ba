//! Volumes: a stack of numbered slices that shows order and orientation of the three axes; and an
//! onion, shells of density about an axis that is not the volume's, as an NRRD file.

use super::lettering::text;
use super::{Asset, mix, noise, rgb, supersampled, to_byte};

/// Returns the slices: slice k is at w = (k + ½) / 6, from blue to orange.
pub(super) fn slices() -> Vec<Asset> {
    const SLICES: [(&str, &str); 6] = [
        ("slices/0.png", "0"),
        ("slices/1.png", "1"),
        ("slices/2.png", "2"),
        ("slices/3.png", "3"),
        ("slices/4.png", "4"),
        ("slices/5.png", "5"),
    ];
    let slice = |(k, (path, digit)): (usize, (&'static str, &str))| {
        let ground = mix(rgb(60, 110, 220), rgb(245, 170, 60), k as f64 / 5.0);
        let image = supersampled(48, 48, 2, |x, y| {
            let edge = x.min(y).min(48.0 - x).min(48.0 - y);
            if edge < 2.0 || text(digit, x, y, (14.0, 10.0), 4.0) { rgb(20, 24, 40) } else { ground }
        });
        Asset { path, image: image.into() }
    };
    SLICES.into_iter().enumerate().map(slice).collect()
}

const ONION: u32 = 40;

/// Returns 8-bit grey shells of growing width from the core outwards, with air (0) outside.
pub(super) fn onion() -> Vec<u8> {
    let header =
        format!("NRRD0004\ntype: uint8\ndimension: 3\nsizes: {ONION} {ONION} {ONION}\nencoding: raw\n\n");
    let place = |a: u32| 2.0 * (f64::from(a) + 0.5) / f64::from(ONION) - 1.0;
    let mut bytes = header.into_bytes();
    for k in 0..ONION {
        for j in 0..ONION {
            for i in 0..ONION {
                bytes.push(to_byte(density(place(i), place(j), place(k))));
            }
        }
    }
    bytes
}

fn density(x: f64, y: f64, z: f64) -> f64 {
    // The core is off centre, and the shells are compressed towards the top.
    let (x, y, z) = (x - 0.12, y * 1.1, z + 0.08);
    let r = (x * x + y * y + z * z).sqrt();
    if r > 0.85 {
        return 0.0;
    }
    let wobble = 0.04 * noise(0x6f6e_696f, 3, 0.5 * x + 0.5, 0.5 * z + 0.5);
    let shell = 7.0 * (r + wobble);
    let t = shell - shell.floor();
    if r < 0.1 { 1.0 } else { 0.35 + 0.5 * t * t }
}
