//! `--aov` of `moire render`: which layers are written beside the picture, or in place of it, and where. Input: the
//! options, the outputs and the scene; what cannot be written is refused before anything is rendered. Output: files.

use std::path::{Path, PathBuf};

use clap::Args;

use super::OUTPUT;
use super::outputs::Outputs;
use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::layer::Layer;
use crate::core::progress::Progress;
use crate::lab::inspect::picture::picture;
use crate::lab::inspect::uses::name_of;
use crate::output::{self, DisplayTransform, Format, Named, WriteOptions};
use crate::render::layers::{Aov, render_layers};
use crate::render::{On, Options, Picture};
use crate::scene::model::Scene;

#[derive(Args, Debug)]
pub struct LayerArgs {
    /// Layers to write too, such as level,depth: see --help
    ///
    /// Separated by commas: into .exr as channels such as level.Y, beside x.png, .jpg and .tif as false-colour pictures
    /// x.level.png.
    #[arg(long, value_name = "LIST", hide_possible_values = true, value_delimiter = ',', value_parser = super::named_parser(Aov::NAMES, Aov::from_name), help_heading = OUTPUT)]
    aov: Vec<Aov>,
    /// Write the layers alone, without the picture
    #[arg(long, requires = "aov", conflicts_with = "json", help_heading = OUTPUT)]
    no_beauty: bool,
}

impl LayerArgs {
    /// Returns true unless the layers are written alone.
    pub fn has_beauty(&self) -> bool {
        !self.no_beauty
    }

    /// Returns true if a layer numbers shapes, of which each mesh has to be one.
    pub fn numbers_meshes(&self) -> bool {
        self.aov.contains(&Aov::Instance)
    }
}

/// A false-colour picture and its file.
struct FalseColors {
    aov: Aov,
    path: PathBuf,
}

/// The layers of a render.
pub struct Wanted {
    /// Each once, in the order of the command line.
    aovs: Vec<Aov>,
    pub has_beauty: bool,
    pictures: Vec<FalseColors>,
}

impl Wanted {
    /// Returns the layers that are asked for. Fails if they cannot be measured, or if an output cannot hold them.
    pub fn new(args: &LayerArgs, outputs: &Outputs, scene: &Scene) -> Result<Wanted> {
        let mut aovs: Vec<Aov> = Vec::new();
        for &aov in &args.aov {
            if !aovs.contains(&aov) {
                aovs.push(aov);
            }
        }
        let mut wanted = Wanted { aovs, has_beauty: args.has_beauty(), pictures: Vec::new() };
        if wanted.aovs.is_empty() {
            return Ok(wanted);
        }
        wanted.aovs.iter().try_for_each(|aov| aov.check(scene))?;
        if outputs.stream.is_some() {
            return Err(Error::with_help(
                "--aov: standard output takes one picture, and layers are several",
                "write files: -o picture.exr holds all layers, -o picture.png has pictures beside it",
            ));
        }
        for path in &outputs.files {
            match output::format_of(path)? {
                Format::Exr => {}
                Format::Hdr => {
                    return Err(Error::with_help(
                        format!("{}: Radiance HDR holds no layers", path.display()),
                        "write .exr, which holds numbers, or .png, .jpg or .tif, beside which false colours are written",
                    ));
                }
                Format::Png | Format::Jpeg | Format::Tiff => {
                    let named = |&aov: &Aov| FalseColors { aov, path: beside(path, aov) };
                    wanted.pictures.extend(wanted.aovs.iter().map(named));
                }
            }
        }
        Ok(wanted)
    }

    /// Returns true if a layer tells the samples or the errors of single pixels.
    pub fn needs_pixels(&self) -> bool {
        self.aovs.iter().any(|aov| matches!(aov, Aov::Samples | Aov::Error))
    }

    /// Returns the picture alone.
    pub fn without_layers(&self) -> Wanted {
        Wanted { aovs: Vec::new(), has_beauty: self.has_beauty, pictures: Vec::new() }
    }

    /// Measures the layers.
    pub fn render(
        &self,
        scene: &Scene,
        options: &Options,
        on: &[On],
        ran: Option<&Picture>,
        progress: &dyn Progress,
    ) -> Result<Vec<Layer>> {
        render_layers(scene, options, on, &self.aovs, ran, progress)
    }

    /// Writes the picture and the layers: all files or none.
    pub fn write(
        &self,
        outputs: &Outputs,
        film: &Film,
        layers: &[Layer],
        scene: &Scene,
        options: &WriteOptions,
    ) -> Result<()> {
        let names: Vec<String> = (0..scene.materials.len()).map(|number| name_of(scene, number)).collect();
        let layer = |aov: Aov| layers.iter().find(|layer| layer.name == aov.name());
        let films: Vec<Film> = self
            .pictures
            .iter()
            .filter_map(|own| Some(picture(own.aov, layer(own.aov)?, [film.width, film.height], &names)))
            .collect();
        // False colours stand for numbers: they stay as they are. Their record would make the picture, not them.
        let plain = WriteOptions { display: DisplayTransform::default(), record: None, ..*options };
        let pairs = films.iter().zip(&self.pictures);
        let beside = pairs.map(|(film, own)| Named { film, path: &own.path, options: &plain });
        let options = WriteOptions { layers, has_colors: self.has_beauty, ..*options };
        outputs.write_with(film, &beside.collect::<Vec<_>>(), &options)
    }

    /// Returns the paths of the files that are written beside the outputs.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.pictures.iter().map(|picture| picture.path.as_path())
    }

    /// Returns the files that are written beside the outputs, for messages.
    pub fn names(&self) -> Vec<String> {
        self.paths().map(|path| path.display().to_string()).collect()
    }
}

/// Returns `x.level.png` for `x.png`.
fn beside(path: &Path, aov: Aov) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!(".{}", aov.name()));
    if let Some(ending) = path.extension() {
        name.push(".");
        name.push(ending);
    }
    path.with_file_name(name)
}
