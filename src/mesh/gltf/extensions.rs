//! Versions and extensions. Input: the file's own statement of what it is and needs. Output: a refusal if it needs
//! something that is not done here, otherwise remarks that name the extensions passed over.

use super::document::Document;
use super::json::Json;
use crate::mesh::Fault;

/// The extensions that are done here.
const DONE: [&str; 12] = [
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "MSFT_texture_dds",
];

/// The most extensions that are named one by one.
const MOST_NAMED: usize = 32;

/// Refuses versions and needed extensions that are not done. Returns a sentence for each other extension.
pub(super) fn check(document: &Document) -> Result<Vec<String>, Fault> {
    let element = document.members(&["asset", "extensionsRequired", "extensionsUsed"])?;
    let root = element.json();
    version(root)?;
    for required in root.list("extensionsRequired")? {
        let name = required.as_text().unwrap_or_default();
        if !DONE.contains(&name) {
            return Err(
                required.fault(format!("the file needs {name:?}, which is not supported{}", hint(name)))
            );
        }
    }
    let mut others: Vec<&str> = root.list("extensionsUsed")?.into_iter().filter_map(Json::as_text).collect();
    others.retain(|name| !DONE.contains(name));
    others.sort_unstable();
    others.dedup();
    let rest = others.split_off(others.len().min(MOST_NAMED));
    let mut sentences: Vec<String> =
        others.iter().map(|name| format!("extension {:?} is ignored", shortened(name))).collect();
    if !rest.is_empty() {
        sentences.push(format!("{} more extensions are ignored", rest.len()));
    }
    Ok(sentences)
}

/// Refuses files of another version than 2, or that ask for a later one than 2.0.
fn version(root: Json) -> Result<(), Fault> {
    let asset = root.needed("asset", root.object("asset")?)?;
    let version = asset.needed("version", asset.text("version")?)?;
    if version.split('.').next() != Some("2") {
        return Err(asset.fault_at("version", format!("it is {:?}; 2.x is read", shortened(version))));
    }
    match asset.text("minVersion")? {
        Some(least) if least != "2.0" => {
            Err(asset.fault_at("minVersion", format!("it is {:?}; 2.0 is read", shortened(least))))
        }
        _ => Ok(()),
    }
}

/// Returns what to do about an extension.
fn hint(name: &str) -> &'static str {
    match name {
        "KHR_draco_mesh_compression" => ": its meshes are compressed by Draco; export it without compression",
        "EXT_meshopt_compression" | "KHR_meshopt_compression" => {
            ": its buffers are compressed by meshopt; export it without compression"
        }
        "KHR_materials_pbrSpecularGlossiness" => ": convert its materials to metallic and roughness",
        _ => "",
    }
}

/// Returns the start of a long name.
fn shortened(name: &str) -> String {
    name.chars().take(60).collect()
}
