//! A whole scene, which only a builder makes, from a file or from code, so that all rules are kept.

use std::path::Path;

use super::builder::SceneBuilder;
use super::model::{self, Camera};
use super::{Reading, Setting, load, load_as, parse};
use crate::core::error::Result;

/// A scene to render: what a [`Renderer`](crate::Renderer) takes. All its limits are checked.
///
/// ```
/// use moire::model::{Camera, Sphere};
/// use moire::Scene;
///
/// let mut scene = Scene::builder(Camera::looking([0.0, 0.0, 5.0], [0.0, 0.0, 0.0], 40.0), 64, 64);
/// scene.shape(Sphere::new([0.0, 0.0, 0.0], 0.0));
/// let error = scene.build().unwrap_err();
/// assert_eq!(error.kind(), moire::ErrorKind::Scene);
/// assert!(error.to_string().contains("radius"), "{error}");
/// ```
#[derive(Clone, Debug)]
pub struct Scene(model::Scene);

impl Scene {
    /// Reads a scene file, a scene of the program if the path is `@NAME`, or standard input if it is `-`. The ending of the path selects the format. Textures
    /// are named, not opened.
    pub fn from_file(path: impl AsRef<Path>) -> Result<Scene> {
        load(path.as_ref()).map(Scene)
    }

    /// Reads a scene file as [`from_file`](Scene::from_file) does, with other values for some of its keys: each
    /// setting is `KEY=VALUE`, as `moire render --set` takes it. Paths in a value are relative to the current folder.
    ///
    /// ```no_run
    /// # fn main() -> moire::Result<()> {
    /// let scene = moire::Scene::from_file_with("scene.toml", ["sampling.spp=64", "sampler.*.filter=ewa"])?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn from_file_with<S: AsRef<str>>(
        path: impl AsRef<Path>,
        settings: impl IntoIterator<Item = S>,
    ) -> Result<Scene> {
        let settings = settings.into_iter().map(|setting| Setting::parse(setting.as_ref()));
        let settings = settings.collect::<Result<Vec<_>>>()?;
        load_as(path.as_ref(), &Reading { settings: &settings, ..Reading::default() }).map(Scene)
    }

    /// Reads a scene from the text of a scene file. Paths in it are relative to the current folder.
    ///
    /// ```
    /// let error = moire::Scene::from_toml("[camera]\neye = [0, 0, nan]\n").unwrap_err();
    /// assert!(error.to_string().starts_with("scene.toml:1:1: key \"camera.look_at\" is missing"), "{error}");
    /// ```
    pub fn from_toml(text: &str) -> Result<Scene> {
        parse(Path::new("scene.toml"), text).map(Scene)
    }

    /// Starts a scene with this camera and a picture of this size in pixels.
    pub fn builder(camera: Camera, width: u32, height: u32) -> SceneBuilder {
        SceneBuilder::new(camera, width, height)
    }

    /// Returns width and height of the picture in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.0.width, self.0.height]
    }

    pub(super) fn new(scene: model::Scene) -> Scene {
        Scene(scene)
    }

    /// Returns its parts.
    pub(crate) fn parts(&self) -> &model::Scene {
        &self.0
    }
}
