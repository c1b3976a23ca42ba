//! Files of the program that a new scene needs beside it. Input: what is shown, or a scene of the program. Output: names and
//! bytes, and the scene's text with these names.

use std::path::{Path, PathBuf};

use super::Kind;
use crate::core::built_in;
use crate::core::error::Result;
use crate::scene::{BuiltIn, load};

/// Files by the paths of the program.
#[derive(Default)]
pub(super) struct Copies(Vec<PathBuf>);

impl Copies {
    /// Adds pictures for a surface, where none are given.
    pub fn samples(&mut self, kind: Kind) -> Vec<PathBuf> {
        let names: &[&str] = match kind {
            Kind::Floor => &["poster.png"],
            Kind::Ball => &["tiles.png", "studs-normal.png", "sky.png"],
            Kind::Quad => &["grass.png"],
            Kind::Model => &[],
        };
        let paths = names.iter().map(|name| built_in::path_of(&format!("textures/{name}")));
        let paths: Vec<PathBuf> = paths.collect();
        self.0.extend(paths.iter().cloned());
        paths
    }

    /// Adds a model.
    pub fn model(&mut self) -> PathBuf {
        let path = built_in::path_of("models/sign.glb");
        self.0.push(path.clone());
        path
    }

    /// Returns names and bytes, each name once.
    pub fn files(&self) -> impl Iterator<Item = (&str, &'static [u8])> {
        let mut names: Vec<&str> = Vec::new();
        self.0.iter().filter_map(move |path| {
            let name = path.file_name()?.to_str()?;
            let is_new = !names.contains(&name);
            names.push(name);
            is_new.then_some((name, built_in::bytes(path)?))
        })
    }

    /// Returns where the scene can be read before it is written: among the files that it names.
    pub fn place(&self, out: &Path) -> PathBuf {
        match self.0.first().and_then(|path| path.parent()) {
            Some(folder) => folder.join("new.toml"),
            None => out.to_owned(),
        }
    }
}

/// Returns the text of a scene whose files lie beside it, and these files.
pub(super) fn of_scene(scene: BuiltIn) -> Result<(String, Copies)> {
    let read = load(&PathBuf::from(scene.shown()))?;
    let textures = read.textures.iter().flat_map(|texture| texture.content.files()).map(Path::to_owned);
    let copies = Copies(textures.chain(read.sources.iter().cloned()).collect());
    let mut text = String::new();
    for (index, part) in scene.text().split('"').enumerate() {
        if index > 0 {
            text.push('"');
        }
        let is_path = index % 2 == 1 && part.starts_with("../");
        text.push_str(if is_path { part.rsplit('/').next().unwrap_or(part) } else { part });
    }
    Ok((text, copies))
}
