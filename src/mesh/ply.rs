//! Reads PLY files: text, and binary of either byte order. Input: their bytes. Output: a mesh whose triangles use one
//! index per corner for position, texture coordinate and normal. Elements and properties of no use here are skipped.

mod colors;
mod faces;
mod fixed;
mod header;
mod records;

use glam::{DVec2, DVec3, DVec4};
use ply_rs_bw::ply::ElementDef;

use super::mtl::MtlMaterial;
use super::{Fault, Mesh, MeshFormat, check};
use colors::Encoding;
use faces::Surfaces;
use fixed::Fixed;
use header::{Parts, is_number};
use records::{Body, NUMBERS, Vertex};

/// The format PLY.
pub(super) const FORMAT: MeshFormat = MeshFormat { name: "PLY", ending: "ply", read };

/// Reads the vertices and faces of a file.
fn read(bytes: &[u8], most: usize) -> Result<Mesh, Fault> {
    let Parts { header, textures, rest } = header::read(bytes)?;
    header::check(&header)?;
    header::fits(&header, rest.len())?;
    let mut body = Body { rest, encoding: header.encoding };
    let mut mesh = Mesh::default();
    let mut surfaces = Surfaces::new(textures.len(), most);
    let holds = |element: &ElementDef| element.name == "vertex" || header::is_surface(element);
    let last = header.elements.values().rposition(holds).unwrap_or(0);
    for element in header.elements.values().take(last + 1) {
        if element.name == "vertex" {
            vertices(&mut body, element, &mut mesh)?;
            surfaces.has_uvs = !mesh.uvs.is_empty();
            surfaces.add_waiting(&mut mesh)?;
        } else if header::is_surface(element) {
            surfaces.read(&mut body, element, &mut mesh)?;
            mesh.notes.extend(header::colors_note(element));
        } else {
            (0..element.count).try_for_each(|i| body.skip(element, i))?;
        }
    }
    // Without a vertex, each of them is at fault.
    surfaces.add_waiting(&mut mesh)?;
    if mesh.triangles.is_empty() {
        return Err(Fault::new("", "none of its faces has an area"));
    }
    textured(&mut mesh, textures);
    check::checked(mesh)
}

/// Makes the pictures that a file names those of its materials.
fn textured(mesh: &mut Mesh, textures: Vec<String>) {
    if !textures.is_empty() && mesh.uvs.is_empty() {
        let first = &textures[0];
        mesh.notes.push(format!("its texture {first:?} is left out: nothing has texture coordinates"));
        mesh.set_material(None);
        return;
    }
    mesh.definitions = textures.iter().map(|file| MtlMaterial::of_picture(file)).collect();
    mesh.materials = textures;
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::mesh::MeshTriangle;

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
        assert_eq!(cube.triangles.iter().map(|t| six_volumes(&t)).sum::<f64>(), 6.0);
        let little = binary_cube("binary_little_endian", f32::to_le_bytes, i32::to_le_bytes);
        assert_eq!(read(&little, 12).unwrap(), cube);
        let big = binary_cube("binary_big_endian", f32::to_be_bytes, i32::to_be_bytes);
        assert_eq!(read(&big, 12).unwrap(), cube);
        assert!(read(&big, 11).unwrap_err().what.contains("more than 11 triangles"));
    }

    #[test]
    fn faces_may_come_first_and_strips_take_their_place() {
        let square = "-1 1 0\n-1 -1 0\n1 -1 0\n1 1 0\n";
        let vertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
        let list = "property list uchar int vertex_indices\n";
        let after =
            ascii(&format!("{vertices}element face 1\n{list}end_header\n{square}4 0 1 2 3\n")).unwrap();
        let before =
            ascii(&format!("element face 1\n{list}{vertices}end_header\n4 0 1 2 3\n{square}")).unwrap();
        assert_eq!(before, after);
        let strips = format!("{vertices}element tristrips 1\n{list}end_header\n{square}");
        let strip = |numbers: &str| ascii(&format!("{strips}{numbers}\n"));
        let of = |mesh: Mesh| mesh.triangles.iter().map(|t| t.positions).collect::<Vec<_>>();
        assert_eq!(of(strip("4 0 1 3 2").unwrap()), [[0, 1, 3], [3, 1, 2]]);
        assert_eq!(of(strip("7 0 1 3 -1 1 2 3").unwrap()), [[0, 1, 3], [1, 2, 3]]);
        assert!(strip("3 0 1 9").unwrap_err().contains("tristrips 0: it refers to vertex 9"));
    }

    #[test]
    fn colours_have_another_name_and_corners_coordinates_of_their_own() {
        let vertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
        let colors =
            "property uchar diffuse_red\nproperty uchar diffuse_green\nproperty uchar diffuse_blue\n";
        let list = "element face 1\nproperty list uchar int vertex_indices\n";
        let positions = ["0 0 0", "1 0 0", "0 1 0"];
        let colored = positions.map(|p| format!("{p} 255 0 255\n")).concat();
        let mesh = ascii(&format!("{vertices}{colors}{list}end_header\n{colored}3 0 1 2\n")).unwrap();
        assert_eq!(mesh.colors, [glam::Vec4::new(1.0, 0.0, 1.0, 1.0); 3]);
        let plain = positions.map(|p| format!("{p}\n")).concat();
        let of = |uvs: &str| {
            let uv = "property list uchar float texcoord\n";
            ascii(&format!("{vertices}{list}{uv}end_header\n{plain}3 0 1 2 {uvs}\n"))
        };
        let mesh = of("6 0 0 .5 0 0 1").unwrap();
        assert_eq!((mesh.uvs[1], mesh.triangles.get(0).uvs), (DVec2::new(0.5, 0.0), Some([0, 1, 2])));
        assert_eq!(of("0").unwrap().triangles.get(0).uvs, None);
        assert!(of("4 0 0 1 1").unwrap_err().contains("4 numbers; 6 are needed"));
    }

    #[test]
    fn words_and_versions_that_are_none_are_named() {
        let text = format!("{TRIANGLE}0 0 0\n1 0 0\n0 1 0\n3 a b c\n");
        assert_refused(&text, "face 0: \"a\" is no number");
        assert_refused(&text.replace("3 a b c", "3 a 1 2"), "face 0: \"a\" is no number");
        assert_refused(&text.replace("3 a b c", "3 0 1 x"), "truncated");
        assert_refused(&text.replace("1 0 0", "1 y 0"), "vertex 1: \"y\" is no number");
        let other = read(b"ply\nformat ascii 2.0\nend_header\n", 1).unwrap_err();
        assert_eq!(other.what, "its version is \"2.0\"; 1.0 is read");
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
        let expected = MeshTriangle { positions: corners, uvs, normals, material: None };
        assert_eq!(mesh.triangles.iter().collect::<Vec<_>>(), [expected]);
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
        assert_refused(&format!("{points}3 0 x 2\n\n"), "face 0: \"x\" is no number");
        assert_refused(&format!("{points}2 0 1\n"), "none of its faces");
        assert_refused(&format!("{points}10001{}\n", " 0".repeat(10_001)), "face 0: it has more than 10000");
        assert_refused(&format!("{TRIANGLE}0 0 nan\n1 0 0\n0 1 0\n3 0 1 2"), "position 0: a number is not");
    }

    #[test]
    fn refuses_faulty_headers() {
        assert!(read(b"solid", 1).unwrap_err().what.contains("begin with \"ply\""));
        let points = TRIANGLE.replace("face", "edge");
        assert_refused(&points, "it has points but no faces and no tristrips, as a point cloud");
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
