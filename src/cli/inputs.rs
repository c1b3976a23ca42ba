//! The files that a command reads, none of which it may replace. In: these files, and those that it is to write. Out: an
//! error before any work if one of these is one of those, by whatever path, or cannot be written. Every command that writes
//! a file asks here.

use std::path::{Path, PathBuf};

use crate::core::error::{Error, Result};
use crate::output::{self, OutputFolder};
use crate::scene::model::Scene;

/// Files that are read, each with what it is in messages.
#[derive(Default)]
pub struct Inputs(Vec<(PathBuf, String)>);

impl Inputs {
    /// Returns one file.
    pub fn of(path: &Path, what: &str) -> Inputs {
        Inputs::default().and(path, what)
    }

    /// Returns the files of a scene: its own, its textures and its meshes.
    pub fn of_scene(scene: &Scene) -> Inputs {
        let mut inputs = Inputs::default();
        inputs.add_scene(scene);
        inputs
    }

    /// Adds a file.
    pub fn and(mut self, path: &Path, what: &str) -> Inputs {
        self.add(path, what.to_owned());
        self
    }

    /// Adds the files of a scene.
    pub fn add_scene(&mut self, scene: &Scene) {
        self.add(&scene.path, "the scene file".into());
        for texture in &scene.textures {
            let what = format!("the file of texture \"{}\"", texture.name);
            texture.content.files().into_iter().for_each(|file| self.add(file, what.clone()));
        }
        scene.sources.iter().for_each(|file| self.add(file, "a file of the scene's meshes".into()));
    }

    fn add(&mut self, path: &Path, what: String) {
        if !self.0.iter().any(|(known, _)| known == path) {
            self.0.push((path.to_owned(), what));
        }
    }

    /// Checks that a picture can be written and replaces none of the files.
    pub fn check_picture(&self, path: &Path) -> Result<()> {
        output::check_writable(path)?;
        self.check_kept(path)
    }

    /// Checks that a file of another kind can be written and replaces none of the files.
    pub fn check_file(&self, path: &Path) -> Result<()> {
        output::check_file_writable(path)?;
        self.check_kept(path)
    }

    /// Makes a folder where it is missing. Files of these names in it must replace none of those that are read.
    pub fn prepare_folder<'n>(
        &self,
        folder: &Path,
        first: &'n str,
        others: impl IntoIterator<Item = &'n str>,
    ) -> Result<OutputFolder> {
        let names = std::iter::once(first).chain(others);
        names.map(|name| folder.join(name)).try_for_each(|path| self.check_kept(&path))?;
        OutputFolder::prepare(folder, first)
    }

    /// Refuses an output that is one of the files.
    fn check_kept(&self, output: &Path) -> Result<()> {
        let Some((_, what)) = self.0.iter().find(|(input, _)| is_same(output, input)) else { return Ok(()) };
        Err(Error::with_help(
            format!("{}: this is {what}, which the output would replace", output.display()),
            "choose another name for what is written: with -o, --out or --diff",
        ))
    }
}

/// Returns true if two paths lead to one file, through links of both kinds, too.
fn is_same(a: &Path, b: &Path) -> bool {
    if a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b)) {
        return true;
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let number = |path: &Path| path.metadata().ok().map(|known| (known.dev(), known.ino()));
        number(a).is_some_and(|own| number(b) == Some(own))
    }
    #[cfg(not(unix))]
    false
}
