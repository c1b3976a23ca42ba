// The first hit of a camera ray -> one of its properties in place of radiance: up to two numbers and 1, or a vector;
// zero where the ray meets nothing that has the property. Twin: src/oracle/quantities.rs.
#ifndef QUANTITIES_GLSL
#define QUANTITIES_GLSL

#include "appearance.glsl"

// Samples measure something other than radiance. The constant has the bit of radiance, or others.
const bool MEASURES = QUANTITIES != (1u << QUANTITY_RADIANCE);
// Some quantity reads texels: the colour, and the normal by a bump map.
const bool MEASURES_COLOR = (QUANTITIES & ((1u << QUANTITY_ALBEDO) | (1u << QUANTITY_NORMAL))) != 0u;

#if SOURCE != SOURCE_NONE
// Returns the place in [0, 1] of a texture at which a coordinate is read.
float place_in_tile(uint mask, uint mode, float u) {
    float place;
    if (MODE_IS(mask, ADDRESS_REPEAT, mode)) {
        place = u - floor(u);
    } else if (MODE_IS(mask, ADDRESS_MIRRORED_REPEAT, mode)) {
        place = 1.0 - abs(u - 2.0 * floor(0.5 * u) - 1.0);
    } else if (MODE_IS(mask, ADDRESS_MIRROR_CLAMP_TO_EDGE, mode)) {
        place = clamp(abs(u), 0.0, 1.0);
    } else {
        place = clamp(u, 0.0, 1.0);
    }
    return place;
}

// Returns the texture whose look-ups are measured: that of the colour, or else the first map that the material has.
TextureUse measured_use(const Material material) {
    TextureUse use = TextureUse(material.texture_index, material.sampler_index, material.image_slot, SECOND_UV_COLOR);
    if (use.texture_index != NO_TEXTURE) return use;
    if (MATERIAL_MAPS != 0u) {
        uint maps = maps_of(material);
        if (maps != 0u) use = use_of(material, uint(findLSB(maps)));
    }
    if (BUMPED && material.bump_texture_index != NO_TEXTURE) {
        use = TextureUse(material.bump_texture_index, material.bump_sampler_index, material.bump_image_slot, SECOND_UV_BUMP);
    }
    return use;
}

// Returns a quantity of the look-up of a texture. Procedural textures have no texels.
vec3 look_up_quantity(uint quantity, const TextureUse use, const TexCoord mapped) {
    bool textured = use.texture_index != NO_TEXTURE;
    Texture image = texture_at(textured ? use.texture_index : 0u);
    Sampler how = sampler_at(textured ? use.sampler_index : 0u);
    uint face;
    Coordinate c = in_texture(image, near_coordinate(image, how, mapped), face);
    FootprintEllipse spread = texel_spread(image, c);
    float major = max(spread.major, 1e-30);
    vec2 value = vec2(place_in_tile(ADDRESSES_U, how.address_u, c.at.x), place_in_tile(ADDRESSES_V, how.address_v, c.at.y));
    if (quantity == QUANTITY_TEXELS) value = sqrt(vec2(spread.major, spread.minor));
    if (quantity == QUANTITY_MAGNIFICATION) value = vec2(-0.5 * log2_accurate(major), 0.0);
    if (quantity == QUANTITY_LEVEL) value = vec2(read_level(image, how, spread), 0.0);
    if (quantity == QUANTITY_ANISOTROPY) value = vec2(min(sqrt(major / max(spread.minor, 1e-30)), MAX_STRETCH), 0.0);
    bool has_texels = !MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_PROCEDURAL, image.kind);
    return textured && has_texels ? vec3(value, 1.0) : vec3(0.0);
}
#endif

// A unit vector as a whole number: two octahedral components of 12 bits each (Cigolle et al. 2014).
float direction_number(vec3 n) {
    vec2 p = n.xy / ((abs(n.x) + abs(n.y)) + abs(n.z));
    vec2 folded = vec2(p.x < 0.0 ? abs(p.y) - 1.0 : 1.0 - abs(p.y), p.y < 0.0 ? abs(p.x) - 1.0 : 1.0 - abs(p.x));
    vec2 steps = floor(4095.0 * clamp(0.5 * (n.z < 0.0 ? folded : p) + 0.5, 0.0, 1.0) + 0.5);
    return steps.x * 4096.0 + steps.y;
}

// Returns a quantity of the surface itself; `missed`: it is the environment's. Numbers count from 1.
vec3 surface_quantity(uint quantity, bool missed, const Hit hit, const Surface surface, vec3 albedo) {
    vec3 value = albedo;
    if (quantity == QUANTITY_NORMAL) value = missed ? vec3(0.0) : vec3(surface.normal);
    if (quantity == QUANTITY_DEPTH) value = missed ? vec3(0.0) : vec3(float(hit.t), 0.0, 1.0);
    if (quantity == QUANTITY_INSTANCE) value = missed ? vec3(0.0) : vec3(float(hit.shape + 1u), 0.0, 1.0);
    if (quantity == QUANTITY_PLACE) value = missed ? vec3(0.0) : vec3(surface.at_rest);
    if (quantity == QUANTITY_FACET) {
        vec3 facet = vec3(float(hit.shape + 1u), direction_number(vec3(surface.geometric_normal)), direction_number(vec3(surface.normal)));
        value = missed ? vec3(0.0) : facet;
    }
    if (quantity == QUANTITY_MATERIAL) value = vec3(float(surface.link.x + 1u), 0.0, 1.0);
    return value;
}

// Returns the quantity that samples measure in place of radiance. Surfaces that let rays pass count as any other.
vec3 measured(const Header header, const Hit hit, bool missed, const Material material, const UvProjection map, const Ray ray,
              uvec2 random, Surface surface, const Footprint print) {
    vec3 albedo = vec3(0.0);
    if (MEASURES_COLOR) albedo = appearance(material, map, ray, surface, print, random).color;
    if (header.quantity == QUANTITY_ALBEDO && missed) albedo = vec3(0.0);
    vec3 value = surface_quantity(header.quantity, missed, hit, surface, albedo);
#if SOURCE != SOURCE_NONE
    if (!MEASURES_COLOR && header.quantity <= QUANTITY_UV) {
        TextureUse use = measured_use(material);
        Surface shown = at_uv_of(material, use.second_uv, surface);
        value = look_up_quantity(header.quantity, use, texture_coordinate(map, map_input(map, ray, shown, print)));
    }
#endif
    return value;
}

#endif
