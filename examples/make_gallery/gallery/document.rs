//! Builds glTF files. Input: elements of its lists as JSON, and bytes for its one buffer. Output: the file as .gltf, with
//! everything within and an element a line, or as .glb.

use std::collections::{BTreeMap, BTreeSet};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde_json::{Value, json};

/// Numbers of component types.
pub const I8: u32 = 5120;
pub const U8: u32 = 5121;
pub const I16: u32 = 5122;
pub const U16: u32 = 5123;
pub const F32: u32 = 5126;

/// A file under construction: one scene of all nodes that [`Document::stand`] adds.
#[derive(Default)]
pub struct Document {
    lists: BTreeMap<&'static str, Vec<Value>>,
    lights: Vec<Value>,
    roots: Vec<usize>,
    used: BTreeSet<&'static str>,
    required: BTreeSet<&'static str>,
    bytes: Vec<u8>,
}

impl Document {
    /// Adds an element to a list of the file; returns its index.
    pub fn push(&mut self, list: &'static str, element: Value) -> usize {
        let list = self.lists.entry(list).or_default();
        list.push(element);
        list.len() - 1
    }

    /// States that the file has this extension.
    pub fn uses(&mut self, extension: &'static str) {
        self.used.insert(extension);
    }

    /// States that the file cannot be read without this extension.
    pub fn requires(&mut self, extension: &'static str) {
        self.uses(extension);
        self.required.insert(extension);
    }

    /// Adds bytes as a view, from a multiple of four on, whose elements are `stride` apart.
    pub fn view(&mut self, bytes: &[u8], stride: Option<usize>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(stride) = stride {
            view["byteStride"] = json!(stride);
        }
        self.bytes.extend_from_slice(bytes);
        self.push("bufferViews", view)
    }

