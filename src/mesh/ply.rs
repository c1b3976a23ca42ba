//! Reads PLY files: text, and binary of either byte order. Input: their bytes. Output: a mesh whose triangles use one
//! index per corner for position, texture coordinate and normal. Elements and properties of no use here are skipped.

mod fixed;
mod header;
mod records;

use glam::{DVec2, DVec3, DVec4};
use ply_rs_bw::ply::{ElementDef, PropertyType, ScalarType};

use super::{Fault, Mesh, MeshFormat, MeshTriangle, check, polygon};
use crate::core::color::srgb_to_linear;
use fixed::Fixed;
use header::is_number;
use records::{Body, Face, NUMBERS, Vertex};

/// The format PLY.
pub(super) const FORMAT: MeshFormat = MeshFormat { name: "PLY", ending: "ply", read };

/// Reads the vertices and faces of a file.
fn read(bytes: &[u8], most: usize) -> Result<Mesh, Fault> {
    let (header, rest) = header::read(bytes)?;
    let (vertex, face) = header::elements(&header)?;
    header::fits(&header, rest.len())?;
    let mut body = Body { rest, encoding: header.encoding };
    let mut mesh = Mesh::default();
    for element in header.elements.values() {
        if element.name == vertex.name {
            vertices(&mut body, element, &mut mesh)?;
        } else if element.name == face.name {
            faces(&mut body, element, &mut mesh, most)?;
            break;
        } else {
            (0..element.count).try_for_each(|i| body.skip(element, i))?;
        }
    }
    check::checked(mesh)
}

/// Reads positions, and texture coordinates, normals and colours if the element has them.
fn vertices(body: &mut Body, element: &ElementDef, mesh: &mut Mesh) -> Result<(), Fault> {
    let has =
        |from: usize, count: usize| NUMBERS.iter().skip(from).take(count).all(|n| is_number(element, n));
    let uv = (10..NUMBERS.len()).step_by(2).find(|&pair| has(pair, 2));
    let has_normals = has(3, 3);
    let encodings = has(6, 3).then(|| NUMBERS.map(|name| Encoding::of(element, name)));
    let has_alpha = has(9, 1);
    let color = |encodings: &[Encoding; NUMBERS.len()], [r, g, b, alpha]: [f64; 4]| {
        let [r, g, b] = [(6, r), (7, g), (8, b)].map(|(k, code)| encodings[k].light(code));
        DVec4::new(r, g, b, if has_alpha { encodings[9].share(alpha) } else { 1.0 }).as_vec4()
    };
    if let Some(fixed) = Fixed::take(body, element) {
        mesh.positions = fixed.of_each([0, 1, 2], DVec3::from_array);
        if has_normals {
            mesh.normals = fixed.of_each([3, 4, 5], DVec3::from_array);
        }
        if let Some(encodings) = &encodings {
            mesh.colors = fixed.of_each([6, 7, 8, 9], |codes| color(encodings, codes));
        }
        if let Some(pair) = uv {
            mesh.uvs = fixed.of_each([pair, pair + 1], DVec2::from_array);
        }
        return Ok(());
    }
    mesh.positions.reserve_exact(element.count);
    for i in 0..element.count {
        let vertex: Vertex = body.record(element, i)?;
        let [x, y, z, nx, ny, nz, ..] = vertex.0;
        mesh.positions.push(DVec3::new(x, y, z));
        if has_normals {
            mesh.normals.push(DVec3::new(nx, ny, nz));
        }
        if let Some(encodings) = &encodings {
            mesh.colors.push(color(encodings, [6, 7, 8, 9].map(|k| vertex.0[k])));
        }
        if let Some(&[u, v]) = uv.and_then(|pair| vertex.0.get(pair..pair + 2)) {
            mesh.uvs.push(DVec2::new(u, v));
        }
    }
    Ok(())
}

/// How a file writes a share of light: whole numbers are codes of sRGB up to the greatest of their type, others linear.
#[derive(Clone, Copy)]
struct Encoding {
    most: f64,
    is_srgb: bool,
}

impl Encoding {
    fn of(element: &ElementDef, name: &str) -> Encoding {
        let most = match element.properties.get(name).map(|property| &property.data_type) {
            Some(PropertyType::Scalar(ScalarType::UChar)) => 255.0,
            Some(PropertyType::Scalar(ScalarType::UShort)) => 65535.0,
            _ => return Encoding { most: 1.0, is_srgb: false },
        };
        Encoding { most, is_srgb: true }
    }

    fn share(self, code: f64) -> f64 {
        code / self.most
    }

    /// Returns the light of a code.
    fn light(self, code: f64) -> f64 {
        let share = self.share(code);
        if self.is_srgb { srgb_to_linear(share) } else { share }
    }
}

