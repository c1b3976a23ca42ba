//! The lines and the JSON of `moire texture` about what a file stores beyond one picture: the formats by name, the meaning
//! that it states, its levels, and whether it is a normal map. Takes the analysis; returns text.

use serde_json::{Value, json};

use crate::core::counted::counted;
use crate::texture::analysis::channel_names;
use crate::texture::analysis_levels::{LevelAnalysis, NormalAnalysis};
use crate::texture::color_profile::ColorProfile;
use crate::texture::data::{ColorSpace, Dimension, TextureData};
use crate::texture::mips::level_count;

/// What is told of a file besides its texels.
pub(super) struct Extra {
    /// The formats of file and texels, and the meaning of values that the file states.
    pub encoding: Option<String>,
    pub profile: Option<Profile>,
    pub stated: Option<ColorSpace>,
    pub levels: Vec<LevelAnalysis>,
    pub normals: Option<NormalAnalysis>,
}

/// The colour profile of a file, and what became of it.
pub(super) struct Profile {
    pub stated: ColorProfile,
    /// The share of the texels that are outside of sRGB, if colours were converted.
    pub clipped: Option<f64>,
}

impl Profile {
    /// Returns a line of text.
    fn line(&self) -> String {
        let name = &self.stated.name;
        match (self.stated.fault(), self.clipped) {
            (Some(why), _) => format!("{name}; it {why} and is not applied"),
            (None, Some(share)) => {
                format!(
                    "{name}, converted to sRGB; {:.2} % of the texels are outside and clipped",
                    100.0 * share
                )
            }
            (None, None) if !self.stated.is_converted() => format!("{name}, whose colours are those of sRGB"),
            (None, None) => format!("{name}; it applies to color_space \"srgb\""),
        }
    }
}

impl Extra {
    /// Returns names and values of lines of the table.
    pub fn lines(&self, texture: &TextureData) -> Vec<(String, String)> {
        let mut lines = Vec::new();
        if let Some(encoding) = &self.encoding {
            let stated =
                self.stated.map_or("says nothing of its color space".into(), |space| format!("says {space}"));
            lines.push(("encoding".into(), format!("{encoding}; {stated}")));
        }
        lines.extend(self.profile.as_ref().map(|profile| ("profile".into(), profile.line())));
        if self.levels.len() > 1 {
            let (stored, whole) = (self.levels.len(), level_count(texture) as usize);
            let end = if stored == whole { "down to one texel".into() } else { format!("of {whole}") };
            lines.push(("levels".into(), format!("{stored} stored, {end}")));
        }
        let has_coverage = self.levels.first().is_some_and(|level| level.coverage.is_some());
        if self.levels.len() > 1 || has_coverage {
            for (index, level) in self.levels.iter().enumerate() {
                lines.push((format!("level {index}"), line(level, texture)));
            }
        }
        if let Some(normals) = self.normals.as_ref().filter(|normals| normals.is_normal_map()) {
            lines.push(("normals".into(), normal_line(normals, texture)));
        }
        lines
    }

    /// Returns the colour profile for JSON.
    pub fn profile_json(&self) -> Value {
        self.profile.as_ref().map_or(Value::Null, |Profile { stated, clipped, .. }| {
            json!({
                "name": stated.name,
                "is_srgb": !stated.is_converted() && stated.fault().is_none(),
                "fault": stated.fault(),
                "clipped": clipped,
            })
        })
    }

    /// Returns the levels for JSON.
    pub fn levels_json(&self) -> Value {
        let level = |level: &LevelAnalysis| json!({ "size": level.size, "means": level.means, "alpha_coverage": level.coverage });
        self.levels.iter().map(level).collect()
    }

    /// Returns the normals for JSON; null where the values cannot be any.
    pub fn normals_json(&self) -> Value {
        self.normals.as_ref().map_or(Value::Null, |normals| {
            json!({
                "is_normal_map": normals.is_normal_map(),
                "unit_share": normals.unit_share,
                "mean_length": normals.mean_length,
                "mean_normal": normals.mean_normal,
                "inward_share": normals.inward_share,
            })
        })
    }
}

fn line(level: &LevelAnalysis, texture: &TextureData) -> String {
    let [width, height, depth] = level.size;
    let size = match texture.dimension {
        Dimension::Three => format!("{width}×{height}×{depth}"),
        _ => format!("{width}×{height}"),
    };
    let mean = |mean: &Option<f64>| mean.map_or("none".into(), |mean| format!("{mean:.6}"));
    let means: Vec<String> = channel_names(texture)
        .iter()
        .zip(&level.means)
        .map(|(name, m)| format!("{name} {}", mean(m)))
        .collect();
    let coverage =
        level.coverage.map_or(String::new(), |part| format!("; alpha covers {:.1} %", 100.0 * part));
    format!("{size}, mean {}{coverage}", means.join(", "))
}

fn normal_line(normals: &NormalAnalysis, texture: &TextureData) -> String {
    let [x, y, z] = normals.mean_normal;
    let odd = (1.0 - normals.unit_share) * f64::from(texture.width) * f64::from(texture.height);
    let mut text = format!(
        "a normal map: mean ({x:.3}, {y:.3}, {z:.3}), mean length {:.3}, {} not of length 1",
        normals.mean_length,
        counted((odd * f64::from(texture.depth)).round() as usize, "texel")
    );
    if normals.inward_share > 0.0 {
        text += &format!(", {:.1} % point inwards", 100.0 * normals.inward_share);
    }
    if texture.color_space == ColorSpace::Srgb {
        text += "; read as srgb they are bent: a scene needs color_space = \"linear\"";
    }
    text
}
