//! Accessors, typed lists of numbers within buffers. Input: the file's list of accessors and the bytes of its views.
//! Output: single elements as numbers, normalized where the file asks for it. All bounds are checked when an accessor
//! is opened; nothing is copied but the indices of sparse elements.

use std::collections::HashMap;
use std::rc::Rc;

use super::buffers::Buffers;
use super::document::{Document, List};
use super::json::Json;
use crate::mesh::Fault;

/// The most elements of an accessor that has no bytes of its own: a short file could claim any number.
const MOST_ZEROS: usize = 1 << 20;

/// Type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    /// Returns the type that a number of the file stands for.
    fn from_code(code: usize) -> Option<Component> {
        Some(match code {
            5120 => Component::I8,
            5121 => Component::U8,
            5122 => Component::I16,
            5123 => Component::U16,
            5125 => Component::U32,
            5126 => Component::F32,
            _ => return None,
        })
    }

    /// Returns the number of bytes.
    fn size(self) -> usize {
        match self {
            Component::I8 | Component::U8 => 1,
            Component::I16 | Component::U16 => 2,
            Component::U32 | Component::F32 => 4,
        }
    }

    /// Returns the number that bytes stand for, or nothing if they are too few.
    fn value(self, bytes: &[u8]) -> Option<f64> {
        Some(match self {
            Component::I8 => f64::from(i8::from_le_bytes(*bytes.first_chunk()?)),
            Component::U8 => f64::from(u8::from_le_bytes(*bytes.first_chunk()?)),
            Component::I16 => f64::from(i16::from_le_bytes(*bytes.first_chunk()?)),
            Component::U16 => f64::from(u16::from_le_bytes(*bytes.first_chunk()?)),
            Component::U32 => f64::from(u32::from_le_bytes(*bytes.first_chunk()?)),
            Component::F32 => f64::from(f32::from_le_bytes(*bytes.first_chunk()?)),
        })
    }

    /// Returns the greatest value, which stands for 1 if numbers are normalized.
    fn one(self) -> f64 {
        match self {
            Component::I8 => f64::from(i8::MAX),
            Component::U8 => f64::from(u8::MAX),
            Component::I16 => f64::from(i16::MAX),
            Component::U16 => f64::from(u16::MAX),
            Component::U32 => f64::from(u32::MAX),
            Component::F32 => 1.0,
        }
    }
}

/// Returns the name of a type of so many numbers.
pub(super) fn type_name(width: usize) -> &'static str {
    match width {
        1 => "SCALAR",
        2 => "VEC2",
        3 => "VEC3",
        _ => "VEC4",
    }
}

/// An open accessor.
pub(super) struct Accessor<'a> {
    /// JSON pointer to it.
    place: String,
    /// Number of elements.
    pub(super) count: usize,
    /// Numbers in an element.
    pub(super) width: usize,
    /// Type of these numbers.
    pub(super) component: Component,
    /// Whether integers stand for fractions.
    pub(super) normalized: bool,
    /// None if all elements are zero.
    data: Option<Data<'a>>,
    sparse: Option<Sparse<'a>>,
}

/// Bytes of elements.
struct Data<'a> {
    bytes: &'a [u8],
    stride: usize,
}

/// Elements that replace others.
struct Sparse<'a> {
    /// Which are replaced, in ascending order.
    indices: Vec<usize>,
    values: Data<'a>,
}

impl Accessor<'_> {
    /// Returns an element of `N` numbers, which have to be finite.
    pub(super) fn numbers<const N: usize>(&self, index: usize) -> Result<[f64; N], Fault> {
        let mut numbers = [0.0; N];
        let size = self.component.size();
        for (number, bytes) in numbers.iter_mut().zip(self.bytes(index).chunks_exact(size)) {
            *number = self.component.value(bytes).unwrap_or_default();
            if !number.is_finite() {
                return Err(self.fault("", format!("element {index} is not finite")));
            }
            if self.normalized {
                *number = (*number / self.component.one()).max(-1.0);
            }
        }
        Ok(numbers)
    }

    /// Returns whether every element is zero.
    pub(super) fn is_zero(&self) -> bool {
        self.data.is_none() && self.sparse.is_none()
    }

    /// Returns the name of its type.
    pub(super) fn kind(&self) -> &'static str {
        type_name(self.width)
    }

    /// Returns the JSON pointer to it.
    pub(super) fn place(&self) -> &str {
        &self.place
    }

    /// Returns a fault at the accessor or one of its members.
    pub(super) fn fault(&self, member: &str, what: impl Into<String>) -> Fault {
        Fault::new(format!("{}{member}", self.place), what)
    }

    /// Returns the bytes of an element, none if it is zero.
    fn bytes(&self, index: usize) -> &[u8] {
        let replaced = self.sparse.as_ref().and_then(|sparse| {
            let at = sparse.indices.binary_search(&index).ok()?;
            Some((&sparse.values, at))
        });
        let found = replaced.or(self.data.as_ref().map(|data| (data, index)));
        let size = self.component.size() * self.width;
        found.and_then(|(data, at)| data.bytes.get(at * data.stride..)?.get(..size)).unwrap_or_default()
    }
}

