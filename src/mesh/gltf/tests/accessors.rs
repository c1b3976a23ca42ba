//! Accessors: every type of numbers, normalization, strides, sparse elements, accessors without bytes, and every way in
//! which one can lie.

use glam::{DVec2, DVec3, DVec4};
use serde_json::json;

use super::build::{Build, MOST, f32s, fault_with, i8s, i16s, u16s, u32s};

/// Returns the second set of texture coordinates of a triangle, stored as given.
fn uvs(component: usize, normalized: bool, bytes: &[u8]) -> Vec<DVec2> {
    let mut build = Build::triangle();
    let accessor = build.attribute("TEXCOORD_1", component, "VEC2", bytes);
    build.set(&format!("/accessors/{accessor}/normalized"), json!(normalized));
    build.read().unwrap().primitives.remove(0).uvs[1].clone()
}

#[test]
fn reads_every_type_of_numbers() {
    let v = DVec2::new;
    let bytes = i8s(&[-128, 127, -127, 0, 64, -1]);
    assert_eq!(uvs(5120, false, &bytes), [v(-128., 127.), v(-127., 0.), v(64., -1.)]);
    assert_eq!(uvs(5120, true, &bytes), [v(-1., 1.), v(-1., 0.), v(64. / 127., -1. / 127.)]);
    let bytes = [0, 255, 128, 1, 51, 254];
    assert_eq!(uvs(5121, false, &bytes), [v(0., 255.), v(128., 1.), v(51., 254.)]);
    assert_eq!(uvs(5121, true, &bytes), [v(0., 1.), v(128. / 255., 1. / 255.), v(0.2, 254. / 255.)]);
    let bytes = i16s(&[-32768, 32767, -32767, 0, 1, -2]);
    assert_eq!(uvs(5122, false, &bytes), [v(-32768., 32767.), v(-32767., 0.), v(1., -2.)]);
    assert_eq!(uvs(5122, true, &bytes), [v(-1., 1.), v(-1., 0.), v(1. / 32767., -2. / 32767.)]);
    let bytes = u16s(&[0, 65535, 13107, 1, 256, 255]);
    assert_eq!(uvs(5123, false, &bytes), [v(0., 65535.), v(13107., 1.), v(256., 255.)]);
    assert_eq!(uvs(5123, true, &bytes), [v(0., 1.), v(0.2, 1. / 65535.), v(256. / 65535., 255. / 65535.)]);
    let bytes = f32s(&[-1.5, 2.25, 1e30, 0.0, 0.1, -0.0]);
    let floats = [v(-1.5, 2.25), v(f64::from(1e30_f32), 0.), v(f64::from(0.1_f32), 0.)];
    assert_eq!(uvs(5126, false, &bytes), floats);
    // Marked by mistake.
    assert_eq!(uvs(5126, true, &bytes), floats);
}

#[test]
fn reads_quantized_attributes() {
    let mut build = Build::new();
    build.set("/extensionsRequired", json!(["KHR_mesh_quantization"]));
    build.attribute("POSITION", 5122, "VEC3", &i16s(&[0, 0, 0, 300, 0, 0, 0, -200, 7]));
    let normal = build.attribute("NORMAL", 5120, "VEC3", &i8s(&[0, 0, 127, 0, 0, -128, 127, 0, 0]));
    let tangent = build.attribute("TANGENT", 5122, "VEC4", &i16s(&[32767, 0, 0, -32767].repeat(3)));
    let color = build.attribute("COLOR_0", 5121, "VEC3", &[255, 0, 51].repeat(3));
    for accessor in [normal, tangent, color] {
        build.set(&format!("/accessors/{accessor}/normalized"), json!(true));
    }
    let primitive = build.read().unwrap().primitives.remove(0);
    assert_eq!(primitive.positions[1..], [DVec3::new(300., 0., 0.), DVec3::new(0., -200., 7.)]);
    assert_eq!(primitive.normals, [DVec3::Z, -DVec3::Z, DVec3::X]);
    assert_eq!(primitive.tangents, [DVec4::new(1., 0., 0., -1.); 3]);
    assert_eq!(primitive.colors, [DVec4::new(1., 0., 0.2, 1.); 3]);
}

#[test]
fn reads_colors_with_alpha() {
    let mut build = Build::triangle();
    let color = build.attribute("COLOR_0", 5123, "VEC4", &u16s(&[65535, 0, 13107, 52428].repeat(3)));
    build.set(&format!("/accessors/{color}/normalized"), json!(true));
    assert_eq!(build.read().unwrap().primitives[0].colors, [DVec4::new(1., 0., 0.2, 0.8); 3]);
}

