//! The values that a filter may return at and around a coordinate with its uncertainty, as boxes of
//! smallest and largest values.

use glam::{DVec3, DVec4};

use super::judge::F32_ULP;
use super::reading::Reading;
use crate::oracle::filter::levels::Reader;
use crate::oracle::footprint_axes::{in_texture, kind_of};
use crate::oracle::mapping::Coordinate;
use crate::oracle::texture::{Level, fetch_texel, level_at};
use crate::pack::{PackedScene, TextureKind};
use crate::schema::layout::{Sampler, Texture};
use crate::texture::sampler_spec::{Filter, TexelCenter};

/// The precision of a coordinate.
#[derive(Clone, Copy, Debug)]
pub enum Uncertainty {
    /// To size · 2⁻²² texels.
    Shader,
    /// To a fraction of a texel in addition to the rounding of u · size in f32, with half a texel
    /// added.
    Hardware { sub_texel: f64 },
}

pub struct LookupInterval<'a> {
    reader: Reader<'a>,
    pub kind: TextureKind,
    /// The coordinate; for a cube, that on a face.
    pub uv: Coordinate,
    face: u32,
}

impl<'a> LookupInterval<'a> {
    pub fn new(
        scene: &'a PackedScene,
        image: &'a Texture,
        how: &'a Sampler,
        position: &Coordinate,
    ) -> LookupInterval<'a> {
        let (uv, face) = in_texture(image, position);
        LookupInterval { reader: Reader { scene, image, how }, kind: kind_of(image), uv, face }
    }

    fn axes(&self) -> usize {
        if self.kind == TextureKind::Volume { 3 } else { 2 }
    }

    /// Returns the number of successive interpolations between two values.
    pub fn mixes(&self, reading: &Reading) -> usize {
        let along = if reading.filter == Filter::Nearest { 0 } else { self.axes() };
        along + usize::from(reading.is_mixed())
    }

    pub fn is_cubic(&self) -> bool {
        self.reader.how.mag_filter == Filter::Cubic || self.reader.how.min_filter == Filter::Cubic
    }

    pub fn longest(&self) -> f64 {
        self.size(&self.level(0)).max_element()
    }

    fn level(&self, index: u32) -> Level {
        level_at(self.reader.scene, self.reader.image, index)
    }

    /// Returns the size along the axes in use, and 1 along the others.
    fn size(&self, level: &Level) -> DVec3 {
        let [width, height, depth] = level.size.map(|n| n as f64);
        DVec3::new(width, height, if self.kind == TextureKind::Volume { depth } else { 1.0 })
    }

    /// Returns the uncertainty in texels of a level.
    fn reach(&self, level: &Level, uncertainty: Uncertainty) -> DVec3 {
        let size = self.size(level);
        match uncertainty {
            Uncertainty::Shader => size * (2.0 * F32_ULP),
            Uncertainty::Hardware { sub_texel } => (self.uv.at.abs() + 1.0) * size * F32_ULP + sub_texel,
        }
    }

    /// Returns the smallest and largest values that a reading allows; nearest texels one by one.
    pub fn values(&self, reading: &Reading, uncertainty: Uncertainty) -> Vec<[DVec4; 2]> {
        let first = self.level_values(reading.filter, &self.level(reading.levels[0]), uncertainty);
        if !reading.is_mixed() {
            return first;
        }
        let second = self.level_values(reading.filter, &self.level(reading.levels[1]), uncertainty);
        let mixed = |a: &[DVec4; 2], b: &[DVec4; 2]| {
            let ends = |side: usize| reading.share.map(|share| a[side] * (1.0 - share) + b[side] * share);
            let ([a, b], [c, d]) = (ends(0), ends(1));
            [a.min(b), c.max(d)]
        };
        first.iter().flat_map(|a| second.iter().map(move |b| mixed(a, b))).collect()
    }

    fn level_values(&self, filter: Filter, level: &Level, uncertainty: Uncertainty) -> Vec<[DVec4; 2]> {
        let size = self.size(level);
        let texel = self.uv.at * size;
        let around = self.reach(level, uncertainty);
        let integer = self.reader.how.texel_center == TexelCenter::Integer;
        let half = if integer && self.kind != TextureKind::Cube { 0.0 } else { 0.5 };
        let stops = |axis: usize| {
            let (at, reach_here) = (texel[axis], around[axis]);
            let (from, to) = (at - reach_here, at + reach_here);
            match (filter, uncertainty) {
                _ if axis >= self.axes() => vec![at],
                (Filter::Nearest, _) => vec![from, to],
                (_, Uncertainty::Shader) => vec![at],
                _ => stops(from, to, half),
            }
        };
        let [xs, ys, zs] = [0, 1, 2].map(stops);
        let mut values = Vec::with_capacity(xs.len() * ys.len() * zs.len());
        for &z in &zs {
            for &y in &ys {
                for &x in &xs {
                    let at = DVec3::new(x, y, z) / size;
                    values.push(self.reader.level(filter, level, at, self.face, DVec3::ZERO));
                }
            }
        }
        if filter == Filter::Nearest {
            values
                .sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).unwrap_or(std::cmp::Ordering::Equal));
            values.dedup();
            return values.into_iter().map(|value| [value; 2]).collect();
        }
        let start = [DVec4::MAX, DVec4::MIN];
        vec![values.into_iter().fold(start, |[low, high], v| [low.min(v), high.max(v)])]
    }

    /// Returns the weight of the missing texel beyond a cube's corner, which devices may distribute
    /// as they like (Vulkan 1.3, "Cube Map Edge Handling").
    pub fn beyond_corner(&self, reading: &Reading, uncertainty: Uncertainty) -> f64 {
        if self.kind != TextureKind::Cube
            || reading.filter == Filter::Nearest
            || matches!(uncertainty, Uncertainty::Shader)
        {
            return 0.0;
        }
        let of = |index: u32| {
            let level = self.level(index);
            let (size, uncertainty) = (self.size(&level), self.reach(&level, uncertainty));
            let beyond = |axis: usize| {
                let texel = self.uv.at[axis] * size[axis] - 0.5;
                ((-texel).max(texel - (size[axis] - 1.0)) + uncertainty[axis]).max(0.0)
            };
            beyond(0) * beyond(1)
        };
        reading.levels.map(of).into_iter().fold(0.0, f64::max)
    }
}

/// Returns the ends of an interval, which is shorter than a texel, and the texel centre in it.
/// Linear filters have no extrema between these points.
fn stops(from: f64, to: f64, half: f64) -> Vec<f64> {
    let crossed = (from - half).ceil() + half;
    let mut all = vec![from, to];
    all.extend((crossed < to).then_some(crossed));
    all
}

/// Returns the smallest and largest value of each channel over all texels of all levels.
pub fn span(scene: &PackedScene, texture: usize) -> [DVec4; 2] {
    let record = &scene.records.textures[texture];
    let mut span = [DVec4::MAX, DVec4::MIN];
    for index in 0..record.levels {
        let level = level_at(scene, record, index);
        let [width, height, depth] = level.size;
        for texel in 0..width * height * depth {
            let at = [texel % width, texel / width % height, texel / (width * height)];
            let value = fetch_texel(scene, record, &level, at);
            span = [span[0].min(value), span[1].max(value)];
        }
    }
    span
}