    /// Adds an accessor over numbers in f32 that follow one another.
    pub fn floats(&mut self, kind: &str, numbers: &[f64]) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|&number| (number as f32).to_le_bytes()).collect();
        let view = self.view(&bytes, None);
        let count = numbers.len() / components(kind);
        self.push(
            "accessors",
            json!({ "bufferView": view, "componentType": F32, "count": count, "type": kind }),
        )
    }

    /// Adds an accessor of positions, with the bounds that the specification asks for.
    pub fn positions(&mut self, points: &[[f64; 3]]) -> usize {
        let index = self.floats("VEC3", points.as_flattened());
        let [min, max] = bounds(points);
        if let Some(accessor) = self.lists.entry("accessors").or_default().get_mut(index) {
            (accessor["min"], accessor["max"]) = (json!(min), json!(max));
        }
        index
    }

    /// Adds an accessor of indices in 16 bits.
    pub fn indices(&mut self, indices: &[u16]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let view = self.view(&bytes, None);
        let count = indices.len();
        self.push(
            "accessors",
            json!({ "bufferView": view, "componentType": U16, "count": count, "type": "SCALAR" }),
        )
    }

    /// Adds a mesh of one primitive.
    pub fn mesh(&mut self, attributes: &Value, indices: Option<usize>, material: usize) -> usize {
        let mut primitive = json!({ "attributes": attributes, "material": material });
        if let Some(indices) = indices {
            primitive["indices"] = json!(indices);
        }
        self.push("meshes", json!({ "primitives": [primitive] }))
    }

    /// Adds a node to the scene.
    pub fn stand(&mut self, node: Value) -> usize {
        let index = self.push("nodes", node);
        self.roots.push(index);
        index
    }

    /// Adds a light where a node holds it.
    pub fn light(&mut self, light: Value, mut node: Value) {
        self.uses("KHR_lights_punctual");
        self.lights.push(light);
        node["extensions"]["KHR_lights_punctual"]["light"] = json!(self.lights.len() - 1);
        self.stand(node);
    }

    /// Adds a light from infinitely far: `towards` points to it.
    pub fn sun(&mut self, towards: [f64; 3], intensity: f64) {
        let node = json!({ "matrix": looking(towards, [0.0; 3]) });
        self.light(json!({ "type": "directional", "intensity": intensity }), node);
    }

    /// Adds a camera that sees 6 × 4 units of the plane z = 0 from the front, without perspective.
    pub fn front_camera(&mut self) {
        let lens = json!({ "xmag": 3, "ymag": 2, "znear": 0.1, "zfar": 100 });
        let camera = self.push("cameras", json!({ "type": "orthographic", "orthographic": lens }));
        self.stand(json!({ "camera": camera, "translation": [0, 0, 10] }));
    }

    /// Adds a camera with perspective.
    pub fn camera(&mut self, eye: [f64; 3], target: [f64; 3], yfov: f64) {
        let lens = json!({ "yfov": yfov, "aspectRatio": 1.5, "znear": 0.1 });
        let camera = self.push("cameras", json!({ "type": "perspective", "perspective": lens }));
        self.stand(json!({ "camera": camera, "matrix": looking(eye, target) }));
    }

    /// Adds a texture of a picture in the file, with this sampler or none.
    pub fn texture(&mut self, png: &[u8], sampler: Option<Value>) -> usize {
        let image = self.image("image/png", png);
        let mut texture = json!({ "source": image });
        if let Some(sampler) = sampler {
            texture["sampler"] = json!(self.push("samplers", sampler));
        }
        self.push("textures", texture)
    }

    /// Adds a picture within the file.
    pub fn image(&mut self, kind: &str, bytes: &[u8]) -> usize {
        self.push("images", json!({ "uri": data_uri(kind, bytes) }))
    }

    /// Adds a material that shows its base colour as it is: members of `pbrMetallicRoughness`.
    pub fn unlit(&mut self, base: Value) -> usize {
        self.uses("KHR_materials_unlit");
        let material = json!({ "pbrMetallicRoughness": base, "extensions": { "KHR_materials_unlit": {} } });
        self.push("materials", material)
    }

    /// Returns everything but where the buffer is.
    fn json(&self) -> BTreeMap<&str, Value> {
        let mut json: BTreeMap<&str, Value> =
            self.lists.iter().map(|(list, elements)| (*list, json!(elements))).collect();
        json.insert("asset", json!({ "version": "2.0", "generator": "moire make_gallery" }));
        json.insert("scene", json!(0));
        json.insert("scenes", json!([{ "nodes": self.roots }]));
        for (key, names) in [("extensionsUsed", &self.used), ("extensionsRequired", &self.required)] {
            if !names.is_empty() {
                json.insert(key, json!(names));
            }
        }
        if !self.lights.is_empty() {
            json.insert("extensions", json!({ "KHR_lights_punctual": { "lights": self.lights } }));
        }
        json
    }

    /// Returns the file as .gltf.
    pub fn text(&self) -> Vec<u8> {
        let mut json = self.json();
        let uri = data_uri("application/octet-stream", &self.bytes);
        json.insert("buffers", json!([{ "byteLength": self.bytes.len(), "uri": uri }]));
        let members: Vec<String> = json
            .iter()
            .map(|(key, value)| match value {
                Value::Array(elements) => {
                    let lines: Vec<String> = elements.iter().map(|element| format!("  {element}")).collect();
                    format!("\"{key}\": [\n{}\n]", lines.join(",\n"))
                }
                value => format!("\"{key}\": {value}"),
            })
            .collect();
        format!("{{\n{}\n}}\n", members.join(",\n")).into_bytes()
    }

    /// Returns the file as .glb.
    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json();
        json.insert("buffers", json!([{ "byteLength": self.bytes.len() }]));
        let mut text = json!(json).to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut binary = self.bytes.clone();
        binary.resize(binary.len().next_multiple_of(4), 0);
        let mut file = b"glTF\x02\0\0\0".to_vec();
        file.extend((12 + 8 + text.len() as u32 + 8 + binary.len() as u32).to_le_bytes());
        for (kind, chunk) in [(b"JSON", text), (b"BIN\0", binary)] {
            file.extend((chunk.len() as u32).to_le_bytes());
            file.extend_from_slice(kind);
            file.extend(chunk);
        }
        file
    }
}

fn data_uri(kind: &str, bytes: &[u8]) -> String {
    format!("data:{kind};base64,{}", BASE64_STANDARD.encode(bytes))
}

fn components(kind: &str) -> usize {
    match kind {
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        _ => 1,
    }
}

/// Returns the least and the greatest coordinates, as f32 has them.
fn bounds(points: &[[f64; 3]]) -> [[f32; 3]; 2] {
    let none = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    points.iter().fold(none, |[min, max], point| {
        let point = point.map(|x| x as f32);
        [[0, 1, 2].map(|i| min[i].min(point[i])), [0, 1, 2].map(|i| max[i].max(point[i]))]
    })
}

/// Returns the matrix, column by column, of a node at `eye` whose −z points to `target`; six digits are enough.
pub fn looking(eye: [f64; 3], target: [f64; 3]) -> [f64; 16] {
    let unit = |v: [f64; 3]| {
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        v.map(|x| x / length)
    };
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let back = unit([0, 1, 2].map(|i| eye[i] - target[i]));
    let right = unit(cross([0.0, 1.0, 0.0], back));
    let up = cross(back, right);
    let columns = [(right, 0.0), (up, 0.0), (back, 0.0), (eye, 1.0)];
    let mut matrix = [0.0; 16];
    for (column, (v, w)) in matrix.chunks_exact_mut(4).zip(columns) {
        column.copy_from_slice(&[v[0], v[1], v[2], w].map(|x| (x * 1e6).round() / 1e6 + 0.0));
    }
    matrix
}
