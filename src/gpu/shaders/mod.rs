//! The compiled shaders, as `build.rs` made them: SPIR-V words and what reflection found in them.

mod specialise;
mod spirv;

use crate::core::error::{Error, Result};
use crate::gpu::BindingKind;
use crate::schema::enums::{Reals, TexelSource};
use crate::schema::specialization::Constant;

pub use specialise::specialise;

/// A descriptor of set 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReflectedBinding {
    pub binding: u32,
    pub kind: BindingKind,
}

/// A named specialization constant; of a boolean the default is 0 or 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpecConstant {
    pub name: &'static str,
    pub id: u32,
    pub default: u32,
}

/// SPIR-V as the build wrote it, aligned as words are.
#[derive(Debug)]
#[repr(C, align(4))]
pub struct Words<Bytes: ?Sized = [u8]>(Bytes);

impl std::ops::Deref for Words {
    type Target = [u32];

    fn deref(&self) -> &[u32] {
        bytemuck::cast_slice(&self.0)
    }
}

/// One shader of `build/shaders.rs`.
#[derive(Debug)]
pub struct Shader {
    pub name: &'static str,
    pub bindings: &'static [ReflectedBinding],
    pub constants: &'static [SpecConstant],
    pub spirv: &'static Words,
}

impl Shader {
    /// Returns true if the shader has a specialization constant.
    pub fn has(&self, constant: Constant) -> bool {
        let id = constant.id();
        self.constants.iter().any(|c| c.id == id)
    }

    /// Returns (id, value) of the constants that the shader has.
    pub fn values(&self, constants: impl IntoIterator<Item = (Constant, u32)>) -> Vec<(u32, u32)> {
        let own = |(constant, value): (Constant, u32)| self.has(constant).then(|| (constant.id(), value));
        constants.into_iter().filter_map(own).collect()
    }
}

/// Shaders of one main file, by where their texels come from and the numbers of their geometry.
#[derive(Debug)]
pub struct Family {
    pub name: &'static str,
    pub shaders: &'static [(TexelSource, Reals, &'static Shader)],
}

impl Family {
    pub fn shader(&self, source: TexelSource, reals: Reals) -> Result<&'static Shader> {
        let wanted = self.shaders.iter().find(|(s, r, _)| (*s, *r) == (source, reals));
        wanted.map(|(_, _, shader)| *shader).ok_or_else(|| {
            Error::with_help(
                format!(
                    "there is no shader \"{}\" with texels from \"{source}\" and reals of \"{reals}\"",
                    self.name
                ),
                "add it to build/shaders.rs",
            )
        })
    }
}

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
