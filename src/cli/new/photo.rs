//! A picture of a new scene. Input: its file. Output: what the file says of itself, and what its texels show.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::names::{self, Role};
use super::{bands, green};
use crate::core::counted::counted;
use crate::core::error::{Error, Result};
use crate::texture::analysis::analyse_along;
use crate::texture::analysis_levels::analyse_normals;
use crate::texture::color_profile::ColorProfile;
use crate::texture::data::{ColorSpace, Component, Dimension, TextureData};
use crate::texture::decode::texture_of;
use crate::texture::read_exr::color_layers;
use crate::texture::read_file::{is_turned, read_any};
use crate::texture::source::ReadOptions;

/// Alpha between these is neither there nor not.
const BETWEEN: [f64; 2] = [0.02, 0.98];
/// The share of such texels above which alpha is more than a mask.
const BLENDED: f64 = 0.05;

pub(super) struct Photo {
    pub path: PathBuf,
    /// What its name says that it is.
    pub named: Option<Role>,
    /// In texels, upright.
    pub size: [u32; 2],
    pub is_float: bool,
    /// What the file says of its values.
    pub stated: Option<ColorSpace>,
    /// True if the file states that it is stored turned or mirrored.
    pub is_turned: bool,
    /// The colour profile of the file.
    pub profile: Option<ColorProfile>,
    /// Layers with colours, if the file has several and the first is read by its name.
    pub layers: Vec<String>,
    /// Alpha below 1: true for a mask, false for all shares.
    pub mask: Option<bool>,
    /// True of a file whose colours are multiplied by its alpha.
    pub is_premultiplied: bool,
    /// Whether opposite borders fit together, left to right and top to bottom.
    /// `None` where it cannot be told.
    pub tiles: [Option<bool>; 2],
    /// The means of the channels, as stored; the last of four is alpha.
    pub means: Vec<f64>,
    pub is_grey: bool,
    /// True if its texels are normals, whatever its name.
    pub is_normals: bool,
    /// Where green points if it is a map of normals: by the name, and by the texels.
    pub green_named: Option<bool>,
    pub green_found: Option<bool>,
}

impl Photo {
    /// Reads files, several at a time.
    pub fn look_all(paths: &[PathBuf]) -> Result<Vec<Photo>> {
        let photos: Vec<Result<Photo>> = paths.par_iter().map(|path| Photo::look(path)).collect();
        photos.into_iter().collect()
    }

    /// Reads a file. One that cannot be read, or is no flat picture, is an error that names it.
    fn look(path: &Path) -> Result<Photo> {
        // None of a file that is not OpenEXR.
        let mut layers = color_layers(path);
        let is_premultiplied = !layers.is_empty();
        let picture = read_any(path, &ReadOptions::default()).inspect(|_| layers.clear());
        let mut picture = match layers.first() {
            Some(first) => {
                let layer = Some(first.clone());
                read_any(path, &ReadOptions { layer, ..ReadOptions::default() })?
            }
            None => picture?,
        };
        let facts = std::mem::take(&mut picture.facts);
        if facts.dimension != Dimension::Two {
            let what = format!("{}: a texture of dimension \"{}\"", path.display(), facts.dimension);
            return Err(Error::with_help(
                what,
                "a new scene takes flat pictures; docs/scene-format.md has the others",
            ));
        }
        let texture = texture_of("photo", Dimension::Two, ColorSpace::Linear, picture);
        check_finite(&texture, path)?;
        let rows = bands::rows(&texture);
        let (along_u, along_v) = rayon::join(
            || analyse_along(&rows, [true, false]),
            || analyse_along(&bands::columns(&texture), [false, true]),
        );
        let named = Role::of(path);
        let normals = analyse_normals(&rows);
        let is_normals = normals.as_ref().is_some_and(|normals| normals.is_normal_map());
        let is_float = texture.format.component() == Component::Float32;
        let green_found =
            if is_normals || named == Some(Role::Normal) { green::is_up(&texture) } else { None };
        let mask = mask(&texture);
        Ok(Photo {
            path: path.to_owned(),
            named,
            size: [texture.width, texture.height],
            is_float,
            stated: facts.color_space,
            is_turned: is_turned(path),
            profile: facts.profile,
            layers,
            mask,
            // All OpenEXR files are so, by its specification.
            is_premultiplied: mask.is_some() && is_premultiplied,
            tiles: [&along_u.u.seam, &along_v.v.seam].map(|seam| seam.tiles()),
            means: along_u.channels.iter().map(|channel| channel.mean.unwrap_or(0.5)).collect(),
            is_grey: !is_float && normals.is_none(),
            is_normals,
            green_named: names::green_is_up(path),
            green_found,
        })
    }

    /// Returns the mean of the first channel.
    pub fn mean(&self) -> f64 {
        self.means.first().copied().unwrap_or(0.5)
    }

    /// Returns width over height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.size[0]) / f64::from(self.size[1])
    }

    /// Returns true if it may be a panorama around the scene.
    pub fn is_panorama(&self) -> bool {
        self.size[0] == 2 * self.size[1]
    }
}

/// Refuses a picture that renders would refuse.
fn check_finite(texture: &TextureData, path: &Path) -> Result<()> {
    match texture.nonfinite_texels() {
        0 => Ok(()),
        count => Err(Error::with_help(
            format!("{}: NaN or infinity in {}", path.display(), counted(count, "texel")),
            "replace them; or name the file in a scene, and let them in: moire render --allow-nonfinite",
        )),
    }
}

/// Returns whether alpha, if any is below 1, is nearly everywhere 0 or 1.
fn mask(texture: &TextureData) -> Option<bool> {
    let channels = texture.format.channels();
    if !matches!(texture.file_channels, 2 | 4) {
        return None;
    }
    let in_row = |y: u32| {
        let row = texture.row_values(y as usize);
        let alphas = row.iter().skip(channels - 1).step_by(channels);
        let (mut below, mut between) = (0u64, 0u64);
        for alpha in alphas {
            below += u64::from(*alpha < BETWEEN[1]);
            between += u64::from(*alpha > BETWEEN[0] && *alpha < BETWEEN[1]);
        }
        [below, between]
    };
    let counts = (0..texture.height).into_par_iter().map(in_row);
    let [below, between] = counts.reduce(|| [0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
    let all = f64::from(texture.width) * f64::from(texture.height);
    (below > 0).then_some((between as f64) < BLENDED * all)
}
