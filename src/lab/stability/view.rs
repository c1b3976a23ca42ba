//! Rays and texture coordinates in f64 from the scene's own numbers, derived from the conventions
//! of the scene vocabulary and not from the renderer: the ray through the centre of a pixel, u = (x
//! − origin)·axis on a plane, and the expected result of a lookup in a texture of ramps.

use glam::{DVec2, DVec3};

use super::scenes::texture;
use crate::texture::data::{Dimension, TextureData};

/// A pinhole camera and its picture.
pub struct View {
    pub eye: DVec3,
    pub look_at: DVec3,
    pub up: DVec3,
    /// The vertical field of view in degrees.
    pub fov: f64,
    pub width: u32,
    pub height: u32,
}

impl View {
    /// Creates the view of a square picture.
    pub fn new(eye: DVec3, look_at: DVec3, up: DVec3, fov: f64, side: u32) -> View {
        View { eye, look_at, up, fov, width: side, height: side }
    }

    /// Returns the equivalent sections of a scene, with one sample at the centre of each pixel.
    pub fn text(&self) -> String {
        let v = |v: DVec3| format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z);
        format!(
            "[camera]\neye = {}\nlook_at = {}\nup = {}\nvertical_fov = {:?}\n[image]\nwidth = {}\nheight = {}\n",
            v(self.eye),
            v(self.look_at),
            v(self.up),
            self.fov,
            self.width,
            self.height
        )
    }

    /// Returns the directions right, up and ahead.
    pub fn axes(&self) -> [DVec3; 3] {
        let ahead = (self.look_at - self.eye).normalize();
        let right = ahead.cross(self.up).normalize();
        [right, right.cross(ahead), ahead]
    }

    /// Returns the direction through a position of the picture in pixels.
    pub fn direction(&self, position: DVec2) -> DVec3 {
        let [right, up, ahead] = self.axes();
        let size = DVec2::new(f64::from(self.width), f64::from(self.height));
        let (x, y) = (2.0 * position.x / size.x - 1.0, 1.0 - 2.0 * position.y / size.y);
        let half = (0.5 * self.fov.to_radians()).tan();
        ahead + right * (x * half * size.x / size.y) + up * (y * half)
    }

    /// Returns index, column and row, and centre of every pixel.
    pub fn pixels(&self) -> impl Iterator<Item = (usize, [u32; 2], DVec2)> {
        let width = self.width;
        (0..self.width * self.height).map(move |i| {
            let position = [i % width, i / width];
            (i as usize, position, DVec2::new(f64::from(position[0]) + 0.5, f64::from(position[1]) + 0.5))
        })
    }
}

/// The wrapping and filter with which a coordinate is read.
#[derive(Clone, Copy)]
pub struct Reading {
    pub mirrored: bool,
    pub linear: bool,
    pub size: [u32; 2],
}

impl Reading {
    /// All four combinations, each with its own texture size.
    pub const ALL: [Reading; 4] = [
        Reading { mirrored: false, linear: false, size: [1000, 37] },
        Reading { mirrored: false, linear: true, size: [1024, 256] },
        Reading { mirrored: true, linear: false, size: [1024, 64] },
        Reading { mirrored: true, linear: true, size: [300, 77] },
    ];

    /// Returns the sections of a scene with a plain material "m" that is read like this; `mapping`
    /// are further keys of the map.
    pub fn text(&self, mapping: &str) -> String {
        let address = if self.mirrored { "mirrored-repeat" } else { "repeat" };
        let filter = if self.linear { "linear" } else { "nearest" };
        format!(
            "[[texture]]\nname = \"t\"\nfile = \"t.exr\"\n\
             [[sampler]]\nname = \"s\"\naddress = \"{address}\"\nfilter = \"{filter}\"\n\
             [[material]]\nname = \"m\"\nmodel = \"unlit\"\ntexture = \"t\"\nsampler = \"s\"\nmapping = {{ {mapping} }}\n"
        )
    }

    pub fn name(&self) -> String {
        let address = if self.mirrored { "mirrored-repeat" } else { "repeat" };
        let filter = if self.linear { "linear" } else { "nearest" };
        format!("{address} {filter} {}×{}", self.size[0], self.size[1])
    }

    /// Returns a texture whose red grows along u and green along v: each texel encodes the position
    /// of its centre.
    pub fn ramps(&self) -> TextureData {
        let [width, height] = self.size;
        texture(Dimension::Two, [width, height, 1], |i| {
            let texel = i / 4;
            let (index, count) = if i % 4 == 0 { (texel % width, width) } else { (texel / width, height) };
            ((f64::from(index) + 0.5) / f64::from(count)) as f32
        })
    }

