//! Textures from arrays. In: rows of texels in memory. Out: the content of a texture, which takes the place of that in a
//! scene; scenes share it.

use std::sync::Arc;

use moire::internal::scene::{model, suggestion};
use moire::internal::texture::data::{ColorSpace, Component, Dimension, TexelFormat};
use moire::internal::texture::source::{PlainTexels, TextureContent};
use moire::{Error, ErrorKind, Result};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::PyBytes;

use crate::errors::exception;
use crate::options::unknown;

/// The texels of an array.
#[pyclass(frozen, module = "moire._moire")]
pub struct Texels {
    plain: Arc<PlainTexels>,
}

#[pymethods]
impl Texels {
    /// Takes rows of texels with 1, 2 or 4 channels, of which `component` names the type.
    #[new]
    fn new(
        py: Python<'_>,
        width: u32,
        height: u32,
        channels: usize,
        component: &str,
        bytes: PyBackedBytes,
    ) -> PyResult<Texels> {
        let read = || {
            let component = Component::from_name(component)
                .ok_or_else(|| unknown("component", component, Component::NAMES))?;
            let length = width as usize * height as usize * channels * component.bytes();
            if !matches!(channels, 1 | 2 | 4) || length == 0 || length != bytes.len() {
                let found = bytes.len();
                return Err(Error::new(format!(
                    "texels: {width}×{height}×{channels} of {component} are not {found} bytes"
                )));
            }
            let format = TexelFormat::new(channels, component);
            Ok(PlainTexels { width, height, format, bytes: bytes.to_vec() })
        };
        let plain = read().map_err(|error| exception(py, &error))?;
        Ok(Texels { plain: Arc::new(plain) })
    }

    /// The arguments from which copies and pickles are made.
    fn __getnewargs__<'py>(&self, py: Python<'py>) -> (u32, u32, usize, &'static str, Bound<'py, PyBytes>) {
        let PlainTexels { width, height, format, bytes } = &*self.plain;
        (*width, *height, format.channels(), format.component().name(), PyBytes::new(py, bytes))
    }
}

/// Lets the texels be those of the scene's texture of this name.
pub fn replace(
    scene: &mut model::Scene,
    name: &str,
    texels: &Texels,
    color_space: Option<&str>,
) -> Result<()> {
    let failed = |what: String| Err(Error::new(what).of_kind(ErrorKind::Scene));
    let Some(at) = scene.textures.iter().position(|texture| texture.name == name) else {
        let names: Vec<&str> = scene.textures.iter().map(|texture| texture.name.as_str()).collect();
        let near = suggestion(name, names.iter().copied());
        let known = if names.is_empty() { "none".into() } else { names.join(", ") };
        return failed(format!("texture {name:?} is not in the scene{near}; its textures are: {known}"));
    };
    let texture = &mut scene.textures[at];
    if texture.dimension != Dimension::Two {
        return failed(format!(
            "texture {name:?} is of dimension \"{}\"; an array stands for one of \"2d\"",
            texture.dimension
        ));
    }
    let is_float = texels.plain.format.component() == Component::Float32;
    match color_space {
        Some(space) => {
            texture.color_space = ColorSpace::from_name(space)
                .ok_or_else(|| unknown("color_space", space, ColorSpace::NAMES))?;
        }
        // Float values are linear light, whatever the file had that they replace.
        None if is_float => texture.color_space = ColorSpace::Linear,
        None => {}
    }
    texture.color_space_stated = true;
    texture.content = TextureContent::Texels(texels.plain.clone());
    Ok(())
}
