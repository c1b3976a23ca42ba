//! Wavefront OBJ. Input: the text of a file, in UTF-8 as far as its names matter. Output: its faces, cut into
//! triangles, with the names of their materials and of the files that define these. Curves, lines, points and words that
//! are unknown are left out and noted.

mod face;
mod left_out;

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

use glam::{DVec2, DVec3, Vec4};

use super::relative::inside;
use super::text::{first_word, float, lines, number, quoted, words};
use super::{Fault, MAX_MATERIALS, Mesh, MeshFormat, MeshTriangle, check, polygon};
use face::{Face, pick};
use left_out::LeftOut;

/// The format.
pub(super) const FORMAT: MeshFormat = MeshFormat { name: "OBJ", ending: "obj", read };

/// Reads a file of at most `most` triangles.
fn read(bytes: &[u8], most: usize) -> Result<Mesh, Fault> {
    let mut reader = Reader::default();
    for (number, line) in lines(bytes)? {
        reader.statement(&line, number).map_err(|what| Fault::new(format!("line {number}"), what))?;
        // Here, so that a file over the limit does not fill the memory first.
        check::count(reader.mesh.triangles.len(), most)?;
    }
    if reader.mesh.triangles.is_empty() {
        return Err(Fault::new("", "it has no faces; at least one of three corners is needed"));
    }
    reader.mesh.notes.extend(reader.left_out.notes());
    check::checked(reader.mesh)
}

/// Libraries that a file may name.
const MAX_LIBRARIES: usize = 1024;

/// What was read so far.
#[derive(Default)]
struct Reader {
    mesh: Mesh,
    /// The material of the faces that follow.
    material: Option<u32>,
    /// Where the mesh holds the name of a material.
    materials: HashMap<String, u32>,
    /// The libraries that were named.
    libraries: HashSet<String>,
    left_out: LeftOut,
    /// The face being read; kept, so that faces share the memory.
    face: Face,
}

impl Reader {
    /// Reads a position, and a colour behind it, of linear light, where there is one.
    fn vertex(&mut self, rest: &[u8]) -> Result<(), String> {
        let [x, y, z, ..]: [f64; 3] = numbers(rest, 3, "vertex")?;
        self.mesh.positions.push(DVec3::new(x, y, z));
        let has_color = words(rest).nth(5).is_some();
        if has_color || !self.mesh.colors.is_empty() {
            self.mesh.colors.resize(self.mesh.positions.len(), Vec4::ONE);
        }
        if let Some(color) = self.mesh.colors.last_mut().filter(|_| has_color) {
            let [.., r, g, b]: [f64; 6] = numbers(rest, 6, "vertex")?;
            *color = DVec3::new(r, g, b).extend(1.0).as_vec4();
        }
        Ok(())
    }

    /// Reads one line, or returns what is wrong with it.
    fn statement(&mut self, line: &[u8], number: usize) -> Result<(), String> {
        let (keyword, rest) = first_word(line);
        let capitals = keyword.iter().any(u8::is_ascii_uppercase);
        let keyword = if capitals { Cow::Owned(keyword.to_ascii_lowercase()) } else { keyword.into() };
        match keyword.as_ref() {
            b"v" => self.vertex(rest)?,
            b"vt" => self.mesh.uvs.push(DVec2::from_array(numbers(rest, 1, "texture coordinate")?)),
            // Programs write what is not finite where they could not make a normal.
            b"vn" => self.mesh.normals.push(DVec3::from_array(numbers_by(float, rest, 3, "normal")?)),
            b"f" => self.face(rest)?,
            b"usemtl" => self.use_material(&String::from_utf8_lossy(rest))?,
            b"mtllib" if rest.is_empty() => {}
            b"mtllib" => {
                for library in libraries(rest)? {
                    self.library(library)?;
                }
            }
            other => self.left_out.add(other, number),
        }
        Ok(())
    }

    /// Adds a library, unless it was named before.
    fn library(&mut self, name: String) -> Result<(), String> {
        if self.libraries.insert(name.clone()) {
            if self.mesh.libraries.len() == MAX_LIBRARIES {
                return Err(format!("more than {MAX_LIBRARIES} different libraries are named"));
            }
            self.mesh.libraries.push(name);
        }
        Ok(())
    }

