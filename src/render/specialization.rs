//! Features and the places of lists → the values of a shader's specialization constants.

use crate::gpu::shaders::Shader;
use crate::pack::features::Features;
use crate::pack::{Sections, SlotCounts};
use crate::schema::specialization::Constant;

/// (specialization id, value) for a shader: the features, the lists' places, the workgroup's size
/// and the number of descriptors. A constant that the shader does not have is not set.
pub fn constants(
    shader: &Shader,
    features: &Features,
    sections: &Sections,
    group: [u32; 2],
    slots: SlotCounts,
) -> Vec<(u32, u32)> {
    let places = sections.lists.iter().map(|&(list, at)| (Constant::At(list), at));
    let parameters = [
        (Constant::PixelFilterAt, sections.pixel_filter),
        (Constant::GroupX, group[0]),
        (Constant::GroupY, group[1]),
        (Constant::Slots, slots.flat.max(1)),
        (Constant::VolumeSlots, slots.volumes.max(1)),
        (Constant::CubeSlots, slots.cubes.max(1)),
        (Constant::TexelBlocks, slots.texel_blocks.max(1)),
        (Constant::BlockLog2, slots.block_log2),
    ];
    shader.values(features.values.iter().copied().chain(places).chain(parameters))
}
