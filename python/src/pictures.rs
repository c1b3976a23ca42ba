//! Pictures. In: arrays of linear light, or files. Out: files with a record of the render, arrays, and the measures of a
//! comparison.

use std::path::PathBuf;

use moire::internal::cli::account::with_words;
use moire::internal::cli::record::Record;
use moire::internal::core::film::Placement;
use moire::internal::lab::metrics::{common, compare as measure, flip, read_placed};
use moire::internal::output::{
    self, DisplayTransform, Format, WriteOptions, screen_pixels, to_bytes_with, write,
};
use moire::{ErrorKind, Film, Gamut, Result, ToneMap};
use numpy::{IntoPyArray, PyArray3, PyArrayMethods, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::errors::{exception, or_kind};
use crate::options::{Given, words};
use crate::process;

/// Reads a picture file as linear light.
#[pyfunction]
pub fn read(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyArray3<f32>>> {
    process::begin(py)?;
    let film = py.detach(|| Film::open(&path)).map_err(|error| exception(py, &error))?;
    let shape = [film.height as usize, film.width as usize, 3];
    film.pixels.into_flattened().into_pyarray(py).reshape(shape)
}

/// Reads the record of a picture file as JSON.
#[pyfunction]
pub fn record(py: Python<'_>, path: PathBuf) -> PyResult<Option<String>> {
    let found = py.detach(|| output::record::read(&path));
    found.map_err(|error| exception(py, &or_kind(error, ErrorKind::File)))
}

/// Writes a picture file. `record`: how its pixels were rendered, as JSON. `placement`: its corner in a larger picture, and
/// the size of that one.
#[pyfunction]
pub fn save(
    py: Python<'_>,
    array: PyReadonlyArray3<'_, f32>,
    path: PathBuf,
    options: &Bound<'_, PyDict>,
    record: Option<String>,
    placement: Option<[u32; 4]>,
) -> PyResult<()> {
    process::begin(py)?;
    let film = film_of(&array)?;
    let (mut with, words) = write_options(&Given(options))?;
    with.placement =
        placement.map(|[x, y, width, height]| Placement { corner: [x, y], full: [width, height] });
    let run = || {
        with.check()?;
        let record = record.map(|text| -> Result<String> {
            Ok(with_words(Record::parse(&text, "this picture")?, &words)?.text())
        });
        let record = record.transpose()?;
        let with = WriteOptions { record: record.as_deref(), ..with };
        write(&film, &path, &with).map_err(|error| or_kind(error, ErrorKind::File))
    };
    py.detach(run).map_err(|error| exception(py, &error))
}

/// Returns how a picture is written, and the words of a command line that say so.
fn write_options(given: &Given<'_, '_>) -> PyResult<(WriteOptions<'static>, Vec<String>)> {
    let default = WriteOptions::default();
    let exposure = given.value::<f64>("exposure", "a number of stops")?;
    let white_balance = given.value::<f64>("white_balance", "a number of kelvin")?;
    let tone_map = given.named("tone_map", ToneMap::NAMES, ToneMap::from_name)?;
    let gamut = given.named("gamut", Gamut::NAMES, Gamut::from_name)?;
    let png_bits = given.value::<u8>("png_bits", "8 or 16")?;
    let jpeg_quality = given.value::<u8>("jpeg_quality", "a whole number from 1 to 100")?;
    let words = words(&[
        ("exposure", exposure.map(|stops| stops.to_string())),
        ("white-balance", white_balance.map(|kelvin| kelvin.to_string())),
        ("tone-map", tone_map.map(|map| map.to_string())),
        ("gamut", gamut.map(|gamut| gamut.to_string())),
        ("png-bits", png_bits.map(|bits| bits.to_string())),
        ("jpeg-quality", jpeg_quality.map(|quality| quality.to_string())),
    ]);
    let display = DisplayTransform {
        exposure: exposure.unwrap_or(default.display.exposure),
        white_balance,
        tone_map: tone_map.unwrap_or(default.display.tone_map),
        gamut: gamut.unwrap_or(default.display.gamut),
    };
    let options = WriteOptions {
        display,
        png_bits: png_bits.unwrap_or(default.png_bits),
        jpeg_quality: jpeg_quality.unwrap_or(default.jpeg_quality),
        ..default
    };
    Ok((options, words))
}

/// Compares two arrays. Returns the measures by name.
#[pyfunction]
pub fn compare<'py>(
    py: Python<'py>,
    a: PyReadonlyArray3<'py, f32>,
    b: PyReadonlyArray3<'py, f32>,
) -> PyResult<Bound<'py, PyDict>> {
    process::begin(py)?;
    let films = [film_of(&a)?, film_of(&b)?];
    measures(py, || Ok(films))
}

