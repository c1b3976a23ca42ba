//! Wavefront MTL, the materials of OBJ files. Input: the text of a file. Output: its materials in its order, with
//! those statements that describe a surface and its textures, and what is told of others that change its look. Nothing
//! is opened here: what the values mean to a renderer is for the caller to say.

use super::text::{first_word, lines, number, quoted, words};
use super::{Fault, MAX_MATERIALS};
use crate::core::number::shown;

/// Material as the file has it; what it does not say is absent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MtlMaterial {
    /// As `usemtl` names it.
    pub name: String,
    /// `Kd`.
    pub diffuse: Option<[f64; 3]>,
    /// `Ks`.
    pub specular: Option<[f64; 3]>,
    /// `Ns`, the exponent of Phong's model.
    pub exponent: Option<f64>,
    /// `Ni`, the index of refraction.
    pub ior: Option<f64>,
    /// `d`, or 1 − `Tr`: how much the surface covers.
    pub opacity: Option<f64>,
    /// `Tf`, the colour of light that passes.
    pub filter: Option<[f64; 3]>,
    /// `Pr`, the roughness of physically based materials.
    pub roughness: Option<f64>,
    /// `Pm`, how much it is a metal.
    pub metallic: Option<f64>,
    /// `illum`, the number of the lighting model.
    pub illumination: Option<u32>,
    /// `map_Kd`.
    pub diffuse_map: Option<MtlMap>,
    /// `map_Pr`.
    pub roughness_map: Option<MtlMap>,
    /// `map_Pm`.
    pub metallic_map: Option<MtlMap>,
    /// `map_Bump` or `bump`, heights.
    pub bump_map: Option<MtlMap>,
    /// `norm`, normals in tangent space.
    pub normal_map: Option<MtlMap>,
    /// `map_d`.
    pub opacity_map: Option<MtlMap>,
    /// `Ke`.
    pub emission: Option<[f64; 3]>,
    /// `map_Ke`.
    pub emission_map: Option<MtlMap>,
    /// Statements that change its look and are not read, with the first line of each.
    pub notes: Vec<String>,
}

impl MtlMaterial {
    /// Returns the material of a surface that shows a picture.
    pub(super) fn of_picture(file: &str) -> MtlMaterial {
        let map = MtlMap::of_file(file.replace('\\', "/"), 0);
        MtlMaterial { name: file.to_owned(), diffuse_map: Some(map), ..MtlMaterial::default() }
    }
}

/// Texture of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct MtlMap {
    /// As written, but with `/` between folders.
    pub file: String,
    /// `-s`, by which texture coordinates are multiplied.
    pub scale: [f64; 2],
    /// `-o`, added to texture coordinates after the scale.
    pub offset: [f64; 2],
    /// `-clamp on`: the texture does not repeat.
    pub clamp: bool,
    /// `-bm`, the factor of a bump map.
    pub strength: Option<f64>,
    /// Line of the file, from 1; 0 outside of MTL files.
    pub line: usize,
}

impl MtlMap {
    fn of_file(file: String, line: usize) -> MtlMap {
        MtlMap { file, scale: [1.0; 2], offset: [0.0; 2], clamp: false, strength: None, line }
    }
}

/// Reads the materials of a file.
pub fn read(bytes: &[u8]) -> Result<Vec<MtlMaterial>, Fault> {
    let mut materials: Vec<MtlMaterial> = Vec::new();
    for (number, line) in lines(bytes)? {
        let (keyword, rest) = first_word(&line);
        if keyword.eq_ignore_ascii_case(b"newmtl") {
            if materials.len() == MAX_MATERIALS {
                let what = format!("more than {MAX_MATERIALS} materials, the most that a library may have");
                return Err(Fault::new(format!("line {number}"), what));
            }
            materials.push(MtlMaterial { name: name(rest), ..MtlMaterial::default() });
        } else if let Some(material) = materials.last_mut() {
            // Before the first material, a statement describes none.
            let read = statement(material, keyword, rest, number);
            read.map_err(|what| Fault::new(format!("line {number}"), what))?;
            material.notes.extend(told(keyword, rest).map(|what| format!("line {number}: {what}")));
        }
    }
    Ok(materials)
}

/// Statements that change the look of a surface and are not read.
const UNREAD: [&str; 7] = ["map_ks", "map_ns", "disp", "map_disp", "refl", "map_refl", "decal"];

/// Reads a statement into its material, or returns what is wrong with it.
fn statement(material: &mut MtlMaterial, keyword: &[u8], rest: &[u8], line: usize) -> Result<(), String> {
    // Programs disagree on capitals, most of all in the names of maps.
    match keyword.to_ascii_lowercase().as_slice() {
        b"kd" => material.diffuse = color(rest)?.or(material.diffuse),
        b"ks" => material.specular = color(rest)?.or(material.specular),
        b"ke" => material.emission = color(rest)?.or(material.emission),
        b"ns" => material.exponent = Some(number(first_value(rest))?),
        b"ni" => material.ior = Some(number(first_value(rest))?),
        b"d" => material.opacity = Some(share(rest)?),
        // Programs that write both mean `d`, wherever it stands.
        b"tr" => material.opacity = material.opacity.or(Some(1.0 - share(rest)?)),
        b"tf" => material.filter = color(rest)?.or(material.filter),
        b"pr" => material.roughness = Some(number(first_value(rest))?),
        b"pm" => material.metallic = Some(number(first_value(rest))?),
        b"illum" => material.illumination = Some(whole(first_value(rest))?),
        b"map_kd" => material.diffuse_map = map(rest, line)?,
        b"map_ke" => material.emission_map = map(rest, line)?,
        b"map_d" => material.opacity_map = map(rest, line)?,
        b"map_pr" => material.roughness_map = map(rest, line)?,
        b"map_pm" => material.metallic_map = map(rest, line)?,
        b"map_bump" | b"bump" => material.bump_map = map(rest, line)?,
        b"norm" => material.normal_map = map(rest, line)?,
        _ => {}
    }
    Ok(())
}

