//! A packed scene → the value of each specialization constant that is narrowed to it: a bit mask of the modes that
//! occur, a number that is known when the pipeline is built or `DYNAMIC`, or whether code is there.

use super::needs::*;
use crate::pack::PackedScene;
use crate::schema::constants::{MAX_PLAIN, NO_MATERIAL, NO_TEXTURE};
use crate::schema::enums::Schedule;
use crate::schema::specialization::Constant;
use crate::texture::data::Component;

/// Returns nothing for what is set where a pipeline is built, whatever the scene uses.
pub fn narrowed(constant: Constant, s: &PackedScene) -> Option<u32> {
    use Constant as C;
    Some(match constant {
        C::Projections => bit(s.header.size[2]),
        C::Patterns => bit(s.header.sampling[0]),
        C::StrataSide => s.header.sampling[1],
        C::Samples => counted_samples(s),
        C::Planes => unrolled(s.planes.len()),
        C::Spheres => unrolled(s.spheres.len()),
        C::Triangles => unrolled(s.triangles.len()),
        C::Lights => unrolled(s.lights.len()),
        C::Materials => unrolled(s.materials.len()),
        C::UvProjections => unrolled(s.maps.len()),
        C::Textures => unrolled(s.textures.len()),
        C::Samplers => unrolled(s.samplers.len()),
        C::BoundedPlanes => u32::from(s.planes.iter().any(|p| p.link[3] != 0)),
        C::SmoothNormals => u32::from(s.triangles.iter().any(|t| t.v[3] != 0.0)),
        C::Models => bits(s.materials.iter().map(|m| m.link[0])),
        C::LightKinds => bits(s.lights.iter().map(|l| l.link[0])),
        C::Shadows => u32::from(casts_shadows(s)),
        C::Bounces => u32::from(bounces(s)),
        C::Environment => u32::from(s.header.counts[3] != NO_MATERIAL),
        C::Footprints => bit(s.header.key[2]),
        C::Random => u32::from(chooses(s)),
        C::Mappings => bits(s.maps.iter().map(|m| m.link[0])),
        C::Entities => bits(s.maps.iter().map(|m| m.link[1])),
        C::RotatedUv => u32::from(s.maps.iter().any(rotates)),
        C::Textured => u32::from(s.materials.iter().any(|m| m.link[1] != NO_TEXTURE)),
        C::Untextured => u32::from(s.materials.iter().any(|m| m.link[1] == NO_TEXTURE)),
        C::Bumped => u32::from(s.materials.iter().any(|m| m.detail[0] != NO_TEXTURE)),
        C::BumpKinds => bump_kinds(s),
        C::Methods => bits(s.samplers.iter().map(|x| x.link[0])),
        C::AddressesU => bits(s.samplers.iter().map(|x| x.modes[0])),
        C::AddressesV => bits(s.samplers.iter().map(|x| x.modes[1])),
        C::AddressesW => bits(s.samplers.iter().map(|x| x.more[0])),
        C::Poles => u32::from(s.samplers.iter().any(|x| x.more[1] != 0)),
        C::Filters => filters(s),
        C::Mips => bits(s.samplers.iter().map(|x| x.link[2])),
        C::TexelCenters => bits(s.samplers.iter().map(|x| x.modes[3])),
        C::TextureSizes => bits(stored(s).map(size_kind)),
        C::TextureKinds => bits(s.textures.iter().map(|t| t.link[3])),
        C::Mipmapped => u32::from(s.textures.iter().any(|t| t.link[1] > 1)),
        C::Nonfinite => u32::from(s.has_nonfinite()),
        C::TexelFormats => bits(stored(s).map(|t| t.place[3])),
        C::ColorSpaces => bits(stored(s).map(|t| t.link[0])),
        C::DeepSrgb => u32::from(s.has_srgb(Component::Unorm16)),
        C::Procedurals => unrolled(s.procedurals.len()),
        C::ProceduralKinds => bits(s.procedurals.iter().map(|p| p.link[0])),
        C::ProceduralFiltered => u32::from(filters_procedurals(s)),
        C::Compensated => u32::from(compensates(s)),
        C::Blocks => u32::from(s.samples > MAX_PLAIN || s.schedule == Schedule::Jobs),
        C::ConeShapes => cone_shapes(s),
        C::SampleDimensions => s.header.chances[0],
        C::Motions => unrolled(s.motions.len()),
        C::MovingCamera => u32::from(s.header.chances[2] != 0),
        C::Schedules => bit(s.schedule as u32),
        C::PixelFilters => bit(s.header.pixel_filter[0]),
        C::Diagnosed => u32::from(s.guarded),
        C::TileCulled => u32::from(s.culls_tiles()),
        C::Warped => u32::from(warps(s)),
        C::GroupX
        | C::GroupY
        | C::PlanesAt
        | C::SpheresAt
        | C::TrianglesAt
        | C::LightsAt
        | C::MaterialsAt
        | C::UvProjectionsAt
        | C::TexturesAt
        | C::SamplersAt
        | C::ProceduralsAt
        | C::MotionsAt
        | C::PixelFilterAt
        | C::Slots
        | C::VolumeSlots
        | C::CubeSlots
        | C::TexelBlocks
        | C::BlockLog2
        | C::TablesInHead
        | C::OpaqueUniforms
        | C::MipChannels
        | C::MipComponentBytes
        | C::MipSrgb => return None,
    })
}
