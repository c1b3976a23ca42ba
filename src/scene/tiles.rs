//! Materials whose textures are UDIM tiles. Input: a scene whose materials map whole squares of the texture plane. Output:
//! the same scene with coordinates that cover the picture of all tiles once, or a refusal.

use glam::DVec2;

use super::model::Scene;
use super::refusal::{Check, Key};
use crate::texture::source::{TextureContent, TextureSource};

/// Scales the coordinates of materials from squares to the picture of all squares.
pub(super) fn apply(scene: &mut Scene) -> Check {
    let textures = &scene.textures;
    for (index, material) in scene.materials.iter_mut().enumerate() {
        let sources: Vec<&TextureSource> = material.textures().map(|used| &textures[used.texture]).collect();
        let Some(&source) = sources.first() else { continue };
        let key = Key::item("material", index).of("mapping");
        let [columns, rows] = grid(source);
        if sources.iter().any(|other| grid(other) != [columns, rows]) {
            let what = "its textures have other numbers of tiles than each other, and one mapping for all; give all of \
                        them the same tiles, or none";
            return key.refuse(what, "tiles differ");
        }
        if !is_tiled(source) {
            continue;
        }
        if material.mapping.rotate != 0.0 && columns != rows {
            let what = format!("a texture of {columns}×{rows} tiles cannot be rotated; leave rotate out");
            return key.refuse(what, "rotates tiles");
        }
        let squares = DVec2::new(columns.into(), rows.into());
        // v grows downwards from the lowest row of tiles, which is the last one of the picture.
        let lowest = if source.flip_v { 0.0 } else { f64::from(rows - 1) };
        material.mapping.scale /= squares;
        material.mapping.offset = (material.mapping.offset + DVec2::new(0.0, lowest)) / squares;
    }
    Ok(())
}

fn is_tiled(source: &TextureSource) -> bool {
    matches!(source.content, TextureContent::Tiles(_))
}

fn grid(source: &TextureSource) -> [u32; 2] {
    match &source.content {
        TextureContent::Tiles(set) => set.grid(),
        _ => [1, 1],
    }
}
