// What a material looks like at a hit, and its maps beside those of its colour and its relief: which ones it has, how each
// is read, and what it changes. Twin: src/oracle/material_maps.rs.
#ifndef MATERIAL_MAPS_GLSL
#define MATERIAL_MAPS_GLSL

#include "features.glsl"
#include "layout.glsl"

struct Appearance {
    vec3 color;
    float opacity;
    float metallic;
    float roughness;
    vec3 emission;
    float occlusion;    // share of the environment's light that arrives
    vec3 dielectric;    // reflectance of a dielectric surface head-on
    float edge;         // and at grazing angles
    float transmission; // share of the light in a body that passes it
};

// Returns the maps that the material has, one bit for each MATERIAL_MAP.
uint maps_of(const Material material) {
    uint maps = 0u;
    if (HAS(MATERIAL_MAPS, MATERIAL_MAP_ROUGHNESS) && material.roughness_texture_index != NO_TEXTURE) maps |= 1u << MATERIAL_MAP_ROUGHNESS;
    if (HAS(MATERIAL_MAPS, MATERIAL_MAP_EMISSION) && material.emission_texture_index != NO_TEXTURE) maps |= 1u << MATERIAL_MAP_EMISSION;
    if (HAS(MATERIAL_MAPS, MATERIAL_MAP_OCCLUSION) && material.occlusion_texture_index != NO_TEXTURE) maps |= 1u << MATERIAL_MAP_OCCLUSION;
    if (HAS(MATERIAL_MAPS, MATERIAL_MAP_MASK) && material.alpha_mode == ALPHA_MASK && material.texture_index != NO_TEXTURE) {
        maps |= 1u << MATERIAL_MAP_MASK;
    }
    if (HAS(MATERIAL_MAPS, MATERIAL_MAP_SPECULAR_WEIGHT) && material.specular_weight_texture_index != NO_TEXTURE) {
        maps |= 1u << MATERIAL_MAP_SPECULAR_WEIGHT;
    }
    if (HAS(MATERIAL_MAPS, MATERIAL_MAP_SPECULAR_TINT) && material.specular_tint_texture_index != NO_TEXTURE) {
        maps |= 1u << MATERIAL_MAP_SPECULAR_TINT;
    }
    if (HAS(MATERIAL_MAPS, MATERIAL_MAP_TRANSMISSION) && material.transmission_texture_index != NO_TEXTURE) {
        maps |= 1u << MATERIAL_MAP_TRANSMISSION;
    }
    return maps;
}

// A texture as a material reads it.
struct TextureUse {
    uint texture_index;
    uint sampler_index;
    uint image_slot;
    uint second_uv; // bit of `second_uv_maps`
};

// Returns how a map is read.
TextureUse use_of(const Material material, uint map) {
    TextureUse use = TextureUse(material.texture_index, material.sampler_index, material.image_slot, SECOND_UV_COLOR);
    if (MODE_IS(MATERIAL_MAPS, MATERIAL_MAP_ROUGHNESS, map)) {
        use = TextureUse(material.roughness_texture_index, material.roughness_sampler_index, material.roughness_image_slot, 1u << map);
    }
    if (MODE_IS(MATERIAL_MAPS, MATERIAL_MAP_EMISSION, map)) {
        use = TextureUse(material.emission_texture_index, material.emission_sampler_index, material.emission_image_slot, 1u << map);
    }
    if (MODE_IS(MATERIAL_MAPS, MATERIAL_MAP_OCCLUSION, map)) {
        use = TextureUse(material.occlusion_texture_index, material.occlusion_sampler_index, material.occlusion_image_slot, 1u << map);
    }
    if (MODE_IS(MATERIAL_MAPS, MATERIAL_MAP_SPECULAR_WEIGHT, map)) {
        use = TextureUse(material.specular_weight_texture_index, material.specular_weight_sampler_index, material.specular_weight_image_slot,
                         1u << map);
    }
    if (MODE_IS(MATERIAL_MAPS, MATERIAL_MAP_SPECULAR_TINT, map)) {
        use = TextureUse(material.specular_tint_texture_index, material.specular_tint_sampler_index, material.specular_tint_image_slot, 1u << map);
    }
    if (MODE_IS(MATERIAL_MAPS, MATERIAL_MAP_TRANSMISSION, map)) {
        use = TextureUse(material.transmission_texture_index, material.transmission_sampler_index, material.transmission_image_slot, 1u << map);
    }
    return use;
}

// Applies what was read of a map.
void apply_map(uint map, vec4 texel, const Material material, float vertex_alpha, inout Appearance look) {
    if (MODE_IS(MATERIAL_MAPS, MATERIAL_MAP_ROUGHNESS, map)) {
        look.roughness *= texel.y;
        look.metallic *= texel.z;
    }
    if (MODE_IS(MATERIAL_MAPS, MATERIAL_MAP_EMISSION, map)) look.emission *= texel.xyz;
    if (MODE_IS(MATERIAL_MAPS, MATERIAL_MAP_OCCLUSION, map)) look.occlusion = 1.0 + material.occlusion_strength * (texel.x - 1.0);
    if (MODE_IS(MATERIAL_MAPS, MATERIAL_MAP_SPECULAR_WEIGHT, map)) {
        look.dielectric *= texel.w;
        look.edge *= texel.w;
    }
    if (MODE_IS(MATERIAL_MAPS, MATERIAL_MAP_SPECULAR_TINT, map)) look.dielectric *= texel.xyz;
    if (MODE_IS(MATERIAL_MAPS, MATERIAL_MAP_TRANSMISSION, map)) look.transmission *= texel.x;
    if (MODE_IS(MATERIAL_MAPS, MATERIAL_MAP_MASK, map)) look.opacity = material.opacity * vertex_alpha * texel.w;
}

#endif
