//! The folder of `moire inspect`: every layer as a picture, all of them in one EXR file, and the page. Input: a scene and
//! the backends that render it. Output: files, each complete or not at all.

use std::path::Path;

use super::advice::{Advice, Facts, advice};
use super::charts::{Charts, charts, readers};
use super::legend::Legend;
use super::page;
use super::picture::colored;
use super::survey::{Survey, View, survey};
use super::uses::name_of;
use crate::core::error::Result;
use crate::core::film::{Film, Placement};
use crate::core::layer::Layer;
use crate::core::progress::{Progress, SubProgress};
use crate::output::{self, Named, WriteOptions};
use crate::render::layers::{Aov, packed_at_centres, render_layers};
use crate::render::{On, Options, Picture, render_scene};
use crate::scene::model::Scene;

/// The page, the layers as numbers and the picture itself, beside a picture for each layer.
pub const PAGE: &str = "index.html";
pub const EXR: &str = "layers.exr";
pub const PICTURE: &str = "picture.png";

/// The share of the work that the picture itself is.
const OWN_SHARE: f64 = 0.4;

/// A layer and what it is.
#[derive(Clone, Debug)]
pub struct Inspected {
    pub aov: Aov,
    pub layer: Layer,
}

/// All that is known of a view.
#[derive(Clone, Debug)]
pub struct Inspection {
    pub picture: Picture,
    pub layers: Vec<Inspected>,
    /// Why layers were left out.
    pub left_out: Vec<String>,
    pub survey: Survey,
    /// Of the texture of each view.
    pub charts: Vec<Option<Charts>>,
    pub advice: Advice,
}

/// Renders the picture and all its layers, and looks at the textures.
pub fn inspect(scene: &Scene, options: &Options, on: &[On], progress: &dyn Progress) -> Result<Inspection> {
    let part = |from, to| SubProgress { whole: progress, from, to };
    let picture = render_scene(scene, options, on, &part(0.0, OWN_SHARE))?;
    let mut wanted = Vec::new();
    let mut left_out = Vec::new();
    for &aov in Aov::ALL {
        match aov.check(scene) {
            Ok(()) => wanted.push(aov),
            Err(why) => left_out.push(why.to_string()),
        }
    }
    let layers = render_layers(scene, options, on, &wanted, Some(&picture), &part(OWN_SHARE, 1.0))?;
    let layers: Vec<Inspected> =
        wanted.into_iter().zip(layers).map(|(aov, layer)| Inspected { aov, layer }).collect();
    let survey = survey(scene, &packed_at_centres(scene, options)?);
    let charts = all_charts(scene, &survey);
    let surfaces = layers.iter().find(|own| own.aov == Aov::Surfaces).map(|own| &own.layer);
    let advice = advice(scene, &Facts::new(scene, &survey, surfaces));
    Ok(Inspection { picture, layers, left_out, survey, charts, advice })
}

/// Returns the charts of each image. The maps of a material have the same ones if they are of one size.
fn all_charts(scene: &Scene, survey: &Survey) -> Vec<Option<Charts>> {
    let mut known: Vec<(_, Option<Charts>)> = Vec::new();
    let of = |view: &View| {
        let key = (readers(scene, &view.textures), view.size, view.levels);
        if let Some((_, found)) = known.iter().find(|(other, _)| *other == key) {
            return found.clone();
        }
        let found = charts(scene, &key.0, view.size, view.levels);
        known.push((key, found.clone()));
        found
    };
    survey.views.iter().map(of).collect()
}

/// Writes all files; returns their names. `view`: options that choose what is seen, for the command on the page.
pub fn write(folder: &Path, scene: &Scene, inspection: &Inspection, view: &[String]) -> Result<Vec<String>> {
    let film = &inspection.picture.film;
    let size = [film.width, film.height];
    let names: Vec<String> = (0..scene.materials.len()).map(|number| name_of(scene, number)).collect();
    let colored = |own: &Inspected| colored(own.aov, &own.layer, size, &names);
    let (films, legends): (Vec<Film>, Vec<Legend>) = inspection.layers.iter().map(colored).unzip();
    let mut files: Vec<String> = vec![PICTURE.into(), EXR.into()];
    files.extend(inspection.layers.iter().map(|own| file_of(own.aov)));
    let paths: Vec<_> = files.iter().map(|file| folder.join(file)).collect();
    let films = [film, film].into_iter().chain(&films);
    let layers: Vec<Layer> = inspection.layers.iter().map(|own| own.layer.clone()).collect();
    let placement = Some(Placement::whole(film.width, film.height));
    let options = WriteOptions { layers: &layers, placement, ..WriteOptions::default() };
    let pairs = films.zip(&paths);
    let pictures: Vec<Named<'_>> =
        pairs.map(|(film, path)| Named { film, path, options: &options }).collect();
    output::write_pictures(&pictures, || Ok(()))?;
    output::write_file(&folder.join(PAGE), page::html(scene, inspection, view, &legends).as_bytes())?;
    files.push(PAGE.into());
    Ok(files)
}

/// Returns the names of all files that may be written.
pub fn files() -> Vec<String> {
    let own = [PAGE, EXR, PICTURE].into_iter().map(String::from);
    own.chain(Aov::ALL.iter().map(|aov| file_of(*aov))).collect()
}

/// Returns the file of a layer's picture.
pub fn file_of(aov: Aov) -> String {
    format!("{}.png", aov.name())
}
