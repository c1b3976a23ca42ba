//! Is the answer to a look-up right? Filtered by the shader: close to the oracle's. Nearest, and all
//! that the device's own sampler does, by the interval rule: right if some coordinate within the
//! declared precision gives it.

use glam::{DVec2, DVec4};
use moire::oracle::texture::{fetch_texel, look_up};
use moire::pack::PackedScene;
use moire::probe::LookUp;
use moire::texture::data::{ColorSpace, Component, TexelFormat};
use moire::texture::sampler_spec::{Address, Filter, TexelCenter};

use super::bench::uv_of;

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

/// Complaints about wrong answers; at most one a query.
pub fn judge(
    scene: &PackedScene,
    queries: &[LookUp],
    answers: &[[f32; 4]],
    precision: Precision,
) -> Vec<String> {
    assert_eq!(queries.len(), answers.len());
    let spans: Vec<[DVec4; 2]> = (0..scene.textures.len()).map(|t| span(scene, t)).collect();
    let wrong = |(query, answer): (&LookUp, &[f32; 4])| {
        let got = DVec4::from_array(answer.map(f64::from));
        let [low, high] = allowed(scene, query, precision, spans[query.texture as usize]);
        let inside = low.iter().zip(&high).any(|(low, high)| got.cmpge(*low).all() && got.cmple(*high).all());
        (!inside).then(|| {
            let how = &scene.sampler_specs[query.sampler as usize];
            format!(
                "{}, {} centre {}, at ({:e}, {:e}): {answer:?}, allowed {low:?} to {high:?}",
                scene.texture_names[query.texture as usize],
                how.label(),
                how.texel_center,
                query.uv[0],
                query.uv[1],
            )
        })
    };
    queries.iter().zip(answers).filter_map(wrong).collect()
}

/// Least and greatest value of each channel over all texels.
fn span(scene: &PackedScene, texture: usize) -> [DVec4; 2] {
    let record = &scene.textures[texture];
    let [_, width, height, _] = record.place.map(i64::from);
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    texels.fold([DVec4::MAX, DVec4::MIN], |[low, high], (x, y)| {
        let texel = fetch_texel(scene, record, x, y);
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

/// Boxes one of which must hold the answer.
fn allowed(
    scene: &PackedScene,
    query: &LookUp,
    precision: Precision,
    [least, most]: [DVec4; 2],
) -> [Vec<DVec4>; 2] {
    let image = &scene.textures[query.texture as usize];
    let how = &scene.samplers[query.sampler as usize];
    let size = DVec2::new(f64::from(image.place[1]), f64::from(image.place[2]));
    let uv = uv_of(query);
    let border = DVec4::from_array(how.border.map(f64::from));
    let (least, most) = (least.min(border), most.max(border));
    let range = most - least;
    let ulps = 4.0 * F32_ULP * least.abs().max(most.abs()); // 4 ulp of the greatest texel
    let nearest = how.modes[2] == Filter::Nearest as u32;
    let at = |texel: DVec2| look_up(scene, image, how, texel / size);

    let (reach, slack) = match precision {
        Precision::Shader if !nearest => {
            let value = look_up(scene, image, how, uv);
            let error = range * (size.max_element() * F32_ULP * 2.0) + ulps; // W · 2⁻²² of the range + 4 ulp
            return [vec![value - error], vec![value + error]];
        }
        Precision::Shader => (size * (2.0 * F32_ULP), ulps), // W · 2⁻²² texels, 4 ulp
        Precision::Hardware { sub_texel, value, decode } => {
            let rounding = (uv.abs() + 1.0) * size * F32_ULP; // u · size in f32, with half a texel added
            let srgb = image.link[0] == ColorSpace::Srgb as u32;
            // The slope of the decoding curve is at most 2.4 / 1.055, at 1.
            let decoding = if srgb { decode * 2.4 / 1.055 } else { 0.0 };
            let eight_bits = TexelFormat::ALL[image.place[3] as usize].component() == Component::Unorm8;
            let value = if nearest { 0.0 } else { value[usize::from(!eight_bits)] };
            // VK_EXT_custom_border_color: a device may hold the colour in the texels' own format.
            let held = if how.modes[..2].contains(&(Address::ClampToBorder as u32)) {
                let component = TexelFormat::ALL[image.place[3] as usize].component();
                half_step(component) + f64::from(f32::EPSILON)
            } else {
                0.0
            };
            (rounding + sub_texel, range * value + DVec4::splat(decoding + held) + ulps)
        }
    };
    let texel = uv * size;
    if nearest {
        let mut values: Vec<DVec4> = Vec::with_capacity(4);
        for x in [texel.x - reach.x, texel.x + reach.x] {
            for y in [texel.y - reach.y, texel.y + reach.y] {
                values.push(at(DVec2::new(x, y)));
            }
        }
        let low = values.iter().map(|v| *v - slack).collect();
        return [low, values.into_iter().map(|v| v + slack).collect()];
    }
    // Bilinear between texel centres: the extremes lie at corners and where centres are crossed.
    let half = if how.modes[3] == TexelCenter::Integer as u32 { 0.0 } else { 0.5 };
    let stops = |from: f64, to: f64| {
        let crossed = (from - half).ceil() + half;
        let mut all = vec![from, to];
        all.extend((crossed < to).then_some(crossed));
        all
    };
    let mut low = DVec4::MAX;
    let mut high = DVec4::MIN;
    for x in stops(texel.x - reach.x, texel.x + reach.x) {
        for y in stops(texel.y - reach.y, texel.y + reach.y) {
            let value = at(DVec2::new(x, y));
            (low, high) = (low.min(value), high.max(value));
        }
    }
    [vec![low - slack], vec![high + slack]]
}
