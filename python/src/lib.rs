//! The part of the Python module `moire` that is compiled. The package around it, which people see, is in `package/moire`:
//! it gives these functions their names, types and defaults, and makes objects of what they return.

mod errors;
mod options;
mod pictures;
mod renderer;
mod scene;
mod study;
mod watched;

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::process::ExitCode;

use moire::internal::cli::program;
use moire::internal::scene::BuiltIn;
use pyo3::prelude::*;

/// Runs a command line, of which the first argument is the name of the program. Returns the exit code.
#[pyfunction]
fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    let told = format!("{:?}", py.detach(|| program::run(arguments)));
    // An exit code tells its number only so.
    (0..=u8::MAX).find(|code| told == format!("{:?}", ExitCode::from(*code))).unwrap_or(2)
}

/// Returns the scenes that the program has in itself, with what each shows.
#[pyfunction]
fn scenes() -> BTreeMap<String, String> {
    BuiltIn::all().into_iter().map(|scene| (scene.shown(), scene.summary())).collect()
}

#[pymodule]
fn _moire(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<renderer::Renderer>()?;
    module.add_function(wrap_pyfunction!(main, module)?)?;
    module.add_function(wrap_pyfunction!(scenes, module)?)?;
    module.add_function(wrap_pyfunction!(renderer::devices, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::read, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::save, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::png, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::compare, module)?)?;
    module.add_function(wrap_pyfunction!(pictures::compare_files, module)?)?;
    module.add_function(wrap_pyfunction!(study::study, module)?)
}
