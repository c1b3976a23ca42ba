//! Features and the places of lists → the values of a shader's specialization constants.

use crate::gpu::shaders::Shader;
use crate::pack::features::Features;
use crate::pack::{Sections, SlotCounts};

/// (specialization id, value) for a shader: the features, the lists' places, the workgroup's size
/// and the number of descriptors. A constant that the shader does not have is not set.
pub fn constants(
    shader: &Shader,
    features: &Features,
    sections: &Sections,
    group: [u32; 2],
    slots: SlotCounts,
) -> Vec<(u32, u32)> {
    let places = [
        ("PLANES_AT", sections.planes),
        ("SPHERES_AT", sections.spheres),
        ("TRIANGLES_AT", sections.triangles),
        ("LIGHTS_AT", sections.lights),
        ("MATERIALS_AT", sections.materials),
        ("MAPS_AT", sections.maps),
        ("TEXTURES_AT", sections.textures),
        ("SAMPLERS_AT", sections.samplers),
        ("PROCEDURALS_AT", sections.procedurals),
        ("MOTIONS_AT", sections.motions),
        ("PIXEL_FILTER_AT", sections.pixel_filter),
        ("GROUP_X", group[0]),
        ("GROUP_Y", group[1]),
        ("SLOTS", slots.flat.max(1)),
        ("VOLUME_SLOTS", slots.volumes.max(1)),
        ("CUBE_SLOTS", slots.cubes.max(1)),
        ("TEXEL_BLOCKS", slots.texel_blocks.max(1)),
        ("BLOCK_LOG2", slots.block_log2),
    ];
    let all = features.values.iter().copied().chain(places);
    all.filter_map(|(name, value)| Some((shader.constant(name)?.id, value))).collect()
}
