//! Codes of a colour profile as linear colours of sRGB, and as codes of sRGB (ICC.1:2022, F.3; IEC 61966-2-1): a table
//! of each transfer function, a matrix, and the inverse transfer function of sRGB. Colours outside of sRGB are clipped in
//! codes, and kept in linear numbers.

use std::sync::OnceLock;

use glam::{DMat3, DVec3, Mat3, Vec3};
use moxcms::ToneReprCurve;
use rayon::prelude::*;

use super::color_profile::{ColorProfile, Colors, Meaning};
use super::data::Component;
use super::read_file::Texels;
use crate::core::color::linear_to_srgb;

/// The steps of the table of linear values by which 8-bit codes are found: the steepest part of sRGB takes 0.05 codes in
/// one.
const STEPS: usize = 65_536;
/// The distance from sRGB, in parts of white, at which a colour counts as outside: half a code of 8 bits.
const OUTSIDE: f32 = 0.5 / 255.0;
const CHUNK_TEXELS: usize = 1 << 14;

/// Linear values of all codes of a component, and the matrix to sRGB.
pub struct ProfileColors {
    /// Of red, green and blue, or of grey.
    tables: Vec<Vec<f32>>,
    matrix: Mat3,
}

impl ColorProfile {
    /// Returns linear sRGB colours for codes of this component; `None` if the codes mean sRGB, or cannot be converted.
    pub fn colors(&self, component: Component) -> Option<ProfileColors> {
        match &self.meaning {
            Meaning::Colors(colors) => ProfileColors::with(colors, component.codes()),
            Meaning::Srgb | Meaning::Unusable(_) => None,
        }
    }

    /// Replaces codes by those of sRGB. Returns the share of the texels that are outside of sRGB; `None` if nothing was
    /// to be done.
    pub(super) fn convert(&self, texels: &mut Texels) -> Option<f64> {
        let component = texels.format.component();
        let colors = self.colors(component)?;
        let channels = texels.format.channels();
        let outside = match component {
            Component::Unorm8 => {
                colors.convert::<1>(&mut texels.bytes, channels, |[b]| usize::from(b), |v| [code8(v)])
            }
            Component::Unorm16 => {
                let code = |v| (linear_to_srgb(f64::from(v)) * 65_535.0).round() as u16;
                colors.convert::<2>(
                    &mut texels.bytes,
                    channels,
                    |b| usize::from(u16::from_ne_bytes(b)),
                    |v| code(v).to_ne_bytes(),
                )
            }
            Component::Float32 => 0,
        };
        Some(outside as f64 / f64::from(texels.width) / f64::from(texels.height))
    }
}

impl ProfileColors {
    /// Returns the colours of 8-bit codes; `None` if a curve is no function.
    pub(super) fn of(colors: &Colors) -> Option<ProfileColors> {
        ProfileColors::with(colors, Component::Unorm8.codes())
    }

    fn with(colors: &Colors, codes: usize) -> Option<ProfileColors> {
        if codes == 0 {
            return None;
        }
        let table = |curve: &ToneReprCurve| {
            let curve = curve.make_linear_evaluator().ok()?;
            let linear = |code: usize| curve.evaluate_value(code as f32 / (codes - 1) as f32);
            let table: Vec<f32> = (0..codes).map(linear).collect();
            table.iter().all(|value| value.is_finite()).then_some(table)
        };
        let (tables, matrix) = match colors {
            Colors::Grey(curve) => (vec![table(curve)?], DMat3::IDENTITY),
            Colors::Rgb(curves, matrix) => (curves.iter().map(table).collect::<Option<Vec<_>>>()?, *matrix),
        };
        Some(ProfileColors { tables, matrix: matrix.as_mat3() })
    }

    /// Returns the linear sRGB colour of three codes.
    pub fn linear(&self, codes: [usize; 3]) -> Vec3 {
        match self.tables.as_slice() {
            [r, g, b] => self.matrix * Vec3::new(r[codes[0]], g[codes[1]], b[codes[2]]),
            tables => codes.map(|code| tables[0][code]).into(),
        }
    }

    /// Returns true if all greys, and the colours of a cube around them, have the codes that sRGB gives them.
    pub(super) fn are_srgb(&self) -> bool {
        let same = |codes: [usize; 3]| {
            let seen = self.linear(codes).to_array().map(|v| linear_to_srgb(f64::from(v).clamp(0.0, 1.0)));
            let off = DVec3::from(seen) * 255.0 - DVec3::from(codes.map(|code| code as f64));
            off.abs().max_element() < 0.5
        };
        let steps = [0, 85, 170, 255];
        let cube =
            || steps.into_iter().flat_map(|r| steps.into_iter().flat_map(move |g| steps.map(|b| [r, g, b])));
        (0..256).all(|code| same([code; 3])) && cube().all(|codes| self.tables.len() < 3 || same(codes))
    }

    /// Replaces the codes of all texels, but for alpha; returns how many colours are outside of sRGB.
    fn convert<const SIZE: usize>(
        &self,
        bytes: &mut [u8],
        channels: usize,
        code: impl Fn([u8; SIZE]) -> usize + Sync,
        coded: impl Fn(f32) -> [u8; SIZE] + Sync,
    ) -> u64 {
        let colored = channels > 2;
        let row = |texels: &mut [u8]| {
            let (values, _) = texels.as_chunks_mut::<SIZE>();
            let mut outside = 0;
            for texel in values.chunks_exact_mut(channels) {
                let codes = if colored { [texel[0], texel[1], texel[2]] } else { [texel[0]; 3] };
                let color = self.linear(codes.map(&code));
                outside += u64::from(color.min_element() < -OUTSIDE || color.max_element() > 1.0 + OUTSIDE);
                let inside = color.clamp(Vec3::ZERO, Vec3::ONE).to_array();
                let kept = if colored { 3 } else { 1 };
                texel[..kept].iter_mut().zip(inside).for_each(|(to, value)| *to = coded(value));
            }
            outside
        };
        bytes.par_chunks_mut(CHUNK_TEXELS * channels * SIZE).map(row).sum()
    }
}

/// Returns the 8-bit code of sRGB of a linear value in [0, 1].
fn code8(linear: f32) -> u8 {
    static CODES: OnceLock<Vec<u8>> = OnceLock::new();
    let code = |step: usize| (linear_to_srgb(step as f64 / (STEPS - 1) as f64) * 255.0).round() as u8;
    let codes = CODES.get_or_init(|| (0..STEPS).map(code).collect());
    codes[(linear * (STEPS - 1) as f32 + 0.5) as usize]
}