/// Reads faces and cuts them into at most `most` triangles.
fn faces(body: &mut Body, element: &ElementDef, mesh: &mut Mesh, most: usize) -> Result<(), Fault> {
    let count = mesh.positions.len();
    let (has_uvs, has_normals) = (!mesh.uvs.is_empty(), !mesh.normals.is_empty());
    let triangle = |positions: [u32; 3]| MeshTriangle {
        positions,
        uvs: has_uvs.then_some(positions),
        normals: has_normals.then_some(positions),
        material: None,
    };
    let missing = |wrong: f64| format!("it refers to vertex {wrong}; the file has {count}");
    if let Some(fixed) =
        Some(element.count).filter(|&count| count <= most).and_then(|_| Fixed::take(body, element))
    {
        let fault = |(i, wrong)| Fault::new(format!("face {i}"), missing(wrong));
        mesh.triangles = fixed.triangles(count, triangle).map_err(fault)?;
        return Ok(());
    }
    for i in 0..element.count {
        let face: Face = body.record(element, i)?;
        let fault = |what| Fault::new(format!("face {i}"), what);
        if face.corners.len() > polygon::MOST_CORNERS {
            return Err(fault(format!("it has more than {} corners", polygon::MOST_CORNERS)));
        }
        let exists = |n: f64| n >= 0.0 && n.fract() == 0.0 && n < count as f64;
        if let Some(wrong) = face.corners.iter().find(|&&n| !exists(n)) {
            return Err(fault(missing(*wrong)));
        }
        let corners: Vec<u32> = face.corners.iter().map(|&n| n as u32).collect();
        for cut in polygon::triangles(&mesh.positions, &corners) {
            let positions = cut.map(|corner| corners.get(corner).copied().unwrap_or_default());
            mesh.triangles.push(triangle(positions));
        }
        check::count(mesh.triangles.len(), most)?;
    }
    if mesh.triangles.is_empty() {
        return Err(Fault::new("", "none of its faces has an area"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    const QUADS: [[u8; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

    const TRIANGLE: &str = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                            element face 1\nproperty list uchar int vertex_indices\nend_header\n";

    fn corner(i: u8) -> [f32; 3] {
        [f32::from(i & 1), f32::from(i >> 1 & 1), f32::from(i >> 2)]
    }

    /// Returns a file with the beginning every file has.
    fn file(encoding: &str, rest: &str) -> Vec<u8> {
        format!("ply\nformat {encoding} 1.0\n{rest}").into_bytes()
    }

    fn ascii(rest: &str) -> Result<Mesh, String> {
        read(&file("ascii", rest), 100).map_err(|fault| fault.to_string())
    }

    /// Asserts that a file is refused with these words.
    fn assert_refused(rest: &str, words: &str) {
        let fault = ascii(rest).unwrap_err();
        assert!(fault.contains(words), "{fault}");
    }

    fn cube_header(extra: &str) -> String {
        let vertex = "element vertex 8\nproperty float x\nproperty float y\nproperty float z\n";
        format!("{vertex}{extra}element face 6\nproperty list uchar int vertex_index\nend_header\n")
    }

    fn ascii_cube() -> Mesh {
        let mut text = cube_header("comment by hand\n\n");
        (0..8).map(corner).for_each(|[x, y, z]| text += &format!("{x} {y} {z}\r\n"));
        QUADS.iter().for_each(|[a, b, c, d]| text += &format!("4 {a} {b} {c} {d}\n"));
        ascii(text.trim_end()).unwrap()
    }

    fn binary_cube(encoding: &str, float: fn(f32) -> [u8; 4], int: fn(i32) -> [u8; 4]) -> Vec<u8> {
        let mut bytes = file(encoding, &cube_header("property uchar red\nproperty list uint short odd\n"));
        for i in 0..8 {
            corner(i).into_iter().for_each(|n| bytes.extend(float(n)));
            bytes.push(255);
            bytes.extend(int(0));
        }
        for quad in QUADS {
            bytes.push(4);
            quad.into_iter().for_each(|i| bytes.extend(int(i.into())));
        }
        bytes
    }

    #[test]
    fn reads_a_cube_in_all_encodings() {
        let cube = ascii_cube();
        assert_eq!((cube.positions.len(), cube.triangles.len()), (8, 12));
        let at = |i: u32| cube.positions[i as usize];
        let six_volumes = |t: &MeshTriangle| {
            let [a, b, c] = t.positions.map(at);
            a.dot(b.cross(c))
        };
        assert_eq!(cube.triangles.iter().map(six_volumes).sum::<f64>(), 6.0);
        let little = binary_cube("binary_little_endian", f32::to_le_bytes, i32::to_le_bytes);
        assert_eq!(read(&little, 12).unwrap(), cube);
        let big = binary_cube("binary_big_endian", f32::to_be_bytes, i32::to_be_bytes);
        assert_eq!(read(&big, 12).unwrap(), cube);
        assert!(read(&big, 11).unwrap_err().what.contains("more than 11 triangles"));
    }

    #[test]
    fn never_reads_part_of_a_file() {
        let whole = binary_cube("binary_little_endian", f32::to_le_bytes, i32::to_le_bytes);
        for length in 3..whole.len() {
            let fault = read(&whole[..length], 100).unwrap_err();
            assert!(fault.what.contains("truncated"), "{length}: {fault}");
        }
    }

    #[test]
    fn reads_properties_in_any_order() {
        let mesh = ascii(
            "obj_info none\nelement camera 1\nproperty list int float view\nelement vertex 3\n\
             property double nz\nproperty uchar red\nproperty float v\nproperty int z\nproperty float u\n\
             property float x\nproperty list uchar int more\nproperty float ny\nproperty float y\n\
             property float nx\nelement face 2\nproperty uchar flags\nproperty list int uint vertex_indices\n\
             end_header\n2 5 6\n1 9 .25 7 0.5 1. 2 8 8 0 2e0 0\n1 9 0 7 0 3 0 0 2 0\n1 9 0 7 0 1 0 0 4 0\n\
             3 3 2 0 1\n0 2 0 1\n",
        )
        .unwrap();
        assert_eq!(mesh.positions[0], DVec3::new(1.0, 2.0, 7.0));
        assert_eq!(mesh.normals, [DVec3::Z; 3]);
        assert_eq!(mesh.uvs[0], DVec2::new(0.5, 0.25));
        let corners = [2, 0, 1];
        let (uvs, normals) = (Some(corners), Some(corners));
        assert_eq!(mesh.triangles, [MeshTriangle { positions: corners, uvs, normals, material: None }]);
    }

    #[test]
    fn whole_numbers_of_colours_are_srgb_and_fractions_are_light() {
        let colored = |kind: &str, values: &str| {
            let colors = ["red", "green", "blue"].map(|name| format!("property {kind} {name}\n")).concat();
            let header = TRIANGLE.replace("float z\n", &format!("float z\n{colors}property uchar alpha\n"));
            let points = ["0 0 0", "1 0 0", "0 1 0"].map(|at| format!("{at} {values} 51\n")).concat();
            ascii(&format!("{header}{points}3 0 1 2\n")).unwrap().colors[2]
        };
        for (kind, values) in
            [("uchar", "128 0 255"), ("ushort", "32896 0 65535"), ("float", "0.2158605 0 1")]
        {
            let found = colored(kind, values).as_dvec4();
            assert!((found - DVec4::new(0.215_860_5, 0.0, 1.0, 0.2)).abs().max_element() < 1e-6, "{found}");
        }
        assert!(ascii_cube().colors.is_empty());
    }

    #[test]
    fn refuses_faulty_records() {
        let points = format!("{TRIANGLE}0 0 0\n1 0 0\n0 1 0\n");
        assert_refused(&format!("{points}3 0 1 3\n"), "face 0: it refers to vertex 3; the file has 3");
        assert_refused(&format!("{points}3 0 1 -1\n"), "face 0: it refers to vertex -1");
        assert_refused(&format!("{points}3 0 1 2.5\n"), "face 0: it refers to vertex 2.5");
        assert_refused(&format!("{points}4000000000 0 1 2\n"), "face 0: the file ends within it");
        assert_refused(&format!("{points}3 0 x 2\n\n"), "face 0: its line does not hold the numbers");
        assert_refused(&format!("{points}2 0 1\n"), "none of its faces");
        assert_refused(&format!("{points}10001{}\n", " 0".repeat(10_001)), "face 0: it has more than 10000");
        assert_refused(&format!("{TRIANGLE}0 0 nan\n1 0 0\n0 1 0\n3 0 1 2"), "position 0: a number is not");
    }

    #[test]
    fn refuses_faulty_headers() {
        assert!(read(b"solid", 1).unwrap_err().what.contains("begin with \"ply\""));
        let points = TRIANGLE.replace("face", "edge");
        assert_refused(&points, "it has points but no faces, as a point cloud");
        assert_refused(&TRIANGLE.replace("float x", "float w"), "element \"vertex\" has no property \"x\"");
        assert_refused(&TRIANGLE.replace("float y", "float x"), "alike");
        assert_refused(&TRIANGLE.replace("float y", "real y"), "line 5: \"property real y\" is not allowed");
        let float_length = TRIANGLE.replace("uchar int", "float int");
        assert_refused(&format!("{float_length}0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), "the length of a list");
        assert_refused(&TRIANGLE.replace("uchar int", "uchar float"), "no list of whole numbers");
        assert_refused(&TRIANGLE.replace("vertex 3", "vertex 9999999999999999999"), "truncated or damaged");
        assert_refused(&TRIANGLE.replace("vertex 3", "vertex 99999999999999999999"), "line 3");
    }

    #[test]
    fn refuses_hostile_counts_without_taking_memory() {
        let header = TRIANGLE.replace("uchar int", "int int");
        for (count, words) in [(i32::MAX, "face 0: the file ends within it"), (-1, "negative length")] {
            let mut bytes = file("binary_little_endian", &header);
            bytes.extend([0; 36]);
            bytes.extend(count.to_le_bytes());
            let fault = read(&bytes, 100).unwrap_err().to_string();
            assert!(fault.contains(words), "{fault}");
        }
        let empty = TRIANGLE.replace("element vertex", "element none 4000000000\nelement vertex");
        assert_refused(&empty, "element \"none\" has no properties");
    }
}
