//! The declarations shared by host and device come from the tables of `src/schema`; these tests cover the remaining
//! faults: bytes at other positions than the packing rule's, constants that no shader has or that default to less than
//! everything, descriptors that differ between shaders, and that a shader of every family is found.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec3, Vec3};
use moire::internal::gpu::BindingKind;
use moire::internal::gpu::shaders::{self, Shader};
use moire::internal::pack::features;
use moire::internal::schema::blocks::{CellRange, Halving, PixelBatch, PositionRange, QueryRange, Slice};
use moire::internal::schema::enums::{AlphaMode, BumpKind, LightKind, Reals, TexelSource};
use moire::internal::schema::layout::{Light, Material, Plane, RealBits, Record, Triangle};
use moire::internal::schema::models::Model;
use moire::internal::schema::packing::{Kind, Packer, Place, shape};
use moire::internal::schema::specialization::{self, Constant};

fn bytes(record: &impl Record, double: bool) -> Vec<u8> {
    let mut bytes = Vec::new();
    record.write(double, &mut bytes);
    bytes
}

fn words(record: &impl Record, double: bool) -> Vec<u32> {
    bytes(record, double).as_chunks::<4>().0.iter().map(|b| u32::from_le_bytes(*b)).collect()
}

#[test]
fn fields_begin_units_where_they_have_no_room_or_are_of_another_kind() {
    let mut packer = Packer::new();
    let mut places = Vec::new();
    for name in ["DVec3", "f64", "DVec3", "DVec3", "Vec3", "u32", "f32", "RealBits", "bool", "UVec2", "Model"]
    {
        let (place, behind) = packer.place(shape(name));
        places.push(place);
        packer = behind;
    }
    let place = |reals, words, lane| Place { reals, words, lane };
    let expected = [
        place(0, 0, 0),
        place(0, 0, 3),
        place(1, 0, 0),
        place(2, 0, 0),
        place(3, 0, 0),
        place(3, 0, 3),
        place(3, 1, 0),
        place(3, 1, 1),
        place(3, 1, 3),
        place(3, 2, 0),
        place(3, 2, 2),
    ];
    assert_eq!(places, expected);
    assert_eq!((packer.reals, packer.words), (3, 3));
    assert_eq!((shape("DVec4").kind, shape("DVec4").lanes), (Kind::Reals, 4));
    assert_eq!((shape("LightKind").kind, shape("LightKind").lanes), (Kind::Words, 1));
}