#[test]
fn strides_over_other_bytes() {
    let mut build = Build::new();
    // Two bytes before the first element, a uv between the positions.
    let element = |x: f32, y: f32| f32s(&[x, y, 0., x + 10., y + 20.]);
    let bytes = [vec![9, 9], element(0., 0.), element(1., 0.), element(0., 1.)].concat();
    let view = build.view(&bytes);
    build.set(&format!("/bufferViews/{view}/byteStride"), json!(20));
    for (i, (name, kind, offset)) in [("POSITION", "VEC3", 2), ("TEXCOORD_0", "VEC2", 14)].iter().enumerate()
    {
        build.set(
            &format!("/accessors/{i}"),
            json!({ "bufferView": view, "byteOffset": offset, "componentType": 5126, "type": kind, "count": 3 }),
        );
        build.set(&format!("/meshes/0/primitives/0/attributes/{name}"), json!(i));
    }
    let primitive = build.read().unwrap().primitives.remove(0);
    assert_eq!(primitive.positions, [DVec3::ZERO, DVec3::X, DVec3::Y]);
    assert_eq!(primitive.uvs[0], [DVec2::new(10., 20.), DVec2::new(11., 20.), DVec2::new(10., 21.)]);
    // The last element ends with the view; one more does not fit.
    for accessor in ["/accessors/0/count", "/accessors/1/count"] {
        let fault = build.clone().set(accessor, json!(4)).fault();
        assert!(fault.starts_with(&format!("{accessor}: 4 elements of ")), "{fault}");
    }
    for (stride, fault) in [
        (3, "/bufferViews/0/byteStride: it is 3; 4 to 252 are allowed"),
        (256, "/bufferViews/0/byteStride: it is 256; 4 to 252 are allowed"),
        (8, "/accessors/0/bufferView: its elements have 12 bytes, but follow each other after 8"),
        (11, "/accessors/0/bufferView: its elements have 12 bytes, but follow each other after 11"),
    ] {
        assert_eq!(build.clone().set("/bufferViews/0/byteStride", json!(stride)).fault(), fault);
    }
}

/// Returns a triangle whose second and third positions are replaced.
fn sparse(component: usize, indices: &[u8]) -> Build {
    let mut build = Build::triangle();
    let indices = build.view(indices);
    let values = build.view(&f32s(&[5., 0., 0., 0., 6., 0.]));
    build.set(
        "/accessors/0/sparse",
        json!({
            "count": 2,
            "indices": { "bufferView": indices, "componentType": component },
            "values": { "bufferView": values },
        }),
    );
    build
}

#[test]
fn replaces_sparse_elements() {
    for (component, indices) in [(5121, vec![1, 2]), (5123, u16s(&[1, 2])), (5125, u32s(&[1, 2]))] {
        let mut build = sparse(component, &indices);
        let replaced = [DVec3::ZERO, DVec3::X * 5., DVec3::Y * 6.];
        assert_eq!(build.read().unwrap().primitives[0].positions, replaced);
        build.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
        assert_eq!(build.read().unwrap().primitives[0].positions, replaced);
    }
    for (indices, fault) in [
        ([1, 1], "index 1 is 1, not greater than the one before"),
        ([2, 1], "index 1 is 1, not greater than the one before"),
        ([1, 3], "index 1 is 3; the accessor has 3 elements"),
    ] {
        assert_eq!(sparse(5121, &indices).fault(), format!("/accessors/0/sparse/indices: {fault}"));
    }
    for (pointer, value, fault) in [
        ("count", json!(4), "count: it is 4; the accessor has 3 elements"),
        (
            "count",
            json!(3),
            "indices/count: 3 elements of 1 bytes, 1 apart, from byte 0; the view has 2 bytes",
        ),
        (
            "indices/componentType",
            json!(5120),
            "indices/componentType: it is 5120; 5121, 5123 and 5125 are allowed here",
        ),
        ("values", json!({}), "values/bufferView: it is missing"),
        ("indices/bufferView", json!(9), "indices/bufferView: 9 does not exist; the file has 3 buffer views"),
    ] {
        let pointer = format!("/accessors/0/sparse/{pointer}");
        let found = sparse(5121, &[1, 2]).set(&pointer, value).fault();
        assert_eq!(found, format!("/accessors/0/sparse/{fault}"));
    }
}

#[test]
fn leaves_out_what_has_no_bytes() {
    let mut build = Build::triangle();
    build.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    let model = build.read().unwrap();
    assert!(model.primitives.is_empty() && model.instances.is_empty());
    assert_eq!(model.notes, ["triangles without an area are left out (at /accessors/0)"]);
    // Zeros are elements like others.
    let mut build = Build::triangle();
    build.set("/accessors/1", json!({ "componentType": 5126, "type": "VEC3", "count": 3 }));
    build.set("/meshes/0/primitives/0/attributes/NORMAL", json!(1));
    assert_eq!(build.read().unwrap().primitives[0].normals, [DVec3::ZERO; 3]);
    build.set("/accessors/0/count", json!(4_000_000_000_u32));
    let what = "4000000000 elements of 12 bytes, 12 apart, from byte 0; the view has 36 bytes";
    assert_eq!(build.fault(), format!("/accessors/0/count: {what}"));
    build.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    let what = "it is 4000000000; without a buffer view at most 1048576 are allowed";
    assert_eq!(build.fault(), format!("/accessors/0/count: {what}"));
    build.set("/accessors/0/count", json!(1_000_000));
    let what = format!("up to here, it has more than {MOST} triangles, the most a scene may have");
    assert_eq!(build.fault(), format!("/nodes/0: {what}"));
}

