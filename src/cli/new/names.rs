//! What a picture of an artist's set is, by the usual words in its name. Input: a path. Output: a role, if a word says one.

use std::path::Path;

/// The part of a picture in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Color,
    Normal,
    Height,
    Roughness,
    Gloss,
    Metallic,
    /// Occlusion, roughness and metal in red, green and blue.
    Packed,
    /// Metal in red, and gloss in alpha, as Unity has them.
    MetalGloss,
    Occlusion,
    Emission,
    Opacity,
    Sky,
    /// Several maps in channels of another order than that of `Packed`, by the word.
    OtherPacked(&'static str),
    /// A map that no material has here, by the word.
    Other(&'static str),
}

const WORDS: [(Role, &[&str]); 12] = [
    (
        Role::Color,
        &["albedo", "basecolor", "basecolour", "diffuse", "diff", "color", "colour", "col", "alb", "bc"],
    ),
    (
        Role::Normal,
        &["normal", "normals", "normalmap", "nrm", "nor", "norm", "normalgl", "norgl", "normaldx", "nordx"],
    ),
    (Role::Height, &["height", "heightmap", "displacement", "disp", "bump", "hgt"]),
    (Role::Roughness, &["roughness", "rough", "rgh"]),
    (Role::Gloss, &["gloss", "glossiness", "smoothness"]),
    (Role::Metallic, &["metallic", "metalness", "metal", "met"]),
    (
        Role::Packed,
        &[
            "orm",
            "arm",
            "metallicroughness",
            "metalroughness",
            "metalrough",
            "roughnessmetallic",
            "occlusionroughnessmetallic",
        ],
    ),
    (Role::MetalGloss, &["metallicsmoothness", "metallicgloss", "metalsmoothness"]),
    (Role::Occlusion, &["ao", "occlusion", "ambientocclusion"]),
    (Role::Emission, &["emission", "emissive", "emit", "glow"]),
    (Role::Opacity, &["opacity", "alpha", "mask"]),
    (Role::Sky, &["sky", "hdri", "environment", "env", "panorama", "equirectangular"]),
];
const OTHER_PACKED: [&str; 8] = ["rma", "mra", "mro", "rmo", "ord", "ordp", "maskmap", "amr"];
const OTHERS: [&str; 18] = [
    "cavity",
    "specular",
    "spec",
    "reflection",
    "refl",
    "translucency",
    "transmission",
    "thickness",
    "fuzz",
    "sheen",
    "clearcoat",
    "anisotropy",
    "curvature",
    "scattering",
    "subsurface",
    "ior",
    "idmap",
    "brush",
];
/// The last letters of names that begin with T, as Unreal has them.
const LETTERS: [(&str, Role); 9] = [
    ("d", Role::Color),
    ("c", Role::Color),
    ("b", Role::Color),
    ("n", Role::Normal),
    ("r", Role::Roughness),
    ("m", Role::Metallic),
    ("h", Role::Height),
    ("e", Role::Emission),
    ("o", Role::Occlusion),
];
/// Words of names whose green points up in the picture, and down.
const UP: [&str; 5] = ["gl", "ogl", "opengl", "normalgl", "norgl"];
const DOWN: [&str; 4] = ["dx", "directx", "normaldx", "nordx"];
/// Most words that are one in a table: ambient occlusion, occlusion roughness metallic.
const MOST_JOINED: usize = 3;

impl Role {
    /// Returns the role that the last telling word of a name says.
    pub fn of(path: &Path) -> Option<Role> {
        let stem = path.file_stem()?.to_string_lossy();
        let (words, lower) = (words(&stem), stem.to_lowercase());
        let joined = |end: usize| {
            let runs = (end.saturating_sub(MOST_JOINED)..end).map(|start| words[start..end].concat());
            let known = runs.filter_map(|word| Some((Role::of_word(&word)?, lower.contains(&word))));
            // Rusty_Metal_Roughness is the roughness of a metal.
            known.filter(|(role, is_one)| *is_one || *role != Role::Packed).map(|(role, _)| role).next()
        };
        (1..=words.len()).rev().find_map(joined).or_else(|| {
            let letter = words.last().filter(|_| words.len() > 2 && words[0] == "t")?;
            LETTERS.iter().find(|(known, _)| known == letter).map(|(_, role)| *role)
        })
    }

    fn of_word(word: &str) -> Option<Role> {
        let in_list = |list: &'static [&'static str]| list.iter().find(|known| **known == word).copied();
        let known = WORDS.iter().find(|(_, words)| words.contains(&word)).map(|(role, _)| *role);
        known
            .or_else(|| in_list(&OTHER_PACKED).map(Role::OtherPacked))
            .or_else(|| in_list(&OTHERS).map(Role::Other))
    }

    /// Returns the role in words.
    pub fn words(self) -> &'static str {
        match self {
            Role::Color => "colors",
            Role::Normal => "a normal map",
            Role::Height => "heights",
            Role::Roughness => "roughness",
            Role::Gloss => "gloss",
            Role::Metallic => "metal",
            Role::Packed => "occlusion, roughness and metal in red, green and blue",
            Role::MetalGloss => "metal and gloss in red and alpha",
            Role::Occlusion => "occlusion",
            Role::Emission => "emission",
            Role::Opacity => "opacity",
            Role::Sky => "a sky",
            Role::OtherPacked(word) | Role::Other(word) => word,
        }
    }
}

