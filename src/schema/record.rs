//! Writes the fields of records to the bytes of device memory, at the positions given by `packing`; reals as f64 if the
//! device reads f64, otherwise rounded to f32.

use glam::{DVec2, DVec3, DVec4, UVec2, UVec3, Vec3, Vec4};

use super::packing::{Packer, Shape};

/// A record of the scene buffer.
pub trait Record: Copy {
    /// Units of reals and of words.
    const UNITS: (u32, u32);

    /// Appends the bytes that the shader reads.
    fn write(&self, double: bool, bytes: &mut Vec<u8>);

    /// Returns the record with all reals rounded to the f32 values that the shader reads unless it reads f64.
    fn quantize_f32(&self) -> Self;
}

/// Returns the bytes of a list of records.
pub fn bytes_of<R: Record>(records: &[R], double: bool) -> Vec<u8> {
    let mut bytes = Vec::new();
    records.iter().for_each(|record| record.write(double, &mut bytes));
    bytes
}

/// A field of a record.
pub trait Field: Copy {
    fn write(self, double: bool, bytes: &mut Vec<u8>);

    /// Returns the value after rounding reals to f32.
    fn quantize_f32(self) -> Self {
        self
    }
}

/// A real among words: two words, of which f32 uses the first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RealBits(pub f64);

/// Writes the fields of one record.
pub struct Writer<'a> {
    double: bool,
    bytes: &'a mut Vec<u8>,
    start: usize,
    packer: Packer,
}

impl<'a> Writer<'a> {
    pub fn new(double: bool, bytes: &'a mut Vec<u8>) -> Writer<'a> {
        let start = bytes.len();
        Writer { double, bytes, start, packer: Packer::new() }
    }

    pub fn field(&mut self, shape: Shape, field: impl Field) {
        let (place, packer) = self.packer.place(shape);
        self.packer = packer;
        let lane = if self.double && shape.kind == super::packing::Kind::Reals { 8 } else { 4 };
        let at = self.units(place.reals, place.words) + place.lane as usize * lane;
        self.bytes.resize(self.start + at, 0);
        field.write(self.double, self.bytes);
    }

    /// Fills the last unit.
    pub fn end(self) {
        let length = self.units(self.packer.reals, self.packer.words);
        self.bytes.resize(self.start + length, 0);
    }

    /// Returns the bytes of this many units.
    fn units(&self, reals: u32, words: u32) -> usize {
        16 * (reals as usize * if self.double { 2 } else { 1 } + words as usize)
    }
}

/// Fields that do not depend on the precision of reals.
macro_rules! plain {
    ($($type:ty),+) => {
        $(impl Field for $type {
            fn write(self, _: bool, bytes: &mut Vec<u8>) {
                bytes.extend_from_slice(bytemuck::bytes_of(&self));
            }
        })+
    };
}
plain!(f32, Vec3, Vec4, u32, UVec2, UVec3);

impl Field for bool {
    fn write(self, double: bool, bytes: &mut Vec<u8>) {
        u32::from(self).write(double, bytes);
    }
}

impl Field for f64 {
    fn write(self, double: bool, bytes: &mut Vec<u8>) {
        if double {
            bytes.extend_from_slice(&self.to_le_bytes());
        } else {
            bytes.extend_from_slice(&(self as f32).to_le_bytes());
        }
    }

    fn quantize_f32(self) -> f64 {
        f64::from(self as f32)
    }
}

/// Vectors of reals.
macro_rules! vectors {
    ($($type:ty: $single:ident $double:ident),+) => {
        $(impl Field for $type {
            fn write(self, double: bool, bytes: &mut Vec<u8>) {
                self.to_array().into_iter().for_each(|x| x.write(double, bytes));
            }

            fn quantize_f32(self) -> Self {
                self.$single().$double()
            }
        })+
    };
}
vectors!(DVec2: as_vec2 as_dvec2, DVec3: as_vec3 as_dvec3, DVec4: as_vec4 as_dvec4);

impl Field for RealBits {
    fn write(self, double: bool, bytes: &mut Vec<u8>) {
        self.0.write(double, bytes);
        if !double {
            0u32.write(double, bytes);
        }
    }

    fn quantize_f32(self) -> RealBits {
        RealBits(self.0.quantize_f32())
    }
}
