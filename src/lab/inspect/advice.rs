//! The settings that suit a view: filter, levels, footprint and number of samples, from what its pixels see. Input: the
//! survey of its textures, and the layer of surfaces. Output: one sentence, and the options that it names. The rules are
//! those of thumb of the guide; `moire study` measures which setting wins.

use super::survey::{Seen, Survey};
use crate::core::layer::Layer;
use crate::scene::changes::Changes;
use crate::scene::model::{Algorithm, Footprint, Scene};
use crate::texture::sampler_spec::{Filter, MipMode};

/// Less than this share of textured pixels with more than a texel in them counts as none.
const SOME_MINIFIED: f64 = 0.01;
/// From this share of the minified pixels on, elongated footprints decide on the filter.
const MANY_ELONGATED: f64 = 0.2;
/// A texel over more than two pixels shows its outline under `linear`; from this share on that decides.
const MANY_MAGNIFIED: f64 = 0.25;
/// Shares of pixels that see several surfaces: below the first few samples are enough, below the second it pays to place
/// them.
const FEW_EDGES: f64 = 0.02;
const MANY_EDGES: f64 = 0.3;

/// What the view's pixels see, as shares.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Facts {
    /// Of all pixels: those that read a texture of texels.
    pub textured: f64,
    /// Of these: those that cover more than a texel of one of their textures.
    pub minified: f64,
    /// Of those: those whose footprint there is more than twice as long as wide.
    pub elongated: f64,
    /// Of the textured pixels: those in which a texel of one is larger than two pixels.
    pub magnified: f64,
    /// Of all pixels: those that see several surfaces.
    pub edges: f64,
    /// True if samples differ in more than their place: a lens, motion, or lights with an extent.
    pub is_noisy: bool,
}

/// The recommended settings.
#[derive(Clone, Debug, PartialEq)]
pub struct Advice {
    pub sentence: String,
    /// Options of `moire render`.
    pub options: Vec<String>,
}

impl Facts {
    pub fn new(scene: &Scene, survey: &Survey, surfaces: Option<&Layer>) -> Facts {
        let ratio = |part: f64, all: f64| if all > 0.0 { part / all } else { 0.0 };
        let Seen { textured, minified, elongated, magnified } = survey.seen;
        let share = |part: u64, all: u64| ratio(part as f64, all as f64);
        let several = surfaces.map_or(0, |layer| layer.first_values().filter(|n| *n > 1.0).count());
        let pixels = surfaces.map_or(0, |layer| layer.present.len());
        Facts {
            textured: share(textured, survey.pixels),
            minified: share(minified, textured),
            elongated: share(elongated, minified),
            magnified: share(magnified, textured),
            edges: ratio(several as f64, pixels as f64),
            is_noisy: scene.camera.lens.is_some()
                || scene.camera.moves()
                || scene.shapes.iter().any(|shape| shape.motion() != glam::DVec3::ZERO)
                || scene.lights.iter().any(|light| light.has_extent()),
        }
    }
}

/// Returns the settings for a scene of these facts.
pub fn advice(scene: &Scene, facts: &Facts) -> Advice {
    let mut options = Vec::new();
    let mut option = |name: &str, value: &str| options.extend([format!("--{name}"), value.to_owned()]);
    let filtering = filtering(scene, facts, &mut option);
    let (spp, placed) = match facts.edges {
        _ if facts.is_noisy => (64, true),
        edges if edges < FEW_EDGES => (4, false),
        edges => (16, edges < MANY_EDGES),
    };
    if placed {
        option("algorithm", Algorithm::Adaptive.name());
    }
    option("spp", &spp.to_string());
    let why = if facts.is_noisy {
        "a lens, motion or lights with an extent need many samples where they blur".to_owned()
    } else {
        format!("{} of all pixels see several surfaces", percent(facts.edges))
    };
    let how = if placed {
        format!("{spp} samples a pixel, placed adaptively")
    } else {
        format!("{spp} samples a pixel")
    };
    Advice { sentence: format!("{filtering} Take {how}: {why}."), options }
}

/// Returns the sentence on filter and footprint, and adds their options.
fn filtering(scene: &Scene, facts: &Facts, option: &mut impl FnMut(&str, &str)) -> String {
    if facts.textured == 0.0 {
        return "No pixel sees a texture of texels, so filters and footprints change nothing.".into();
    }
    let minified = facts.minified >= SOME_MINIFIED;
    let wanted = match minified {
        true if facts.elongated >= MANY_ELONGATED => Filter::Anisotropic,
        false if facts.magnified >= MANY_MAGNIFIED => Filter::Cubic,
        _ => Filter::Linear,
    };
    let (mip, footprint) =
        if minified { (MipMode::Linear, Footprint::Differentials) } else { (MipMode::None, Footprint::None) };
    let suits = |filter| {
        let changes = Changes {
            filter: Some(filter),
            mip: Some(mip.into()),
            footprint: Some(footprint),
            ..Changes::default()
        };
        changes.apply(&mut scene.clone()).is_ok()
    };
    let filter = if suits(wanted) { wanted } else { Filter::Linear };
    option("filter", filter.name());
    option("mip", mip.name());
    option("footprint", footprint.name());
    if !minified {
        let closer = percent(facts.magnified);
        return format!(
            "Use filter {filter} without levels or a footprint: a texel is larger than two pixels in {closer} of the \
             textured pixels, and hardly any pixel covers more than one."
        );
    }
    format!(
        "Use filter {filter} with blended levels (mip {mip}) over the footprint of {footprint}: {} of the textured pixels \
         cover more than a texel, and {} of these are more than twice as long as wide.",
        percent(facts.minified),
        percent(facts.elongated)
    )
}

/// Returns a share as `12 %`.
pub fn percent(share: f64) -> String {
    match 100.0 * share {
        0.0 => "none".into(),
        p if p < 1.0 => "less than 1 %".into(),
        p => format!("{p:.0} %"),
    }
}