/// Returns whether the green of a normal map points up in the picture (OpenGL), or down (DirectX), if the name says so.
pub(super) fn green_is_up(path: &Path) -> Option<bool> {
    let words = words(&path.file_stem()?.to_string_lossy());
    let has = |list: &[&str]| {
        let pairs = words.windows(2).map(<[String]>::concat);
        words.iter().cloned().chain(pairs).any(|word| list.contains(&word.as_str()))
    };
    if has(&DOWN) { Some(false) } else { has(&UP).then_some(true) }
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
            ("Bricks076_1K-JPG_AmbientOcclusion.jpg", Some(Role::Occlusion)),
            ("Bricks076_1K-JPG_Displacement.jpg", Some(Role::Height)),
            ("Bricks076_1K-JPG_Metalness.jpg", Some(Role::Metallic)),
            ("Bricks076_1K-JPG_Opacity.jpg", Some(Role::Opacity)),
            ("metal_plate_diff_1k.png", Some(Role::Color)),
            ("metal_plate_rough_1k.png", Some(Role::Roughness)),
            ("metal_plate_arm_1k.png", Some(Role::Packed)),
            ("rock-baseColor.png", Some(Role::Color)),
            ("rock_base_color.png", Some(Role::Color)),
            ("RockWall Roughness.tif", Some(Role::Roughness)),
            ("Rock_OcclusionRoughnessMetallic.png", Some(Role::Packed)),
            ("Rock_metallicRoughness.png", Some(Role::Packed)),
            ("Rock_MetallicSmoothness.png", Some(Role::MetalGloss)),
            ("rusty_metal_rough.png", Some(Role::Roughness)),
            ("Rock_MaskMap.png", Some(Role::OtherPacked("maskmap"))),
            ("Rock_RMA.png", Some(Role::OtherPacked("rma"))),
            ("vbrick_2K_Cavity.jpg", Some(Role::Other("cavity"))),
            ("vbrick_2K_Specular.jpg", Some(Role::Other("specular"))),
            ("wood_ao.png", Some(Role::Occlusion)),
            ("wood_disp.png", Some(Role::Height)),
            ("T_Brick_D.png", Some(Role::Color)),
            ("T_Brick_N.png", Some(Role::Normal)),
            ("T_Brick_ORM.png", Some(Role::Packed)),
            ("Vitamin_D.png", None),
            ("T_N.png", None),
            ("kloofendal_sky_2k.hdr", Some(Role::Sky)),
            ("holiday.jpg", None),
            ("colander.jpg", None),
        ] {
            assert_eq!(Role::of(Path::new(name)), role, "{name}");
        }
    }

    #[test]
    fn names_say_where_the_green_of_normals_points() {
        for (name, up) in [
            ("Bricks076_1K-JPG_NormalGL.jpg", Some(true)),
            ("Bricks076_1K-JPG_NormalDX.jpg", Some(false)),
            ("brick_nor_gl_4k.exr", Some(true)),
            ("brick_nor_dx_4k.exr", Some(false)),
            ("Brick_Normal_OpenGL.png", Some(true)),
            ("Brick_Normal_DirectX.png", Some(false)),
            ("Brick_Normal_OGL.png", Some(true)),
            ("Brick_Normal.png", None),
        ] {
            assert_eq!(Role::of(Path::new(name)), Some(Role::Normal), "{name}");
            assert_eq!(green_is_up(Path::new(name)), up, "{name}");
        }
    }
}
