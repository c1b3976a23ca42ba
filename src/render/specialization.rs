//! Maps features and offsets of lists to the values of a shader's specialization constants.

use crate::gpu::shaders::Shader;
use crate::pack::features::Features;
use crate::pack::{Sections, SlotCounts};
use crate::schema::constants::DYNAMIC;
use crate::schema::specialization::Constant;

/// Returns (constant id, value) for each constant of a shader: the features, the offsets of lists, the
/// workgroup's size and the numbers of descriptors. Constants that the shader does not have are left out.
pub fn constants(
    shader: &Shader,
    features: &Features,
    sections: &Sections,
    group: [u32; 2],
    slots: SlotCounts,
) -> Vec<(u32, u32)> {
    // A pipeline that keeps everything reads the offsets, so that all scenes share it.
    let place = |at| if features.everything { DYNAMIC } else { at };
    let places = sections.lists.iter().map(|&(list, at)| (Constant::At(list), place(at)));
    let parameters = [
        (Constant::PixelFilterAt, sections.pixel_filter),
        (Constant::GroupX, group[0]),
        (Constant::GroupY, group[1]),
        (Constant::Slots, slots.flat.max(1)),
        (Constant::VolumeSlots, slots.volumes.max(1)),
        (Constant::CubeSlots, slots.cubes.max(1)),
        (Constant::TexelBlocks, slots.texel_blocks.max(1)),
        (Constant::BlockLog2, slots.block_log2),
        (Constant::TexelQuads, u32::from(slots.texel_quads)),
    ];
    shader.values(features.values.iter().copied().chain(places).chain(parameters))
}
