//! Renderers: devices, or float64 on the CPU, that are kept over renders. In: scenes and options. Out: arrays of linear
//! light or of layers, and what is known of the render.

use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::Duration;
use std::{mem, thread};

use moire::internal::cli::account::of_words;
use moire::internal::core::layer::Layer;
use moire::internal::gpu::{DeviceSelect, list_devices};
use moire::internal::render::layers::{Aov, render_layers};
use moire::internal::render::{Kept, On, Picture, render_kept};
use moire::internal::scene::model;
use moire::{Error, ErrorKind, Progress, Result};
use numpy::{IntoPyArray, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde_json::{Value, json};

use crate::errors::{exception, or_kind, plain};
use crate::options::{Wanted, unknown};
use crate::process;
use crate::scene::Scene;
use crate::watched::watched;

/// How long another render of the same renderer is waited for before Ctrl-C is looked for again.
const PERIOD: Duration = Duration::from_millis(2);

/// Devices that are kept.
#[pyclass(frozen, module = "moire._moire")]
pub struct Renderer {
    on: Vec<On>,
    /// The devices as they were named.
    named: Vec<String>,
    device: String,
    /// Nothing once the renderer is closed.
    kept: Mutex<Option<Kept>>,
}

impl Drop for Renderer {
    fn drop(&mut self) {
        if process::is_forked() {
            // The threads that a device would wait for are those of another process.
            mem::forget(self.lock().take());
        }
    }
}

#[pymethods]
impl Renderer {
    /// Selects the devices.
    #[new]
    fn new(py: Python<'_>, devices: Vec<String>) -> PyResult<Renderer> {
        process::begin(py)?;
        let (on, device) = py.detach(|| select(&devices)).map_err(|error| exception(py, &error))?;
        Ok(Renderer { on, named: devices, device, kept: Mutex::new(Some(Kept::with_textures())) })
    }

    /// The devices' names.
    #[getter]
    fn device(&self) -> &str {
        &self.device
    }

    /// Gives the devices back, after a render that another thread may have begun.
    fn close(&self, py: Python<'_>) {
        py.detach(|| drop(self.lock().take()));
    }

    /// Renders a scene. Returns an array of height, width and three channels, and what is told of it as JSON.
    fn render<'py>(
        &self,
        py: Python<'py>,
        scene: &Scene,
        options: &Bound<'py, PyDict>,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<(Bound<'py, PyArray3<f32>>, String)> {
        process::begin(py)?;
        let wanted = Wanted::read(options)?;
        let changed = wanted.apply(&scene.parts).map_err(|error| exception(py, &error))?;
        let mut picture = watched(py, "rendering", progress, |progress| {
            let mut kept = self.wait(progress)?;
            let kept = kept.as_mut().ok_or_else(|| Error::new(CLOSED))?;
            let picture = render_kept(&changed, &wanted.options, &self.on, kept, progress);
            picture.map_err(|error| {
                // A lost device stays lost: the next render opens it anew.
                if error.kind().is_transient() {
                    kept.close();
                }
                or_kind(error, ErrorKind::Unsupported)
            })
        })?;
        let told =
            self.told(scene, &wanted, &changed, &mut picture).map_err(|error| exception(py, &error))?;
        let [width, height] = [picture.film.width, picture.film.height].map(|side| side as usize);
        let values = picture.film.pixels.into_flattened();
        Ok((values.into_pyarray(py).reshape([height, width, 3])?, told.to_string()))
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
        process::begin(py)?;
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

impl Renderer {
    fn lock(&self) -> MutexGuard<'_, Option<Kept>> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for the render of another thread, unless this one is cancelled.
    fn wait(&self, progress: &dyn Progress) -> Result<MutexGuard<'_, Option<Kept>>> {
        loop {
            match self.kept.try_lock() {
                Ok(kept) => return Ok(kept),
                Err(TryLockError::Poisoned(kept)) => return Ok(kept.into_inner()),
                Err(TryLockError::WouldBlock) if progress.cancelled() => return Err(Error::Interrupted),
                Err(TryLockError::WouldBlock) => thread::sleep(PERIOD),
            }
        }
    }

    /// Returns what is told of a picture: the report of the program with what notebooks ask for first, the record that its
    /// files carry, where it lies in a larger one, and the files that it shall not replace.
    fn told(
        &self,
        scene: &Scene,
        wanted: &Wanted,
        changed: &model::Scene,
        picture: &mut Picture,
    ) -> Result<Value> {
        let devices = self.named.iter().map(|name| format!("--device={name}"));
        let words: Vec<String> = scene.words.iter().cloned().chain(wanted.words()).chain(devices).collect();
        let (mut record, mut report) = of_words(&words, &scene.path, scene.file.clone(), changed, picture)?;
        record.scene.arrays.clone_from(&scene.arrays);
        let outcome = picture.report.outcome.as_ref();
        for (key, value) in [
            ("pattern", json!(changed.sampling.pattern.name())),
            ("algorithm", json!(changed.sampling.algorithm.name())),
            ("samples", json!(outcome.map_or(f64::from(picture.film.samples), |found| found.mean_samples))),
            ("reached", json!(outcome.is_none_or(|found| found.reached))),
            ("estimated_rmse", json!(outcome.map(|found| found.estimated_rmse))),
            ("outcome", json!(outcome)),
            ("warnings", json!(picture.report.warnings.iter().map(|told| plain(told)).collect::<Vec<_>>())),
        ] {
            report[key] = value;
        }
        if let Some(report) = report.as_object_mut() {
            // Nothing is written yet, and the process is that of the caller.
            report.remove("outputs");
            report.remove("process");
        }
        if let Some(seconds) = report["seconds"].as_object_mut() {
            seconds.remove("write");
            seconds.remove("total");
        }
        let placement = wanted.options.crop.map(|crop| [crop.x, crop.y, changed.width, changed.height]);
        Ok(json!({
            "report": report,
            "record": record.text(),
            "placement": placement,
            "inputs": scene.inputs().into_iter().map(|(path, what)| (path.display().to_string(), what)).collect::<Vec<_>>(),
        }))
    }
}

/// The message of a renderer that is used after its end.
const CLOSED: &str = "this renderer is closed";

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

/// Lists the devices of this machine as JSON.
#[pyfunction]
pub fn devices(py: Python<'_>) -> PyResult<String> {
    process::begin(py)?;
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