#[test]
fn refuses_by_the_place() {
    for (pointer, value, fault) in [
        (
            "/accessors/0/count",
            json!(u64::MAX),
            "count: 18446744073709551615 elements of 12 bytes, 12 apart, from byte 0; the view has 36 bytes",
        ),
        (
            "/accessors/0/count",
            json!(4),
            "count: 4 elements of 12 bytes, 12 apart, from byte 0; the view has 36 bytes",
        ),
        ("/accessors/0/count", json!(-1), "count: it is -1; a whole number from 0 is needed"),
        ("/accessors/0/count", json!(1.5), "count: it is 1.5; a whole number from 0 is needed"),
        ("/accessors/0/count", json!(null), "count: it is missing"),
        (
            "/accessors/0/byteOffset",
            json!(1),
            "count: 3 elements of 12 bytes, 12 apart, from byte 1; the view has 36 bytes",
        ),
        (
            "/accessors/0/byteOffset",
            json!(u64::MAX),
            "count: 3 elements of 12 bytes, 12 apart, from byte 18446744073709551615; the view has 36 bytes",
        ),
        (
            "/accessors/0/componentType",
            json!(5124),
            "componentType: it is 5124; 5120, 5121, 5122, 5123, 5125 and 5126 are allowed",
        ),
        (
            "/accessors/0/componentType",
            json!(5125),
            "componentType: POSITION has to be of floats (5126) or integers of 8 or 16 bits (5120 to 5123)",
        ),
        (
            "/accessors/0/type",
            json!("MAT4"),
            "type: it is \"MAT4\"; SCALAR, VEC2, VEC3 and VEC4 are allowed here",
        ),
        ("/accessors/0/type", json!("VEC2"), "type: it is VEC2; POSITION has to be VEC3"),
        ("/accessors/0/bufferView", json!(1), "bufferView: 1 does not exist; the file has 1 buffer views"),
        ("/accessors/0/sparse", json!([]), "sparse: it is []; an object is needed"),
    ] {
        assert_eq!(fault_with(pointer, value), format!("/accessors/0/{fault}"));
    }
    for (pointer, value, fault) in [
        ("/bufferViews/0/buffer", json!(1), "buffer: 1 does not exist; the file has 1 buffers"),
        ("/bufferViews/0/byteLength", json!(37), "byteLength: 37 bytes from byte 0; buffer 0 has 36"),
        (
            "/bufferViews/0/byteOffset",
            json!(u64::MAX),
            "byteLength: 36 bytes from byte 18446744073709551615; buffer 0 has 36",
        ),
    ] {
        assert_eq!(fault_with(pointer, value), format!("/bufferViews/0/{fault}"));
    }
    let what = "/buffers/0/byteLength: it is 37, but the data has 36 bytes";
    assert_eq!(fault_with("/buffers/0/byteLength", json!(37)), what);
    assert_eq!(fault_with("/accessors/0", json!(3)), "/accessors/0: it is 3; an object is needed");
}

#[test]
fn refuses_numbers_that_are_not_finite() {
    for wrong in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut build = Build::triangle();
        build.bytes[16..20].copy_from_slice(&wrong.to_le_bytes());
        assert_eq!(build.fault(), "/accessors/0: element 1 is not finite");
    }
}

#[test]
fn refuses_attributes_that_do_not_fit() {
    let mut build = Build::triangle();
    build.attribute("NORMAL", 5126, "VEC3", &f32s(&[0.; 12]));
    assert_eq!(build.fault(), "/accessors/1/count: it is 4; NORMAL has to have 3 elements here");
    let mut build = Build::triangle();
    build.attribute("NORMAL", 5120, "VEC3", &[0; 9]);
    let what = "NORMAL has to be of floats (5126) or normalized signed integers of 8 or 16 bits (5120, 5122)";
    assert_eq!(build.fault(), format!("/accessors/1/componentType: {what}"));
    let mut build = Build::triangle();
    build.attribute("COLOR_0", 5121, "VEC3", &[0; 9]);
    let what =
        "COLOR has to be of floats (5126) or normalized unsigned integers of 8 or 16 bits (5121, 5123)";
    assert_eq!(build.fault(), format!("/accessors/1/componentType: {what}"));
    build.set("/accessors/1/type", json!("SCALAR"));
    assert_eq!(build.fault(), "/accessors/1/type: it is SCALAR; COLOR has to be VEC3 or VEC4");
}
