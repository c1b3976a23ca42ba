//! Values that know where they stand. Input: a parsed element of a glTF file. Output: typed values in it; one of the
//! wrong type becomes a fault whose place is a JSON pointer.

use serde_json::Value;

use crate::mesh::Fault;

/// The most characters of a name.
const LONGEST_NAME: usize = 256;

/// A value within an element.
#[derive(Clone, Copy)]
pub(super) struct Json<'a> {
    /// JSON pointer to the element.
    place: &'a str,
    element: &'a Value,
    value: &'a Value,
}

impl<'a> Json<'a> {
    /// Returns the outermost value of an element.
    pub(super) fn new(place: &'a str, element: &'a Value) -> Json<'a> {
        Json { place, element, value: element }
    }

    /// Returns a fault at this value.
    pub(super) fn fault(self, what: impl Into<String>) -> Fault {
        Fault::new(self.pointer(), what)
    }

    /// Returns a fault at a member of this object, whether it is there or not.
    pub(super) fn fault_at(self, key: &str, what: impl Into<String>) -> Fault {
        Fault::new(format!("{}/{}", self.pointer(), escaped(key)), what)
    }

    /// Returns the fault of a member that is none of what is allowed.
    pub(super) fn other_than(self, key: &str, allowed: &str) -> Fault {
        let found = self.get(key).map_or_else(|| "missing".to_owned(), |json| shown(json.value));
        self.fault_at(key, format!("it is {found}; {allowed}"))
    }

    /// Returns the JSON pointer to this value.
    pub(super) fn pointer(self) -> String {
        let mut pointer = self.place.to_owned();
        // Looked for only when something is wrong, so that values need not carry their places.
        path(self.element, self.value, &mut pointer);
        pointer
    }

    /// Returns a member of this object; some programs write null for one that is not there.
    pub(super) fn get(self, key: &str) -> Option<Json<'a>> {
        let value = self.value.get(key).filter(|value| !value.is_null())?;
        Some(Json { value, ..self })
    }

    /// Returns the members of this object.
    pub(super) fn members(self) -> impl Iterator<Item = (&'a str, Json<'a>)> {
        let members = self.value.as_object().into_iter().flatten();
        members.map(move |(key, value)| (key.as_str(), Json { value, ..self }))
    }

    /// Returns a member that has to be an object.
    pub(super) fn object(self, key: &str) -> Result<Option<Json<'a>>, Fault> {
        self.typed(key, "an object", |json| json.value.is_object().then_some(json))
    }

    /// Returns the data of an extension of this object.
    pub(super) fn extension(self, name: &str) -> Result<Option<Json<'a>>, Fault> {
        self.object("extensions")?.map_or(Ok(None), |all| all.object(name))
    }

    /// Returns the elements of a member that has to be a list, none if it is not there.
    pub(super) fn list(self, key: &str) -> Result<Vec<Json<'a>>, Fault> {
        let list = self.typed(key, "a list", |json| json.value.as_array())?;
        Ok(list.into_iter().flatten().map(|value| Json { value, ..self }).collect())
    }

    /// Returns a member that has to be a text.
    pub(super) fn text(self, key: &str) -> Result<Option<&'a str>, Fault> {
        self.typed(key, "a text", Json::as_text)
    }

    /// Returns this value if it is a text.
    pub(super) fn as_text(self) -> Option<&'a str> {
        self.value.as_str()
    }

    /// Returns the name of this object, empty if it has none. It is shortened if it is very long, since all that is
    /// made of the object gets a copy.
    pub(super) fn name(self) -> Result<String, Fault> {
        Ok(self.text("name")?.unwrap_or_default().chars().take(LONGEST_NAME).collect())
    }

    /// Returns a member that has to be true or false, which it is if it is not there.
    pub(super) fn flag(self, key: &str) -> Result<bool, Fault> {
        Ok(self.typed(key, "true or false", |json| json.value.as_bool())?.unwrap_or(false))
    }

    /// Returns a member that has to be a number.
    pub(super) fn number(self, key: &str) -> Result<Option<f64>, Fault> {
        self.typed(key, "a number", |json| json.value.as_f64())
    }

    /// Returns a member that has to be a number that fulfils a condition, which the text states.
    pub(super) fn number_if(
        self,
        key: &str,
        allowed: &str,
        condition: impl Fn(f64) -> bool,
    ) -> Result<Option<f64>, Fault> {
        let found = self.number(key)?;
        match found.filter(|number| !condition(*number)) {
            Some(number) => Err(self.fault_at(key, format!("it is {number}; it has to be {allowed}"))),
            None => Ok(found),
        }
    }

    /// Returns a member that has to be a list of `N` numbers.
    pub(super) fn numbers<const N: usize>(self, key: &str) -> Result<Option<[f64; N]>, Fault> {
        self.typed(key, &format!("a list of {N} numbers"), |json| {
            let found: Option<Vec<f64>> = json.value.as_array()?.iter().map(Value::as_f64).collect();
            found?.try_into().ok()
        })
    }

    /// Returns a member that has to be a whole number from 0.
    pub(super) fn whole(self, key: &str) -> Result<Option<usize>, Fault> {
        self.typed(key, "a whole number from 0", Json::as_whole)
    }

    /// Returns a member that has to be the index of one of `count` things.
    pub(super) fn index(self, key: &str, count: usize, things: &str) -> Result<Option<usize>, Fault> {
        self.get(key).map(|json| json.as_index(count, things)).transpose()
    }

    /// Returns this value, which has to be the index of one of `count` things.
    pub(super) fn as_index(self, count: usize, things: &str) -> Result<usize, Fault> {
        let index = self.as_whole().ok_or_else(|| self.mistyped("a whole number from 0"))?;
        if index < count {
            return Ok(index);
        }
        Err(self.fault(format!("{index} does not exist; the file has {count} {things}")))
    }

    /// Returns what was found of a member, or a fault if it is not there.
    pub(super) fn needed<T>(self, key: &str, found: Option<T>) -> Result<T, Fault> {
        found.ok_or_else(|| self.fault_at(key, "it is missing"))
    }

    /// Returns this value if it is a whole number, which may be written as 3.0.
    fn as_whole(self) -> Option<usize> {
        let exact = self.value.as_u64().and_then(|number| usize::try_from(number).ok());
        let float = || {
            let number = self.value.as_f64().filter(|n| n.fract() == 0.0 && (0.0..=9e15).contains(n))?;
            usize::try_from(number as u64).ok()
        };
        exact.or_else(float)
    }

    /// Returns a member as a type, or a fault that says which type is needed.
    fn typed<T>(
        self,
        key: &str,
        needed: &str,
        convert: impl Fn(Json<'a>) -> Option<T>,
    ) -> Result<Option<T>, Fault> {
        let found = self.get(key);
        found.map(|json| convert(json).ok_or_else(|| json.mistyped(needed))).transpose()
    }

    fn mistyped(self, needed: &str) -> Fault {
        self.fault(format!("it is {}; {needed} is needed", shown(self.value)))
    }
}

/// Appends the pointer from a value to one within it, and returns whether it is there.
fn path(within: &Value, target: &Value, pointer: &mut String) -> bool {
    if std::ptr::eq(within, target) {
        return true;
    }
    let length = pointer.len();
    let mut step = |key: &str, value: &Value| {
        pointer.push('/');
        pointer.push_str(&escaped(key));
        let found = path(value, target, pointer);
        if !found {
            pointer.truncate(length);
        }
        found
    };
    match within {
        Value::Array(list) => list.iter().enumerate().any(|(i, value)| step(&i.to_string(), value)),
        Value::Object(members) => members.iter().any(|(key, value)| step(key, value)),
        _ => false,
    }
}

/// Returns a key as JSON pointers write it.
fn escaped(key: &str) -> String {
    key.replace('~', "~0").replace('/', "~1")
}

/// Shows a value in a message, shortened if it is long.
pub(super) fn shown(value: &Value) -> String {
    value.to_string().chars().take(40).collect()
}
