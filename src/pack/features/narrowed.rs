//! The value of each specialization constant that is narrowed to a packed scene: a bit mask of the modes that occur, a
//! count that is known when the pipeline is built or `DYNAMIC`, or whether code is kept.

use glam::Vec3;

use super::needs::*;
use crate::pack::PackedScene;
use crate::schema::constants::{MAX_PLAIN, NO_MATERIAL, NO_TEXTURE};
use crate::schema::enums::{LightKind, Schedule};
use crate::schema::specialization::Constant;
use crate::texture::data::Component;

/// Returns the narrowed value; `None` for parameters, which are set when a pipeline is built, whatever the scene uses.
pub fn narrowed(constant: Constant, s: &PackedScene) -> Option<u32> {
    use Constant as C;
    Some(match constant {
        C::Projections => bit(s.header.projection as u32),
        C::Patterns => bit(s.header.pattern as u32),
        C::StrataSide => s.header.strata_side,
        C::Samples => counted_samples(s),
        C::BoundedPlanes => u32::from(s.records.planes.iter().any(|p| p.half_extent.0 >= 0.0)),
        C::SmoothNormals => u32::from(s.has_smooth_normals()),
        C::Models => bits(s.records.materials.iter().map(|m| m.model as u32)),
        C::LightKinds => bits(s.records.lights.iter().map(|l| l.kind as u32)),
        C::Ranged => u32::from(s.records.lights.iter().any(|l| l.kind == LightKind::Spot)),
        C::RoughMirrors => u32::from(mirrors_environment(s)),
        C::Shadows => u32::from(casts_shadows(s)),
        C::Bounces => u32::from(bounces(s)),
        C::Environment => u32::from(s.header.environment_material != NO_MATERIAL),
        C::Footprints => bit(s.header.footprint as u32),
        C::Random => u32::from(chooses(s)),
        C::Mappings => bits(s.records.uv_projections.iter().map(|m| m.kind as u32)),
        C::Entities => bits(s.records.uv_projections.iter().map(|m| m.entity as u32)),
        C::BoundlessUv => u32::from(!s.bounded_uv),
        C::RotatedUv => u32::from(s.records.uv_projections.iter().any(rotates)),
        C::Textured => u32::from(s.records.materials.iter().any(|m| m.texture_index != NO_TEXTURE)),
        C::Untextured => u32::from(s.records.materials.iter().any(|m| m.texture_index == NO_TEXTURE)),
        C::Bumped => u32::from(s.records.materials.iter().any(|m| m.bump_texture_index != NO_TEXTURE)),
        C::BumpKinds => bump_kinds(s),
        C::MaterialMaps => material_maps(s),
        C::AlphaModes => bits(s.records.materials.iter().map(|m| m.alpha_mode as u32)),
        C::Emissive => u32::from(s.records.materials.iter().any(|m| m.emission != Vec3::ZERO)),
        C::Transmissive => u32::from(s.records.materials.iter().any(|m| m.transmission > 0.0)),
        C::OneSided => u32::from(s.has_one_sided_shapes()),
        C::CulledBacks => u32::from(s.culls_backs()),
        C::VertexColors => u32::from(s.records.meshes.iter().any(|m| m.has_colors)),
        C::SecondUv => u32::from(s.records.materials.iter().any(|m| m.second_uv_maps != 0)),
        C::Tangents => u32::from(s.records.meshes.iter().any(|m| m.has_tangents)),
        C::Methods => bits(s.records.samplers.iter().map(|x| x.method as u32)),
        C::AddressesU => bits(s.records.samplers.iter().map(|x| x.address_u as u32)),
        C::AddressesV => bits(s.records.samplers.iter().map(|x| x.address_v as u32)),
        C::AddressesW => bits(s.records.samplers.iter().map(|x| x.address_w as u32)),
        C::Poles => u32::from(s.records.samplers.iter().any(|x| x.crosses_poles)),
        C::Filters => filters(s),
        C::Mips => bits(s.records.samplers.iter().map(|x| x.mip_mode as u32)),
        C::TexelCenters => bits(s.records.samplers.iter().map(|x| x.texel_center as u32)),
        C::TextureSizes => bits(stored(s).map(size_kind)),
        C::TextureKinds => bits(s.records.textures.iter().map(|t| t.kind as u32)),
        C::Mipmapped => u32::from(s.records.textures.iter().any(|t| t.levels > 1)),
        C::Nonfinite => u32::from(s.has_nonfinite()),
        C::TexelFormats => bits(stored(s).map(|t| t.format as u32)),
        C::ColorSpaces => bits(stored(s).map(|t| t.color_space as u32)),
        C::DeepSrgb => u32::from(s.has_srgb(Component::Unorm16)),
        C::ProceduralKinds => bits(s.records.procedurals.iter().map(|p| p.kind as u32)),
        C::ProceduralFiltered => u32::from(filters_procedurals(s)),
        C::Compensated => u32::from(compensates(s)),
        C::Blocks => u32::from(s.samples > MAX_PLAIN || s.schedule == Schedule::Batches),
        C::ConeShapes => cone_shapes(s),
        C::SampleDimensions => s.header.sample_dimensions,
        C::MovingCamera => u32::from(s.header.camera_moves),
        C::Schedules => bit(s.schedule as u32),
        C::PixelFilters => bit(s.header.pixel_filter as u32),
        C::Diagnosed => u32::from(s.diagnosed),
        C::TileCulled => u32::from(s.culls_tiles()),
        C::Warped => u32::from(warps(s)),
        C::Length(list) => unrolled(s.records.len(list)),
        C::GroupX
        | C::GroupY
        | C::At(_)
        | C::PixelFilterAt
        | C::Slots
        | C::VolumeSlots
        | C::CubeSlots
        | C::TexelBlocks
        | C::BlockLog2
        | C::TexelQuads
        | C::TablesInHead
        | C::Quantities
        | C::MeshSearch
        | C::HoldsTriangles
        | C::ListsShades
        | C::LoopsEnd
        | C::OpaqueUniforms
        | C::MipChannels
        | C::MipComponentBytes
        | C::GoalStepKind
        | C::MipSrgb => return None,
    })
}
