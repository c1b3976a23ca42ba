//! Checks the answer to a lookup by the interval rule of the Khronos conformance tests (VK-GL-CTS,
//! `vktSampleVerifier.cpp`): it is correct if some coordinate and level within the declared
//! precision (`VkPhysicalDeviceLimits::subTexelPrecisionBits` and `mipmapPrecisionBits`) give it,
//! up to the arithmetic of filtering. Answers of this program's shader filters must be close to the
//! oracle's value itself.

use glam::DVec4;

use super::interval::{LookupInterval, Uncertainty, span};
use super::queries::place_of;
use super::reading::{Reading, levels_of_detail, readings};
use crate::gpu::{DeviceInfo, DeviceKind};
use crate::lab::probe::LookupQuery;
use crate::oracle::filter::sample_texture;
use crate::oracle::footprint::is_filtered;
use crate::pack::{PackedScene, TextureKind};
use crate::schema::layout::Sampler;
use crate::texture::data::{ColorSpace, Component};
use crate::texture::sampler_spec::{Address, Filter, MipMode};

pub(super) const F32_ULP: f64 = 1.0 / 8_388_608.0; // of 1: 2⁻²³

/// The declared precision of a method.
#[derive(Clone, Copy, Debug)]
pub enum Precision {
    /// f32 arithmetic: a coordinate to size · 2⁻²² texels, a value to 4 ulp.
    Shader,
    /// The texture unit: a coordinate to `sub_texel` texels in addition to the rounding of u · size
    /// in f32.
    Hardware {
        sub_texel: f64,
        /// The precision of the level of detail.
        level: f64,
        /// The error of a filtered value as a fraction of the texels' range: of 8-bit texels, of
        /// others.
        value: [f64; 2],
        /// The error of sRGB decoding, in encoded units.
        decode: f64,
    },
}

impl Precision {
    /// Returns the precision of a device's samplers. Texture units may round each of the four
    /// products of two weights to half a sub-texel step: as the weights still sum to 1, that is at
    /// most one step of the range. CPU drivers have numbers wider than their weights: half a step.
    pub fn declared(device: &DeviceInfo) -> Precision {
        let step = (-f64::from(device.limits.sub_texel_bits)).exp2();
        let value = if device.kind == DeviceKind::Cpu { 0.5 * step } else { step };
        let level = (-f64::from(device.limits.mip_bits)).exp2();
        let decode = 0.5 / 255.0; // half a step of the encoded value
        Precision::Hardware { sub_texel: step, level, value: [value; 2], decode }
    }

    /// Returns how far a filtered value may be outside the interval, as a fraction of the range,
    /// per two of the interpolations that filter it.
    fn value(self, component: Component, mixes: usize) -> f64 {
        match self {
            Precision::Hardware { value, .. } => {
                value[usize::from(component != Component::Unorm8)] * mixes as f64 / 2.0
            }
            Precision::Shader => 0.0,
        }
    }

    fn level(self) -> f64 {
        match self {
            Precision::Hardware { level, .. } => level,
            Precision::Shader => 0.0,
        }
    }
}

/// One answer compared with the oracle. Both errors are of the worst channel, relative to the unit
/// of the format: 1 for normalized integers, the texels' range (border included) for floats, unless
/// it is 0; infinite for a NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judgement {
    /// The distance from the oracle's value (linear), or from the nearest texel that may be
    /// selected (nearest).
    pub error: f64,
    /// The distance from every value that a coordinate within the declared precision gives.
    pub beyond: f64,
    /// True if that distance is within the arithmetic error of filtering.
    pub right: bool,
}

/// The comparison for one packed scene's lookups.
pub struct Judge<'a> {
    scene: &'a PackedScene,
    precision: Precision,
    /// The smallest and largest texel of each texture.
    spans: Vec<[DVec4; 2]>,
}

/// The values of which an answer must match one: boxes, each to within `slack`, and the exact
/// value.
struct Allowed {
    boxes: Vec<[DVec4; 2]>,
    /// Rounding errors that do not count as filtering.
    slack: DVec4,
    /// The error of a filtered value.
    arithmetic: DVec4,
    /// The unit in which errors are expressed.
    unit: DVec4,
    exact: Option<DVec4>,
    /// The levels of detail that are allowed, if there is a footprint.
    levels: Option<[f64; 2]>,
}

