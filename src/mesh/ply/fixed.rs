//! Binary records of one length. Input: the bytes of an element. Output: its numbers and its triangles, read by several
//! threads; nothing where records have lists of other lengths, which are left to the reader of one after the other.

use std::sync::atomic::{AtomicBool, Ordering};

use ply_rs_bw::ply::{ElementDef, Encoding, PropertyType, ScalarType};
use rayon::prelude::*;

use super::records::{Body, CORNERS, NUMBERS};

/// Records that a thread takes at once.
const AT_ONCE: usize = 1 << 12;

/// A number within a record.
#[derive(Clone, Copy)]
struct Number {
    at: usize,
    /// Reads it from the bytes that begin with it.
    read: fn(&[u8]) -> f64,
}

impl Number {
    /// What is not in a record.
    const NONE: Number = Number { at: 0, read: |_| 0.0 };

    fn of(self, record: &[u8]) -> f64 {
        (self.read)(&record[self.at..])
    }
}

/// Returns the bytes of a number, and what reads it from the bytes that begin with it.
fn reader(scalar: &ScalarType, is_big: bool) -> (usize, fn(&[u8]) -> f64) {
    macro_rules! of {
        ($kind:ident) => {{
            let read: [fn(&[u8]) -> f64; 2] = [
                |bytes| $kind::from_le_bytes(bytes.first_chunk().copied().unwrap_or_default()).into(),
                |bytes| $kind::from_be_bytes(bytes.first_chunk().copied().unwrap_or_default()).into(),
            ];
            (size_of::<$kind>(), read[usize::from(is_big)])
        }};
    }
    match scalar {
        ScalarType::Char => of!(i8),
        ScalarType::UChar => of!(u8),
        ScalarType::Short => of!(i16),
        ScalarType::UShort => of!(u16),
        ScalarType::Int => of!(i32),
        ScalarType::UInt => of!(u32),
        ScalarType::Float => of!(f32),
        ScalarType::Double => of!(f64),
    }
}

/// Records of one length.
pub(super) struct Fixed<'a> {
    bytes: &'a [u8],
    stride: usize,
    numbers: [Number; NUMBERS.len()],
    corners: [Number; 3],
}

