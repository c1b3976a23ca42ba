//! Is the answer to a look-up right? By the interval rule of the Khronos conformance tests (VK-GL-CTS,
//! `vktSampleVerifier.cpp`): right if some coordinate and level within the declared precision
//! (`VkPhysicalDeviceLimits::subTexelPrecisionBits` and `mipmapPrecisionBits`) give it, up to the
//! arithmetic of filtering. What our shader filters must be close to the oracle's value itself.

use glam::DVec4;

use super::place::{Place, Reach, span};
use super::queries::place_of;
use super::reading::{Reading, levels_of_detail, readings};
use crate::gpu::{DeviceInfo, DeviceKind};
use crate::lab::probe::LookUp;
use crate::oracle::filter::sample_texture;
use crate::oracle::footprint::is_filtered;
use crate::pack::{PackedScene, TextureKind};
use crate::schema::layout::Sampler;
use crate::texture::data::{ColorSpace, Component};
use crate::texture::sampler_spec::{Address, Filter, MipMode};

pub(super) const F32_ULP: f64 = 1.0 / 8_388_608.0; // of 1: 2⁻²³

/// How exact a method promises to be.
#[derive(Clone, Copy, Debug)]
pub enum Precision {
    /// In f32: a coordinate to size · 2⁻²² texels, a value to 4 ulp.
    Shader,
    /// By the device: a coordinate to `sub_texel` texels beside the rounding of u · size in f32.
    Hardware {
        sub_texel: f64,
        /// Of a level of detail.
        level: f64,
        /// Error of a filtered value, as a part of the texels' range: of 8-bit texels, of others.
        value: [f64; 2],
        /// Error of sRGB decoding, in encoded units.
        decode: f64,
    },
}

impl Precision {
    /// What a device's samplers promise. Texture units may round each of the four products of two
    /// weights to half a sub-texel step: where the weights still sum to 1, that is one step of the range
    /// at most. Processors have wider numbers than their weights: half a step.
    pub fn declared(device: &DeviceInfo) -> Precision {
        let step = (-f64::from(device.limits.sub_texel_bits)).exp2();
        let value = if device.kind == DeviceKind::Cpu { 0.5 * step } else { step };
        let level = (-f64::from(device.limits.mip_bits)).exp2();
        let decode = 0.5 / 255.0; // half a step of the encoded value
        Precision::Hardware { sub_texel: step, level, value: [value; 2], decode }
    }

    /// What a filtered value may lie beyond the interval, as a part of the range, for each two of the
    /// mixes of values that filter it.
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

/// One answer against the oracle. Both errors are of the worst channel, as a part of what the format can
/// tell apart: of 1 for normalized integers, of the texels' range (border included) for floats, if it is
/// not 0; infinite for a NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judgement {
    /// From the oracle's value (linear), or from the nearest texel that may be chosen (nearest).
    pub error: f64,
    /// Beyond every value that a coordinate within the declared precision gives.
    pub beyond: f64,
    /// Not beyond those values by more than the arithmetic of filtering.
    pub right: bool,
}

/// Reads one packed scene's look-ups by one rule.
pub struct Judge<'a> {
    scene: &'a PackedScene,
    precision: Precision,
    /// Least and greatest texel of each texture.
    spans: Vec<[DVec4; 2]>,
}

/// Values one of which an answer must meet: boxes, each met to `slack`, and the exact value.
struct Allowed {
    boxes: Vec<[DVec4; 2]>,
    /// Rounding of numbers, that nobody counts as filtering.
    slack: DVec4,
    /// Error of a filtered value.
    arithmetic: DVec4,
    /// What errors are told in.
    unit: DVec4,
    exact: Option<DVec4>,
    /// Levels of detail that count, where there is a footprint.
    levels: Option<[f64; 2]>,
}

