//! The record of a study as stored in `study.json`: conditions, reference, every point with its
//! times and errors, and the evaluation. Points are read back to resume after an interruption; each
//! carries a hash of everything on which it depends.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::gpu::{DeviceInfo, Gpu};
use crate::lab::metrics::Comparison;
use crate::scene::model::Scene;

use super::Options;
use super::fit::median;
use super::results::{Analysis, OwnError};

pub const FILE: &str = "study.json";

/// What a study is asked.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Question {
    /// The least error within these seconds of rendering.
    Budget(f64),
    /// The least time to this RMSE.
    Error(f64),
}

/// The conditions beside the scene on which a point depends.
#[derive(Clone, Debug, Serialize)]
pub struct Conditions {
    pub program: String,
    pub scene: String,
    pub size: [u32; 2],
    pub seed: u32,
    pub device: DeviceInfo,
    pub repeats: u32,
    /// The time limit of the study in seconds.
    pub limit: f64,
    pub counts: Vec<u32>,
    /// The arguments that every command has beside its method.
    pub arguments: Vec<String>,
    pub folder: String,
    /// What the recommendation answers, if it is not what wins most times.
    pub question: Option<Question>,
}

impl Conditions {
    pub fn new(gpu: &Gpu, scene: &Scene, options: &Options) -> Conditions {
        Conditions {
            program: format!("moire {}", env!("CARGO_PKG_VERSION")),
            scene: scene.path.display().to_string(),
            size: [scene.width, scene.height],
            seed: scene.sampling.seed,
            device: gpu.info().clone(),
            repeats: options.repeats,
            limit: options.limit,
            counts: options.counts.clone(),
            arguments: options.arguments.clone(),
            folder: options.out.display().to_string(),
            question: options.question,
        }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MethodRecord {
    pub name: String,
    /// The name as a person calls it.
    pub label: String,
    pub algorithm: String,
    pub pattern: String,
    pub footprint: String,
    pub filter: Option<String>,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ReferenceRecord {
    /// The hash of scene, device and kind; together with the number of samples it identifies the
    /// errors.
    pub hash: String,
    /// The kind as text.
    pub kind: String,
    /// The picture file, for `moire compare`.
    pub file: String,
    /// Samples per pixel; 0 if a file does not state them.
    pub samples: u32,
    pub seconds: f64,
    /// The RMSE of the reference itself, from its two independent halves.
    pub rmse: Option<f64>,
    /// Its sums of squared errors of parts of the picture, from the halves; empty if there are none.
    #[serde(default)]
    pub blocks: Vec<f32>,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PointRecord {
    pub hash: String,
    pub method: String,
    pub spp: u32,
    /// Camera rays per pixel, including those of beams and cones; a mean if pixels differ.
    pub samples: u32,
    /// For beams, the fraction of the pixels that took samples, `spp` each.
    #[serde(default)]
    pub sampled: Option<f64>,
    /// The hash of the picture, by which equal pictures are recognised.
    #[serde(default)]
    pub picture: String,
    /// Wall seconds of the render stage, one for each repeat.
    pub seconds: Vec<f64>,
    pub device_seconds: Vec<f64>,
    pub stages: Stages,
    /// The errors against the reference, as `moire compare` measures them.
    pub errors: Errors,
    /// The RMSE without the reference's; absent if nothing is known of the reference.
    #[serde(default)]
    pub own: Option<OwnError>,
    /// Sums of squared errors of parts of the picture; empty for a point of an older study.
    #[serde(default)]
    pub blocks: Vec<f32>,
    pub command: String,
}

/// Wall seconds before and after rendering. Textures are packed and uploaded once for all methods
/// that read them alike.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Stages {
    pub pack: f64,
    pub upload: f64,
    pub compile: f64,
    pub readback: f64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    pub rmse: f64,
    pub relative_mse: f64,
    pub max: f64,
    pub over_1_255: f64,
    pub flip: f64,
}

impl Errors {
    pub fn new(comparison: &Comparison, flip: f64) -> Errors {
        Errors {
            rmse: comparison.rmse,
            relative_mse: comparison.relative_mse,
            max: comparison.max,
            over_1_255: comparison.over_1_255,
            flip,
        }
    }
}

impl PointRecord {
    pub fn median_seconds(&self) -> f64 {
        median(&self.seconds)
    }

    pub fn median_device_seconds(&self) -> f64 {
        median(&self.device_seconds)
    }
}

#[derive(Clone, Debug, Serialize)]
pub struct Record {
    #[serde(flatten)]
    pub conditions: Conditions,
    pub methods: Vec<MethodRecord>,
    pub reference: ReferenceRecord,
    /// Points omitted for lack of time, and methods that the scene does not support.
    pub notes: Vec<String>,
    pub points: Vec<PointRecord>,
    pub analysis: Option<Analysis>,
}

impl Record {
    pub fn new(conditions: Conditions, methods: Vec<MethodRecord>) -> Record {
        Record {
            conditions,
            methods,
            reference: ReferenceRecord::default(),
            notes: Vec::new(),
            points: Vec::new(),
            analysis: None,
        }
    }

    /// Returns the name of a method as a person calls it.
    pub fn label<'a>(&'a self, method: &'a str) -> &'a str {
        self.methods.iter().find(|m| m.name == method).map_or(method, |m| &m.label)
    }

    /// Returns the measured points of a method, fewest samples first.
    pub fn points_of<'a>(&'a self, method: &'a str) -> impl Iterator<Item = &'a PointRecord> {
        self.points.iter().filter(move |p| p.method == method)
    }
}

/// The points of an earlier run.
#[derive(Debug, Default)]
pub struct Kept {
    pub reference: Option<ReferenceRecord>,
    pub points: Vec<PointRecord>,
}

/// Reads the points of an earlier run; a damaged file counts as none.
pub fn read(folder: &Path) -> Kept {
    let text = fs::read_to_string(folder.join(FILE)).unwrap_or_default();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    let points = json["points"].as_array().cloned().unwrap_or_default();
    Kept {
        reference: serde_json::from_value(json["reference"].clone()).ok(),
        points: points.into_iter().filter_map(|p| serde_json::from_value(p).ok()).collect(),
    }
}