impl<'a> Fixed<'a> {
    /// Takes the records of an element off the body, if the file has them all and their lists are the three corners of a
    /// triangle each, or there are none.
    pub(super) fn take(body: &mut Body<'a>, element: &ElementDef) -> Option<Fixed<'a>> {
        let is_big = match body.encoding {
            Encoding::Ascii => return None,
            Encoding::BinaryLittleEndian => false,
            Encoding::BinaryBigEndian => true,
        };
        let mut stride = 0;
        let mut next = |scalar: &ScalarType| {
            let (bytes, read) = reader(scalar, is_big);
            stride += bytes;
            Number { at: stride - bytes, read }
        };
        let (mut numbers, mut list) = ([Number::NONE; NUMBERS.len()], None);
        for (name, property) in &element.properties {
            match &property.data_type {
                PropertyType::Scalar(scalar) => {
                    let number = next(scalar);
                    if let Some(place) = NUMBERS.iter().position(|known| known == name) {
                        numbers[place] = number;
                    }
                }
                PropertyType::List(length, item) if list.is_none() && CORNERS.contains(&name.as_str()) => {
                    list = Some((next(length), [next(item), next(item), next(item)]));
                }
                PropertyType::List(..) => return None,
            }
        }
        let bytes = body.rest.get(..stride.checked_mul(element.count)?)?;
        let (length, corners) = list.unwrap_or((Number::NONE, [Number::NONE; 3]));
        let fixed = Fixed { bytes, stride, numbers, corners };
        // As long as each list has three items, the next record begins where it is looked for.
        let three = |record: &&[u8]| length.of(record) == 3.0;
        if list.is_some() && fixed.records().filter(three).count() != element.count {
            return None;
        }
        body.rest = &body.rest[bytes.len()..];
        Some(fixed)
    }

    fn records(&self) -> impl IndexedParallelIterator<Item = &'a [u8]> + use<'a> {
        self.bytes.par_chunks_exact(self.stride).with_min_len(AT_ONCE)
    }

    /// Returns what is made of these numbers of each record, which are given by their places in `NUMBERS`.
    pub(super) fn of_each<const N: usize, T: Send>(
        &self,
        places: [usize; N],
        make: impl Fn([f64; N]) -> T + Sync + Send,
    ) -> Vec<T> {
        let numbers = places.map(|place| self.numbers[place]);
        self.records().map(|record| make(numbers.map(|number| number.of(record)))).collect()
    }

    /// Returns the corners of each record, or which record has corners that do not exist.
    pub(super) fn triangles(&self, vertices: usize) -> Result<Vec<[u32; 3]>, (usize, f64)> {
        let corners = |record: &[u8]| self.corners.map(|corner| corner.of(record));
        let exists = |n: f64| n >= 0.0 && n < vertices as f64;
        let wrong = |record: &[u8]| corners(record).into_iter().find(|&n| !exists(n));
        let is_wrong = AtomicBool::new(false);
        let read = |record: &[u8]| {
            let corners = corners(record);
            if !corners.into_iter().all(exists) {
                is_wrong.store(true, Ordering::Relaxed);
            }
            corners.map(|n| n as u32)
        };
        let all: Vec<[u32; 3]> = self.records().map(read).collect();
        if !is_wrong.into_inner() {
            return Ok(all);
        }
        let first = self.records().enumerate().find_map_first(|(i, record)| Some((i, wrong(record)?)));
        first.map_or(Ok(all), Err)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::super::read;
    use crate::mesh::Mesh;

    const HEADER: &str = "element vertex 5\nproperty double x\nproperty uchar red\nproperty short y\nproperty float z\n\
                          property uchar green\nproperty uchar blue\nproperty float s\nproperty float t\n\
                          property float nx\nproperty float ny\nproperty float nz\n";
    const FACES: [&[u32]; 3] = [&[0, 1, 2], &[2, 1, 3], &[4, 0, 3]];

    /// Returns the same file as text and in both byte orders.
    fn files(faces: &[&[u32]]) -> [Vec<u8>; 3] {
        let list = format!(
            "element face {}\nproperty char flag\nproperty list uchar uint vertex_indices\n",
            faces.len()
        );
        let header = |encoding: &str| format!("ply\nformat {encoding} 1.0\n{HEADER}{list}end_header\n");
        let mut text = header("ascii");
        let [mut little, mut big] =
            ["little", "big"].map(|e| header(&format!("binary_{e}_endian")).into_bytes());
        for i in 0..5u8 {
            let (x, y) = (f64::from(i * i) * 0.1, i16::from(i) - 3);
            let floats = [1.5, 0.25, 0.125, 0.0, -1.0, 2.0].map(|f| f * f32::from(i + 1));
            let [z, s, t, nx, ny, nz] = floats;
            text += &format!("{x} {i} {y} {z} 7 200 {s} {t} {nx} {ny} {nz}\n");
            little
                .extend([&x.to_le_bytes()[..], &[i], &y.to_le_bytes(), &z.to_le_bytes(), &[7, 200]].concat());
            big.extend([&x.to_be_bytes()[..], &[i], &y.to_be_bytes(), &z.to_be_bytes(), &[7, 200]].concat());
            floats[1..].iter().for_each(|f| little.extend(f.to_le_bytes()));
            floats[1..].iter().for_each(|f| big.extend(f.to_be_bytes()));
        }
        for face in faces {
            text +=
                &format!("-1 {} {}\n", face.len(), face.iter().map(|n| format!("{n} ")).collect::<String>());
            little.extend([255, face.len() as u8]);
            big.extend([255, face.len() as u8]);
            face.iter().for_each(|n| little.extend(n.to_le_bytes()));
            face.iter().for_each(|n| big.extend(n.to_be_bytes()));
        }
        [text.into_bytes(), little, big]
    }

    /// Reads all three and asserts that they are the same, or faulty with the same words.
    fn read_same(faces: &[&[u32]], most: usize) -> Result<Mesh, String> {
        let [text, little, big] =
            files(faces).map(|file| read(&file, most).map_err(|fault| fault.to_string()));
        assert_eq!(text, little);
        assert_eq!(text, big);
        text
    }

    #[test]
    fn binary_files_are_what_texts_are() {
        let mesh = read_same(&FACES, 3).unwrap();
        let counts = [&mesh.positions.len(), &mesh.normals.len(), &mesh.uvs.len(), &mesh.colors.len()];
        assert_eq!((counts, mesh.triangles.len()), ([&5; 4], 3));
        // Its corners are 4, 0, 3, and its normals point backwards.
        assert_eq!(mesh.triangles.get(2).normals, Some([4, 3, 0]));
        assert!(read_same(&FACES, 2).unwrap_err().contains("more than 2 triangles"));
    }

    #[test]
    fn other_faces_than_triangles_are_read_one_by_one() {
        for lists in [&[0, 1, 2, 4][..], &[0, 1], &[]] {
            let mesh = read_same(&[FACES[0], lists, FACES[1]], 9).unwrap();
            assert_eq!(mesh.triangles.positions().last().copied().unwrap(), [2, 1, 3]);
        }
    }

    #[test]
    fn the_first_missing_vertex_is_named() {
        let fault = read_same(&[FACES[0], &[1, 2, 5], &[9, 9, 9]], 9).unwrap_err();
        assert_eq!(fault, "face 1: it refers to vertex 5; the file has 5");
        assert!(read_same(&[&[u32::MAX, 0, 1]], 9).unwrap_err().contains("vertex 4294967295"));
    }

    #[test]
    fn the_last_record_is_not_cut() {
        for file in &files(&FACES)[1..] {
            let fault = read(&file[..file.len() - 1], 9).unwrap_err();
            assert!(fault.what.contains("truncated"), "{fault}");
        }
    }
}
