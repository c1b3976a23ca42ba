//! The header of a PLY file. Input: the bytes of the file. Output: its elements, checked for what a mesh needs and
//! against the bytes that follow, so that no memory is taken for records that cannot be there.

use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Encoding, Header, PropertyType, ScalarType};

use super::Fault;
use super::records::{CORNERS, NUMBERS, Skipped, next_line};
use crate::core::counted::counted;

/// The header of a file, the pictures that its remarks name, and the bytes that follow.
pub(super) struct Parts<'a> {
    pub(super) header: Header,
    pub(super) textures: Vec<String>,
    pub(super) rest: &'a [u8],
}

/// Reads the header.
pub(super) fn read(bytes: &[u8]) -> Result<Parts<'_>, Fault> {
    if !bytes.starts_with(b"ply") {
        return Err(Fault::new("header", "it does not begin with \"ply\""));
    }
    let (text, textures, rest) = plain(bytes)?;
    let version = text.lines().find_map(|line| line.strip_prefix("format ")?.split_whitespace().nth(1));
    if let Some(other) = version.filter(|version| *version != "1.0") {
        let shown: String = other.chars().take(40).collect();
        return Err(Fault::new("header", format!("its version is {shown:?}; 1.0 is read")));
    }
    let header = Parser::<Skipped>::new().read_header(&mut Reader::new(text.as_bytes()));
    let header = header.map_err(|error| in_words(&error, &text))?;
    let announces = |line: &&str| line.starts_with("element") || line.starts_with("property");
    let announced = text.lines().filter(announces).count();
    // The crate keeps one of two that share a name, and would then read the records wrongly.
    if announced != header.elements.values().map(|e| 1 + e.properties.len()).sum::<usize>() {
        return Err(Fault::new("header", "it names two elements, or two properties of one, alike"));
    }
    Ok(Parts { header, textures, rest })
}

/// Returns the lines of the header, the pictures that remarks name (MeshLab), and the bytes that follow. Remarks are left
/// empty, as they may hold what the crate refuses: blank lines, other encodings than UTF-8.
fn plain(bytes: &[u8]) -> Result<(String, Vec<String>, &[u8]), Fault> {
    let (mut text, mut textures, mut rest) = (String::new(), Vec::new(), bytes);
    while !text.ends_with("end_header\n") {
        let line = next_line(&mut rest)
            .ok_or_else(|| Fault::new("header", "it has no line \"end_header\"; the file is truncated"))?;
        let line = String::from_utf8_lossy(line);
        let word = line.split_whitespace().next().unwrap_or("comment");
        let texture =
            line.trim().strip_prefix("comment").and_then(|rest| rest.trim().strip_prefix("TextureFile "));
        textures.extend(texture.map(|name| name.trim().to_owned()));
        text += if ["comment", "obj_info"].contains(&word) { word } else { line.trim() };
        text.push('\n');
    }
    // Some programs write the colours of vertices by the name of what they mean.
    for name in ["red", "green", "blue", "alpha"] {
        if !text.contains(&format!(" {name}\n")) {
            text = text.replace(&format!(" diffuse_{name}\n"), &format!(" {name}\n"));
        }
    }
    Ok((text, textures, rest))
}

/// Says which line of the header the crate refused.
fn in_words(error: &ParseError, text: &str) -> Fault {
    let numbered = |number: usize| Some((number, text.lines().nth(number.checked_sub(1)?)?));
    let Some((number, line)) = error.line().and_then(numbered) else {
        return Fault::new("header", "it has no valid line \"format\"");
    };
    let shown: String = line.chars().take(60).collect();
    Fault::new(format!("line {number}"), format!("\"{shown}\" is not allowed in the header at this place"))
}

/// Tells whether an element holds faces or strips of triangles.
pub(super) fn is_surface(element: &ElementDef) -> bool {
    element.count > 0 && ["face", "tristrips"].contains(&element.name.as_str())
}

/// Tells of colours of faces.
pub(super) fn colors_note(element: &ElementDef) -> Option<String> {
    let has_colors = ["red", "green", "blue"].iter().all(|name| is_number(element, name));
    let what = "those of vertices are read";
    has_colors.then(|| format!("left out: colours of {}; {what}", counted(element.count, "face")))
}

/// Refuses elements that do not hold what a mesh needs.
pub(super) fn check(header: &Header) -> Result<(), Fault> {
    let vertex = header.elements.get("vertex");
    let vertex = vertex.ok_or_else(|| Fault::new("header", "it has no element \"vertex\""))?;
    if let Some(name) = NUMBERS.iter().take(3).find(|name| !is_number(vertex, name)) {
        return Err(Fault::new("header", format!("element \"vertex\" has no property \"{name}\"")));
    }
    let mut surfaces = header.elements.values().filter(|element| is_surface(element)).peekable();
    if surfaces.peek().is_none() {
        return Err(Fault::new("", "it has points but no faces and no tristrips, as a point cloud"));
    }
    for surface in surfaces {
        let mut types = CORNERS.iter().filter_map(|name| surface.properties.get(*name)).map(|p| &p.data_type);
        let what = match types.next() {
            Some(PropertyType::List(_, item)) if !is_fraction(item) => continue,
            Some(_) => "\"vertex_indices\" is no list of whole numbers".to_owned(),
            None => format!("element \"{}\" has no property \"vertex_indices\"", surface.name),
        };
        return Err(Fault::new("header", what));
    }
    Ok(())
}

/// Tells whether an element has a number of this name.
pub(super) fn is_number(element: &ElementDef, name: &str) -> bool {
    element.properties.get(name).is_some_and(|p| matches!(p.data_type, PropertyType::Scalar(_)))
}

/// Tells whether a type holds fractions, which neither counts nor indices may.
fn is_fraction(scalar: &ScalarType) -> bool {
    matches!(scalar, ScalarType::Float | ScalarType::Double)
}

/// Refuses a header that announces more records than `bytes` can hold, before memory is taken for them.
pub(super) fn fits(header: &Header, bytes: usize) -> Result<(), Fault> {
    let mut needed = 0;
    for element in header.elements.values().filter(|element| element.count > 0) {
        let types = || element.properties.values().map(|p| &p.data_type);
        if types().any(|t| matches!(t, PropertyType::List(count, _) if is_fraction(count))) {
            return Err(Fault::new("header", "the length of a list is no whole number"));
        }
        let least: usize = types().map(|t| least_bytes(t, header.encoding)).sum();
        if least == 0 {
            return Err(Fault::new("header", format!("element \"{}\" has no properties", element.name)));
        }
        needed += element.count as u128 * least as u128;
        // The last number of a text needs no space after it.
        if needed > bytes as u128 + 1 {
            let what = format!("it announces {} of element \"{}\"", element.count, element.name);
            let rest = format!("only {bytes} bytes follow it; the file is truncated or damaged");
            return Err(Fault::new("header", format!("{what}, but {rest}")));
        }
    }
    Ok(())
}

/// Returns the least bytes that a property takes: in a text, a digit and a space.
fn least_bytes(property: &PropertyType, encoding: Encoding) -> usize {
    let (PropertyType::Scalar(first) | PropertyType::List(first, _)) = property;
    match (encoding, first) {
        (Encoding::Ascii, _) | (_, ScalarType::Short | ScalarType::UShort) => 2,
        (_, ScalarType::Char | ScalarType::UChar) => 1,
        (_, ScalarType::Int | ScalarType::UInt | ScalarType::Float) => 4,
        (_, ScalarType::Double) => 8,
    }
}
