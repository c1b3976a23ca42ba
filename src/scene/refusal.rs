//! The reasons for refusing a scene. Input: a value, its limits, and its key. Output: nothing, or a
//! [`Refusal`] that a format turns into an error at a position in its file, and other callers into a
//! sentence.

use std::fmt;
use std::ops::RangeInclusive;

use glam::DVec3;

use super::limits::{COORDINATE, Limits};
use crate::core::error::{Error, ErrorKind};
use crate::core::number::{shown, shown_vector};

/// The result of a check.
pub(super) type Check<T = ()> = Result<T, Box<Refusal>>;

/// The path of a value within a scene: a key of an item of a section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Key {
    pub section: &'static str,
    /// Index among the section's items; 0 for a single one.
    pub item: usize,
    /// Path below the item, separated by dots; empty for the item itself.
    pub name: &'static str,
    /// Index in a list: of vertices, colours.
    pub element: Option<usize>,
    /// Index in a vector.
    pub component: Option<usize>,
    /// The default that applies if the key is not given.
    pub default: Option<&'static str>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Fault {
    /// Another value was expected than the one that was found.
    Expected { wanted: String, found: String },
    /// `label` states it in a few words.
    Rule { what: String, label: String },
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Refusal {
    pub key: Key,
    pub fault: Fault,
}

impl Key {
    /// Returns the key of a whole item.
    pub const fn item(section: &'static str, item: usize) -> Key {
        Key { section, item, name: "", element: None, component: None, default: None }
    }

    pub const fn of(self, name: &'static str) -> Key {
        Key { name, ..self }
    }

    pub const fn at(self, element: usize) -> Key {
        Key { element: Some(element), ..self }
    }

    pub const fn or_default(self, default: &'static str) -> Key {
        Key { default: Some(default), ..self }
    }

    pub fn refuse<T>(self, what: impl Into<String>, label: impl Into<String>) -> Check<T> {
        let fault = Fault::Rule { what: what.into(), label: label.into() };
        Err(Box::new(Refusal { key: self, fault }))
    }

    fn expect<T>(self, wanted: String, found: impl fmt::Display) -> Check<T> {
        Err(Box::new(Refusal { key: self, fault: Fault::Expected { wanted, found: found.to_string() } }))
    }

    pub fn number(self, x: f64, limits: &Limits) -> Check {
        match x.is_finite() {
            true if (limits.allow)(x) => Ok(()),
            true => self.expect(format!("a number {}", limits.words), shown(x)),
            false => self.expect("a finite number".into(), x),
        }
    }

    /// As `number`, for a value that was rounded to single precision.
    pub fn number_f32(self, x: f32, limits: &Limits) -> Check {
        if x.is_finite() && limits.allow_f32(x) { Ok(()) } else { self.number(f64::from(x), limits) }
    }

    pub fn numbers<const N: usize>(self, numbers: [f64; N], limits: &Limits) -> Check {
        self.all_of(&numbers, limits.allow, limits)
    }

    /// As `numbers`, for values that were rounded to single precision.
    pub fn numbers_f32(self, numbers: &[f32], limits: &Limits) -> Check {
        let numbers: Vec<f64> = numbers.iter().map(|&x| f64::from(x)).collect();
        self.all_of(&numbers, |x| limits.allow_f32(x as f32), limits)
    }

    fn all_of(self, numbers: &[f64], allow: impl Fn(f64) -> bool, limits: &Limits) -> Check {
        let count = numbers.len();
        for (component, &x) in numbers.iter().enumerate() {
            let key = Key { component: Some(component), ..self };
            if !x.is_finite() {
                return key.expect(format!("{count} finite numbers"), x);
            }
            if !allow(x) {
                return key.expect(format!("{count} numbers {}", limits.words), shown(x));
            }
        }
        Ok(())
    }

    pub fn vector(self, vector: DVec3, limits: &Limits) -> Check {
        self.numbers(vector.to_array(), limits)
    }

    /// Accepts a vector of any length but zero.
    pub fn direction(self, vector: DVec3) -> Check {
        self.vector(vector, &COORDINATE)?;
        if vector.abs().max_element() < 1e-30 {
            return self
                .expect("a vector that is not zero (shorter than 1e-30)".into(), shown_vector(vector));
        }
        Ok(())
    }

    pub fn integer(self, integer: u32, range: &RangeInclusive<u32>) -> Check {
        if range.contains(&integer) {
            return Ok(());
        }
        self.expect(format!("an integer from {} to {}", range.start(), range.end()), integer)
    }

    /// Accepts 1 to `most` elements.
    pub fn count(self, count: usize, of: &str, most: u32) -> Check {
        if (1..=most as usize).contains(&count) {
            return Ok(());
        }
        self.expect(format!("an array of 1 to {most} {of}"), format_args!("{count}"))
    }

    /// Accepts an index of something that the scene has `count` of.
    pub fn index(self, index: usize, count: usize, what: &str) -> Check {
        if index < count {
            return Ok(());
        }
        self.refuse(format!("the scene has no {what} {index}; it has {count}"), format!("no such {what}"))
    }

    /// Accepts the result of a rule that also applies to an option of the command line.
    pub fn rule(self, checked: Result<(), String>, label: &str) -> Check {
        checked.or_else(|what| self.refuse(what, label))
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.section, self.item)?;
        if !self.name.is_empty() {
            write!(f, ": {}", self.name)?;
        }
        [self.element, self.component].iter().flatten().try_for_each(|index| write!(f, "[{index}]"))
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.fault {
            Fault::Expected { wanted, found } => {
                write!(f, "{}: expected {wanted}, found {found}", self.key)
            }
            Fault::Rule { what, .. } => write!(f, "{}: {what}", self.key),
        }
    }
}

impl Refusal {
    /// Returns the error for the author of a scene in code.
    pub fn error(&self) -> Error {
        Error::new(self.to_string()).of_kind(ErrorKind::Scene)
    }
}
