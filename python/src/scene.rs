//! Scenes. In: a file or a text, and values in place of some of its own. Out: a scene that keeps all rules.

use std::path::{Path, PathBuf};

use moire::ErrorKind;
use moire::internal::core::panics;
use moire::internal::scene::{Reading, Setting, load_as, model, parse_as};
use pyo3::prelude::*;

use crate::errors::{exception, or_kind};

/// The name of a text in messages.
const TEXT: &str = "scene.toml";

/// A scene that was read.
#[pyclass(frozen, module = "moire._moire")]
pub struct Scene {
    pub parts: model::Scene,
}

#[pymethods]
impl Scene {
    /// Reads a scene: a file, or else a text in the format of scene files.
    #[new]
    #[pyo3(signature = (path, text, settings, camera, keeps_meshes))]
    fn new(
        py: Python<'_>,
        path: Option<PathBuf>,
        text: Option<String>,
        settings: Vec<String>,
        camera: Option<String>,
        keeps_meshes: bool,
    ) -> PyResult<Scene> {
        let read = || {
            let settings =
                settings.iter().map(|text| Setting::parse(text)).collect::<moire::Result<Vec<_>>>()?;
            let reading = Reading { camera: camera.as_deref(), keeps_meshes, settings: &settings };
            match (&path, &text) {
                (Some(path), _) => load_as(path, &reading).map_err(|error| or_kind(error, ErrorKind::File)),
                (None, text) => panics::contain(&TEXT, || {
                    parse_as(Path::new(TEXT), text.as_deref().unwrap_or_default(), &reading)
                }),
            }
        };
        let parts = py.detach(read).map_err(|error| exception(py, &error))?;
        Ok(Scene { parts })
    }

    /// Width and height of the picture in pixels.
    #[getter]
    fn size(&self) -> (u32, u32) {
        (self.parts.width, self.parts.height)
    }

    /// Samples per pixel.
    #[getter]
    fn spp(&self) -> u32 {
        self.parts.sampling.spp
    }

    /// The sample pattern.
    #[getter]
    fn pattern(&self) -> &'static str {
        self.parts.sampling.pattern.name()
    }

    /// The rendering algorithm.
    #[getter]
    fn algorithm(&self) -> &'static str {
        self.parts.sampling.algorithm.name()
    }
}
