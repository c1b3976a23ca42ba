//! The records of a PLY file. Input: the bytes after the header. Output: one record after the other: the numbers of a
//! vertex, the corners of a face, or nothing. The crate reads binary records; text is read here, as the crate knows
//! too few spellings of numbers.

use std::io::ErrorKind;

use ply_rs_bw::parser::{ParseError, Parser};
use ply_rs_bw::ply::{ElementDef, Encoding, Property, PropertyAccess, PropertyAccessResult, PropertyType};

use super::Fault;

/// Names of the numbers of a vertex: the position, from 3 the normal, from 6 the colour with its alpha, from 10 the pairs
/// of names that texture coordinates go by.
#[rustfmt::skip]
pub(super) const NUMBERS: [&str; 18] = [
    "x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "alpha",
    "s", "t", "u", "v", "texture_u", "texture_v", "tx", "ty",
];

/// Name of the list of coordinates at the corners of a face.
const CORNER_UVS: &str = "texcoord";

/// Name of the number of a face's texture.
pub(super) const TEXTURE: &str = "texnumber";

/// Names of the list of the corners of a face.
pub(super) const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

const TRUNCATED: &str = "the file ends within it; the file is truncated";

/// What is left of the file after the header and the records read.
pub(super) struct Body<'a> {
    pub(super) rest: &'a [u8],
    pub(super) encoding: Encoding,
}

impl Body<'_> {
    /// Reads record `i` of an element.
    pub(super) fn record<R: PropertyAccess>(&mut self, element: &ElementDef, i: usize) -> Result<R, Fault> {
        let record = match self.encoding {
            Encoding::Ascii => self.text_record(element),
            Encoding::BinaryLittleEndian => {
                Parser::new().read_little_endian_element(&mut self.rest, element).map_err(in_words)
            }
            Encoding::BinaryBigEndian => {
                Parser::new().read_big_endian_element(&mut self.rest, element).map_err(in_words)
            }
        };
        record.map_err(|what| Fault::new(format!("{} {i}", element.name), what))
    }

    /// Skips record `i` of an element; of a text, whatever its line holds.
    pub(super) fn skip(&mut self, element: &ElementDef, i: usize) -> Result<(), Fault> {
        if self.encoding == Encoding::Ascii && self.line().is_some() {
            return Ok(());
        }
        self.record::<Skipped>(element, i).map(|_| ())
    }

    /// Reads a record from the next line.
    fn text_record<R: PropertyAccess>(&mut self, element: &ElementDef) -> Result<R, String> {
        let line = self.line().ok_or(TRUNCATED)?;
        let line = String::from_utf8_lossy(line).into_owned();
        parsed(&line, element).ok_or_else(|| {
            // A file that was cut ends within its last word.
            let other = line.split_ascii_whitespace().find(|word| word.parse::<f64>().is_err());
            match other {
                Some(word) if !self.rest.is_empty() || !line.trim_ascii_end().ends_with(word) => {
                    format!("{:?} is no number", word.chars().take(40).collect::<String>())
                }
                _ if self.rest.is_empty() => TRUNCATED.to_owned(),
                _ => "its line does not hold the numbers that the header announces".to_owned(),
            }
        })
    }

    /// Takes the next line that is not blank.
    fn line(&mut self) -> Option<&[u8]> {
        loop {
            let line = next_line(&mut self.rest)?;
            if !line.trim_ascii().is_empty() {
                return Some(line);
            }
        }
    }
}

/// Takes the next line off, without its end.
pub(super) fn next_line<'a>(rest: &mut &'a [u8]) -> Option<&'a [u8]> {
    let line = rest.split(|byte| *byte == b'\n').next().filter(|_| !rest.is_empty())?;
    *rest = rest.get(line.len() + 1..).unwrap_or_default();
    Some(line)
}

/// Says what ails a binary record. Types that do not fit are refused with the header.
fn in_words(error: ParseError) -> String {
    let what = match error.kind() {
        ErrorKind::UnexpectedEof => TRUNCATED,
        _ => "it has a list of negative length",
    };
    what.to_owned()
}

/// Reads a record from its line. Numbers become doubles, whichever type they have in the header.
fn parsed<R: PropertyAccess>(line: &str, element: &ElementDef) -> Option<R> {
    let mut words = line.split_ascii_whitespace();
    let mut record = R::new();
    for (name, property) in &element.properties {
        let value = match property.data_type {
            PropertyType::Scalar(_) => Property::Double(words.next()?.parse().ok()?),
            PropertyType::List(..) => {
                let count: usize = words.next()?.parse().ok()?;
                let items = words.by_ref().take(count).map(|word| word.parse().ok());
                let items: Vec<f64> = items.collect::<Option<_>>()?;
                Property::ListDouble(Some(items).filter(|items| items.len() == count)?)
            }
        };
        record.set_property(name, value);
    }
    Some(record)
}

/// A record of which nothing is kept.
pub(super) struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Skipped
    }
}

/// The values of a vertex, in the order of `NUMBERS`.
pub(super) struct Vertex(pub(super) [f64; NUMBERS.len()]);

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Vertex([0.0; NUMBERS.len()])
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let mut places = self.0.iter_mut().zip(NUMBERS);
        let Some((place, _)) = places.find(|(_, number)| *number == name) else {
            return PropertyAccessResult::Ignored;
        };
        let Some(number) = scalar(&property) else { return PropertyAccessResult::Ignored };
        *place = number;
        PropertyAccessResult::Set
    }
}

/// Returns a number of any type.
fn scalar(property: &Property) -> Option<f64> {
    Some(match *property {
        Property::Char(n) => n.into(),
        Property::UChar(n) => n.into(),
        Property::Short(n) => n.into(),
        Property::UShort(n) => n.into(),
        Property::Int(n) => n.into(),
        Property::UInt(n) => n.into(),
        Property::Float(n) => n.into(),
        Property::Double(n) => n,
        _ => return None,
    })
}

/// The corners of a face or a strip, as numbers that may be any, with what each corner has, and its texture.
pub(super) struct Face {
    pub(super) corners: Vec<f64>,
    /// Two for each corner, or none.
    pub(super) uvs: Vec<f64>,
    pub(super) texture: Option<f64>,
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Face { corners: Vec::new(), uvs: Vec::new(), texture: None }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if name == TEXTURE {
            self.texture = scalar(&property);
            return PropertyAccessResult::Set;
        }
        let list = match name {
            CORNER_UVS => &mut self.uvs,
            _ if CORNERS.contains(&name) => &mut self.corners,
            _ => return PropertyAccessResult::Ignored,
        };
        if !list.is_empty() {
            return PropertyAccessResult::Ignored;
        }
        *list = match property {
            Property::ListChar(list) => numbers(list),
            Property::ListUChar(list) => numbers(list),
            Property::ListShort(list) => numbers(list),
            Property::ListUShort(list) => numbers(list),
            Property::ListInt(list) => numbers(list),
            Property::ListUInt(list) => numbers(list),
            Property::ListFloat(list) => numbers(list),
            Property::ListDouble(list) => list,
            _ => return PropertyAccessResult::Ignored,
        };
        PropertyAccessResult::Set
    }
}

fn numbers<N: Into<f64>>(list: Vec<N>) -> Vec<f64> {
    list.into_iter().map(Into::into).collect()
}
