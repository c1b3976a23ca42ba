//! Operations of programs on a film: writing and reading files, and comparing pictures.

use std::path::Path;

use super::save::SaveOptions;
use crate::core::error::{ErrorKind, Result};
use crate::core::film::Film;
use crate::lab::metrics::{self, Comparison};
use crate::output;

impl Film {
    /// Writes the picture. The ending of the name selects the format: `.exr` and `.hdr` hold linear values, `.png`,
    /// `.jpg` and `.tif` are clipped and sRGB-encoded. The file appears complete or not at all.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        self.save_with(path, &SaveOptions::new())
    }

    /// Writes the picture as [`save`](Film::save) does, with these settings.
    pub fn save_with(&self, path: impl AsRef<Path>, options: &SaveOptions) -> Result<()> {
        let options = options.write_options();
        options.check()?;
        output::write(self, path.as_ref(), &options).map_err(|e| e.or_kind(ErrorKind::File))
    }

    /// Reads a picture file.
    pub fn open(path: impl AsRef<Path>) -> Result<Film> {
        metrics::read_picture(path.as_ref()).map_err(|e| e.or_kind(ErrorKind::File))
    }

    /// Compares the picture with a reference of the same size, in linear RGB.
    ///
    /// ```
    /// let (mut film, black) = (moire::Film::new(8, 8, 1), moire::Film::new(8, 8, 1));
    /// film.pixels[9] = [0.0, 0.5, 0.0];
    /// let compared = film.compare(&black).unwrap();
    /// assert_eq!((compared.max, compared.max_at), (0.5, Some([1, 1])));
    /// ```
    pub fn compare(&self, reference: &Film) -> Result<Comparison> {
        metrics::compare(self, reference)
    }
}
