//! The values of a shape's keys, as a scene format provides them: `None` if the key is not set, or an error that names the
//! place of a wrong value.

use glam::{DVec2, DVec3};

use crate::core::error::{Error, Result};

/// The values of the keys of one shape.
pub trait Fields {
    /// Returns a finite number.
    fn number(&self, key: &'static str) -> Result<Option<f64>>;

    /// Returns three finite numbers.
    fn vector(&self, key: &'static str) -> Result<Option<DVec3>>;

    /// Returns three vectors; `what` names them.
    fn vectors(&self, key: &'static str, what: &str) -> Result<Option<[DVec3; 3]>>;

    /// Returns three texture coordinates.
    fn coordinates(&self, key: &'static str) -> Result<Option<[DVec2; 3]>>;

    /// Returns which of the names is given.
    fn choice(&self, key: &'static str, names: &[&str]) -> Result<Option<usize>>;

    /// Returns the error for a key that must be set and is not.
    fn missing(&self, key: &'static str) -> Error;
}

/// Returns the value of a key that must be set.
pub(super) fn required<T>(
    fields: &dyn Fields,
    key: &'static str,
    read: impl Fn(&'static str) -> Result<Option<T>>,
) -> Result<T> {
    read(key)?.ok_or_else(|| fields.missing(key))
}