#[test]
fn records_are_written_as_the_rule_says() {
    let material = Material {
        color: Vec3::new(1.0, 2.0, 3.0),
        bump_strength: 4.0,
        model: Model::Phong,
        texture_index: 5,
        sampler_index: 6,
        image_slot: 7,
        bump_texture_index: 8,
        bump_sampler_index: 16,
        bump_image_slot: 9,
        bump_kind: BumpKind::NormalDown,
        alpha: 10.0,
        roughness: 17.0,
        metallic: 18.0,
        roughness_texture_index: 19,
        roughness_sampler_index: 20,
        roughness_image_slot: 21,
        emission_texture_index: 22,
        emission_sampler_index: 23,
        emission_image_slot: 24,
        emission: Vec3::new(25.0, 26.0, 27.0),
        occlusion_strength: 28.0,
        occlusion_texture_index: 29,
        occlusion_sampler_index: 30,
        occlusion_image_slot: 31,
        second_uv_maps: 32,
        own_uv_maps: 42,
        first_map_uv: 43,
        alpha_mode: AlphaMode::Blend,
        alpha_cutoff: 33.0,
        opacity: 34.0,
        one_sided: true,
        transmission: 44.0,
        specular: Vec3::new(11.0, 12.0, 13.0),
        edge: 35.0,
        exponent: 14.0,
        ior: 15.0,
        specular_weight_texture_index: 36,
        specular_weight_sampler_index: 37,
        specular_weight_image_slot: 38,
        specular_tint_texture_index: 39,
        specular_tint_sampler_index: 40,
        specular_tint_image_slot: 41,
        transmission_texture_index: 45,
        transmission_sampler_index: 46,
        transmission_image_slot: 47,
    };
    let f = f32::to_bits;
    let expected = [
        [f(1.0), f(2.0), f(3.0), f(4.0)],
        [Model::Phong as u32, 5, 6, 7],
        [8, 16, 9, BumpKind::NormalDown as u32],
        [f(10.0), f(17.0), f(18.0), 19],
        [20, 21, 22, 23],
        [24, f(25.0), f(26.0), f(27.0)],
        [f(28.0), 29, 30, 31],
        [32, 42, 43, AlphaMode::Blend as u32],
        [f(33.0), f(34.0), 1, f(44.0)],
        [f(11.0), f(12.0), f(13.0), f(35.0)],
        [f(14.0), f(15.0), 36, 37],
        [38, 39, 40, 41],
        [45, 46, 47, 0],
    ];
    assert_eq!(Material::UNITS, (0, 13));
    // Without reals, whatever their precision.
    assert_eq!(words(&material, false), expected.concat());
    assert_eq!(words(&material, true), expected.concat());

    let plane = Plane {
        normal: DVec3::new(0.1, 0.2, 0.3),
        distance: 0.4,
        axis_u: DVec3::new(0.5, 0.6, 0.7),
        eye_u: 0.8,
        axis_v: DVec3::new(0.9, 1.0, 1.1),
        eye_v: 1.2,
        material: 3,
        uv_projection: 4,
        half_extent: RealBits(2.1),
    };
    let reals: Vec<f64> = (1..=12).map(|i| f64::from(i) / 10.0).collect();
    let single: Vec<u32> = reals.iter().map(|&x| f(x as f32)).chain([3, 4, f(2.1), 0]).collect();
    assert_eq!(words(&plane, false), single);
    let double: Vec<u8> = reals.iter().flat_map(|x| x.to_le_bytes()).collect();
    let link = [3_u32, 4].iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    assert_eq!(bytes(&plane, true), [double, link, 2.1_f64.to_le_bytes().to_vec()].concat());
    assert_eq!(plane.quantize_f32().half_extent.0, f64::from(2.1_f32));
    assert_eq!(plane.bounds(), Some(2.1));
    assert_eq!(Plane { half_extent: RealBits(-1.0), ..plane }.bounds(), None);
}

#[test]
fn what_is_left_of_a_unit_is_empty() {
    let triangle = Triangle {
        v: DVec3::ONE,
        normal: DVec3::ONE,
        normal_c: DVec3::ONE,
        is_smooth: true,
        ..Triangle::default()
    };
    assert_eq!(Triangle::UNITS, (8, 1));
    let words = words(&triangle, false);
    assert_eq!(words.len(), 9 * 4);
    let one = 1.0_f32.to_bits();
    assert_eq!(words[12..20], [one, one, one, 0, one, one, one, 0]);
    assert_eq!(words[31..36], [0, 0, 0, 1, 0]);
    let light = Light { kind: LightKind::Sun, power: Vec3::ONE, ..Light::default() };
    assert_eq!(Light::UNITS, (4, 2));
    assert_eq!(bytes(&light, true).len(), 4 * 32 + 32);
    assert_eq!(bytes(&light, true)[156..], (LightKind::Sun as u32).to_le_bytes());
}

#[test]
fn blocks_of_words_have_no_gaps() {
    assert_eq!(size_of::<Slice>(), 40);
    assert_eq!(size_of::<CellRange>(), 12);
    assert_eq!(size_of::<PixelBatch>(), 16);
    assert_eq!(size_of::<Halving>(), 32);
    assert_eq!(size_of::<QueryRange>(), 4);
    assert_eq!(size_of::<PositionRange>(), 20);
}

