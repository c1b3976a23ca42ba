//! Records → the bytes of device memory. Vectors of reals take one unit of 16 bytes where the device computes
//! its geometry in f32, and two where it computes in f64; all other members are the same in both.

/// A member of a record, of which device memory has one unit of 16 bytes, or two where reals are f64.
pub trait Member: Copy {
    const REALS: u32;

    fn write(self, double: bool, bytes: &mut Vec<u8>);

    /// As memory of f32 holds it.
    fn quantize_f32(self) -> Self;
}

impl Member for [f64; 4] {
    const REALS: u32 = 1;

    fn write(self, double: bool, bytes: &mut Vec<u8>) {
        if double {
            bytes.extend_from_slice(bytemuck::bytes_of(&self));
        } else {
            bytes.extend_from_slice(bytemuck::bytes_of(&self.map(|x| x as f32)));
        }
    }

    fn quantize_f32(self) -> Self {
        self.map(|x| f64::from(x as f32))
    }
}

/// Members that are the same in both.
macro_rules! plain {
    ($($type:ty),+) => {
        $(impl Member for $type {
            const REALS: u32 = 0;

            fn write(self, _: bool, bytes: &mut Vec<u8>) {
                bytes.extend_from_slice(bytemuck::bytes_of(&self));
            }

            fn quantize_f32(self) -> Self {
                self
            }
        })+
    };
}
plain!([f32; 4], [u32; 4]);

/// A record of the scene buffer.
pub trait Record {
    /// Members that are vectors of reals, and those that are not.
    const REALS: u32;
    const OTHERS: u32;

    /// Appends what the shader reads.
    fn write(&self, double: bool, bytes: &mut Vec<u8>);

    /// The record with the f32 numbers that the shader reads unless it reads f64.
    fn quantize_f32(&self) -> Self;
}

/// The bytes of a list of records.
pub fn bytes_of<R: Record>(records: &[R], double: bool) -> Vec<u8> {
    let mut bytes = Vec::new();
    records.iter().for_each(|record| record.write(double, &mut bytes));
    bytes
}
