//! Reads STL files (3D Systems, Stereolithography Interface Specification, 1988), binary and as text. Input: the bytes of
//! a file. Output: flat triangles; the normals of the file say no more than the corners do and are left.

mod text;

use glam::DVec3;

use super::{Fault, Mesh, MeshFormat, Triangles, check};
use crate::core::counted::counted;

pub(super) const FORMAT: MeshFormat = MeshFormat { name: "STL", ending: "stl", read };

/// Bytes before the first triangle: a comment, and the number of triangles.
const HEADER: usize = 84;
/// Bytes in which a binary file has a zero.
const AT_BEGINNING: usize = 512;
/// Bytes of a triangle: normal, three corners, two bytes of attributes.
const RECORD: usize = 50;

fn read(bytes: &[u8], most: usize) -> Result<Mesh, Fault> {
    // Programs begin binary files with `solid` too, so that the length decides first.
    let begins = bytes.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    // A number of triangles, or a coordinate, has a zero byte; a text has none.
    let is_text = begins && !bytes.iter().take(AT_BEGINNING).any(|byte| *byte == 0);
    match announced(bytes) {
        Some(count) if bytes.len() as u64 == length_of(count) || !is_text => binary(bytes, count, most),
        None if !is_text => {
            Err(Fault::new("", "it is no STL file: neither \"solid\" nor a header of 84 bytes"))
        }
        _ => check::checked(of_corners(text::corners(bytes, most)?)),
    }
}

fn announced(bytes: &[u8]) -> Option<u32> {
    let count = bytes.get(HEADER - 4..HEADER)?;
    count.try_into().ok().map(u32::from_le_bytes)
}

fn length_of(count: u32) -> u64 {
    HEADER as u64 + RECORD as u64 * u64::from(count)
}

fn binary(bytes: &[u8], count: u32, most: usize) -> Result<Mesh, Fault> {
    let needed = length_of(count);
    if (bytes.len() as u64) < needed {
        let what = format!("{count} triangles need {needed} bytes; the file ends after {}", bytes.len());
        return Err(Fault::new("header", what));
    }
    check::count(count as usize, most)?;
    let records = bytes[HEADER..needed as usize].chunks_exact(RECORD);
    let number = |bytes: &[u8]| f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]));
    let corner = |bytes: &[u8]| DVec3::new(number(bytes), number(&bytes[4..]), number(&bytes[8..]));
    let corners =
        records.clone().flat_map(|record| [12, 24, 36].map(|first| corner(&record[first..first + 12])));
    let mut mesh = of_corners(corners.collect());
    let colored = colored(&bytes[..HEADER], records);
    if colored > 0 {
        let triangles = counted(colored, "triangle");
        mesh.notes.push(format!("left out: colours of {triangles}, which STL itself does not know"));
    }
    let further = bytes.len() as u64 - needed;
    if further > 0 {
        mesh.notes
            .push(format!("its last {further} bytes are ignored: they are behind the {count} triangles"));
    }
    check::checked(mesh)
}

/// Returns the number of triangles whose two bytes of attributes are a colour. Bit 15 says so (VisCAM), or says that it is
/// not (Magics, whose header names a colour for the others).
fn colored<'a>(header: &[u8], records: impl Iterator<Item = &'a [u8]>) -> usize {
    let of_magics = header.windows(6).any(|word| word == b"COLOR=");
    records.filter(|record| (record[RECORD - 1] & 0x80 == 0) == of_magics).count()
}

/// Returns the mesh of triangles that share no corner.
fn of_corners(positions: Vec<DVec3>) -> Mesh {
    let triangle = |first: u32| [first, first + 1, first + 2];
    let triangles = (0..positions.len() as u32).step_by(3).map(triangle).collect();
    let triangles = Triangles::of_vertices(triangles, false, false, None);
    Mesh { positions, triangles, ..Mesh::default() }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    const TEXT: &str = "solid a b\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\r\n   vertex 0 1e0 0\n  endloop\n endfacet\nendsolid a b\n";

    fn bytes(comment: &[u8], corners: &[[f32; 3]]) -> Vec<u8> {
        let mut bytes = comment.to_vec();
        bytes.resize(80, 0);
        bytes.extend((corners.len() as u32 / 3).to_le_bytes());
        for triangle in corners.chunks(3) {
            bytes.extend([0; 12]);
            bytes.extend(triangle.iter().flatten().flat_map(|x| x.to_le_bytes()));
            bytes.extend([7, 7]);
        }
        bytes
    }

    #[test]
    fn text_and_binary_files_give_the_same_triangles_whatever_the_comment() {
        let text = read(TEXT.as_bytes(), 1).unwrap();
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        for comment in [&b"made by hand"[..], b"solid made by a program"] {
            assert_eq!(read(&bytes(comment, &corners), 1).unwrap(), text);
        }
        assert_eq!(text.positions[2], DVec3::Y);
    }

    #[test]
    fn broken_files_are_refused_where_they_break() {
        let fault = |bytes: &[u8]| read(bytes, 1).unwrap_err().to_string();
        let corners = [[0.0; 3]; 6];
        assert!(fault(&bytes(b"", &corners)).contains("more than 1 triangles"));
        assert!(fault(&bytes(b"", &corners[..3])[..100]).contains("the file ends after 100"));
        assert!(fault(&bytes(b"", &[[f32::NAN; 3]; 3])).contains("not finite"));
        assert_eq!(fault(TEXT.replace("1e0", "x").as_bytes()), "line 6: \"x\" is no number");
        assert!(fault(TEXT.replace("vertex 1 0 0", "").as_bytes()).starts_with("line 8: a facet has 3"));
        assert!(fault(b"solid\nendsolid").contains("no facets"));
        assert!(fault(b"hello").contains("no STL file"));
    }

    #[test]
    fn capitals_and_bytes_behind_the_triangles_are_read() {
        let small = read(TEXT.as_bytes(), 1).unwrap();
        assert_eq!(read(TEXT.to_uppercase().as_bytes(), 1).unwrap(), small);
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let mut longer = bytes(b"solid made by a program", &corners);
        longer.extend(b"extra");
        let mesh = read(&longer, 1).unwrap();
        assert_eq!((mesh.positions, mesh.triangles), (small.positions, small.triangles));
        assert_eq!(mesh.notes, ["its last 5 bytes are ignored: they are behind the 1 triangles"]);
    }
}