    /// Makes a material that of the faces that follow; an empty name stands for none.
    fn use_material(&mut self, name: &str) -> Result<(), String> {
        self.material = match self.materials.get(name) {
            _ if name.is_empty() => None,
            Some(index) => Some(*index),
            None if self.mesh.materials.len() == MAX_MATERIALS => {
                return Err(format!("more than {MAX_MATERIALS} different materials are named"));
            }
            None => {
                let index = u32::try_from(self.mesh.materials.len()).map_err(|e| e.to_string())?;
                self.mesh.materials.push(name.to_owned());
                self.materials.insert(name.to_owned(), index);
                Some(index)
            }
        };
        Ok(())
    }

    /// Reads a face and adds its triangles. One of fewer than three corners has none.
    fn face(&mut self, rest: &[u8]) -> Result<(), String> {
        self.face.read(rest, &self.mesh)?;
        let corners = &self.face.positions;
        match corners.len() {
            0..3 => {}
            // Most faces; they need no list of their own.
            3 => self.triangle([0, 1, 2]),
            _ => {
                let cut = polygon::triangles(&self.mesh.positions, corners);
                cut.into_iter().for_each(|three| self.triangle(three));
            }
        }
        Ok(())
    }

    /// Adds the triangle of three corners of the face.
    fn triangle(&mut self, corners: [usize; 3]) {
        let Some(positions) = pick(&self.face.positions, corners) else {
            return;
        };
        self.mesh.triangles.push(MeshTriangle {
            positions,
            uvs: pick(&self.face.uvs, corners),
            normals: pick(&self.face.normals, corners),
            material: self.material,
        });
    }
}

/// Returns the files that a statement names: one whose name may have spaces, or several of which each has its ending.
fn libraries(rest: &[u8]) -> Result<Vec<String>, String> {
    let line = String::from_utf8_lossy(rest).replace('\\', "/");
    let words: Vec<&str> = line.split_ascii_whitespace().collect();
    let is_list = words.iter().all(|word| word.to_ascii_lowercase().ends_with(".mtl"));
    let names = if is_list { words } else { vec![line.as_str()] };
    let refused = |name: &str, why: &str| format!("mtllib {} {why}", quoted(name.as_bytes()));
    names.into_iter().map(|name| inside(name).map_err(|why| refused(name, why))).collect()
}

/// Reads up to `N` finite numbers, of which `least` must be there; the others are 0.
fn numbers<const N: usize>(rest: &[u8], least: usize, what: &str) -> Result<[f64; N], String> {
    numbers_by(number, rest, least, what)
}

