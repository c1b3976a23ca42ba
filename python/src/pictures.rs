//! Pictures. In: arrays of linear light, or files. Out: files, arrays, and the measures of a comparison.

use std::path::PathBuf;

use moire::internal::lab::metrics::{common, compare as measure, flip, read_placed};
use moire::internal::output::{Format, WriteOptions, to_bytes_with};
use moire::{Error, ErrorKind, Film, Gamut, Result, SaveOptions, ToneMap};
use numpy::{IntoPyArray, PyArray3, PyArrayMethods, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde_json::Value;

use crate::errors::{exception, or_kind};
use crate::options::Given;

/// Reads a picture file as linear light.
#[pyfunction]
pub fn read(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyArray3<f32>>> {
    let film = py.detach(|| Film::open(&path)).map_err(|error| exception(py, &error))?;
    let shape = [film.height as usize, film.width as usize, 3];
    film.pixels.into_flattened().into_pyarray(py).reshape(shape)
}

/// Writes a picture file.
#[pyfunction]
pub fn save(
    py: Python<'_>,
    array: PyReadonlyArray3<'_, f32>,
    path: PathBuf,
    options: &Bound<'_, PyDict>,
) -> PyResult<()> {
    let film = film_of(&array)?;
    let given = Given(options);
    let mut with = SaveOptions::new();
    if let Some(stops) = given.value("exposure", "a number of stops")? {
        with = with.exposure(stops);
    }
    if let Some(kelvin) = given.value("white_balance", "a number of kelvin")? {
        with = with.white_balance(kelvin);
    }
    if let Some(map) = given.named("tone_map", ToneMap::NAMES, ToneMap::from_name)? {
        with = with.tone_map(map);
    }
    if let Some(gamut) = given.named("gamut", Gamut::NAMES, Gamut::from_name)? {
        with = with.gamut(gamut);
    }
    if let Some(bits) = given.value("png_bits", "8 or 16")? {
        with = with.png_bits(bits);
    }
    if let Some(quality) = given.value("jpeg_quality", "1 to 100")? {
        with = with.jpeg_quality(quality);
    }
    py.detach(|| film.save_with(&path, &with)).map_err(|error| exception(py, &error))
}

/// Compares two arrays. Returns the measures as JSON.
#[pyfunction]
pub fn compare(
    py: Python<'_>,
    a: PyReadonlyArray3<'_, f32>,
    b: PyReadonlyArray3<'_, f32>,
) -> PyResult<String> {
    let (a, b) = (film_of(&a)?, film_of(&b)?);
    py.detach(|| measures(&a, &b)).map_err(|error| exception(py, &error))
}

/// Compares two files, of which each may be a part of a picture. Returns the measures as JSON.
#[pyfunction]
pub fn compare_files(py: Python<'_>, a: PathBuf, b: PathBuf) -> PyResult<String> {
    let read = |path: &PathBuf| read_placed(path).map_err(|error| or_kind(error, ErrorKind::File));
    let both = || {
        let both = common(read(&a)?, read(&b)?)?;
        measures(&both.a, &both.b)
    };
    py.detach(both).map_err(|error| exception(py, &error))
}

fn measures(a: &Film, b: &Film) -> Result<String> {
    let mut json = serde_json::to_value(measure(a, b)?).map_err(|error| Error::new(error.to_string()))?;
    json["flip"] = Value::from(flip(a, b)?);
    Ok(json.to_string())
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
pub fn png<'py>(py: Python<'py>, array: PyReadonlyArray3<'py, f32>) -> PyResult<Bound<'py, PyBytes>> {
    let film = film_of(&array)?;
    let bytes = py.detach(|| to_bytes_with(&film, Format::Png, &WriteOptions::default()));
    Ok(PyBytes::new(py, &bytes.map_err(|error| exception(py, &error))?))
}
