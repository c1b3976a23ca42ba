//! Cameras and lights: every kind, where they stand, and values that are refused.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use glam::DVec3;
use serde_json::{Value, json};

use super::super::{LightKind, Projection};
use super::build::{Build, fault_with};

#[test]
fn reads_cameras() {
    let mut build = Build::triangle();
    build.set(
        "/cameras",
        json!([
            { "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.1 }, "name": "eye" },
            { "type": "orthographic", "orthographic": { "xmag": 3, "ymag": 2, "znear": 0, "zfar": 9 } },
            { "type": "perspective", "perspective": { "yfov": 1, "aspectRatio": 1.5, "znear": 1 } },
        ]),
    );
    build.set("/nodes/1", json!({ "camera": 1, "translation": [1, 2, 3] }));
    build.set("/nodes/2", json!({ "camera": 0 })).set("/nodes/3", json!({ "camera": 0 }));
    build.set("/nodes/4", json!({ "camera": 2 }));
    let cameras = build.read().unwrap().cameras;
    assert_eq!(cameras.iter().map(|camera| camera.node).collect::<Vec<_>>(), [1, 2, 3, 4]);
    assert_eq!(cameras[0].projection, Projection::Orthographic { xmag: 3.0, ymag: 2.0 });
    assert_eq!(cameras[0].matrix.translation, DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(cameras[1].projection, Projection::Perspective { yfov: 0.8, aspect: None });
    assert_eq!(cameras[1].name, "eye");
    assert_eq!(cameras[3].projection, Projection::Perspective { yfov: 1.0, aspect: Some(1.5) });
}

#[test]
fn refuses_wrong_cameras() {
    for (camera, fault) in [
        (json!({}), "type: it is missing"),
        (json!({ "type": "fisheye" }), "type: it is \"fisheye\"; perspective and orthographic are allowed"),
        (json!({ "type": "perspective" }), "perspective: it is missing"),
        (json!({ "type": "perspective", "perspective": {} }), "perspective/yfov: it is missing"),
        (
            json!({ "type": "perspective", "perspective": { "yfov": 0 } }),
            "perspective/yfov: it is 0; it has to be between 0 and π",
        ),
        (
            json!({ "type": "perspective", "perspective": { "yfov": 4 } }),
            "perspective/yfov: it is 4; it has to be between 0 and π",
        ),
        (
            json!({ "type": "perspective", "perspective": { "yfov": 1, "aspectRatio": 0 } }),
            "perspective/aspectRatio: it is 0; it has to be greater than 0",
        ),
        (
            json!({ "type": "orthographic", "orthographic": { "xmag": 1, "ymag": -1 } }),
            "orthographic/ymag: it is -1; it has to be greater than 0",
        ),
    ] {
        assert_eq!(fault_with("/cameras", json!([camera])), format!("/cameras/0/{fault}"));
    }
}

/// Returns a triangle with lights.
fn lit(lights: Value) -> Build {
    let mut build = Build::triangle();
    build.set("/extensions", json!({ "KHR_lights_punctual": { "lights": lights } }));
    build
}

#[test]
fn reads_lights() {
    let mut build = lit(json!([
        { "type": "directional", "intensity": 3, "name": "sun" },
        { "type": "point", "color": [1, 0.5, 0.25], "range": 8 },
        { "type": "spot", "spot": { "innerConeAngle": 0.1, "outerConeAngle": 0.2 } },
        { "type": "spot", "spot": { "outerConeAngle": f64::from(std::f32::consts::FRAC_PI_2) } },
        { "type": "spot", "spot": {} },
    ]));
    for node in 0..5 {
        let light = json!({ "light": 4 - node });
        build.set(&format!("/nodes/{node}"), json!({ "extensions": { "KHR_lights_punctual": light } }));
    }
    build.set("/nodes/4/translation", json!([0, 0, 1]));
    let lights = build.read().unwrap().lights;
    let wide = f64::from(std::f32::consts::FRAC_PI_2);
    assert_eq!(lights[0].kind, LightKind::Spot { inner: 0.0, outer: FRAC_PI_4 });
    assert_eq!(lights[1].kind, LightKind::Spot { inner: 0.0, outer: wide });
    assert!(wide > FRAC_PI_2);
    assert_eq!(lights[2].kind, LightKind::Spot { inner: 0.1, outer: 0.2 });
    let point = &lights[3];
    assert_eq!((point.kind, point.range, point.intensity), (LightKind::Point, Some(8.0), 1.0));
    assert_eq!(point.color, DVec3::new(1.0, 0.5, 0.25));
    let sun = &lights[4];
    assert_eq!((sun.kind, sun.range, sun.intensity), (LightKind::Directional, None, 3.0));
    assert_eq!((sun.name.as_str(), sun.color, sun.node), ("sun", DVec3::ONE, 4));
    assert_eq!(sun.matrix.translation, DVec3::Z);
}

#[test]
fn refuses_wrong_lights() {
    for (light, fault) in [
        (json!({}), "/type: it is missing"),
        (json!({ "type": "area" }), "/type: it is \"area\"; directional, point and spot are allowed"),
        (json!({ "type": "spot" }), "/spot: it is missing"),
        (
            json!({ "type": "spot", "spot": { "innerConeAngle": 1 } }),
            "/spot/innerConeAngle: it is 1, greater than the outer angle, 0.7853981633974483",
        ),
        (
            json!({ "type": "spot", "spot": { "outerConeAngle": 2 } }),
            "/spot/outerConeAngle: it is 2; it has to be between 0 and π/2",
        ),
        (
            json!({ "type": "point", "color": [1, -1, 1] }),
            "/color: it is [1,-1,1]; numbers from 0 are allowed",
        ),
        (json!({ "type": "point", "intensity": -1 }), "/intensity: it is -1; it has to be at least 0"),
        (json!({ "type": "point", "range": 0 }), "/range: it is 0; it has to be greater than 0"),
    ] {
        let place = "/extensions/KHR_lights_punctual/lights/0";
        assert_eq!(lit(json!([light])).fault(), format!("{place}{fault}"));
    }
    let place = "/nodes/0/extensions/KHR_lights_punctual";
    let fault = lit(json!([])).set(place, json!({ "light": 0 })).fault();
    assert_eq!(fault, format!("{place}/light: 0 does not exist; the file has 0 lights"));
}