    /// Returns the error in texels of a lookup that returned this colour; `None` where the ramp
    /// jumps.
    pub fn texels_off(&self, found: [f32; 3], uv: DVec2) -> Option<f64> {
        if !found.iter().all(|x| x.is_finite()) {
            return Some(f64::INFINITY);
        }
        let axis = |found: f32, coordinate: f64, size: u32| {
            let wide = f64::from(size);
            let position = self.folded(coordinate) * wide;
            let read = f64::from(found) * wide;
            if !self.linear {
                // A texel extends half a texel to both sides of its centre.
                let around = |shift: f64| ((position - read + shift).abs() - 0.5).max(0.0);
                return Some(if self.mirrored {
                    around(0.0)
                } else {
                    around(0.0).min(around(wide)).min(around(-wide))
                });
            }
            let inside = position.clamp(0.5, wide - 0.5);
            (self.mirrored || inside == position).then(|| (read - inside).abs())
        };
        Some(axis(found[0], uv.x, self.size[0])?.max(axis(found[1], uv.y, self.size[1])?))
    }

    /// Wraps a coordinate into [0, 1].
    fn folded(&self, coordinate: f64) -> f64 {
        let half = 0.5 * coordinate;
        match self.mirrored {
            false => coordinate - coordinate.floor(),
            true => 1.0 - (2.0 * (half - half.floor()) - 1.0).abs(),
        }
    }
}

/// Returns the coordinate of a ray's hit on the plane, in tangents and bitangents, relative to that
/// of the eye; `None` beyond the horizon.
pub fn on_plane(
    eye: DVec3,
    direction: DVec3,
    [origin, tangent, bitangent]: [DVec3; 3],
) -> Option<[DVec2; 2]> {
    let normal = tangent.cross(bitangent);
    let t = normal.dot(origin - eye) / normal.dot(direction);
    // p × b = u t × b, t × p = v t × b.
    let solved = |p: DVec3| {
        DVec2::new(p.cross(bitangent).dot(normal), tangent.cross(p).dot(normal)) / normal.length_squared()
    };
    (t > 0.0 && t.is_finite()).then(|| [solved(eye - origin), solved(t * direction)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the expected colour of a lookup at `uv`, offset by so many texels.
    fn read(reading: &Reading, uv: DVec2, moved: f64) -> [f32; 3] {
        let axis = |coordinate: f64, size: u32| {
            let wide = f64::from(size);
            let position = reading.folded(coordinate) * wide + moved;
            (if reading.linear { position } else { position.floor() + 0.5 } / wide) as f32
        };
        [axis(uv.x, reading.size[0]), axis(uv.y, reading.size[1]), 0.0]
    }

    #[test]
    fn a_look_up_is_off_by_as_many_texels_as_it_was_moved() {
        let uv = DVec2::new(1234.3721, -17.6);
        for reading in Reading::ALL {
            let off = |moved| reading.texels_off(read(&reading, uv, moved), uv).unwrap();
            assert!(off(0.0) < 1e-3, "{}", reading.name());
            // A nearest texel encodes its position to a texel.
            assert!((off(3.0) - 3.0).abs() < if reading.linear { 1e-3 } else { 1.0 }, "{}", reading.name());
            assert_eq!(reading.texels_off([f32::NAN, 0.5, 0.0], uv), Some(f64::INFINITY));
        }
    }

    #[test]
    fn the_ray_through_the_middle_of_a_picture_looks_ahead() {
        let view = View::new(DVec3::ONE, DVec3::new(4.0, 1.0, 1.0), DVec3::Y, 90.0, 8);
        assert!((view.direction(DVec2::splat(4.0)) - DVec3::X).length() < 1e-15);
        // Right is +z when looking along +x; up is the tangent of 45 degrees.
        assert!((view.direction(DVec2::new(8.0, 0.0)) - DVec3::new(1.0, 1.0, 1.0)).length() < 1e-15);
        let [eye, beyond] = on_plane(
            DVec3::new(2.0, 3.0, 5.0),
            DVec3::new(1.0, -1.0, 0.0),
            [DVec3::ZERO, DVec3::new(2.0, 0.0, 0.0), DVec3::Z],
        )
        .unwrap();
        assert_eq!((eye, beyond), (DVec2::new(1.0, 5.0), DVec2::new(1.5, 0.0)));
        assert!(on_plane(DVec3::Y, DVec3::Y, [DVec3::ZERO, DVec3::X, DVec3::Z]).is_none());
    }
}