/// Compares two files, of which each may be a part of a picture. Returns the measures by name.
#[pyfunction]
pub fn compare_files(py: Python<'_>, a: PathBuf, b: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    process::begin(py)?;
    let read = |path: &PathBuf| read_placed(path).map_err(|error| or_kind(error, ErrorKind::File));
    measures(py, || {
        let both = common(read(&a)?, read(&b)?)?;
        Ok([both.a, both.b])
    })
}

/// Measures, and returns the measures by name.
fn measures<'py>(
    py: Python<'py>,
    films: impl FnOnce() -> Result<[Film; 2]> + Send,
) -> PyResult<Bound<'py, PyDict>> {
    let both = || {
        let [a, b] = films()?;
        Ok((measure(&a, &b)?, flip(&a, &b)?))
    };
    let (found, flip) = py.detach(both).map_err(|error| exception(py, &error))?;
    let measures = PyDict::new(py);
    measures.set_item("width", found.width)?;
    measures.set_item("height", found.height)?;
    measures.set_item("rmse", found.rmse)?;
    measures.set_item("mse", found.mse)?;
    measures.set_item("relative_mse", found.relative_mse)?;
    measures.set_item("max", found.max)?;
    measures.set_item("max_at", found.max_at.map(|[x, y]| (x, y)))?;
    measures.set_item("psnr", found.psnr)?;
    measures.set_item("flip", flip)?;
    measures.set_item("over_1_255", found.over_1_255)?;
    measures.set_item("over_1_255_pixels", found.over_1_255_pixels)?;
    measures.set_item("max_encoded", found.max_encoded)?;
    measures.set_item("nan_pixels", found.nan_pixels)?;
    Ok(measures)
}

/// Returns the film of an array of height, width and three channels.
fn film_of(array: &PyReadonlyArray3<'_, f32>) -> PyResult<Film> {
    let [height, width] = [0, 1].map(|axis| array.shape()[axis] as u32);
    let mut film = Film::new(width, height, 0);
    let (pixels, _) = array.as_slice()?.as_chunks::<3>();
    film.pixels.copy_from_slice(pixels);
    Ok(film)
}

/// Returns the bytes of a PNG file, as notebooks show them.
#[pyfunction]
pub fn png<'py>(
    py: Python<'py>,
    array: PyReadonlyArray3<'py, f32>,
    options: &Bound<'_, PyDict>,
) -> PyResult<Bound<'py, PyBytes>> {
    process::begin(py)?;
    let film = film_of(&array)?;
    let (with, _) = write_options(&Given(options))?;
    let bytes = py.detach(|| with.check().and_then(|()| to_bytes_with(&film, Format::Png, &with)));
    Ok(PyBytes::new(py, &bytes.map_err(|error| exception(py, &error))?))
}

/// Returns the pixels that a screen shows.
#[pyfunction]
pub fn screen<'py>(
    py: Python<'py>,
    array: PyReadonlyArray3<'py, f32>,
    options: &Bound<'_, PyDict>,
) -> PyResult<Bound<'py, PyArray3<u8>>> {
    let film = film_of(&array)?;
    let (with, _) = write_options(&Given(options))?;
    let pixels = py.detach(|| screen_pixels(&film, &with.display)).map_err(|error| exception(py, &error))?;
    pixels.into_flattened().into_pyarray(py).reshape([film.height as usize, film.width as usize, 3])
}

/// Returns a number by which a change of any value is noticed.
#[pyfunction]
pub fn digest(array: PyReadonlyArray3<'_, f32>) -> PyResult<u64> {
    Ok(digest_of(array.as_slice()?))
}

/// Returns the digest of values: a polynomial of their bits, for speed of pairs.
pub fn digest_of(values: &[f32]) -> u64 {
    const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
    let (pairs, rest) = values.as_chunks::<2>();
    let bits = |value: f32| u64::from(value.to_bits());
    let whole = pairs.iter().fold(values.len() as u64, |sum, [a, b]| {
        (sum ^ (bits(*a) | bits(*b) << 32)).wrapping_mul(FACTOR).rotate_left(23)
    });
    rest.iter().fold(whole, |sum, value| (sum ^ bits(*value)).wrapping_mul(FACTOR))
}
