//! The header of a PLY file. Input: the bytes of the file. Output: its elements, checked for what a mesh needs and
//! against the bytes that follow, so that no memory is taken for records that cannot be there.

use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Encoding, Header, PropertyType, ScalarType};

use super::Fault;
use super::records::{CORNERS, NUMBERS, Skipped, next_line};

/// Reads the header and returns it with the bytes that follow.
pub(super) fn read(bytes: &[u8]) -> Result<(Header, &[u8]), Fault> {
    if !bytes.starts_with(b"ply") {
        return Err(Fault::new("header", "it does not begin with \"ply\""));
    }
    let (text, rest) = plain(bytes)?;
    let header = Parser::<Skipped>::new().read_header(&mut Reader::new(text.as_bytes()));
    let header = header.map_err(|error| in_words(&error, &text))?;
    let announces = |line: &&str| line.starts_with("element") || line.starts_with("property");
    let announced = text.lines().filter(announces).count();
    // The crate keeps one of two that share a name, and would then read the records wrongly.
    if announced != header.elements.values().map(|e| 1 + e.properties.len()).sum::<usize>() {
        return Err(Fault::new("header", "it names two elements, or two properties of one, alike"));
    }
    Ok((header, rest))
}

/// Returns the lines of the header and the bytes that follow. Remarks are left empty, as they may hold what the
/// crate refuses: blank lines, other encodings than UTF-8.
fn plain(bytes: &[u8]) -> Result<(String, &[u8]), Fault> {
    let (mut text, mut rest) = (String::new(), bytes);
    while !text.ends_with("end_header\n") {
        let line = next_line(&mut rest)
            .ok_or_else(|| Fault::new("header", "it has no line \"end_header\"; the file is truncated"))?;
        let line = String::from_utf8_lossy(line);
        let word = line.split_whitespace().next().unwrap_or("comment");
        text += if ["comment", "obj_info"].contains(&word) { word } else { line.trim() };
        text.push('\n');
    }
    Ok((text, rest))
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

/// Returns the elements of vertices and faces if they hold what a mesh needs.
pub(super) fn elements(header: &Header) -> Result<(&ElementDef, &ElementDef), Fault> {
    let place = |name: &str| header.elements.get_index_of(name);
    let vertex = header.elements.get("vertex");
    let vertex = vertex.ok_or_else(|| Fault::new("header", "it has no element \"vertex\""))?;
    if let Some(name) = NUMBERS.iter().take(3).find(|name| !is_number(vertex, name)) {
        return Err(Fault::new("header", format!("element \"vertex\" has no property \"{name}\"")));
    }
    let face = header.elements.get("face").filter(|face| face.count > 0);
    let face = face.ok_or_else(|| Fault::new("", "it has points but no faces, as a point cloud"))?;
    if place("face") < place("vertex") {
        return Err(Fault::new("header", "element \"face\" comes before element \"vertex\""));
    }
    let mut types = CORNERS.iter().filter_map(|name| face.properties.get(*name)).map(|p| &p.data_type);
    match types.next() {
        Some(PropertyType::List(_, item)) if !is_fraction(item) => Ok((vertex, face)),
        Some(_) => Err(Fault::new("header", "\"vertex_indices\" is no list of whole numbers")),
        None => Err(Fault::new("header", "element \"face\" has no property \"vertex_indices\"")),
    }
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
