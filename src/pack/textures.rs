//! Packs textures and samplers into texel bytes, records and image slots.

use glam::{UVec3, Vec4};

use crate::core::color::srgb_table;
use crate::core::error::{Error, Result};
use crate::scene::model::{Footprint, Scene};
use crate::schema::layout::{self, Texture};
use crate::texture::data::{ColorSpace, Component, Dimension, MipKernel, TextureData};
use crate::texture::room::{bytes_of_levels, check_room, no_room};
use crate::texture::sampler_spec::{Method, MipMode, SamplerSpec};
use crate::texture::{mips, prefix_sums, summed};

use super::texel_format::{linear_floats, needs_linear_floats, without_equal_channels};
use super::texture_readers::readers;
use super::{LevelMaker, MipPlacement, PackedScene, TextureKind, stored_levels};

/// One image descriptor: a texture and its sampler. Look-ups of method shader fetch texels and ignore the sampler, so
/// all of them share one slot per texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    pub texture: usize,
    pub sampler: usize,
    pub hardware: bool,
}

/// Largest number of image descriptors (`SLOT_SWITCH` in `texture.glsl`).
pub const MAX_SLOTS: usize = 16;

/// Packs a sampler. Without a footprint every look-up magnifies in level 0: properties of minification are left out.
pub fn sampler(spec: &SamplerSpec, filtered: bool) -> layout::Sampler {
    let (min, mip) = if filtered { (spec.min, spec.mip) } else { (spec.mag, MipMode::None) };
    layout::Sampler {
        border: Vec4::from_array(spec.border_color),
        address_u: spec.address[0],
        address_v: spec.address[1],
        address_w: spec.address_w,
        texel_center: spec.texel_center,
        method: spec.method,
        mag_filter: spec.mag,
        min_filter: min,
        mip_mode: mip,
        max_anisotropy: spec.max_anisotropy,
        crosses_poles: false,
        cubic_b: spec.cubic[0],
        cubic_c: spec.cubic[1],
    }
}

/// Appends all texels to the texel buffer, first those that images cannot hold. The texels of the first texture are
/// moved, not copied.
pub fn pack_textures(
    packed: &mut PackedScene,
    scene: &Scene,
    textures: Vec<TextureData>,
    mip_chains: MipPlacement,
    level_maker: &mut dyn LevelMaker,
) -> Result<()> {
    let mut order: Vec<usize> = (0..textures.len()).collect();
    let tables = |i: usize, packed: &PackedScene| reads(packed, scene, i, SamplerSpec::needs_sums);
    let pooled: Vec<bool> =
        order.iter().map(|&i| kind(&textures[i]) != TextureKind::Flat || tables(i, packed)).collect();
    order.sort_by_key(|&i| !pooled[i]);
    packed.records.textures = vec![layout::Texture::default(); textures.len()];
    packed.texture_names = textures.iter().map(|t| t.name.clone()).collect();
    packed.file_channels = textures.iter().map(|t| t.file_channels).collect();
    let mut textures: Vec<Option<TextureData>> = textures.into_iter().map(Some).collect();
    for index in order {
        let Some(texture) = textures[index].take() else { continue };
        if let Some(procedural) = scene.textures.get(index).and_then(|t| t.content.procedural()) {
            packed.records.textures[index] = Texture {
                size: UVec3::ONE,
                levels: 1,
                kind: TextureKind::Procedural,
                procedural: packed.records.procedurals.len() as u32,
                ..Texture::default()
            };
            packed.records.procedurals.push(super::procedural(procedural));
            continue;
        }
        let reads_levels = reads(packed, scene, index, SamplerSpec::reads_levels);
        let kernel =
            if reads_levels { stored_levels::kernel(scene, index, &texture)? } else { MipKernel::Box };
        let mut texture = texture;
        if kernel != MipKernel::Stored {
            texture.stored_levels.clear();
        }
        let texture = without_equal_channels(texture)?;
        let mut texture =
            if needs_linear_floats(&texture, scene, index) { linear_floats(&texture)? } else { texture };
        let kind = kind(&texture);
        let levels = if !reads_levels {
            Vec::new()
        } else if kernel == MipKernel::Stored {
            std::mem::take(&mut texture.stored_levels)
        } else if packed.nonfinite_texels[index] > 0 {
            // Copies of the texels and their shares, and the levels of both.
            let bytes = 2 * (texture.texels.len() + bytes_of_levels(&texture, kernel));
            check_room(&texture, "its mip levels", bytes)?;
            mips::mip_chain_of_finite(&texture)
        } else if mip_chains.leaves(&texture, kernel) {
            packed.device_levels.push(index);
            check_room(&texture, "its mip levels", bytes_of_levels(&texture, kernel))?;
            mips::zeroed_levels(&texture)
        } else {
            check_room(&texture, "its mip levels", bytes_of_levels(&texture, kernel))?;
            level_maker.levels(index, &texture, kernel)
        };
        let record = Texture {
            size: UVec3::new(texture.width, texture.height, texture.depth),
            format: texture.format,
            color_space: texture.color_space,
            levels: 1 + levels.len() as u32,
            kind,
            ..Texture::default()
        };
        let table = if tables(index, packed) {
            let bytes = summed::words(&texture) * size_of::<u32>();
            check_room(&texture, "its summed-area table", bytes)?;
            Some(summed::table(&texture))
        } else {
            None
        };
        let first_word = append(packed, texture, levels, table)?;
        packed.records.textures[index] = Texture { first_word, ..record };
        if pooled[index] {
            packed.solid_bytes = packed.texels.len();
        }
    }
    Ok(())
}

