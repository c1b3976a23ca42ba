//! The part of the Python module `moire` that is compiled. The package around it, which people see, is in `package/moire`:
//! it gives these functions their names, types and defaults, and makes objects of what they return.

mod errors;
mod options;
mod pictures;
mod process;
mod renderer;
mod scene;
mod study;
mod texels;
mod vocabulary;
mod watched;

use std::collections::BTreeMap;
use std::ffi::OsString;

use moire::internal::cli::program;
use moire::internal::core::panics;
use moire::internal::gpu::advised_driver_cache;
use moire::internal::scene::BuiltIn;
use pyo3::prelude::*;

/// Runs a command line, of which the first argument is the name of the program. Returns the exit code.
#[pyfunction]
fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| program::run(arguments))
}

/// Returns the scenes that the program has in itself, with what each shows.
#[pyfunction]
fn scenes() -> BTreeMap<String, String> {
    BuiltIn::all().into_iter().map(|scene| (scene.shown(), scene.summary())).collect()
}

/// Returns the variable of the environment, and its value, by which drivers get a folder for their caches; nothing if they
/// have one.
#[pyfunction]
fn driver_cache() -> Option<(&'static str, OsString)> {
    advised_driver_cache()
}

#[pymodule]
fn _moire(module: &Bound<'_, PyModule>) -> PyResult<()> {
    // Panics become exceptions with the place, in place of text on stderr. The hook is that of this library alone.
    panics::record();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<renderer::Renderer>()?;
    module.add_class::<texels::Texels>()?;
    module.add_function(wrap_pyfunction!(main, module)?)?;
    module.add_function(wrap_pyfunction!(scenes, module)?)?;
    module.add_function(wrap_pyfunction!(driver_cache, module)?)?;
    module.add_function(wrap_pyfunction!(vocabulary::vocabulary, module)?)?;
    module.add_function(wrap_pyfunction!(renderer::devices, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::digest, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::record, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::read, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::save, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::png, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::screen, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::compare, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::compare_files, module)?)?;
    module.add_function(wrap_pyfunction!(study::study, module)?)
}