/// The accessors of a file.
pub(super) struct Accessors<'a> {
    list: List<'a>,
    buffers: &'a Buffers<'a>,
    /// Those that were opened before.
    open: HashMap<usize, Rc<Accessor<'a>>>,
    /// How many more sparse elements are read. A file has at least one byte for each, unless many accessors share
    /// the bytes to keep the reader busy.
    sparse_left: usize,
}

impl<'a> Accessors<'a> {
    /// Finds the accessors of a file.
    pub(super) fn new(document: &Document<'a>, buffers: &'a Buffers<'a>) -> Result<Accessors<'a>, Fault> {
        let list = document.list("accessors")?;
        Ok(Accessors { list, buffers, open: HashMap::new(), sparse_left: buffers.byte_count() })
    }

    /// Returns the number of accessors.
    pub(super) fn len(&self) -> usize {
        self.list.len()
    }

    /// Returns an accessor, all of whose elements are within their buffers.
    pub(super) fn open(&mut self, index: usize) -> Result<Rc<Accessor<'a>>, Fault> {
        if let Some(accessor) = self.open.get(&index) {
            return Ok(Rc::clone(accessor));
        }
        let element = self.list.element(index)?;
        let accessor = Rc::new(self.accessor(element.json())?);
        self.open.insert(index, Rc::clone(&accessor));
        Ok(accessor)
    }

    /// Reads an accessor.
    fn accessor(&mut self, json: Json) -> Result<Accessor<'a>, Fault> {
        let component = component(json)?;
        let width = match json.needed("type", json.text("type")?)? {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => return Err(json.other_than("type", "SCALAR, VEC2, VEC3 and VEC4 are allowed here")),
        };
        let size = component.size() * width;
        let count = json.needed("count", json.whole("count")?)?;
        let data = match json.get("bufferView") {
            Some(_) => Some(self.data(json, count, size)?),
            None if count > MOST_ZEROS => {
                let what = format!("it is {count}; without a buffer view at most {MOST_ZEROS} are allowed");
                return Err(json.fault_at("count", what));
            }
            None => None,
        };
        let sparse = json.object("sparse")?.map(|sparse| self.sparse(sparse, count, size)).transpose()?;
        // Floats are what they are, even if a program marks them.
        let normalized = json.flag("normalized")? && component != Component::F32;
        Ok(Accessor { place: json.pointer(), count, width, component, normalized, data, sparse })
    }

    /// Returns the bytes of `count` elements of `size` bytes in the view that an object names.
    fn data(&self, json: Json, count: usize, size: usize) -> Result<Data<'a>, Fault> {
        let (view, stride) = self.buffers.view_bytes(json, "bufferView")?;
        let stride = stride.unwrap_or(size);
        if stride < size {
            let what = format!("its elements have {size} bytes, but follow each other after {stride}");
            return Err(json.fault_at("bufferView", what));
        }
        let offset = json.whole("byteOffset")?.unwrap_or(0);
        let end = match count.checked_sub(1) {
            Some(last) => {
                last.checked_mul(stride).and_then(|bytes| bytes.checked_add(size)?.checked_add(offset))
            }
            None => Some(offset),
        };
        match end.filter(|end| *end <= view.len()).and_then(|_| view.get(offset..)) {
            Some(bytes) => Ok(Data { bytes, stride }),
            None => {
                let what = format!(
                    "{count} elements of {size} bytes, {stride} apart, from byte {offset}; the view has {} bytes",
                    view.len()
                );
                Err(json.fault_at("count", what))
            }
        }
    }

    /// Reads the elements that replace others of the `all`, each of `size` bytes.
    fn sparse(&mut self, json: Json, all: usize, size: usize) -> Result<Sparse<'a>, Fault> {
        let count = json.needed("count", json.whole("count")?)?;
        if count > all {
            return Err(json.fault_at("count", format!("it is {count}; the accessor has {all} elements")));
        }
        let places = json.needed("indices", json.object("indices")?)?;
        let component = component(places)?;
        if !matches!(component, Component::U8 | Component::U16 | Component::U32) {
            return Err(places.other_than("componentType", "5121, 5123 and 5125 are allowed here"));
        }
        let data = self.data(places, count, component.size())?;
        let values = self.data(json.needed("values", json.object("values")?)?, count, size)?;
        self.sparse_left = self.sparse_left.checked_sub(count).ok_or_else(|| {
            json.fault_at("count", "sparse accessors replace more elements than the file has bytes")
        })?;
        let mut indices = Vec::with_capacity(count);
        for i in 0..count {
            let index = data.bytes.get(i * data.stride..).and_then(|bytes| component.value(bytes));
            let index = index.unwrap_or_default() as usize;
            if index >= all {
                return Err(places.fault(format!("index {i} is {index}; the accessor has {all} elements")));
            }
            if indices.last().is_some_and(|last| *last >= index) {
                return Err(places.fault(format!("index {i} is {index}, not greater than the one before")));
            }
            indices.push(index);
        }
        Ok(Sparse { indices, values })
    }
}

/// Reads the type of the numbers of an accessor.
fn component(json: Json) -> Result<Component, Fault> {
    let code = json.needed("componentType", json.whole("componentType")?)?;
    Component::from_code(code).ok_or_else(|| {
        let what = format!("it is {code}; 5120, 5121, 5122, 5123, 5125 and 5126 are allowed");
        json.fault_at("componentType", what)
    })
}