impl<'a> Judge<'a> {
    pub fn new(scene: &'a PackedScene, precision: Precision) -> Judge<'a> {
        let spans = (0..scene.textures.len()).map(|t| span(scene, t)).collect();
        Judge { scene, precision, spans }
    }

    pub fn judge(&self, query: &LookUp, answer: [f32; 4]) -> Judgement {
        let got = DVec4::from_array(answer.map(f64::from));
        if !got.is_finite() {
            return Judgement { error: f64::INFINITY, beyond: f64::INFINITY, right: false };
        }
        let allowed = self.allowed(query);
        let outside = |[low, high]: &[DVec4; 2]| (*low - got).max(got - *high).max(DVec4::ZERO);
        let least = |slack: DVec4| {
            let of = |b| part(outside(b) - slack, allowed.unit);
            allowed.boxes.iter().map(of).fold(f64::INFINITY, f64::min)
        };
        let error = match allowed.exact {
            Some(exact) => part((got - exact).abs(), allowed.unit),
            None => least(DVec4::ZERO),
        };
        let right = least(allowed.slack + allowed.arithmetic) == 0.0;
        Judgement { error, beyond: least(allowed.slack), right }
    }

    /// What a wrong answer should have been.
    pub fn complaint(&self, query: &LookUp, answer: [f32; 4]) -> String {
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

    fn allowed(&self, query: &LookUp) -> Allowed {
        let scene = self.scene;
        let image = &scene.textures[query.texture as usize];
        let how = &scene.samplers[query.sampler as usize];
        let component = image.format.component();
        let place = Place::new(scene, image, how, &place_of(query));
        let levels = is_filtered(&scene.header)
            .then(|| levels_of_detail(image, how, &place.at, self.precision.level()));
        let mag = how.mag_filter;
        let readings = levels.map_or(vec![Reading::at(mag, 0)], |l| readings(how, image.levels, l));

        let border = how.border.as_dvec4();
        let [least, most] = self.spans[query.texture as usize];
        let (least, most) = (least.min(border), most.max(border));
        let range = most - least;
        let ulps = 4.0 * F32_ULP * least.abs().max(most.abs()); // 4 ulp of the greatest texel
        let mixes = readings.iter().map(|r| place.mixes(r)).max().unwrap_or(0);
        let arithmetic = range * self.precision.value(component, mixes);
        let spread = DVec4::select(range.cmpgt(DVec4::ZERO), range, DVec4::ONE);
        let unit = if component == Component::Float32 { spread } else { DVec4::ONE };
        let (reach, slack) = match self.precision {
            Precision::Shader => (Reach::Shader, self.shader_slack(&place, mixes > 0, range, ulps)),
            Precision::Hardware { sub_texel, decode, .. } => {
                let srgb = image.color_space == ColorSpace::Srgb;
                // The slope of the decoding curve is at most 2.4 / 1.055, at 1.
                let decoding = if srgb { decode * 2.4 / 1.055 } else { 0.0 };
                let slack = DVec4::splat(decoding + held(how, place.kind, component)) + ulps;
                (Reach::Hardware { sub_texel }, slack)
            }
        };
        let slack =
            slack + range * readings.iter().map(|r| place.beyond_corner(r, reach)).fold(0.0, f64::max);
        let boxes = readings.iter().flat_map(|r| place.values(r, reach)).collect();
        let by_nearest = |r: &Reading| r.filter == Filter::Nearest;
        let smooth = !readings.iter().any(by_nearest)
            && how.min_filter != Filter::Anisotropic
            && (how.mip_mode != MipMode::Nearest || readings.len() == 1);
        let exact = smooth.then(|| sample_texture(scene, image, how, &place_of(query), [query.seed, 0]));
        Allowed { boxes, slack, arithmetic, unit, exact, levels }
    }

    /// W · 2⁻²² of the range and 4 ulp where texels are mixed. The weights of the cubic filter rise and fall
    /// by up to 1.5 a texel, and their sizes add up to 1.25, squared.
    fn shader_slack(&self, place: &Place<'_>, mixed: bool, range: DVec4, ulps: DVec4) -> DVec4 {
        let steep = if place.is_cubic() { 1.5 * 1.25 } else { 1.0 };
        let moved = if mixed { range * (place.longest() * F32_ULP * 2.0) } else { DVec4::ZERO };
        (moved + ulps) * steep
    }
}

/// VK_EXT_custom_border_color: a device may hold the colour in the texels' own format.
fn held(how: &Sampler, kind: TextureKind, component: Component) -> f64 {
    let axes = [how.address_u, how.address_v, how.address_w];
    let read = if kind == TextureKind::Volume { &axes[..] } else { &axes[..2] };
    let border = kind != TextureKind::Cube && read.contains(&Address::ClampToBorder);
    if border { half_step(component) + f64::from(f32::EPSILON) } else { 0.0 }
}

/// Complaints about wrong answers; at most one a query.
pub fn complaints(
    scene: &PackedScene,
    queries: &[LookUp],
    answers: &[[f32; 4]],
    precision: Precision,
) -> Vec<String> {
    assert_eq!(queries.len(), answers.len());
    let judge = Judge::new(scene, precision);
    let pairs = queries.iter().zip(answers);
    let wrong = pairs.filter(|(query, answer)| !judge.judge(query, **answer).right);
    wrong.map(|(query, answer)| judge.complaint(query, *answer)).collect()
}

/// The worst channel as a part of its range.
fn part(distance: DVec4, range: DVec4) -> f64 {
    let channels = distance.to_array().into_iter().zip(range.to_array());
    let of = |(distance, range): (f64, f64)| match () {
        () if distance <= 0.0 => 0.0,
        () if range > 0.0 => distance / range,
        () => f64::INFINITY,
    };
    channels.map(of).fold(0.0, f64::max)
}

/// Half the distance of two neighbouring values of a stored channel, near 1.
fn half_step(component: Component) -> f64 {
    match component {
        Component::Unorm8 => 0.5 / 255.0,
        Component::Unorm16 => 0.5 / 65_535.0,
        Component::Float32 => 0.5 * F32_ULP,
    }
}
