//! Decodes one stored number, an integer or float of any common length, to `f64`. Integers are
//! fractions of their range, like Vulkan's UNORM and SNORM formats: unsigned from 0 to 1, signed
//! from −1 to 1 (Vulkan 1.3, "Conversion From Normalized Fixed-Point to Floating-Point").

use super::data::Component;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NumberKind {
    Unsigned,
    Signed,
    Float,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Scalar {
    pub bits: u32,
    pub kind: NumberKind,
}

impl Scalar {
    /// Returns the scalar type of a texture component.
    pub fn of(component: Component) -> Scalar {
        match component {
            Component::Unorm8 => Scalar { bits: 8, kind: NumberKind::Unsigned },
            Component::Unorm16 => Scalar { bits: 16, kind: NumberKind::Unsigned },
            Component::Float32 => Scalar { bits: 32, kind: NumberKind::Float },
        }
    }

    /// Returns true if numbers of this type are supported.
    pub fn is_known(self) -> bool {
        match self.kind {
            NumberKind::Unsigned => (1..=32).contains(&self.bits) || self.bits == 64,
            NumberKind::Signed => (2..=32).contains(&self.bits) || self.bits == 64,
            NumberKind::Float => [16, 24, 32, 64].contains(&self.bits),
        }
    }

    /// Returns the component that stores such numbers without loss, or else 32-bit floats.
    pub fn component(self) -> Component {
        match (self.kind, self.bits) {
            (NumberKind::Unsigned, ..=8) => Component::Unorm8,
            (NumberKind::Unsigned, ..=16) => Component::Unorm16,
            _ => Component::Float32,
        }
    }

    /// Returns the number of the bit pattern in the low bits of `code`; an integer is not scaled.
    pub fn number(self, code: u64) -> f64 {
        match (self.kind, self.bits) {
            (NumberKind::Unsigned, _) => code as f64,
            (NumberKind::Signed, bits) => ((code << (64 - bits)) as i64 >> (64 - bits)) as f64,
            (NumberKind::Float, 16) => small_float(code, 5, 10),
            (NumberKind::Float, 24) => small_float(code, 7, 16),
            (NumberKind::Float, 32) => f64::from(f32::from_bits(code as u32)),
            (NumberKind::Float, _) => f64::from_bits(code),
        }
    }

    /// Scales an integer so that the largest one becomes 1; floats are unchanged.
    pub fn fraction(self, number: f64) -> f64 {
        match self.kind {
            NumberKind::Unsigned => number / self.greatest(),
            NumberKind::Signed => (number / self.greatest()).max(-1.0),
            NumberKind::Float => number,
        }
    }

    fn greatest(self) -> f64 {
        let bits = if self.kind == NumberKind::Signed { self.bits - 1 } else { self.bits };
        (2f64).powi(bits as i32) - 1.0
    }
}

/// Decodes a float with a sign, `exponent` and `mantissa` bits by the rules of IEEE 754.
fn small_float(code: u64, exponent: u32, mantissa: u32) -> f64 {
    let bias = (1 << (exponent - 1)) - 1;
    let sign = if code >> (exponent + mantissa) & 1 == 1 { -1.0 } else { 1.0 };
    let fraction = (code & ((1 << mantissa) - 1)) as f64 / f64::from(1u32 << mantissa);
    let power = (code >> mantissa & ((1 << exponent) - 1)) as i32;
    let size = match power {
        0 => fraction * 2f64.powi(1 - bias),
        p if p == (1 << exponent) - 1 => {
            if fraction == 0.0 {
                f64::INFINITY
            } else {
                f64::NAN
            }
        }
        p => (1.0 + fraction) * 2f64.powi(p - bias),
    };
    sign * size
}

impl Component {
    /// Stores a value, rounded to the nearest one that the component can represent.
    pub(super) fn store(self, value: f64, to: &mut [u8]) {
        match self {
            Component::Unorm8 => to[0] = (value * 255.0).round() as u8,
            Component::Unorm16 => to.copy_from_slice(&((value * 65_535.0).round() as u16).to_ne_bytes()),
            Component::Float32 => to.copy_from_slice(&(value as f32).to_ne_bytes()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_are_fractions_of_their_range() {
        for (kind, bits, code, want) in [
            (NumberKind::Unsigned, 1, 1, 1.0),
            (NumberKind::Unsigned, 10, 1023, 1.0),
            (NumberKind::Unsigned, 32, u64::from(u32::MAX), 1.0),
            (NumberKind::Signed, 8, 0x80, -1.0),
            (NumberKind::Signed, 8, 0x81, -1.0),
            (NumberKind::Signed, 16, 0xffff, -1.0 / 32_767.0),
            (NumberKind::Signed, 64, i64::MAX as u64, 1.0),
        ] {
            let scalar = Scalar { bits, kind };
            assert_eq!(scalar.fraction(scalar.number(code)), want, "{kind:?} {bits} {code:x}");
        }
    }

    #[test]
    fn small_floats_are_those_of_ieee_754() {
        let half = |code| Scalar { bits: 16, kind: NumberKind::Float }.number(code);
        for code in 0..=u16::MAX {
            let want = f64::from(exr::prelude::f16::from_bits(code));
            let found = half(code.into());
            assert!(found == want || (found.is_nan() && want.is_nan()), "{code:x}: {found} {want}");
        }
        let float24 = |code| Scalar { bits: 24, kind: NumberKind::Float }.number(code);
        assert_eq!(float24(0x3f_0000), 1.0);
        assert_eq!(float24(0xc0_8000), -3.0);
        assert_eq!(float24(1), 2f64.powi(-62 - 16));
    }

    #[test]
    fn every_code_of_8_and_16_bits_survives() {
        for (bits, component) in [(8, Component::Unorm8), (16, Component::Unorm16)] {
            let scalar = Scalar { bits, kind: NumberKind::Unsigned };
            assert_eq!(scalar.component(), component);
            for code in 0..1u64 << bits {
                let mut stored = [0; 2];
                component.store(scalar.fraction(code as f64), &mut stored[..component.bytes()]);
                let back = if bits == 8 { u64::from(stored[0]) } else { u16::from_ne_bytes(stored).into() };
                assert_eq!(back, code);
            }
        }
    }
}