/// Returns the faults in the constants of a shader.
fn complaints(shader: &Shader) -> Vec<String> {
    let mut found = Vec::new();
    let mut ids = BTreeSet::new();
    for constant in shader.constants {
        if !ids.insert(constant.id) {
            found.push(format!("{}: id {} stands twice", shader.name, constant.id));
        }
        match Constant::all().nth(constant.id as usize) {
            Some(known) if known.name() == constant.name => {}
            known => found.push(format!("{}: {} has the id of {known:?}", shader.name, constant.name)),
        }
    }
    for (constant, widest) in features::widest() {
        let own = shader.constants.iter().find(|c| c.id == constant.id());
        if let Some(own) = own.filter(|own| own.default != widest) {
            found.push(format!("{}: {} is {} without being set", shader.name, own.name, own.default));
        }
    }
    found
}

#[test]
fn constants_of_shaders_are_those_of_the_table_and_keep_everything() {
    let found: Vec<String> = shaders::ALL.iter().flat_map(|shader| complaints(shader)).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
    let some = |constant: &Constant| !shaders::ALL.iter().any(|shader| shader.has(*constant));
    let unused: Vec<_> = Constant::all().filter(some).collect();
    assert!(unused.is_empty(), "constants that no shader has: {unused:?}");
}

#[test]
fn planted_constants_are_found() {
    let planted = |change: fn(&mut shaders::SpecConstant)| {
        let mut constants = shaders::RENDER_BUFFER.constants.to_vec();
        let models = constants.iter().position(|c| c.name == "MODELS").unwrap();
        change(&mut constants[models]);
        let constants: &'static [shaders::SpecConstant] = constants.leak();
        complaints(&Shader { name: "planted", bindings: &[], constants, spirv: shaders::RENDER_BUFFER.spirv })
    };
    assert!(planted(|_| {}).is_empty());
    assert!(planted(|c| c.default = 1)[0].contains("MODELS is 1"));
    assert!(planted(|c| c.name = "MODELLS")[0].contains("MODELLS has the id of"));
    assert!(!planted(|c| c.id = 3).is_empty());
}

#[test]
fn kinds_of_constants_say_how_they_are_narrowed() {
    let narrowed: BTreeSet<Constant> = features::widest().map(|(constant, _)| constant).collect();
    for constant in Constant::all() {
        let parameter = constant.kind() == specialization::Kind::Parameter;
        assert_eq!(narrowed.contains(&constant), !parameter, "{constant:?}");
    }
}

#[test]
fn a_descriptor_is_the_same_in_all_shaders() {
    let mut kinds: BTreeMap<u32, BindingKind> = BTreeMap::new();
    for shader in shaders::ALL.iter().filter(|shader| !["mips", "goal"].contains(&shader.name)) {
        for found in shader.bindings {
            let known = *kinds.entry(found.binding).or_insert(found.kind);
            assert_eq!(known, found.kind, "{}: binding {}", shader.name, found.binding);
        }
    }
    assert_eq!(kinds.len(), 14, "{kinds:?}");
}

#[test]
fn families_have_a_shader_for_all_that_a_scene_may_ask() {
    for &source in TexelSource::ALL {
        for reals in [Reals::F32, Reals::F64Math] {
            assert!(shaders::RENDER_FAMILY.shader(source, reals).is_ok());
        }
        assert!(shaders::CONE_FAMILY.shader(source, Reals::F32).is_ok());
    }
    for reals in [Reals::F32, Reals::F64Records] {
        assert!(shaders::BEAM_FAMILY.shader(TexelSource::None, reals).is_ok());
        assert!(shaders::TILE_CULLING_FAMILY.shader(TexelSource::None, reals).is_ok());
    }
    let error = shaders::CONE_FAMILY.shader(TexelSource::None, Reals::F64Math).unwrap_err();
    assert!(error.to_string().contains("cone"), "{error}");
}
