//! Scenes. In: a file or a text, and values and arrays in place of some of its own. Out: a scene that keeps all rules, and
//! what pictures record of it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use moire::ErrorKind;
use moire::internal::core::panics;
use moire::internal::scene::{Reading, SceneFile, Setting, load_recorded, model, parse_as};
use moire::internal::texture::source::TextureContent;
use pyo3::prelude::*;

use crate::errors::{exception, or_kind};
use crate::process;
use crate::texels::{Texels, replace};

/// The name of a text in messages and records.
const TEXT: &str = "scene.toml";

/// A texture's name, its texels, and what they mean.
type Replaced = (String, Py<Texels>, Option<String>);

/// A scene that was read.
#[pyclass(frozen, module = "moire._moire")]
pub struct Scene {
    pub parts: model::Scene,
    /// The scene's file as it was given.
    pub path: PathBuf,
    /// What pictures record of it.
    pub file: SceneFile,
    /// The options by which it was read, as `moire render` has them.
    pub words: Vec<String>,
    /// The textures that are arrays.
    pub arrays: Vec<String>,
}

#[pymethods]
impl Scene {
    /// Reads a scene: a file, or else a text in the format of scene files.
    #[new]
    #[pyo3(signature = (path, text, settings, camera, keeps_meshes, textures))]
    fn new(
        py: Python<'_>,
        path: Option<PathBuf>,
        text: Option<String>,
        settings: Vec<String>,
        camera: Option<String>,
        keeps_meshes: bool,
        textures: Vec<Replaced>,
    ) -> PyResult<Scene> {
        process::check(py)?;
        let words = camera.iter().map(|camera| format!("--camera={camera}"));
        let words = words.chain(settings.iter().map(|text| format!("--set={text}"))).collect();
        let read = || {
            let settings =
                settings.iter().map(|text| Setting::parse(text)).collect::<moire::Result<Vec<_>>>()?;
            let reading = Reading { camera: camera.as_deref(), keeps_meshes, settings: &settings };
            let (mut parts, file) = match (&path, &text) {
                (Some(path), _) => {
                    // What begins with an option is about that and no file.
                    let is_option = |error: &moire::Error| error.to_string().starts_with("--");
                    let told =
                        |error| if is_option(&error) { error } else { or_kind(error, ErrorKind::File) };
                    load_recorded(path, &reading).map_err(told)?
                }
                (None, text) => panics::contain(&TEXT, || {
                    let text = text.as_deref().unwrap_or_default();
                    let scene = parse_as(Path::new(TEXT), text, &reading);
                    let scene = scene.map_err(|error| or_kind(error, ErrorKind::Scene))?;
                    Ok((scene, SceneFile::of_bytes(text.as_bytes())))
                })?,
            };
            for (name, texels, color_space) in &textures {
                replace(&mut parts, name, texels.get(), color_space.as_deref())?;
            }
            Ok((parts, file))
        };
        let (parts, file) = py.detach(read).map_err(|error| exception(py, &error))?;
        if !parts.sources.is_empty() {
            // Meshes are read by several threads.
            process::begin(py)?;
        }
        let arrays = textures.into_iter().map(|(name, ..)| name).collect();
        Ok(Scene { parts, path: path.unwrap_or(TEXT.into()), file, words, arrays })
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

    /// The textures by their names, with what each is read from.
    #[getter]
    fn textures(&self) -> BTreeMap<&str, String> {
        let told = |content: &TextureContent| match content {
            TextureContent::Procedural(_) => "a pattern".to_owned(),
            TextureContent::Texels(texels) => {
                format!("an array of {}×{} texels, {}", texels.width, texels.height, texels.format)
            }
            content => {
                let files = content.files().into_iter().map(|file| file.display().to_string());
                let files = files.collect::<Vec<_>>().join(", ");
                if files.is_empty() { "values of the scene".into() } else { files }
            }
        };
        self.parts.textures.iter().map(|texture| (texture.name.as_str(), told(&texture.content))).collect()
    }
}

impl Scene {
    /// Returns the files that the scene is made of, each with what it is: no picture shall replace them.
    pub fn inputs(&self) -> Vec<(PathBuf, String)> {
        let own = self.parts.path.is_file().then(|| (self.parts.path.clone(), "the scene file".to_owned()));
        let textures = self.parts.textures.iter().flat_map(|texture| {
            let what = format!("the file of texture \"{}\"", texture.name);
            texture.content.files().into_iter().map(move |file| (file.to_owned(), what.clone()))
        });
        let sources = self.parts.sources.iter().map(|file| (file.clone(), "a file of the scene".to_owned()));
        own.into_iter().chain(textures).chain(sources).collect()
    }
}
