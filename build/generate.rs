//! Generates the GLSL files that shaders include as `schema/NAME.glsl` from the tables of `src/schema`. They
//! are in `OUT_DIR` and are rewritten only if their text changes.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::bindings::BINDINGS;
use crate::blocks::BLOCKS;
use crate::constants::CONSTANTS;
use crate::records::RECORDS;
use crate::specialization::SPECIALIZATION;
use crate::tables::{Enum, Number};
use crate::{AnyError, record_text, shape_text};

/// Writes all generated files to `folder`.
pub fn generate(folder: &Path) -> Result<(), AnyError> {
    fs::create_dir_all(folder)?;
    let numbers = [enums(), constants(), bindings()].concat();
    for (name, text) in [
        ("numbers", numbers),
        ("features", features()?),
        ("blocks", blocks()),
        ("records", record_text::records()),
        ("shapes", shape_text::shapes()),
    ] {
        let guard = format!("SCHEMA_{}_GLSL", name.to_uppercase());
        let text = format!("#ifndef {guard}\n#define {guard}\n\n{text}\n#endif\n");
        let path = folder.join(name).with_extension("glsl");
        if fs::read_to_string(&path).ok().as_deref() != Some(&text) {
            fs::write(&path, text)?;
        }
    }
    Ok(())
}

fn screaming(name: &str) -> String {
    name.replace('-', "_").to_uppercase()
}

/// Returns all enums that the shaders know.
fn all_enums() -> impl Iterator<Item = &'static Enum> {
    crate::enums::ENUMS.iter().chain(crate::surface_enums::ENUMS).chain(crate::models::ENUMS)
}

/// Returns `const uint PREFIX_VARIANT` for each variant, and their number. The preprocessor compares sources.
fn enums() -> String {
    let mut text = String::new();
    for one in all_enums() {
        for (i, variant) in one.variants.iter().enumerate() {
            let name = format!("{}_{}", one.prefix, screaming(variant));
            text += &match one.prefix {
                "SOURCE" => format!("#define {name} {i}\n"),
                _ => format!("const uint {name} = {i}u;\n"),
            };
        }
        text += &format!("const uint {}_COUNT = {}u;\n\n", one.prefix, one.variants.len());
    }
    text
}

fn constants() -> String {
    let line = |(name, number): &(&str, Number)| match number {
        Number::Uint(n) => format!("const uint {name} = {n}u;\n"),
        Number::Float(x) => format!("const float {name} = {x:?};\n"),
    };
    CONSTANTS.iter().map(line).collect::<String>() + "\n"
}

fn bindings() -> String {
    let descriptors = BINDINGS.iter().map(|(name, number)| format!("#define BINDING_{name} {number}\n"));
    let ids = SPECIALIZATION.iter().zip(0..).filter(|(c, _)| c.kind == "id");
    let ids = ids.map(|(c, id)| format!("#define ID_{} {id}\n", c.name));
    descriptors.chain(ids).collect()
}

/// Returns the specialization constants, each with the default that keeps everything: those of the table, then length
/// and offset of each list of records.
fn features() -> Result<String, AnyError> {
    let mut text = String::new();
    for (constant, id) in SPECIALIZATION.iter().zip(0..) {
        let (kind, default) = match constant.kind {
            "modes" => {
                let all = all_enums().find(|e| e.name == constant.of);
                let all = all.ok_or_else(|| format!("{}: no enum {}", constant.name, constant.of))?;
                ("uint", format!("0x{:X}u", (1u32 << all.variants.len()) - 1))
            }
            "count" => ("uint", "DYNAMIC".into()),
            "switch" | "flag" => ("bool", "true".into()),
            "parameter" => ("uint", format!("{}u", constant.of)),
            _ => continue,
        };
        writeln!(text, "layout(constant_id = {id}) const {kind} {} = {default};", constant.name)?;
    }
    let lists = RECORDS.iter().map(|record| record.list.to_uppercase());
    for (list, at) in lists.zip(0..) {
        let id = SPECIALIZATION.len() + 2 * at;
        writeln!(text, "layout(constant_id = {id}) const uint {list} = DYNAMIC;")?;
        writeln!(text, "layout(constant_id = {}) const uint {list}_AT = DYNAMIC;", id + 1)?;
    }
    Ok(text)
}

/// Returns the blocks of words as structs.
fn blocks() -> String {
    let one = |block: &crate::tables::Block| {
        let fields: String = block.fields.iter().map(|f| format!("    uint {f};\n")).collect();
        format!("struct {} {{\n{fields}}};\n", block.name)
    };
    BLOCKS.iter().map(one).collect()
}