/// Returns what is told of a statement that is not read as it stands.
fn told(keyword: &[u8], rest: &[u8]) -> Option<String> {
    let shown = String::from_utf8_lossy(keyword);
    let lower = shown.to_ascii_lowercase();
    match lower.as_str() {
        "kd" | "ks" | "ke" | "tf" if is_spectral(rest) => {
            Some(format!("{shown} is given by a spectrum or in XYZ, which is not read"))
        }
        "map_kd" | "map_ke" | "map_d" | "map_pr" | "map_pm" | "map_bump" | "bump" | "norm"
            if rest.is_empty() =>
        {
            Some(format!("{shown} names no file"))
        }
        other => UNREAD.contains(&other).then(|| format!("{shown} is not drawn")),
    }
}

/// Reads a number from 0 to 1, behind the option of a halo.
fn share(rest: &[u8]) -> Result<f64, String> {
    let share = number(words(rest).find(|word| *word != b"-halo").unwrap_or_default())?;
    let is_share = (0.0..=1.0).contains(&share);
    if is_share { Ok(share) } else { Err(format!("{} is out of range; 0 to 1 is allowed", shown(share))) }
}

fn is_spectral(rest: &[u8]) -> bool {
    [&b"spectral"[..], b"xyz"].contains(&first_value(rest))
}

/// Reads a colour, or nothing if it is given by a spectrum or in XYZ.
fn color(rest: &[u8]) -> Result<Option<[f64; 3]>, String> {
    if is_spectral(rest) {
        return Ok(None);
    }
    let values: Vec<f64> = words(rest).take(3).map(number).collect::<Result<_, _>>()?;
    if let Some(negative) = values.iter().find(|value| **value < 0.0) {
        return Err(format!("colour has {}; numbers from 0 are allowed", shown(*negative)));
    }
    match *values.as_slice() {
        [grey] => Ok(Some([grey; 3])),
        [r, g, b] => Ok(Some([r, g, b])),
        _ => Err(format!("colour has {} numbers; it needs 1 or 3", values.len())),
    }
}

/// Reads a texture, or nothing if no file is named.
fn map(mut rest: &[u8], line: usize) -> Result<Option<MtlMap>, String> {
    let mut map = MtlMap::of_file(String::new(), line);
    while let Some(after) = option(&mut map, rest)? {
        rest = after;
    }
    map.file = name(rest).replace('\\', "/");
    // Some programs write the statement for textures that are not there.
    Ok(Some(map).filter(|map| !map.file.is_empty()))
}

/// Reads an option of a texture and returns what follows it, or nothing if the file name is next.
fn option<'a>(map: &mut MtlMap, rest: &'a [u8]) -> Result<Option<&'a [u8]>, String> {
    let (option, after) = first_word(rest);
    let (argument, after_one) = first_word(after);
    let after = match option {
        b"-s" => vector(after, &mut map.scale)?,
        b"-o" => vector(after, &mut map.offset)?,
        b"-t" => vector(after, &mut [0.0; 2])?,
        b"-clamp" => {
            map.clamp = switch(argument)?;
            after_one
        }
        b"-bm" => {
            map.strength = Some(number(argument)?);
            after_one
        }
        b"-mm" => first_word(after_one).1,
        b"-blendu" | b"-blendv" | b"-boost" | b"-cc" | b"-texres" | b"-type" | b"-imfchan" => after_one,
        _ => return Ok(None),
    };
    Ok(Some(after))
}

/// Reads one to three numbers, of which the first two are kept, and returns what follows them.
fn vector<'a>(rest: &'a [u8], kept: &mut [f64; 2]) -> Result<&'a [u8], String> {
    let (first, mut rest) = first_word(rest);
    kept[0] = number(first)?;
    for i in 1..3 {
        let (word, after) = first_word(rest);
        // The last word is the file, even if it reads as a number.
        let Some(value) = number(word).ok().filter(|_| !after.is_empty()) else {
            break;
        };
        if let Some(slot) = kept.get_mut(i) {
            *slot = value;
        }
        rest = after;
    }
    Ok(rest)
}

/// Reads `on` or `off`.
fn switch(word: &[u8]) -> Result<bool, String> {
    match word {
        b"on" => Ok(true),
        b"off" => Ok(false),
        _ => Err(format!("{} is neither on nor off", quoted(word))),
    }
}

/// Reads a whole number.
fn whole(word: &[u8]) -> Result<u32, String> {
    let parsed = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
    parsed.ok_or_else(|| format!("{} is no whole number from 0", quoted(word)))
}

/// Returns the first word of the arguments, empty if there is none.
fn first_value(rest: &[u8]) -> &[u8] {
    words(rest).next().unwrap_or_default()
}

/// Turns the rest of a line into a name.
fn name(rest: &[u8]) -> String {
    String::from_utf8_lossy(rest).into_owned()
}

#[cfg(test)]
mod tests;
