//! A picture of a new scene. Input: its file. Output: what the file says of itself, and what its texels show.

use std::path::{Path, PathBuf};

use super::names::Role;
use crate::core::error::{Error, Result};
use crate::texture::analysis::analyse;
use crate::texture::analysis_levels::analyse_normals;
use crate::texture::data::{ColorSpace, Component, Dimension, TextureData};
use crate::texture::decode::texture_of;
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
    /// Alpha below 1: true for a mask, false for all shares.
    pub mask: Option<bool>,
    /// Whether opposite borders fit together, left to right and top to bottom.
    pub tiles: [bool; 2],
    /// The mean of the first channel, as stored.
    pub mean: f64,
    /// True if its texels are normals, whatever its name.
    pub is_normals: bool,
}

impl Photo {
    /// Reads a file. One that cannot be read, or is no flat picture, is an error that names it.
    pub fn look(path: &Path) -> Result<Photo> {
        let mut picture = read_any(path, &ReadOptions::default())?;
        let facts = std::mem::take(&mut picture.facts);
        if facts.dimension != Dimension::Two {
            let what = format!("{}: a texture of dimension \"{}\"", path.display(), facts.dimension);
            return Err(Error::with_help(
                what,
                "a new scene takes flat pictures; docs/scene-format.md has the others",
            ));
        }
        let texture = texture_of("photo", Dimension::Two, ColorSpace::Linear, picture);
        let analysis = analyse(&texture);
        let seams = [&analysis.u.seam, &analysis.v.seam];
        Ok(Photo {
            path: path.to_owned(),
            named: Role::of(path),
            size: [texture.width, texture.height],
            is_float: texture.format.component() == Component::Float32,
            stated: facts.color_space,
            is_turned: is_turned(path),
            mask: mask(&texture),
            tiles: seams.map(|seam| seam.tiles() == Some(true)),
            mean: analysis.channels.first().and_then(|channel| channel.mean).unwrap_or(0.5),
            is_normals: analyse_normals(&texture).is_some_and(|normals| normals.is_normal_map()),
        })
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

/// Returns whether alpha, if any is below 1, is nearly everywhere 0 or 1.
fn mask(texture: &TextureData) -> Option<bool> {
    let channels = texture.format.channels();
    if !matches!(texture.file_channels, 2 | 4) {
        return None;
    }
    let (mut below, mut between) = (0u64, 0u64);
    for y in 0..texture.height {
        for x in 0..texture.width {
            let alpha = texture.value(x, y, channels - 1);
            below += u64::from(alpha < BETWEEN[1]);
            between += u64::from(alpha > BETWEEN[0] && alpha < BETWEEN[1]);
        }
    }
    let all = f64::from(texture.width) * f64::from(texture.height);
    (below > 0).then_some((between as f64) < BLENDED * all)
}
