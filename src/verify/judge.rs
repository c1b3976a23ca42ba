//! Is the answer to a look-up right? By the interval rule of the Khronos conformance tests (VK-GL-CTS,
//! `vktSampleVerifier.cpp`): right if some coordinate within the declared precision
//! (`VkPhysicalDeviceLimits::subTexelPrecisionBits`) gives it, up to the arithmetic of filtering. What
//! our shader filters must be close to the oracle's value itself.

use glam::{DVec2, DVec4};

use super::queries::uv_of;
use crate::gpu::{DeviceInfo, DeviceKind};
use crate::oracle::filter::look_up;
use crate::oracle::mapping::Coordinate;
use crate::oracle::texture::{fetch_texel, level_at};
use crate::pack::PackedScene;
use crate::probe::LookUp;
use crate::texture::data::{ColorSpace, Component, TexelFormat};
use crate::texture::sampler_spec::{Address, Filter, TexelCenter};

const F32_ULP: f64 = 1.0 / 8_388_608.0; // of 1: 2⁻²³
/// How exact a method promises to be.
#[derive(Clone, Copy, Debug)]
pub enum Precision {
    /// In f32: a coordinate to size · 2⁻²² texels, a value to 4 ulp.
    Shader,
    /// By the device: a coordinate to `sub_texel` texels beside the rounding of u · size in f32.
    Hardware {
        sub_texel: f64,
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
        Precision::Hardware { sub_texel: step, value: [value; 2], decode: 0.5 / 255.0 } // half a step of the encoded value
    }

    /// What a filtered value may lie beyond the interval, as a part of the range.
    fn value(self, component: Component, nearest: bool) -> f64 {
        match self {
            Precision::Hardware { value, .. } if !nearest => {
                value[usize::from(component != Component::Unorm8)]
            }
            _ => 0.0,
        }
    }
}

/// One answer against the oracle. Both errors are of the worst channel, as a part of what the format can
/// tell apart: of 1 for normalized integers, of the texels' range (border included) for floats; infinite
/// for a NaN, or where that range is 0 and the answer is off.
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
        format!(
            "{}, {} centre {}, at ({:e}, {:e}): {answer:?}, allowed {}",
            self.scene.texture_names[query.texture as usize],
            how.label(),
            how.texel_center,
            query.uv[0],
            query.uv[1],
            boxes.join(" or "),
        )
    }

    fn allowed(&self, query: &LookUp) -> Allowed {
        let scene = self.scene;
        let image = &scene.textures[query.texture as usize];
        let how = &scene.samplers[query.sampler as usize];
        let size = DVec2::new(f64::from(image.place[1]), f64::from(image.place[2]));
        let component = TexelFormat::ALL[image.place[3] as usize].component();
        let uv = uv_of(query);
        let border = DVec4::from_array(how.border.map(f64::from));
        let [least, most] = self.spans[query.texture as usize];
        let (least, most) = (least.min(border), most.max(border));
        let range = most - least;
        let ulps = 4.0 * F32_ULP * least.abs().max(most.abs()); // 4 ulp of the greatest texel
        let filter = Filter::ALL[how.modes[2] as usize];
        let nearest = matches!(filter, Filter::Nearest | Filter::Stochastic); // one texel
        let arithmetic = range * self.precision.value(component, nearest);
        let unit = if component == Component::Float32 { range } else { DVec4::ONE };
        let value_at = |uv: DVec2| look_up(scene, image, how, &Coordinate::flat(uv), [query.seed, 0]);
        let at = |texel: DVec2| value_at(texel / size);

        let (reach, slack) = match self.precision {
            Precision::Shader if !nearest => {
                let exact = value_at(uv);
                // W · 2⁻²² of the range + 4 ulp. The weights of four texels an axis rise and fall by up to
                // 1.5 a texel, and their sizes add up to 1.25, squared.
                let steep = if filter == Filter::Cubic { 1.5 * 1.25 } else { 1.0 };
                let slack = (range * (size.max_element() * F32_ULP * 2.0) + ulps) * steep;
                return Allowed { boxes: vec![[exact; 2]], slack, arithmetic, unit, exact: Some(exact) };
            }
            Precision::Shader => (size * (2.0 * F32_ULP), ulps), // W · 2⁻²² texels, 4 ulp
            Precision::Hardware { sub_texel, decode, .. } => {
                let rounding = (uv.abs() + 1.0) * size * F32_ULP; // u · size in f32, with half a texel added
                let srgb = image.link[0] == ColorSpace::Srgb as u32;
                // The slope of the decoding curve is at most 2.4 / 1.055, at 1.
                let decoding = if srgb { decode * 2.4 / 1.055 } else { 0.0 };
                // VK_EXT_custom_border_color: a device may hold the colour in the texels' own format.
                let held = if how.modes[..2].contains(&(Address::ClampToBorder as u32)) {
                    half_step(component) + f64::from(f32::EPSILON)
                } else {
                    0.0
                };
                (rounding + sub_texel, DVec4::splat(decoding + held) + ulps)
            }
        };
        let texel = uv * size;
        let boxes = if nearest {
            let xs = [texel.x - reach.x, texel.x + reach.x];
            let ys = [texel.y - reach.y, texel.y + reach.y];
            xs.iter().flat_map(|&x| ys.map(|y| [at(DVec2::new(x, y)); 2])).collect()
        } else {
            // Bilinear between texel centres: the extremes lie at corners and where centres are crossed.
            let half = if how.modes[3] == TexelCenter::Integer as u32 { 0.0 } else { 0.5 };
            let mut low = DVec4::MAX;
            let mut high = DVec4::MIN;
            for x in stops(texel.x - reach.x, texel.x + reach.x, half) {
                for y in stops(texel.y - reach.y, texel.y + reach.y, half) {
                    let value = at(DVec2::new(x, y));
                    (low, high) = (low.min(value), high.max(value));
                }
            }
            vec![[low, high]]
        };
        let exact = (!nearest).then(|| value_at(uv));
        Allowed { boxes, slack, arithmetic, unit, exact }
    }
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

/// The ends of an interval, and the texel centre in it; intervals are shorter than a texel.
fn stops(from: f64, to: f64, half: f64) -> Vec<f64> {
    let crossed = (from - half).ceil() + half;
    let mut all = vec![from, to];
    all.extend((crossed < to).then_some(crossed));
    all
}

/// Least and greatest value of each channel over all texels.
fn span(scene: &PackedScene, texture: usize) -> [DVec4; 2] {
    let record = &scene.textures[texture];
    let level = level_at(scene, record, 0);
    let [width, height, _] = level.size;
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    texels.fold([DVec4::MAX, DVec4::MIN], |[low, high], (x, y)| {
        let texel = fetch_texel(scene, record, &level, [x, y, 0]);
        [low.min(texel), high.max(texel)]
    })
}

/// Half the distance of two neighbouring values of a stored channel, near 1.
fn half_step(component: Component) -> f64 {
    match component {
        Component::Unorm8 => 0.5 / 255.0,
        Component::Unorm16 => 0.5 / 65_535.0,
        Component::Float32 => 0.5 * F32_ULP,
    }
}
