//! Maps the needs of a packed scene to the specialization constants of its pipelines, and to the list of what was left
//! out. The constants are in `src/schema/specialization.rs`; `narrowed.rs` computes the value of each.

mod narrowed;
mod needs;

use crate::pack::PackedScene;
use crate::schema::constants::DYNAMIC;
use crate::schema::enums::Reals;
pub use crate::schema::enums::{TexelSource, TextureSize};
use crate::schema::specialization::{Constant, Kind};

use narrowed::narrowed;
use needs::compensates;
pub use needs::{bends_rays, bounces};

/// Longer lists are read at run time, as unrolled code would grow without limit.
const UNROLL: usize = 16;

/// The features for which a pipeline is built.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Features {
    /// (constant, value) in the order of the table.
    pub values: Vec<(Constant, u32)>,
    /// User-visible names of the code that the pipeline leaves out.
    pub left_out: Vec<String>,
    pub source: TexelSource,
    /// True if the film has a second half for compensation.
    pub compensated: bool,
    /// True if rays, shapes and texture coordinates are f64.
    pub double: bool,
    /// The quantities that the pipeline can measure, one bit each.
    pub quantities: u32,
    /// True if nothing is left out.
    pub everything: bool,
}

impl Features {
    /// Returns exactly the features that the scene needs, or with `keep_everything` all of them.
    pub fn new(scene: &PackedScene, image_source: bool, keep_everything: bool) -> Features {
        let source = match (scene.records.textures.is_empty(), image_source) {
            (true, _) if !keep_everything => TexelSource::None,
            (false, true) if scene.has_solids() => TexelSource::Solids,
            (false, true) => TexelSource::Image,
            _ => TexelSource::Buffer,
        };
        let mut features = Features {
            values: Vec::new(),
            left_out: Vec::new(),
            source,
            compensated: true,
            double: scene.double,
            quantities: needs::quantities(scene.header.quantity),
            everything: keep_everything,
        };
        if keep_everything {
            features.values = widest().collect();
            return features;
        }
        features.compensated = compensates(scene);
        for constant in Constant::all() {
            if let Some(value) = narrowed(constant, scene) {
                features.values.push((constant, value));
                features.left_out.extend(left_out(constant, value));
            }
        }
        let unused = [
            ("texel buffer", !matches!(source, TexelSource::Buffer | TexelSource::Solids)),
            ("geometry in f64", !scene.double),
            ("images and device samplers", !matches!(source, TexelSource::Image | TexelSource::Solids)),
        ];
        features.left_out.extend(unused.iter().filter(|(_, unused)| *unused).map(|(text, _)| (*text).into()));
        features
    }
}

impl Features {
    /// Returns the precision of the records for shaders that compute in f32.
    pub fn records(&self) -> Reals {
        if self.double { Reals::F64Records } else { Reals::F32 }
    }

    /// Returns the value of a constant, `None` for one that the scene does not narrow.
    pub fn value(&self, constant: Constant) -> Option<u32> {
        self.values.iter().find(|(own, _)| *own == constant).map(|(_, value)| *value)
    }

    /// Returns true if the code of a switch is kept.
    pub fn has(&self, switch: Constant) -> bool {
        self.value(switch).is_some_and(|value| value != 0)
    }
}

/// Returns the widest value of each constant that can be narrowed: all modes, run-time counts, all code. These are the
/// shaders' defaults.
pub fn widest() -> impl Iterator<Item = (Constant, u32)> {
    let widest = |constant: Constant| match constant.kind() {
        Kind::Modes(names) => Some((1 << names.len()) - 1),
        Kind::Count => Some(DYNAMIC),
        Kind::Switch => Some(1),
        Kind::Parameter => None,
    };
    Constant::all().filter_map(move |constant| Some((constant, widest(constant)?)))
}

fn left_out(constant: Constant, value: u32) -> Option<String> {
    let what = constant.what();
    match constant.kind() {
        Kind::Modes(names) => {
            let absent: Vec<&str> =
                names.iter().enumerate().filter(|(i, _)| value >> i & 1 == 0).map(|(_, n)| *n).collect();
            (!absent.is_empty()).then(|| format!("{what}: {}", absent.join(", ")))
        }
        Kind::Count => (value != DYNAMIC).then(|| what.to_string()),
        Kind::Switch => (value == 0).then(|| what.to_string()),
        Kind::Parameter => None,
    }
}