impl<'a> Judge<'a> {
    pub fn new(scene: &'a PackedScene, precision: Precision) -> Judge<'a> {
        let spans = (0..scene.records.textures.len()).map(|t| span(scene, t)).collect();
        Judge { scene, precision, spans }
    }

    pub fn judge(&self, query: &LookupQuery, answer: [f32; 4]) -> Judgement {
        let got = DVec4::from_array(answer.map(f64::from));
        if !got.is_finite() {
            return Judgement { error: f64::INFINITY, beyond: f64::INFINITY, right: false };
        }
        let allowed = self.allowed(query);
        let outside = |[low, high]: &[DVec4; 2]| (*low - got).max(got - *high).max(DVec4::ZERO);
        let least = |slack: DVec4| {
            let of = |b| relative(outside(b) - slack, allowed.unit);
            allowed.boxes.iter().map(of).fold(f64::INFINITY, f64::min)
        };
        let error = match allowed.exact {
            Some(exact) => relative((got - exact).abs(), allowed.unit),
            None => least(DVec4::ZERO),
        };
        let right = least(allowed.slack + allowed.arithmetic) == 0.0;
        Judgement { error, beyond: least(allowed.slack), right }
    }

    /// Returns a message with the expected value of a wrong answer.
    pub fn message(&self, query: &LookupQuery, answer: [f32; 4]) -> String {
        let allowed = self.allowed(query);
        let slack = allowed.slack + allowed.arithmetic;
        let boxes: Vec<String> = allowed
            .boxes
            .iter()
            .map(|[low, high]| {
                let [low, high] = [*low - slack, *high + slack].map(|v| v.as_vec4());
                format!("{low} to {high}")
            })
            .collect();
        let how = &self.scene.sampler_specs[query.sampler as usize];
        let [u, v, w, _] = query.uv;
        let level = match &allowed.levels {
            Some([from, to]) => format!(", level {from:.4} to {to:.4}"),
            None => String::new(),
        };
        format!(
            "{}, {} centre {}, at ({u:e}, {v:e}, {w:e}){level}: {answer:?}, allowed {}",
            self.scene.texture_names[query.texture as usize],
            how.label(),
            how.texel_center,
            boxes.join(" or "),
        )
    }

    fn allowed(&self, query: &LookupQuery) -> Allowed {
        let scene = self.scene;
        let image = &scene.records.textures[query.texture as usize];
        let how = &scene.records.samplers[query.sampler as usize];
        let component = image.format.component();
        let region = LookupInterval::new(scene, image, how, &place_of(query));
        let levels = is_filtered(&scene.header)
            .then(|| levels_of_detail(image, how, &region.uv, self.precision.level()));
        let mag = how.mag_filter;
        let readings = levels.map_or(vec![Reading::at(mag, 0)], |l| readings(how, image.levels, l));

        let border = how.border.as_dvec4();
        let [least, most] = self.spans[query.texture as usize];
        let (least, most) = (least.min(border), most.max(border));
        let range = most - least;
        let ulps = 4.0 * F32_ULP * least.abs().max(most.abs()); // 4 ulp of the greatest texel
        let mixes = readings.iter().map(|r| region.mixes(r)).max().unwrap_or(0);
        let arithmetic = range * self.precision.value(component, mixes);
        let spread = DVec4::select(range.cmpgt(DVec4::ZERO), range, DVec4::ONE);
        let unit = if component == Component::Float32 { spread } else { DVec4::ONE };
        let (uncertainty, slack) = match self.precision {
            Precision::Shader => (Uncertainty::Shader, self.shader_slack(&region, mixes > 0, range, ulps)),
            Precision::Hardware { sub_texel, decode, .. } => {
                let srgb = image.color_space == ColorSpace::Srgb;
                // The slope of the decoding curve is at most 2.4 / 1.055, at 1.
                let decoding = if srgb { decode * 2.4 / 1.055 } else { 0.0 };
                let slack = DVec4::splat(decoding + border_error(how, region.kind, component)) + ulps;
                (Uncertainty::Hardware { sub_texel }, slack)
            }
        };
        let slack =
            slack + range * readings.iter().map(|r| region.beyond_corner(r, uncertainty)).fold(0.0, f64::max);
        let boxes = readings.iter().flat_map(|r| region.values(r, uncertainty)).collect();
        let by_nearest = |r: &Reading| r.filter == Filter::Nearest;
        let smooth = !readings.iter().any(by_nearest)
            && how.min_filter != Filter::Anisotropic
            && (how.mip_mode != MipMode::Nearest || readings.len() == 1);
        let exact = smooth.then(|| sample_texture(scene, image, how, &place_of(query), [query.seed, 0]));
        Allowed { boxes, slack, arithmetic, unit, exact, levels }
    }

    /// Returns W · 2⁻²² of the range and 4 ulp if texels are interpolated. The weights of the cubic
    /// filter change by up to 1.5 per texel, and their magnitudes sum to 1.25, squared.
    fn shader_slack(&self, region: &LookupInterval<'_>, mixed: bool, range: DVec4, ulps: DVec4) -> DVec4 {
        let steep = if region.is_cubic() { 1.5 * 1.25 } else { 1.0 };
        let moved = if mixed { range * (region.longest() * F32_ULP * 2.0) } else { DVec4::ZERO };
        (moved + ulps) * steep
    }
}

/// Returns the error of the stored border colour: a device may store it in the texels' own format
/// (VK_EXT_custom_border_color).
fn border_error(how: &Sampler, kind: TextureKind, component: Component) -> f64 {
    let axes = [how.address_u, how.address_v, how.address_w];
    let read = if kind == TextureKind::Volume { &axes[..] } else { &axes[..2] };
    let border = kind != TextureKind::Cube && read.contains(&Address::ClampToBorder);
    if border { half_step(component) + f64::from(f32::EPSILON) } else { 0.0 }
}

/// Returns messages about wrong answers, at most one per query.
pub fn messages(
    scene: &PackedScene,
    queries: &[LookupQuery],
    answers: &[[f32; 4]],
    precision: Precision,
) -> Vec<String> {
    assert_eq!(queries.len(), answers.len());
    let judge = Judge::new(scene, precision);
    let pairs = queries.iter().zip(answers);
    let wrong = pairs.filter(|(query, answer)| !judge.judge(query, **answer).right);
    wrong.map(|(query, answer)| judge.message(query, *answer)).collect()
}

/// Returns the worst channel relative to its range.
fn relative(distance: DVec4, range: DVec4) -> f64 {
    let channels = distance.to_array().into_iter().zip(range.to_array());
    let of = |(distance, range): (f64, f64)| match () {
        () if distance <= 0.0 => 0.0,
        () if range > 0.0 => distance / range,
        () => f64::INFINITY,
    };
    channels.map(of).fold(0.0, f64::max)
}

/// Returns half the distance of two neighbouring values of a stored channel, near 1.
fn half_step(component: Component) -> f64 {
    match component {
        Component::Unorm8 => 0.5 / 255.0,
        Component::Unorm16 => 0.5 / 65_535.0,
        Component::Float32 => 0.5 * F32_ULP,
    }
}