pub fn kind(texture: &TextureData) -> TextureKind {
    match texture.dimension {
        Dimension::One | Dimension::Two => TextureKind::Flat,
        Dimension::Three => TextureKind::Volume,
        Dimension::Cube => TextureKind::Cube,
    }
}

/// Returns for each texture the offset of its prefix sums, 0 if it is not 2D, followed by those sums.
pub fn prefix_sums(textures: &[TextureData]) -> Vec<u32> {
    // One word more than needed: no table is at offset 0, and a buffer must not be empty.
    let mut words = vec![0; textures.len() + 1];
    for (i, texture) in textures.iter().enumerate().filter(|(_, t)| t.dimension == Dimension::Two) {
        words[i] = words.len() as u32;
        let table = prefix_sums::table(texture, words.len());
        words.extend(table);
    }
    words
}

/// Returns the number of words of all prefix sums.
pub fn prefix_sum_words(textures: &[TextureData]) -> u64 {
    let flat = textures.iter().filter(|t| t.dimension == Dimension::Two);
    textures.len() as u64 + 1 + flat.map(prefix_sums::words).sum::<u64>()
}

/// Returns true if some sampler that minifies this texture satisfies `such`.
pub(super) fn reads(
    packed: &PackedScene,
    scene: &Scene,
    texture: usize,
    such: impl Fn(&SamplerSpec) -> bool,
) -> bool {
    packed.header.footprint != Footprint::None && readers(scene, texture).any(such)
}

/// Returns the texture's first word, which is the offset of level 0. The words before it are the offsets of the other
/// levels, level 1 last; before them, if there is a summed-area table, its offset.
fn append(
    packed: &mut PackedScene,
    texture: TextureData,
    levels: Vec<TextureData>,
    table: Option<Vec<u32>>,
) -> Result<u32> {
    let pointers = levels.len() + usize::from(table.is_some());
    let start = packed.texels.len() / 4 + pointers;
    let mut words = Vec::with_capacity(pointers);
    let mut end = start + texture.texels.len().div_ceil(4);
    for level in &levels {
        words.push(end);
        end += level.texels.len().div_ceil(4);
    }
    if let Some(table) = &table {
        words.push(end);
        end += table.len();
    }
    if u32::try_from(end).is_err() {
        return Err(Error::with_help(
            format!("texture \"{}\": all textures together exceed 16 GiB", texture.name),
            "use smaller textures, or fewer",
        ));
    }
    let more = |held: usize| end * 4 - held;
    let no_room = |held: usize| no_room(&texture.name, "its texels", more(held));
    let pointers: Vec<u8> = words.iter().rev().flat_map(|&word| (word as u32).to_ne_bytes()).collect();
    if packed.texels.is_empty() {
        packed.texels = texture.texels;
        let held = packed.texels.len();
        packed.texels.try_reserve_exact(more(held)).map_err(|_| no_room(held))?;
        packed.texels.splice(0..0, pointers);
    } else {
        let held = packed.texels.len();
        packed.texels.try_reserve_exact(more(held)).map_err(|_| no_room(held))?;
        packed.texels.extend(pointers);
        packed.texels.extend_from_slice(&texture.texels);
    }
    let fill = |texels: &mut Vec<u8>| texels.resize(texels.len().next_multiple_of(4), 0);
    fill(&mut packed.texels);
    for level in levels {
        packed.texels.extend_from_slice(&level.texels);
        fill(&mut packed.texels);
    }
    if let Some(table) = table {
        packed.texels.extend_from_slice(bytemuck::cast_slice(&table));
        packed.summed_tables = true;
    }
    Ok(start as u32)
}

