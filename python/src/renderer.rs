//! Renderers: devices, or float64 on the CPU, that are kept over renders. In: scenes and options. Out: arrays of linear
//! light or of layers, and what is known of the render.

use std::sync::{Mutex, PoisonError};

use moire::internal::core::layer::Layer;
use moire::internal::gpu::{DeviceSelect, list_devices};
use moire::internal::render::layers::{Aov, render_layers};
use moire::internal::render::{Kept, On, Picture, render_kept};
use moire::internal::scene::advice;
use moire::internal::scene::model;
use moire::{Error, ErrorKind, Result};
use numpy::{IntoPyArray, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde_json::{Value, json};

use crate::errors::{exception, or_kind};
use crate::options::{Wanted, unknown};
use crate::scene::Scene;
use crate::watched::watched;

/// Devices that are kept.
#[pyclass(frozen, module = "moire._moire")]
pub struct Renderer {
    on: Vec<On>,
    device: String,
    kept: Mutex<Kept>,
}

#[pymethods]
impl Renderer {
    /// Selects the devices.
    #[new]
    fn new(py: Python<'_>, devices: Vec<String>) -> PyResult<Renderer> {
        let (on, device) = py.detach(|| select(&devices)).map_err(|error| exception(py, &error))?;
        Ok(Renderer { on, device, kept: Mutex::new(Kept::with_textures()) })
    }

    /// The devices' names.
    #[getter]
    fn device(&self) -> &str {
        &self.device
    }

    /// Renders a scene. Returns an array of height, width and three channels, and a report as JSON.
    fn render<'py>(
        &self,
        py: Python<'py>,
        scene: &Scene,
        options: &Bound<'py, PyDict>,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<(Bound<'py, PyArray3<f32>>, String)> {
        let wanted = Wanted::read(options)?;
        let changed = wanted.apply(&scene.parts).map_err(|error| exception(py, &error))?;
        let picture = watched(py, "rendering", progress, |progress| {
            let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
            let picture = render_kept(&changed, &wanted.options, &self.on, &mut kept, progress);
            picture.map_err(|error| {
                // A lost device stays lost: the next render opens it anew.
                if error.kind().is_transient() {
                    kept.close();
                }
                or_kind(error, ErrorKind::Unsupported)
            })
        })?;
        let report = report(&changed, &picture).to_string();
        let [width, height] = [picture.film.width, picture.film.height].map(|side| side as usize);
        let values = picture.film.pixels.into_flattened();
        Ok((values.into_pyarray(py).reshape([height, width, 3])?, report))
    }

    /// Measures layers. Returns for each its name and an array, which has NaN where there is no value.
    fn aov<'py>(
        &self,
        py: Python<'py>,
        scene: &Scene,
        names: Vec<String>,
        options: &Bound<'py, PyDict>,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyList>> {
        let wanted = Wanted::read(options)?;
        let layer = |name: &String| Aov::from_name(name).ok_or_else(|| unknown("aov", name, Aov::NAMES));
        let aovs = names.iter().map(layer).collect::<Result<Vec<Aov>>>();
        let aovs = aovs.map_err(|error| exception(py, &error))?;
        let changed = wanted.apply(&scene.parts).map_err(|error| exception(py, &error))?;
        aovs.iter().try_for_each(|aov| aov.check(&changed)).map_err(|error| exception(py, &error))?;
        let layers = watched(py, "measuring layers", progress, |progress| {
            let layers = render_layers(&changed, &wanted.options, &self.on, &aovs, None, progress);
            layers.map_err(|error| or_kind(error, ErrorKind::Unsupported))
        })?;
        let size =
            wanted.options.crop.map_or([changed.width, changed.height], |crop| [crop.width, crop.height]);
        let [width, height] = size.map(|side| side as usize);
        let found = PyList::empty(py);
        for layer in layers {
            let channels = layer.channels.len();
            let values = interleaved(&layer).into_pyarray(py).reshape([height, width, channels])?;
            found.append((layer.name, values))?;
        }
        Ok(found)
    }
}

/// Returns the backends of these names, and their full names.
fn select(devices: &[String]) -> Result<(Vec<On>, String)> {
    let mut on = devices.iter().map(|text| On::parse(text)).collect::<Result<Vec<On>>>()?;
    if on.is_empty() {
        on.push(On::Device(DeviceSelect::Default));
    }
    let name = |one: &On| match one {
        On::Oracle => Ok("oracle".to_owned()),
        On::Device(select) => {
            let known = list_devices()?;
            Ok(known[select.choose(&known)?].name.clone())
        }
    };
    let names = on.iter().map(name).collect::<Result<Vec<String>>>()?;
    Ok((on, names.join(" + ")))
}

/// Returns the values pixel by pixel.
fn interleaved(layer: &Layer) -> Vec<f32> {
    let pixel = |(at, present): (usize, &bool)| {
        let value = move |values: &Vec<f32>| if *present { values[at] } else { f32::NAN };
        layer.channels.iter().map(move |channel| value(&channel.values)).collect::<Vec<f32>>()
    };
    layer.present.iter().enumerate().flat_map(pixel).collect()
}

fn report(scene: &model::Scene, picture: &Picture) -> Value {
    let (report, seconds) = (&picture.report, &picture.report.seconds);
    let outcome = report.outcome.as_ref();
    let warnings = [advice::of_scene(scene), report.warnings.clone()].concat();
    json!({
        "device": picture.device,
        "driver": picture.driver,
        "pattern": scene.sampling.pattern.name(),
        "algorithm": scene.sampling.algorithm.name(),
        "samples": outcome.map_or(f64::from(picture.film.samples), |outcome| outcome.mean_samples),
        "reached": outcome.is_none_or(|outcome| outcome.reached),
        "estimated_rmse": outcome.map(|outcome| outcome.estimated_rmse),
        "outcome": report.outcome,
        "seconds": {
            "startup": seconds.startup,
            "load": seconds.load,
            "compile": seconds.compile,
            "upload": seconds.upload,
            "render": seconds.render,
            "readback": seconds.readback,
        },
        "device_render_seconds": report.device_render_seconds,
        "device_bytes": report.device_bytes,
        "warnings": warnings,
    })
}

/// Lists the devices of this machine as JSON.
#[pyfunction]
pub fn devices(py: Python<'_>) -> PyResult<String> {
    let list = || {
        let devices = list_devices()?;
        let default = DeviceSelect::Default.choose(&devices).ok();
        let row = |(number, device)| {
            let mut row = serde_json::to_value(device).map_err(|error| Error::new(error.to_string()))?;
            row["default"] = Value::from(default == Some(number));
            Ok(row)
        };
        devices.iter().enumerate().map(row).collect::<Result<Vec<Value>>>()
    };
    let rows = py.detach(list).map_err(|error| exception(py, &error))?;
    Ok(Value::from(rows).to_string())
}
