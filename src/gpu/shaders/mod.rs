//! The compiled shaders, as `build.rs` made them: SPIR-V words and what reflection found in them.

mod specialise;
mod spirv;

use crate::gpu::BindingKind;

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

/// One `glsl/*.comp`.
#[derive(Debug)]
pub struct Shader {
    pub name: &'static str,
    pub bindings: &'static [ReflectedBinding],
    pub constants: &'static [SpecConstant],
    pub spirv: &'static Words,
}

impl Shader {
    pub fn constant(&self, name: &str) -> Option<&'static SpecConstant> {
        self.constants.iter().find(|c| c.name == name)
    }
}

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
