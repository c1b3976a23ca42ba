//! Planes, spheres, triangles and lights: none of them degenerate. A triangle without area is no mistake: meshes have
//! such ones, and no ray meets them.

use super::super::limits::{CAP, COLOR, COORDINATE, LENGTH, NOT_NEGATIVE, parallel};
use super::super::model::{Light, Plane, Sphere, Triangle};
use super::super::refusal::{Check, Key};

pub fn plane(key: Key, plane: &Plane) -> Check {
    key.of("origin").vector(plane.origin, &COORDINATE)?;
    key.of("tangent").direction(plane.tangent)?;
    key.of("bitangent").direction(plane.bitangent)?;
    if parallel(plane.tangent, plane.bitangent) {
        let what = "tangent and bitangent are parallel and span no plane; turn one of them";
        return key.of("bitangent").refuse(what, "parallel to tangent");
    }
    plane.half_extent.map_or(Ok(()), |extent| key.of("half_extent").number(extent, &LENGTH))?;
    key.of("motion").vector(plane.motion, &COORDINATE)
}

pub fn sphere(key: Key, sphere: &Sphere) -> Check {
    key.of("center").vector(sphere.center, &COORDINATE)?;
    key.of("radius").number(sphere.radius, &LENGTH)?;
    key.of("motion").vector(sphere.motion, &COORDINATE)
}

pub fn triangle(key: Key, triangle: &Triangle) -> Check {
    for (i, vertex) in triangle.vertices.iter().enumerate() {
        key.of("vertices").at(i).vector(*vertex, &COORDINATE)?;
    }
    for (i, uv) in triangle.uvs.iter().enumerate() {
        key.of("uvs").at(i).numbers(uv.to_array(), &COORDINATE)?;
    }
    for (i, normal) in triangle.normals.iter().flatten().enumerate() {
        key.of("normals").at(i).direction(*normal)?;
    }
    key.of("motion").vector(triangle.motion, &COORDINATE)
}

pub fn light(key: Key, light: &Light) -> Check {
    let [position, direction] = ["position", "direction"].map(|name| key.of(name));
    let [intensity, irradiance, radiance] = ["intensity", "irradiance", "radiance"].map(|name| key.of(name));
    match *light {
        Light::Point { position: place, intensity: power } => {
            position.vector(place, &COORDINATE)?;
            intensity.vector(power, &COLOR)
        }
        Light::Sphere { position: place, radius, intensity: power } => {
            position.vector(place, &COORDINATE)?;
            intensity.vector(power, &COLOR)?;
            key.of("radius").number(radius, &NOT_NEGATIVE)
        }
        Light::Directional { direction: towards, irradiance: power } => {
            direction.direction(towards)?;
            irradiance.vector(power, &COLOR)
        }
        Light::Sun { direction: towards, angle, irradiance: power } => {
            direction.direction(towards)?;
            irradiance.vector(power, &COLOR)?;
            key.of("angle").number(angle, &CAP)
        }
        Light::Rectangle { position: place, edge_u, edge_v, radiance: power } => {
            position.vector(place, &COORDINATE)?;
            key.of("edge_u").direction(edge_u)?;
            key.of("edge_v").direction(edge_v)?;
            if parallel(edge_u, edge_v) {
                let what = "edge_u and edge_v are parallel and span no area; turn one of them";
                return key.of("edge_v").refuse(what, "parallel to edge_u");
            }
            radiance.vector(power, &COLOR)
        }
    }
}
