//! The container, the JSON as such, versions and extensions.

use serde_json::json;

use super::super::read;
use super::build::{Build, MOST, fault_with, no_files};

fn fault(bytes: &[u8]) -> String {
    read(bytes, MOST, no_files()).unwrap_err().to_string()
}

#[test]
fn reads_both_containers() {
    let build = Build::triangle();
    let model = build.read().unwrap();
    assert_eq!(model.instances.len(), 1);
    assert_eq!(read(&build.text(), MOST, no_files()).unwrap(), model);
    let marked = [b"\xef\xbb\xbf \n", build.text().as_slice()].concat();
    assert_eq!(read(&marked, MOST, no_files()).unwrap(), model);
    // Bytes after the stated length are not part of it.
    assert_eq!(read(&[build.glb(), vec![7; 9]].concat(), MOST, no_files()).unwrap(), model);
}

#[test]
fn pads_json_with_zeros() {
    let json = br#"{"asset":{"version":"2.0"}}"#;
    let mut file = b"glTF\x02\0\0\0\x30\0\0\0\x1c\0\0\0JSON".to_vec();
    file.extend_from_slice(json);
    file.push(0);
    assert_eq!(read(&file, MOST, no_files()).unwrap().nodes.len(), 0);
}

#[test]
fn refuses_broken_containers() {
    let glb = Build::triangle().glb();
    for length in 4..glb.len() {
        let fault = fault(&glb[..length]);
        assert!(fault.starts_with("byte "), "{fault}");
    }
    // Within the stated length, but too short for a chunk.
    let mut tail = glb.clone();
    let end = 20 + usize::from(tail[12]) + 256 * usize::from(tail[13]);
    tail.truncate(end + 5);
    tail[8..10].copy_from_slice(&u16::try_from(end + 5).unwrap().to_le_bytes());
    assert_eq!(fault(&tail), format!("byte {}: the file is cut off", end + 5));
    let changed = |at: usize, byte: u8| {
        let mut bytes = glb.clone();
        bytes[at] = byte;
        fault(&bytes)
    };
    assert_eq!(changed(4, 1), "header: its binary container is of version 1; 2 is read");
    assert!(changed(11, 1).starts_with("byte 8: it says "));
    assert!(changed(15, 1).starts_with("byte 12: the chunk says "));
    assert_eq!(changed(16, b'K'), "byte 16: the first chunk is not JSON");
    assert_eq!(changed(24, 0xff), "byte 24: its JSON is not in UTF-8");
    let none = "header: it is no glTF file: it starts neither with \"glTF\" nor with the brace of a JSON object in UTF-8";
    for bytes in [&b""[..], b"gl", b"[]", b"v 0 0 0", b"\xff\xfe{\0"] {
        assert_eq!(fault(bytes), none);
    }
}

#[test]
fn refuses_broken_json() {
    assert_eq!(fault(b"{\"asset\":\n x}"), "line 2 column 2: it is not valid JSON: expected value");
    assert_eq!(
        fault(b"{\"asset\": {}"),
        "line 1 column 12: it is not valid JSON: EOF while parsing an object"
    );
    assert_eq!(fault(b"{\"asset\": 3}"), "/asset: it is 3; an object is needed");
    assert_eq!(fault(b"{}"), "/asset: it is missing");
    let start = "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": ";
    let deep = format!("{start}[{}{}]}}", "[".repeat(100_000), "]".repeat(100_000));
    assert_eq!(fault(deep.as_bytes()), "/nodes/0: it is not valid: recursion limit exceeded");
    assert_eq!(fault(format!("{start} {{}}}}").as_bytes()), "/nodes: it is not a list");
    let huge = fault(format!("{start} [{{\"mesh\": 1e999}}]}}").as_bytes());
    assert_eq!(huge, "/nodes/0: it is not valid: number out of range");
    let many = format!("{start}[{}0]}}", "0,".repeat(1_000_000));
    assert_eq!(fault(many.as_bytes()), "/nodes: it has 1000001 elements; at most 1000000 are allowed");
    let many = format!("{{\"asset\": {{\"version\": \"2.0\"}}, \"images\": [{}0]}}", "0,".repeat(100_000));
    assert_eq!(fault(many.as_bytes()), "/images: it has 100001 elements; at most 100000 are allowed");
    let wide = format!("{start}[{{\"children\": [{}0]}}]}}", "0,".repeat(1 << 21));
    assert_eq!(fault(wide.as_bytes()), "/nodes/0: it has more than 2097152 values");
}

#[test]
fn treats_null_as_absent() {
    let mut build = Build::triangle();
    for pointer in ["/nodes/0/name", "/nodes/0/camera", "/scene", "/materials", "/nodes/0/children"] {
        build.set(pointer, json!(null));
    }
    assert_eq!(build.read().unwrap(), Build::triangle().read().unwrap());
    // As some programs write whole numbers.
    assert_eq!(build.set("/nodes/0/mesh", json!(0.0)).read().unwrap().instances.len(), 1);
}

#[test]
fn checks_versions() {
    let with = |version, least| {
        Build::triangle().set("/asset", json!({ "version": version, "minVersion": least })).read()
    };
    assert!(with("2.0", json!("2.0")).is_ok() && with("2.1", json!(null)).is_ok());
    let fault = |version, least| with(version, least).unwrap_err().to_string();
    assert_eq!(fault("1.0", json!(null)), "/asset/version: it is \"1.0\"; 2.x is read");
    assert_eq!(fault("20", json!(null)), "/asset/version: it is \"20\"; 2.x is read");
    assert_eq!(fault("2.1", json!("2.1")), "/asset/minVersion: it is \"2.1\"; 2.0 is read");
}

#[test]
fn refuses_needed_extensions_by_name() {
    for (name, hint) in [
        ("KHR_draco_mesh_compression", ": its meshes are compressed by Draco; export it without compression"),
        ("EXT_meshopt_compression", ": its buffers are compressed by meshopt; export it without compression"),
        ("KHR_materials_pbrSpecularGlossiness", ": convert its materials to metallic and roughness"),
        ("VENDOR_other", ""),
    ] {
        let fault = fault_with("/extensionsRequired", json!(["KHR_texture_transform", name]));
        let what = format!("the file needs {name:?}, which is not supported{hint}");
        assert_eq!(fault, format!("/extensionsRequired/1: {what}"));
    }
    let fault = fault_with("/extensionsRequired", json!([3]));
    assert_eq!(fault, "/extensionsRequired/0: the file needs \"\", which is not supported");
}

#[test]
fn names_a_limited_number_of_extensions() {
    let names: Vec<String> = (0..40).map(|i| format!("VENDOR_{i}")).collect();
    let notes = Build::triangle().set("/extensionsUsed", json!(names)).read().unwrap().notes;
    assert_eq!((notes.len(), notes[32].as_str()), (33, "8 more extensions are ignored"));
}
