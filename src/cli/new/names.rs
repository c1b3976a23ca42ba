//! What a picture of an artist's set is, by the usual words in its name. Input: a path. Output: a role, if a word says one.

use std::path::Path;

/// The part of a picture in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Color,
    /// A normal map whose green points up in the picture (OpenGL), or down (DirectX).
    Normal,
    NormalDown,
    Height,
    Roughness,
    Gloss,
    Metallic,
    /// Occlusion, roughness and metal in red, green and blue.
    Packed,
    Occlusion,
    Emission,
    Opacity,
    Sky,
}

const WORDS: [(Role, &[&str]); 11] = [
    (Role::Color, &["albedo", "basecolor", "basecolour", "diffuse", "diff", "color", "colour", "col", "alb"]),
    (Role::Normal, &["normal", "normals", "normalmap", "nrm", "nor", "norm", "normalgl", "norgl"]),
    (Role::NormalDown, &["normaldx", "nordx"]),
    (Role::Height, &["height", "heightmap", "displacement", "disp", "bump", "hgt"]),
    (Role::Roughness, &["roughness", "rough", "rgh"]),
    (Role::Gloss, &["gloss", "glossiness", "smoothness"]),
    (Role::Metallic, &["metallic", "metalness", "metal", "met"]),
    (Role::Packed, &["orm", "arm"]),
    (Role::Occlusion, &["ao", "occlusion", "ambientocclusion"]),
    (Role::Emission, &["emission", "emissive", "emit", "glow"]),
    (Role::Opacity, &["opacity", "alpha", "mask"]),
];
const SKIES: [&str; 6] = ["sky", "hdri", "environment", "env", "panorama", "equirectangular"];

impl Role {
    /// Returns the role that the last telling word of a name says.
    pub fn of(path: &Path) -> Option<Role> {
        let stem = path.file_stem()?.to_string_lossy().into_owned();
        let words = words(&stem);
        let said = words.iter().rev().find_map(|word| Role::of_word(word))?;
        let is_direct_x = words.iter().any(|word| ["dx", "directx"].contains(&word.as_str()));
        Some(if said == Role::Normal && is_direct_x { Role::NormalDown } else { said })
    }

    fn of_word(word: &str) -> Option<Role> {
        if SKIES.contains(&word) {
            return Some(Role::Sky);
        }
        WORDS.iter().find(|(_, words)| words.contains(&word)).map(|(role, _)| *role)
    }

    /// Returns the role in words.
    pub fn words(self) -> &'static str {
        match self {
            Role::Color => "colors",
            Role::Normal => "a normal map whose green points up in the picture",
            Role::NormalDown => "a normal map whose green points down in the picture (DirectX)",
            Role::Height => "heights",
            Role::Roughness => "roughness",
            Role::Gloss => "gloss",
            Role::Metallic => "metal",
            Role::Packed => "occlusion, roughness and metal in red, green and blue",
            Role::Occlusion => "occlusion",
            Role::Emission => "emission",
            Role::Opacity => "opacity",
            Role::Sky => "a sky",
        }
    }
}

/// Returns the words of a name in lower case: `RockWall_NormalGL-2K` has rock, wall, normalgl and 2k.
fn words(stem: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut was_lower = false;
    for c in stem.chars() {
        // GL and DX stay with the word before them.
        let begins = c.is_uppercase() && was_lower && !matches!(c, 'G' | 'D');
        if !c.is_alphanumeric() || begins {
            words.push(String::new());
        }
        if c.is_alphanumeric() {
            words.last_mut().into_iter().for_each(|word| word.extend(c.to_lowercase()));
        }
        was_lower = c.is_lowercase();
    }
    words.retain(|word| !word.is_empty());
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_usual_names_of_sets_say_what_files_are() {
        for (name, role) in [
            ("Bricks076_1K-JPG_Color.jpg", Some(Role::Color)),
            ("Bricks076_1K-JPG_NormalGL.jpg", Some(Role::Normal)),
            ("Bricks076_1K-JPG_NormalDX.jpg", Some(Role::NormalDown)),
            ("metal_plate_diff_1k.png", Some(Role::Color)),
            ("metal_plate_nor_gl_1k.png", Some(Role::Normal)),
            ("metal_plate_nor_dx_1k.png", Some(Role::NormalDown)),
            ("metal_plate_rough_1k.png", Some(Role::Roughness)),
            ("metal_plate_arm_1k.png", Some(Role::Packed)),
            ("rock-baseColor.png", Some(Role::Color)),
            ("RockWall Roughness.tif", Some(Role::Roughness)),
            ("wood_ao.png", Some(Role::Occlusion)),
            ("wood_disp.png", Some(Role::Height)),
            ("kloofendal_sky_2k.hdr", Some(Role::Sky)),
            ("holiday.jpg", None),
            ("colander.jpg", None),
        ] {
            assert_eq!(Role::of(Path::new(name)), role, "{name}");
        }
    }
}
