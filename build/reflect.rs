//! Reflects SPIR-V: the descriptors of a shader, and its specialization constants with names and defaults.

use std::collections::BTreeMap;

use crate::AnyError;
use crate::specialization::SPECIALIZATION;

/// The data that reflection collects: SPIR-V 1.5, section 3 (binary form). Only decorations, names, the types
/// of descriptors, and the defaults of scalar specialization constants matter.
#[derive(Default)]
pub struct Reflection {
    names: BTreeMap<u32, String>,
    spec_ids: BTreeMap<u32, u32>,
    bindings: BTreeMap<u32, u32>,
    types: BTreeMap<u32, (u32, Vec<u32>)>,
    variables: Vec<(u32, u32, u32)>,
    spec_defaults: BTreeMap<u32, u32>,
}

impl Reflection {
    pub fn new(words: &[u32]) -> Reflection {
        let mut r = Reflection::default();
        let mut at = 5;
        while at < words.len() {
            let (op, len) = (words[at] & 0xFFFF, (words[at] >> 16) as usize);
            let w = &words[at + 1..at + len];
            match op {
                5 => drop(r.names.insert(w[0], literal_string(&w[1..]))),
                71 if w[1] == 1 => drop(r.spec_ids.insert(w[0], w[2])),
                71 if w[1] == 33 => drop(r.bindings.insert(w[0], w[2])),
                19..=32 => drop(r.types.insert(w[0], (op, w[1..].to_vec()))),
                48 => drop(r.spec_defaults.insert(w[1], 1)),
                49 => drop(r.spec_defaults.insert(w[1], 0)),
                50 => drop(r.spec_defaults.insert(w[1], w[2])),
                59 => r.variables.push((w[1], w[0], w[2])),
                _ => {}
            }
            at += len;
        }
        r
    }

    /// Returns (binding, kind) of every descriptor, in the order of bindings.
    pub fn descriptors(&self) -> Result<Vec<(u32, &'static str)>, AnyError> {
        const UNIFORM_CONSTANT: u32 = 0;
        const UNIFORM: u32 = 2;
        const STORAGE_BUFFER: u32 = 12;
        let mut found = Vec::new();
        for &(variable, pointer, storage) in &self.variables {
            let Some(&binding) = self.bindings.get(&variable) else { continue };
            let kind = match storage {
                UNIFORM => "UniformBuffer",
                STORAGE_BUFFER => "StorageBuffer",
                UNIFORM_CONSTANT => self.opaque_kind(self.types[&pointer].1[1])?,
                other => return Err(format!("binding {binding}: storage class {other} is not known").into()),
            };
            found.push((binding, kind));
        }
        found.sort();
        Ok(found)
    }

    fn opaque_kind(&self, id: u32) -> Result<&'static str, AnyError> {
        const DIM_BUFFER: u32 = 5;
        match &self.types[&id] {
            (28, operands) => self.opaque_kind(operands[0]), // OpTypeArray of sampled images
            (27, operands) => {
                // OpTypeSampledImage of an OpTypeImage: sampled type, dimension, …
                let buffer = self.types[&operands[0]].1[1] == DIM_BUFFER;
                Ok(if buffer { "TexelBuffer" } else { "SampledImage" })
            }
            (op, _) => Err(format!("descriptor of type instruction {op} is not known").into()),
        }
    }

    /// Returns (name, id, default) of every specialization constant. Those of the workgroup's size have no
    /// names in the module.
    pub fn constants(&self) -> Vec<(String, u32, u32)> {
        let mut found: Vec<_> = self
            .spec_ids
            .iter()
            .filter_map(|(id, &spec)| {
                let name = match self.names.get(id) {
                    Some(name) => name.clone(),
                    None => SPECIALIZATION.get(spec as usize)?.name.into(),
                };
                Some((name, spec, *self.spec_defaults.get(id)?))
            })
            .collect();
        found.sort_by_key(|c| c.1);
        found
    }
}

fn literal_string(words: &[u32]) -> String {
    let bytes: Vec<u8> = words.iter().flat_map(|w| w.to_le_bytes()).take_while(|&b| b != 0).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}
