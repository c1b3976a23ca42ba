//! Makes GLSL of the tables in `src/schema`, compiles the shaders of `build/shaders.rs` to SPIR-V and writes
//! `$OUT_DIR/shaders.rs`: for each shader where its words lie and what reflection finds in them (descriptor
//! bindings, specialization constants), and the families by which a host chooses among them. `$OUT_DIR/built_in.rs` lists
//! the files of scenes that the program has in itself.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::{env, fs};

#[macro_use]
#[path = "build/tables.rs"]
mod tables;

#[path = "src/schema/bindings.rs"]
mod bindings;
#[path = "src/schema/blocks.rs"]
mod blocks;
#[path = "build/built_in.rs"]
mod built_in;
#[path = "build/compile.rs"]
mod compile;
#[path = "src/schema/constants.rs"]
mod constants;
#[path = "src/schema/enums.rs"]
mod enums;
#[path = "build/generate.rs"]
mod generate;
#[path = "src/schema/header.rs"]
mod header;
#[path = "src/schema/models.rs"]
mod models;
#[path = "src/schema/packing.rs"]
mod packing;
#[path = "build/records.rs"]
mod record_text;
#[path = "src/schema/records.rs"]
mod records;
#[path = "build/reflect.rs"]
mod reflect;
#[path = "build/shaders.rs"]
mod shaders;
#[path = "build/shapes.rs"]
mod shape_text;
#[path = "src/schema/shapes.rs"]
mod shapes;
#[path = "src/schema/specialization.rs"]
mod specialization;
#[path = "src/schema/surface_enums.rs"]
mod surface_enums;
#[path = "build/uncontracted.rs"]
mod uncontracted;
#[path = "build/version.rs"]
mod version;

use reflect::Reflection;
use shaders::{FAMILIES, Family};

type AnyError = Box<dyn std::error::Error>;

fn main() -> Result<(), AnyError> {
    for input in ["glsl", "src/schema", "build.rs", "build"] {
        println!("cargo:rerun-if-changed={input}");
    }
    for folder in built_in::FOLDERS {
        println!("cargo:rerun-if-changed=data/{folder}");
    }
    version::set();
    let out = PathBuf::from(env::var("OUT_DIR")?);
    fs::write(out.join("built_in.rs"), built_in::list()?)?;
    let generated = out.join("schema");
    generate::generate(&generated)?;
    let mut rust = String::new();
    let mut all = Vec::new();
    let compiler = shaderc::Compiler::new()?;
    for family in FAMILIES {
        let variants = family.variants();
        for variant in &variants {
            let words =
                compile::compile_if_changed(&compiler, &variant.text, &out.join(&variant.name), &generated)?;
            write_shader(&mut rust, &variant.name, family.main, &Reflection::new(&words))?;
            all.push(variant.name.to_uppercase());
        }
        write_family(&mut rust, family)?;
    }
    writeln!(rust, "/// All shaders.\npub static ALL: &[&Shader] = &[&{}];", all.join(", &"))?;
    fs::write(out.join("shaders.rs"), rust)?;
    Ok(())
}

fn write_shader(rust: &mut String, name: &str, main: &str, found: &Reflection) -> Result<(), AnyError> {
    writeln!(rust, "/// Compiled from `glsl/{main}`.")?;
    writeln!(rust, "pub static {}: Shader = Shader {{ name: {name:?}, bindings: &[", name.to_uppercase())?;
    for (binding, kind) in found.descriptors()? {
        writeln!(rust, "    ReflectedBinding {{ binding: {binding}, kind: BindingKind::{kind} }},")?;
    }
    writeln!(rust, "], constants: &[")?;
    for (name, id, default) in found.constants() {
        writeln!(rust, "    SpecConstant {{ name: {name:?}, id: {id}, default: {default} }},")?;
    }
    // As literals they would take seconds and a gigabyte to compile.
    writeln!(rust, "], spirv: &Words(*include_bytes!(concat!(env!(\"OUT_DIR\"), \"/{name}.spv\"))) }};")?;
    Ok(())
}

/// Families of one shader are that shader.
fn write_family(rust: &mut String, family: &Family) -> Result<(), AnyError> {
    let variants = family.variants();
    if variants.len() == 1 {
        return Ok(());
    }
    let name = family.name;
    writeln!(rust, "/// The shaders of `glsl/{}`.", family.main)?;
    writeln!(
        rust,
        "pub static {}_FAMILY: Family = Family {{ name: {name:?}, shaders: &[",
        name.to_uppercase()
    )?;
    for variant in &variants {
        let source = variant.source.map_or("None".into(), camel);
        let reals = variant.reals.map_or("F32".into(), camel);
        let shader = variant.name.to_uppercase();
        writeln!(rust, "    (TexelSource::{source}, Reals::{reals}, &{shader}),")?;
    }
    writeln!(rust, "] }};")?;
    Ok(())
}

/// `f64-math` → `F64Math`.
fn camel(name: &str) -> String {
    let word = |word: &str| word[..1].to_uppercase() + &word[1..];
    name.split('-').map(word).collect()
}
