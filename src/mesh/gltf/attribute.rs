//! Attributes of vertices. Input: an open accessor, what it is used as, and which of its elements are wanted. Output:
//! these elements as vectors; an accessor of a type that the use does not allow is refused.

use std::rc::Rc;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::accessor::{Accessor, Accessors, Component};
use crate::mesh::Fault;

/// Elements that a thread reads at once.
const AT_ONCE: usize = 1 << 12;

/// Sets of texture coordinates that are read.
pub(super) const MOST_SETS: usize = 8;

/// What an accessor is used as.
#[derive(Clone, Copy)]
pub(super) struct Use {
    /// As messages name it.
    name: &'static str,
    /// Allowed types.
    widths: &'static [usize],
    /// Allowed types of numbers, besides floats.
    integers: Integers,
}

/// Types of numbers besides floats.
#[derive(Clone, Copy)]
enum Integers {
    None,
    /// All of 8 and 16 bits, normalized or not.
    Short,
    /// Signed, of 8 and 16 bits, normalized.
    Signed,
    /// Unsigned, of 8 and 16 bits, normalized.
    Unsigned,
}

impl Use {
    pub(super) const POSITION: Use = Use { name: "POSITION", widths: &[3], integers: Integers::Short };
    pub(super) const NORMAL: Use = Use { name: "NORMAL", widths: &[3], integers: Integers::Signed };
    pub(super) const TANGENT: Use = Use { name: "TANGENT", widths: &[4], integers: Integers::Signed };
    pub(super) const UV: Use = Use { name: "TEXCOORD", widths: &[2], integers: Integers::Short };
    pub(super) const COLOR: Use = Use { name: "COLOR", widths: &[3, 4], integers: Integers::Unsigned };
    pub(super) const TRANSLATION: Use = Use { name: "TRANSLATION", widths: &[3], integers: Integers::None };
    pub(super) const ROTATION: Use = Use { name: "ROTATION", widths: &[4], integers: Integers::Signed };
    pub(super) const SCALE: Use = Use { name: "SCALE", widths: &[3], integers: Integers::None };

    /// Opens an accessor for this use, which has to have `count` elements.
    pub(super) fn open<'a>(
        self,
        accessors: &mut Accessors<'a>,
        index: usize,
        count: usize,
    ) -> Result<Rc<Accessor<'a>>, Fault> {
        let accessor = accessors.open(index)?;
        if !self.widths.contains(&accessor.width) {
            let allowed: Vec<String> = self.widths.iter().map(|width| format!("VEC{width}")).collect();
            let (found, allowed) = (accessor.kind(), allowed.join(" or "));
            return Err(accessor.fault("/type", format!("it is {found}; {} has to be {allowed}", self.name)));
        }
        if !self.integers.allow(&accessor) {
            let what = format!("{} has to be of {}", self.name, self.integers.allowed());
            return Err(accessor.fault("/componentType", what));
        }
        if accessor.count != count {
            let what = format!("it is {}; {} has to have {count} elements here", accessor.count, self.name);
            return Err(accessor.fault("/count", what));
        }
        Ok(accessor)
    }
}

impl Integers {
    /// Returns whether the numbers of an accessor are of these types or floats.
    fn allow(self, accessor: &Accessor) -> bool {
        match accessor.component {
            Component::F32 => true,
            Component::U32 => false,
            Component::I8 | Component::I16 => {
                matches!(self, Integers::Short) || matches!(self, Integers::Signed) && accessor.normalized
            }
            Component::U8 | Component::U16 => {
                matches!(self, Integers::Short) || matches!(self, Integers::Unsigned) && accessor.normalized
            }
        }
    }

    /// Returns what is allowed, for a message.
    fn allowed(self) -> &'static str {
        match self {
            Integers::None => "floats (5126)",
            Integers::Short => "floats (5126) or integers of 8 or 16 bits (5120 to 5123)",
            Integers::Signed => "floats (5126) or normalized signed integers of 8 or 16 bits (5120, 5122)",
            Integers::Unsigned => {
                "floats (5126) or normalized unsigned integers of 8 or 16 bits (5121, 5123)"
            }
        }
    }
}

/// Which elements of the accessors of a primitive are its vertices.
pub(super) enum Vertices {
    /// The first ones.
    First(usize),
    /// These, in ascending order.
    Some(Vec<u32>),
}

impl Vertices {
    /// Reads the elements of an accessor that are vertices.
    pub(super) fn read<const N: usize, T: Send>(
        &self,
        accessor: &Accessor,
        convert: impl Fn([f64; N]) -> T + Sync + Send,
    ) -> Result<Vec<T>, Fault> {
        let count = match self {
            Vertices::First(count) => *count,
            Vertices::Some(used) => used.len(),
        };
        each(count, |i| Ok(convert(accessor.numbers(self.element(i))?)), || convert([0.0; N]))
    }

    /// Returns which element a vertex is.
    fn element(&self, vertex: usize) -> usize {
        match self {
            Vertices::First(_) => vertex,
            Vertices::Some(used) => used.get(vertex).map_or(0, |index| *index as usize),
        }
    }
}

/// Returns what is read for each of `count` elements, by several threads, or the fault of the first one that has any;
/// `none` stands for those meanwhile.
pub(super) fn each<T: Send>(
    count: usize,
    read: impl Fn(usize) -> Result<T, Fault> + Sync + Send,
    none: impl Fn() -> T + Sync + Send,
) -> Result<Vec<T>, Fault> {
    let first_fault = AtomicUsize::new(usize::MAX);
    let at = |element: usize| {
        read(element).unwrap_or_else(|_| {
            first_fault.fetch_min(element, Ordering::Relaxed);
            none()
        })
    };
    // Collected results would not tell how much memory is needed.
    let values = (0..count).into_par_iter().with_min_len(AT_ONCE).map(at).collect();
    match first_fault.into_inner() {
        usize::MAX => Ok(values),
        element => read(element).map(|_| values),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn of_many_elements_the_first_fault_is_named() {
        let count = 5 * AT_ONCE;
        let read = |wrong: &[usize]| {
            let read = |i: usize| {
                if wrong.contains(&i) { Err(Fault::new(format!("element {i}"), "")) } else { Ok(i) }
            };
            each(count, read, || 0)
        };
        assert_eq!(read(&[]).unwrap(), (0..count).collect::<Vec<_>>());
        for wrong in [[3, 7], [count - 1, 2 * AT_ONCE], [AT_ONCE, AT_ONCE + 1], [count - 1, count - 2]] {
            let first = wrong.into_iter().min().unwrap();
            assert_eq!(read(&wrong).unwrap_err().place, format!("element {first}"));
        }
    }
}
