//! A picture of some number of samples, and the files that show it: made when they are asked for, kept for the displays
//! that were asked for last. Input: a film and what becomes of its light on a screen. Output: PNG.

use std::sync::{Arc, Mutex, PoisonError};

use crate::core::error::Result;
use crate::core::film::Film;
use crate::output::{self, DisplayTransform, Format, WriteOptions};

/// Files of a film that are kept: one a side.
const MAX_FILES: usize = 2;

/// A PNG file with the display of which it is.
type File = (DisplayTransform, Arc<Vec<u8>>);

/// A picture of some number of samples.
pub struct Shown {
    /// Samples a pixel for which it was rendered.
    pub count: u32,
    pub film: Film,
    files: Mutex<Vec<File>>,
}

impl Shown {
    pub fn new(count: u32, film: Film) -> Shown {
        Shown { count, film, files: Mutex::default() }
    }

    /// Returns the picture as `moire render` writes it with that display.
    pub fn png(&self, display: &DisplayTransform) -> Result<Arc<Vec<u8>>> {
        // Others that want a file of this film wait meanwhile, and then find the same one.
        let mut files = self.files.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, png)) = files.iter().find(|(own, _)| own == display) {
            return Ok(png.clone());
        }
        let png = Arc::new(self.file(display, None)?);
        files.truncate(MAX_FILES - 1);
        files.insert(0, (*display, png.clone()));
        Ok(png)
    }

    /// Returns the file that `moire render` writes with that display and a record of how it was made.
    pub fn file(&self, display: &DisplayTransform, record: Option<&str>) -> Result<Vec<u8>> {
        let options = WriteOptions { display: *display, record, ..WriteOptions::default() };
        output::to_bytes_with(&self.film, Format::Png, &options)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::ToneMap;

    #[test]
    fn files_are_made_once_for_each_of_the_displays_asked_for_last() {
        let shown = Shown::new(1, Film::new(4, 4, 1));
        let displays = [ToneMap::None, ToneMap::Agx, ToneMap::Aces]
            .map(|tone_map| DisplayTransform { tone_map, ..Default::default() });
        let [none, agx, aces] = displays.map(|display| move |shown: &Shown| shown.png(&display).unwrap());
        let first = none(&shown);
        agx(&shown);
        assert!(Arc::ptr_eq(&first, &none(&shown)));
        aces(&shown);
        agx(&shown);
        assert!(!Arc::ptr_eq(&first, &none(&shown)), "more files are kept than sides can show");
        assert_eq!(shown.files.lock().unwrap().len(), MAX_FILES);
    }
}
