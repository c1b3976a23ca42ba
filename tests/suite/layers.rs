//! Layers of a picture: known answers, the device against the oracle, the files of `--aov`, and what `moire inspect` says
//! of textures.

mod agree;
mod browser;
mod command;
mod inspect;
mod known;
mod maps;
mod surfaces;

use std::fs;
use std::path::Path;

use moire::internal::core::layer::Layer;
use moire::internal::core::progress::NoProgress;
use moire::internal::output::{WriteOptions, write};
use moire::internal::render::layers::{Aov, render_layers};
use moire::internal::render::{On, Options};
use moire::internal::scene::model::Scene;
use moire::internal::scene::{self, prune::prune};

use crate::support::gradient;

/// Side of the texture `t.png` that scenes here read.
const TEXELS: u32 = 64;

/// A plane under a camera that looks straight down with parallel rays: a pixel is an eighth of a unit wide.
const DOWN: &str = r#"
[camera]
eye = [0.0, 5.0, 0.0]
look_at = [0.0, 0.0, 0.0]
up = [0.0, 0.0, -1.0]
orthographic_height = 2.0
[image]
width = 16
height = 16
[[texture]]
name = "t"
file = "t.png"
[[sampler]]
name = "s"
filter = "linear"
mip = "linear"
[[material]]
name = "m"
model = "unlit"
texture = "t"
sampler = "s"
mapping = { kind = "surface", scale = [0.5, 0.25] }
[[plane]]
origin = [0.0, 0.0, 0.0]
tangent = [1.0, 0.0, 0.0]
bitangent = [0.0, 0.0, 1.0]
material = "m"
"#;

/// Writes a scene and its texture into a folder.
fn stage(folder: &Path, text: &str) -> std::path::PathBuf {
    let path = folder.join("scene.toml");
    fs::write(&path, text).unwrap();
    write(&gradient(TEXELS, TEXELS), &folder.join("t.png"), &WriteOptions::default()).unwrap();
    path
}

/// Calls `with` with a scene from a text, while its files exist.
fn with_scene<T>(text: &str, with: impl FnOnce(Scene) -> T) -> T {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = scene::load(&stage(folder.path(), text)).unwrap();
    prune(&mut scene);
    with(scene)
}

fn layers(scene: &Scene, on: On, wanted: &[Aov]) -> Vec<Layer> {
    render_layers(scene, &Options::default(), &[on], wanted, None, &NoProgress).unwrap()
}

fn layer(scene: &Scene, aov: Aov) -> Layer {
    layers(scene, On::Oracle, &[aov]).remove(0)
}
