//! The texel that a look-up reads at its centre. Input: a look-up. Output: its place among the texels, row 0 at v = 0, and
//! where it lies in the file, where that is another place: rows that were turned over, and tiles.

use serde_json::{Value, json};

use crate::oracle::quantities::{LookUp, place_in_tile};
use crate::pack::TextureKind;
use crate::texture::sampler_spec::{Address, TexelCenter};
use crate::texture::source::{TextureContent, TextureSource};

/// Faces of a cube in their order.
const FACES: [&str; 6] = ["+x", "−x", "+y", "−y", "+z", "−z"];

/// Returns the texel of level 0 in which the centre lies: column and row, of a volume the slice, too; none beyond a border.
pub fn texel(look_up: &LookUp<'_>) -> Option<Vec<u32>> {
    let LookUp { image, how, coordinate, .. } = look_up;
    let modes = [how.address_u, how.address_v, how.address_w];
    let axes = if image.kind == TextureKind::Volume { 3 } else { 2 };
    let index = |axis: usize| {
        let size = f64::from(image.size[axis]);
        let mode = if image.kind == TextureKind::Cube { Address::ClampToEdge } else { modes[axis] };
        let shift = if how.texel_center == TexelCenter::Integer { 0.5 / size } else { 0.0 };
        let at = coordinate.at[axis] + shift;
        if mode == Address::ClampToBorder && !(0.0..1.0).contains(&at) {
            return None;
        }
        Some(((place_in_tile(mode, at) * size).floor().max(0.0) as u32).min(image.size[axis] - 1))
    };
    (0..axes).map(index).collect()
}

/// Returns the face of a cube that is read.
pub fn face(look_up: &LookUp<'_>) -> Option<&'static str> {
    (look_up.image.kind == TextureKind::Cube).then(|| FACES.get(look_up.face as usize).copied()).flatten()
}

/// Returns where a texel lies in the texture's file, if that is not where it lies in the texture.
pub fn in_file(source: &TextureSource, texel: &[u32], size: [u32; 2]) -> Option<Value> {
    let &[x, y] = texel else { return None };
    let row = if source.flip_v { size[1] - 1 - y } else { y };
    if let TextureContent::Tiles(set) = &source.content {
        let [columns, rows] = set.grid();
        let tile = [size[0] / columns, size[1] / rows];
        let number = 1001 + x / tile[0] + 10 * (rows - 1 - row / tile[1]);
        return Some(json!({ "tile": number, "texel": [x % tile[0], row % tile[1]], "size": tile }));
    }
    source.flip_v.then(|| json!({ "texel": [x, row], "size": size }))
}
