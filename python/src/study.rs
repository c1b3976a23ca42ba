//! Studies of error against time. In: a scene, methods, numbers of samples. Out: the record as JSON; the page, plots and
//! pictures are in a folder.

use std::path::PathBuf;
use std::time::Instant;

use moire::internal::gpu::{DeviceSelect, Gpu};
use moire::internal::lab::study::method::Method;
use moire::internal::lab::study::record::{self, Question};
use moire::internal::lab::study::{self as lab, Options, ReferenceChoice, steadiness};
use moire::internal::output::{OutputFolder, write_file};
use moire::internal::scene::MAX_SPP;
use moire::internal::scene::prune::prune;
use moire::{Error, ErrorKind, Film, Result};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{exception, or_kind};
use crate::options::Given;
use crate::process;
use crate::scene::Scene;
use crate::watched::watched;

/// The word for those methods that a coarse pass finds promising.
const BEST: &str = "best";

/// The file of a scene that has none, in the folder of the study, as the page's commands need one.
const SCENE_FILE: &str = "scene.toml";

/// Measures, and returns as JSON a list of the record and of a note where the machine was too busy to tell neighbours apart. `text`: that of a scene without a file.
#[pyfunction]
pub fn study<'py>(
    py: Python<'py>,
    scene: &Scene,
    text: Option<String>,
    out: PathBuf,
    options: &Bound<'py, PyDict>,
    arguments: Vec<String>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<String> {
    process::begin(py)?;
    let started = Instant::now();
    let given = Given(options);
    let mut changed = scene.parts.clone();
    if let Some([width, height]) = given.size()? {
        (changed.width, changed.height) = (width, height);
    }
    let device = given.value::<String>("device", "the name of a device")?;
    if device.as_deref() == Some("oracle") {
        let what = "a study measures a device; the oracle is no device, but it can make the reference";
        let help = "name one that moire.devices() lists, or leave device out; see reference=\"oracle\"";
        return Err(exception(py, &Error::with_help(what, help)));
    }
    let select = device.as_deref().map_or(Ok(DeviceSelect::Default), DeviceSelect::parse);
    let select = select.map_err(|error| exception(py, &error))?;
    let names = given.value::<Vec<String>>("methods", "a list of names")?.unwrap_or_default();
    let listed = methods(&names).map_err(|error| exception(py, &error))?;
    let budget = given.seconds("budget")?.map(Question::Budget);
    let error = given.positive("error", f64::INFINITY)?.map(Question::Error);
    if budget.is_some() && error.is_some() {
        return Err(exception(
            py,
            &Error::new("budget and error are both given; a study answers one question"),
        ));
    }
    let counts: Vec<u32> =
        given.value("spp", "a list of whole numbers")?.unwrap_or_else(|| vec![1, 4, 16, 64, 256]);
    let repeats = given.value("repeats", "a whole number")?.unwrap_or(3);
    check(&counts, repeats).map_err(|error| exception(py, &error))?;
    let reference = given.value::<String>("reference", "a file or \"oracle\"")?;
    let options = Options {
        methods: (!listed.is_empty()).then_some(listed),
        best: names.iter().any(|name| name == BEST),
        question: budget.or(error),
        counts,
        repeats,
        reference: match reference.as_deref() {
            None => ReferenceChoice::Device,
            Some("oracle") => ReferenceChoice::Oracle,
            Some(file) => ReferenceChoice::File(file.into()),
        },
        limit: given.seconds("seconds")?.unwrap_or(600.0),
        started,
        out,
        arguments,
    };
    if let ReferenceChoice::File(file) = &options.reference {
        py.detach(|| Film::open(file)).map_err(|error| exception(py, &error))?;
    }
    prune(&mut changed);
    let found = watched(py, "a study", progress, |progress| {
        let _folder = OutputFolder::prepare(&options.out, record::FILE)
            .map_err(|error| or_kind(error, ErrorKind::File))?;
        if let Some(text) = text {
            changed.path = options.out.join(SCENE_FILE);
            write_file(&changed.path, text.as_bytes())?;
        }
        let gpu = Gpu::open(&select)?;
        lab::run(&gpu, &changed, &options, progress).map_err(|error| or_kind(error, ErrorKind::Unsupported))
    })?;
    let told = (&found, steadiness::note(&found));
    serde_json::to_string(&told)
        .map_err(|error| exception(py, &Error::new(format!("the study as JSON: {error}"))))
}

/// Returns the methods of these names, each once.
fn methods(names: &[String]) -> Result<Vec<Method>> {
    let mut methods = Vec::new();
    for name in names.iter().filter(|name| *name != BEST) {
        let method = Method::parse(name).map_err(|told| Error::new(format!("methods: {told}")))?;
        if !methods.contains(&method) {
            methods.push(method);
        }
    }
    Ok(methods)
}

fn check(counts: &[u32], repeats: u32) -> Result<()> {
    if counts.is_empty() || counts.iter().any(|count| !(1..=MAX_SPP).contains(count)) {
        return Err(Error::new(format!("spp: expected numbers from 1 to {MAX_SPP}, found {counts:?}")));
    }
    if !(1..=1000).contains(&repeats) {
        return Err(Error::new(format!("repeats: expected 1 to 1000, found {repeats}")));
    }
    Ok(())
}
