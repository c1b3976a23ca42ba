//! The few shapes of the gallery as accessors: a square, a ball, a block and a letter.

use serde_json::{Value, json};

use super::document::Document;

/// Accessors of a shape, to be used by meshes of several materials.
pub struct Shape {
    pub attributes: Value,
    pub indices: Option<usize>,
}

impl Shape {
    /// Puts the shape in a material where `node` is.
    pub fn stand(&self, document: &mut Document, material: usize, mut node: Value) {
        let mesh = document.mesh(&self.attributes, self.indices, material);
        node["mesh"] = json!(mesh);
        document.stand(node);
    }

    /// Returns the shape with one more attribute.
    pub fn with(&self, name: &str, accessor: usize) -> Shape {
        let mut attributes = self.attributes.clone();
        attributes[name] = json!(accessor);
        Shape { attributes, indices: self.indices }
    }
}

/// Corners of the square, counter-clockwise from the lower left.
pub const CORNERS: [[f64; 3]; 4] = [[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, 0.5, 0.0]];

/// Returns a square of side 1 about the origin that faces +z; its picture stands upright.
pub fn square(document: &mut Document) -> Shape {
    let uvs = document.floats("VEC2", &corner_uvs([0.0, 0.0], [1.0, 1.0]));
    let positions = document.positions(&CORNERS);
    let normals = document.floats("VEC3", [[0.0, 0.0, 1.0]; 4].as_flattened());
    let attributes = json!({ "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs });
    Shape { attributes, indices: Some(document.indices(&[0, 1, 2, 0, 2, 3])) }
}

/// Returns the texture coordinates of the square's corners: `min` is at the upper left, `max` at the lower right.
pub fn corner_uvs(min: [f64; 2], max: [f64; 2]) -> [f64; 8] {
    [min[0], max[1], max[0], max[1], max[0], min[1], min[0], min[1]]
}

/// Returns a ball of radius 1: an octahedron, each triangle divided into four as often as `steps` says.
pub fn ball(document: &mut Document, steps: usize) -> Shape {
    let (points, indices) = ball_points(steps);
    let positions = document.positions(&points);
    // Its normals are its positions.
    let attributes = json!({ "POSITION": positions, "NORMAL": positions });
    Shape { attributes, indices: Some(document.indices(&indices)) }
}

pub fn ball_points(steps: usize) -> (Vec<[f64; 3]>, Vec<u16>) {
    let mut points: Vec<[f64; 3]> = vec![
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
    ];
    let mut faces: Vec<[u16; 3]> =
        vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    for _ in 0..steps {
        let mut halves = Vec::new();
        let mut half = |points: &mut Vec<[f64; 3]>, a: u16, b: u16| {
            let edge = (a.min(b), a.max(b));
            if let Some((_, index)) = halves.iter().find(|(known, _)| *known == edge) {
                return *index;
            }
            let [p, q] = [points[usize::from(a)], points[usize::from(b)]];
            let sum = [0, 1, 2].map(|i| p[i] + q[i]);
            let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
            points.push(sum.map(|x| x / length));
            let index = (points.len() - 1) as u16;
            halves.push((edge, index));
            index
        };
        let divided = faces.iter().flat_map(|&[a, b, c]| {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(a, b)| half(&mut points, a, b));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        });
        faces = divided.collect();
    }
    (points, faces.into_flattened())
}

/// Returns a block of side 1 on the plane y = 0, without normals: its faces are flat.
pub fn block(document: &mut Document) -> Shape {
    let corner = |i: usize| [(i & 1) as f64 - 0.5, (i >> 1 & 1) as f64, (i >> 2) as f64 - 0.5];
    let positions = document.positions(&[0, 1, 2, 3, 4, 5, 6, 7].map(corner));
    let faces: [[u16; 4]; 6] =
        [[4, 5, 7, 6], [1, 0, 2, 3], [5, 1, 3, 7], [0, 4, 6, 2], [6, 7, 3, 2], [0, 1, 5, 4]];
    let indices: Vec<u16> = faces.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect();
    Shape { attributes: json!({ "POSITION": positions }), indices: Some(document.indices(&indices)) }
}

/// Returns the letter F as a body, 1 wide, 1.5 high and 0.3 deep, without normals.
pub fn letter(document: &mut Document) -> Shape {
    // Its outline, counter-clockwise from the lower left.
    let outline = [
        [0.0, 0.0],
        [0.3, 0.0],
        [0.3, 0.6],
        [0.8, 0.6],
        [0.8, 0.9],
        [0.3, 0.9],
        [0.3, 1.2],
        [1.0, 1.2],
        [1.0, 1.5],
        [0.0, 1.5],
    ];
    let side = |z: f64| outline.iter().map(move |[x, y]| [x - 0.5, y - 0.75, z]);
    let points: Vec<[f64; 3]> = side(0.15).chain(side(-0.15)).collect();
    // The stem and the two bars, with the corners that they share.
    let front: [[u16; 3]; 8] =
        [[0, 1, 2], [0, 2, 5], [2, 3, 4], [2, 4, 5], [0, 5, 6], [0, 6, 9], [6, 7, 8], [6, 8, 9]];
    let back = front.map(|[a, b, c]| [a + 10, c + 10, b + 10]);
    let rim = (0..10u16).flat_map(|a| {
        let b = (a + 1) % 10;
        [[a, a + 10, b + 10], [a, b + 10, b]]
    });
    let indices: Vec<u16> = front.into_iter().chain(back).chain(rim).flatten().collect();
    let positions = document.positions(&points);
    Shape { attributes: json!({ "POSITION": positions }), indices: Some(document.indices(&indices)) }
}