/// Returns the slot of this pair among those of its kind, new or shared; textures that need no image have none.
pub fn slot(packed: &mut PackedScene, texture: usize, sampler: usize) -> u32 {
    let hardware = packed.sampler_specs[sampler].method == Method::Hardware;
    let slots = match packed.records.textures[texture].kind {
        TextureKind::Flat => &mut packed.slots,
        TextureKind::Procedural => return 0,
        _ if !hardware => return 0,
        TextureKind::Volume => &mut packed.volume_slots,
        TextureKind::Cube => &mut packed.cube_slots,
    };
    let same =
        |s: &Slot| s.texture == texture && s.hardware == hardware && (!hardware || s.sampler == sampler);
    let index = slots.iter().position(same).unwrap_or_else(|| {
        slots.push(Slot { texture, sampler, hardware });
        slots.len() - 1
    });
    index as u32
}

impl PackedScene {
    /// Returns the linear values of all codes of 8-bit sRGB, then of 16-bit sRGB, if the scene has any.
    pub fn srgb_light(&self) -> Vec<f32> {
        let of = |component: Component| srgb_table(component.codes());
        match (self.has_srgb(Component::Unorm8), self.has_srgb(Component::Unorm16)) {
            (false, false) => Vec::new(),
            (true, false) => of(Component::Unorm8).to_vec(),
            (_, true) => [of(Component::Unorm8), of(Component::Unorm16)].concat(),
        }
    }

    /// Returns true if some texture has sRGB codes of this type.
    pub fn has_srgb(&self, component: Component) -> bool {
        self.records
            .textures
            .iter()
            .any(|t| t.color_space == ColorSpace::Srgb && t.format.component() == component)
    }

    /// Returns width, height and depth of a level (Vulkan 1.3, "Image Miplevel Sizing"); the depth of a cube is 6.
    pub fn level_size(&self, texture: usize, level: u32) -> [u32; 3] {
        let Texture { size, kind, .. } = self.records.textures[texture];
        let [width, height, depth] = size.to_array();
        let halved = |n: u32| (n >> level).max(1);
        let depth = if kind == TextureKind::Volume { halved(depth) } else { depth };
        [halved(width), halved(height), depth]
    }

    /// Returns the texels of a level.
    pub fn level_texels(&self, texture: usize, level: u32) -> &[u8] {
        let Texture { first_word, format, .. } = self.records.textures[texture];
        let start = self.level_word(first_word, level) as usize * 4;
        let [width, height, depth] = self.level_size(texture, level).map(|n| n as usize);
        let bytes = width * height * depth * format.bytes_per_texel();
        &self.texels[start..start + bytes]
    }

    /// Returns the offset of a level of the texture whose level 0 is at `first_word`.
    pub fn level_word(&self, first_word: u32, level: u32) -> u32 {
        if level == 0 {
            return first_word;
        }
        let at = (first_word - level) as usize * 4;
        let word = &self.texels[at..at + 4];
        u32::from_ne_bytes([word[0], word[1], word[2], word[3]])
    }
}