/// Reads numbers as [`numbers`] does, each by this function.
fn numbers_by<const N: usize>(
    number: fn(&[u8]) -> Result<f64, String>,
    rest: &[u8],
    least: usize,
    what: &str,
) -> Result<[f64; N], String> {
    let mut found = [0.0; N];
    let mut count = 0;
    for (slot, word) in found.iter_mut().zip(words(rest)) {
        *slot = number(word)?;
        count += 1;
    }
    if count < least {
        return Err(format!("{what} has {count} numbers; it needs {least}"));
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.5\nvn 0 0 1\n";

    fn square(more: &str) -> Result<Mesh, Fault> {
        read(format!("{SQUARE}{more}").as_bytes(), 4)
    }

    #[test]
    fn reads_faces_of_every_form() {
        let text = "f 1/1/1 2/1/1 3/1/1 # all\r\nf\t-4//-1 -3//1 \\\r\n -2//1\nf 1/1 2 3\n";
        let mesh = square(text).unwrap();
        let triangle = |uvs, normals| MeshTriangle { positions: [0, 1, 2], uvs, normals, material: None };
        let zero = Some([0; 3]);
        let expected = [triangle(zero, zero), triangle(None, zero), triangle(None, None)];
        assert_eq!(mesh.triangles.iter().collect::<Vec<_>>(), expected);
        assert_eq!(mesh.uvs, [DVec2::new(0.5, 0.0)]);
        assert_eq!(square("f 1 2 3 4\nl 1 2\nf 1 2\n").unwrap().triangles.len(), 2);
    }

    #[test]
    fn colours_follow_positions_and_are_white_elsewhere() {
        let mesh = square("v 0 0 9 0.5 0.25 0\nf 1 2 3\n").unwrap();
        assert_eq!((mesh.colors.len(), mesh.colors[0]), (5, Vec4::ONE));
        assert_eq!(mesh.colors[4], Vec4::new(0.5, 0.25, 0.0, 1.0));
        assert!(square("v 0 0 9 1\nf 1 2 3\n").unwrap().colors.is_empty());
        assert!(square("v 0 0 9 1 1 x\nf 1 2 3\n").unwrap_err().to_string().contains("line 7"));
    }

    #[test]
    fn names_materials_once() {
        let text =
            "mtllib my file.mtl \nusemtl a b\nf 1 2 3\nusemtl c\nf 1 2 3\n# C:\\\nusemtl  a b\r\nf 1 2 3";
        let mesh = square(text).unwrap();
        assert_eq!(
            (mesh.materials, mesh.libraries),
            (vec!["a b".into(), "c".into()], vec!["my file.mtl".into()])
        );
        assert_eq!(mesh.triangles.iter().filter_map(|t| t.material).collect::<Vec<_>>(), [0, 1, 0]);
    }

    #[test]
    fn carriage_returns_alone_end_lines_and_libraries_are_several() {
        let text = "mtllib a.mtl sub\\b.MTL\nmtllib my file.mtl\nf 1 2 3\n";
        let mesh = square(text).unwrap();
        assert_eq!(mesh.libraries, ["a.mtl", "sub/b.MTL", "my file.mtl"]);
        assert_eq!(read(format!("{SQUARE}{text}").replace('\n', "\r").as_bytes(), 4).unwrap(), mesh);
    }

    #[test]
    fn faults_name_the_line() {
        let many = format!("f{}", " 1".repeat(polygon::MOST_CORNERS + 1));
        for (text, fault) in [
            ("\\\n\nf 1 2 99", "line 9: face refers to vertex 99; 4 are defined above"),
            ("f 1 2 -5", "line 7: face refers to vertex -5; 4 are defined above"),
            (
                "f 1 2 -9223372036854775808",
                "line 7: face refers to vertex -9223372036854775808; 4 are defined above",
            ),
            ("f 1/0 2 3", "line 7: face refers to texture coordinate 0; the first is 1"),
            ("f 1/1/1/1 2 3", "line 7: \"1/1/1/1\" has more than three indices"),
            ("f /1 2 3", "line 7: \"\" is no whole number"),
            ("v 1 2", "line 7: vertex has 2 numbers; it needs 3"),
            ("v 1 abc 2", "line 7: \"abc\" is no number"),
            ("vn 1 x 2", "line 7: \"x\" is no number"),
            (&many, "line 7: face has more than 10000 corners"),
            (
                "mtllib ../../../etc/passwd",
                "line 7: mtllib \"../../../etc/passwd\" leaves the folder of the file",
            ),
            ("mtllib /m.mtl", "line 7: mtllib \"/m.mtl\" is an absolute path; it has to be relative"),
            ("f 1 2", "it has no faces; at least one of three corners is needed"),
        ] {
            assert_eq!(square(text).unwrap_err().to_string(), fault);
        }
        assert!(square(&"f 1 2 3 4\n".repeat(2)).is_ok());
        assert!(square(&"f 1 2 3 4\n".repeat(3)).is_err());
    }

    #[test]
    fn tells_encodings_apart() {
        let marked = format!("\u{feff}{SQUARE}usemtl é\nf 1 2 3");
        assert_eq!(read(marked.as_bytes(), 1).unwrap().materials, ["é"]);
        let latin = [SQUARE.as_bytes(), b"usemtl \xe9 \\\n\n\\\nf 1 2 3\\"].concat();
        assert_eq!(read(&latin, 1).unwrap().materials, ["\u{fffd}"]);
        for wide in [&b"\xff\xfev\0"[..], b"\xfe\xff\0v", b"v\0 \0", b"\0v"] {
            assert!(read(wide, 1).unwrap_err().what.contains("UTF-16"));
        }
    }
}
