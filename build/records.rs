//! Generates GLSL for the records of `src/schema/header.rs` and `records.rs`: a struct with named fields; functions that read it, each
//! unit of 16 bytes once; and for records in a list the access by index, cached if the list is short.

use crate::header::HEADER;
use crate::packing::{Kind, Packer, shape};
use crate::records::{LENGTHS, PLACES, RECORDS};
use crate::tables::Record;

pub fn records() -> String {
    let preloads: String = RECORDS.iter().map(|record| format!("    preload_{}();\n", record.list)).collect();
    let some = |of: &str| {
        let dynamic = |record: &Record| format!("{}{of} == DYNAMIC", record.list.to_uppercase());
        RECORDS.iter().map(dynamic).collect::<Vec<_>>().join(" || ")
    };
    let mut text: String =
        [&HEADER].into_iter().chain(RECORDS).chain([&LENGTHS, &PLACES]).map(record).collect();
    // Both follow the header; they are read only if something in them is not known when the pipeline is built.
    text += "Lengths lengths;\nPlaces places;\n\n";
    text.extend(RECORDS.iter().map(list));
    let lengths = format!("    if ({}) lengths = lengths_in_head(HEADER_UNITS);\n", some(""));
    let places = format!("    if ({}) places = places_in_head(HEADER_UNITS + LENGTHS_UNITS);\n", some("_AT"));
    text + &format!("void preload_records() {{\n{lengths}{places}{preloads}}}\n")
}

fn record(record: &Record) -> String {
    let name = record.name;
    let fields: String = record.fields.iter().map(|(f, t)| format!("    {} {f};\n", glsl_type(t))).collect();
    let shapes: Vec<_> = record.fields.iter().map(|(_, t)| shape(t)).collect();
    let (reals, words) = Packer::units(&shapes);
    let units =
        format!("const uint {}_UNITS = {reals}u * REAL_UNITS + {words}u;\n", snake(name).to_uppercase());
    let mut text = format!("struct {name} {{\n{fields}}};\n{units}");
    text += &loader(record, "head");
    if !record.list.is_empty() {
        text += &loader(record, "scene");
    }
    text + "\n"
}

/// Returns a function that reads the record from the uniform buffer, or from the whole scene buffer.
fn loader(record: &Record, from: &str) -> String {
    let (mut units, mut parts) = (String::new(), Vec::new());
    let mut packer = Packer::new();
    for (_, field_type) in record.fields {
        let shape = shape(field_type);
        let (place, behind) = packer.place(shape);
        packer = behind;
        let at = format!("at + {}u * REAL_UNITS + {}u", place.reals, place.words);
        let read = format!("READ_{}", from.to_uppercase());
        let unit = match shape.kind {
            Kind::Reals => format!("reals_{}", place.reals),
            Kind::Words => format!("words_{}", place.words),
        };
        if place.lane == 0 {
            units += &match shape.kind {
                Kind::Reals => format!("    real4 {unit} = READ_REAL({read}, {at});\n"),
                Kind::Words => format!("    uvec4 {unit} = {read}({at});\n"),
            };
        }
        let lanes = &"xyzw"[place.lane as usize..(place.lane + shape.lanes) as usize];
        let part = format!("{unit}.{lanes}");
        parts.push(match *field_type {
            "f32" | "Vec2" | "Vec3" | "Vec4" => format!("uintBitsToFloat({part})"),
            "bool" => format!("{part} != 0u"),
            "RealBits" => format!("REAL_BITS({part})"),
            _ => part,
        });
    }
    let (name, function) = (record.name, snake(record.name));
    let parts = parts.join(",\n        ");
    format!("{name} {function}_in_{from}(uint at) {{\n{units}    return {name}(\n        {parts});\n}}\n")
}

/// Returns the access to a list. Lists of known, small length are read once, before any branch: some compilers
/// (lavapipe's) read a buffer lane by lane inside control flow. An index that is not known at build time then selects
/// among registers.
fn list(record: &Record) -> String {
    let (name, list, one) = (record.name, record.list, snake(record.name));
    let length = list.to_uppercase();
    let begin = format!("COUNT({length}_AT, places.{list})");
    let units = format!("{}_UNITS", one.to_uppercase());
    format!(
        "{name} cached_{list}[{length} == DYNAMIC || {length} == 0u ? 1u : {length}];
void preload_{list}() {{
    if ({length} == DYNAMIC || {length} == 0u) return;
    for (uint i = 0u; i < {length}; i++) cached_{list}[i] = {one}_in_head({begin} + i * {units});
}}
{name} {one}_at(uint index) {{
    if ({length} == DYNAMIC) return {one}_in_scene({begin} + index * {units});
    {name} found = cached_{list}[0];
    for (uint i = 1u; i < {length}; i++) {{
        if (i == index) found = cached_{list}[i];
    }}
    return found;
}}

"
    )
}

fn glsl_type(name: &str) -> &str {
    match name {
        "f32" => "float",
        "Vec2" => "vec2",
        "Vec3" => "vec3",
        "Vec4" => "vec4",
        "UVec2" => "uvec2",
        "UVec3" => "uvec3",
        "bool" => "bool",
        "f64" | "RealBits" => "real",
        "DVec2" => "real2",
        "DVec3" => "real3",
        "DVec4" => "real4",
        _ => "uint",
    }
}

/// Converts `UvProjection` to `uv_projection`.
fn snake(name: &str) -> String {
    let mut text = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !text.is_empty() {
            text.push('_');
        }
        text.push(letter.to_ascii_lowercase());
    }
    text
}
