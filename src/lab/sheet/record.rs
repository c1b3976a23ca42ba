//! What was rendered and measured for a sheet, as data: what `--json` prints and captions are made of.

use std::collections::BTreeMap;

use serde::Serialize;

#[derive(Clone, Debug, Serialize)]
pub struct AxisRecord {
    pub name: String,
    pub labels: Vec<String>,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ReferenceRecord {
    pub kind: String,
    /// Samples per pixel; 0 if a file does not state them.
    pub samples: u32,
    /// The RMSE of the reference itself, from its two halves.
    pub rmse: Option<f64>,
    /// Wall seconds of its samples.
    pub seconds: f64,
}

#[derive(Clone, Debug, Default, Serialize)]
pub struct CellRecord {
    /// The varied settings, by their names.
    pub settings: BTreeMap<String, String>,
    pub label: String,
    pub size: [u32; 2],
    /// Renders the picture alone.
    pub command: String,
    /// The reason why there is no picture.
    pub error: Option<String>,
    /// What a pixel took, as text.
    pub taken: String,
    /// Samples of a pixel, on average.
    pub samples: f64,
    /// Wall seconds of the render stage, one for each repeat.
    pub seconds: Vec<f64>,
    /// The same by the device's timestamps.
    pub device_seconds: Vec<f64>,
    pub median_device_seconds: Option<f64>,
    /// The cell whose film is shown, if it is another one: both differ only in how they are shown.
    pub film_of: Option<usize>,
    /// Of the linear film against the reference, over the whole picture, without the reference's own noise.
    pub rmse: Option<f64>,
    /// The standard deviation that this noise gives it, unless the reference is a file.
    pub rmse_deviation: Option<f64>,
    /// What the RMSE is not above, where the noise does not tell more.
    pub rmse_below: Option<f64>,
    pub flip: Option<f64>,
    /// The index of the reference.
    pub reference: Option<usize>,
}

#[derive(Clone, Debug, Serialize)]
pub struct Record {
    pub program: String,
    pub scene: String,
    pub device: String,
    pub driver: String,
    pub axes: Vec<AxisRecord>,
    /// How often each cell was rendered.
    pub repeats: u32,
    /// The part that is shown: x, y, width, height.
    pub zoom: Option<[u32; 4]>,
    pub references: Vec<ReferenceRecord>,
    /// The difference that the light end of the ramp stands for.
    pub difference_scale: Option<f32>,
    pub cells: Vec<CellRecord>,
    pub warnings: Vec<String>,
    pub outputs: Vec<String>,
}
