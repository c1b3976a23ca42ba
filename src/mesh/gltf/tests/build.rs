//! Builds glTF files. Input: values and the JSON pointers where they go, and bytes for accessors. Output: the file as
//! .glb or .gltf, or what the reader makes of it.

use base64::Engine;
use serde_json::{Value, json};

use super::super::{Model, Resolve, read};
use crate::mesh::Fault;

/// The most triangles of these files.
pub const MOST: usize = 100;

/// A file under construction.
#[derive(Clone)]
pub struct Build {
    pub json: Value,
    /// Buffer 0.
    pub bytes: Vec<u8>,
}

impl Build {
    /// Starts with one node of one mesh of one primitive, which has no attributes yet.
    pub fn new() -> Build {
        let json = json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "mesh": 0 }],
            "meshes": [{ "primitives": [{ "attributes": {} }] }],
            "accessors": [], "bufferViews": [],
            "buffers": [{ "byteLength": 0 }],
        });
        Build { json, bytes: Vec::new() }
    }

    /// Starts with one triangle in the plane z = 0 without indices. Its positions are accessor 0 and view 0.
    pub fn triangle() -> Build {
        let mut build = Build::new();
        build.attribute("POSITION", 5126, "VEC3", &f32s(&[0., 0., 0., 1., 0., 0., 0., 1., 0.]));
        build
    }

    /// Sets a value; objects on the way are made, and a list grows by one at its end.
    pub fn set(&mut self, pointer: &str, value: Value) -> &mut Build {
        let mut place = &mut self.json;
        for key in pointer.split('/').skip(1) {
            place = match place {
                Value::Array(list) => {
                    let index: usize = key.parse().unwrap();
                    if index == list.len() {
                        list.push(Value::Null);
                    }
                    &mut list[index]
                }
                other => {
                    if other.is_null() {
                        *other = if key == "0" { json!([]) } else { json!({}) };
                    }
                    match other {
                        Value::Array(list) => {
                            list.push(Value::Null);
                            &mut list[0]
                        }
                        other => &mut other[key],
                    }
                }
            };
        }
        *place = value;
        self
    }

    /// Adds a view of new bytes and returns its index.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let start = self.bytes.len();
        self.bytes.extend_from_slice(bytes);
        self.json["buffers"][0]["byteLength"] = json!(self.bytes.len());
        let views = self.json["bufferViews"].as_array_mut().unwrap();
        views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": bytes.len() }));
        views.len() - 1
    }

    /// Adds an accessor over new bytes, which follow one another, and returns its index.
    pub fn accessor(&mut self, component: usize, kind: &str, bytes: &[u8]) -> usize {
        let size = size(component) * width(kind);
        let view = self.view(bytes);
        let accessors = self.json["accessors"].as_array_mut().unwrap();
        accessors.push(json!({
            "bufferView": view, "componentType": component, "type": kind, "count": bytes.len() / size,
        }));
        accessors.len() - 1
    }

    /// Adds an attribute of the primitive and returns the index of its accessor.
    pub fn attribute(&mut self, name: &str, component: usize, kind: &str, bytes: &[u8]) -> usize {
        let accessor = self.accessor(component, kind, bytes);
        self.set(&format!("/meshes/0/primitives/0/attributes/{name}"), json!(accessor));
        accessor
    }

    /// Returns the file as .glb.
    pub fn glb(&self) -> Vec<u8> {
        let mut text = self.json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut file = b"glTF\x02\0\0\0".to_vec();
        let chunks = [(b"JSON", &text), (b"BIN\0", &self.bytes)];
        let length = 12 + chunks.iter().map(|(_, data)| 8 + data.len()).sum::<usize>();
        file.extend(u32::try_from(length).unwrap().to_le_bytes());
        for (kind, data) in chunks {
            file.extend(u32::try_from(data.len()).unwrap().to_le_bytes());
            file.extend_from_slice(kind);
            file.extend_from_slice(data);
        }
        file
    }

    /// Returns the file as .gltf, its buffer within.
    pub fn text(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        let data = base64::engine::general_purpose::STANDARD.encode(&self.bytes);
        json["buffers"][0]["uri"] = json!(format!("data:application/octet-stream;base64,{data}"));
        serde_json::to_vec_pretty(&json).unwrap()
    }

    /// Reads the file, which has to need no other.
    pub fn read(&self) -> Result<Model, Fault> {
        read(&self.glb(), MOST, no_files())
    }

    /// Returns the fault of the file as text.
    pub fn fault(&self) -> String {
        self.read().unwrap_err().to_string()
    }
}

/// Fails if a file is asked for.
pub fn no_files() -> Resolve<'static> {
    Box::leak(Box::new(|path: &str| Err(format!("{path} was not expected"))))
}

/// Returns the fault of a triangle in which one value is changed.
pub fn fault_with(pointer: &str, value: Value) -> String {
    Build::triangle().set(pointer, value).fault()
}

pub fn f32s(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

pub fn u16s(values: &[u16]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

pub fn i16s(values: &[i16]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

pub fn u32s(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

pub fn i8s(values: &[i8]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn size(component: usize) -> usize {
    match component {
        5120 | 5121 => 1,
        5122 | 5123 => 2,
        _ => 4,
    }
}

fn width(kind: &str) -> usize {
    match kind {
        "SCALAR" => 1,
        other => other[3..].parse().unwrap(),
    }
}
