// What a material looks like at a hit: its colour, times its texture and that of the vertices, and what its other maps
// say. A bump map changes the normal on the way. One loop for all look-ups of a hit, as they are most of the code.
// Twin: src/oracle/appearance.rs.
#ifndef APPEARANCE_GLSL
#define APPEARANCE_GLSL

#include "filter/sample_texture.glsl"
#include "geometry/hit.glsl"
#include "material_maps.glsl"
#include "shading_normal.glsl"

// Some ray may pass a surface.
const bool TRANSPARENT = (ALPHA_MODES & ~(1u << ALPHA_OPAQUE)) != 0u || ONE_SIDED;

// Returns the inputs of the surface's mapping.
MapInput map_input(const UvProjection map, const Ray ray, const Surface surface, const Footprint print) {
    MapInput seen = MapInput(surface.at_rest, vec3(0.0), vec3(0.0), surface.own_uv, vec2(0.0), vec2(0.0), false);
    uint entity = map.entity;
    if (DERIVATIVES) {
        seen.entity_x = print.point_x;
        seen.entity_y = print.point_y;
        seen.own_x = vec2(dot3(surface.own_u, print.point_x), dot3(surface.own_v, print.point_x));
        seen.own_y = vec2(dot3(surface.own_u, print.point_y), dot3(surface.own_v, print.point_y));
    }
    if (MODE_IS(ENTITIES, ENTITY_POSITION, entity)) return seen;
    vec3 bent_x = normal_change(surface.shape_operator, print.point_x);
    vec3 bent_y = normal_change(surface.shape_operator, print.point_y);
    if (MODE_IS(ENTITIES, ENTITY_NORMAL, entity)) {
        seen.entity = surface.normal;
        seen.entity_x = bent_x;
        seen.entity_y = bent_y;
        return seen;
    }
    real3 way = ray.direction;
    vec3 way_x = print.direction_x;
    vec3 way_y = print.direction_y;
    if (MODE_IS(ENTITIES, ENTITY_REFLECTION, entity)) {
        Surface mirror = surface;
        consistent_normal(ray.direction, mirror);
        way_x = mirrored_change(vec3(way), vec3(mirror.normal), way_x, normal_change(mirror.shape_operator, print.point_x));
        way_y = mirrored_change(vec3(way), vec3(mirror.normal), way_y, normal_change(mirror.shape_operator, print.point_y));
        way = mirrored(way, mirror.normal);
    }
    // Of unit length; the change is perpendicular to it.
    real size = inverse_root(dot3(way, way));
    seen.entity = way * size;
    if (DERIVATIVES) {
        vec3 unit = vec3(seen.entity);
        float scale = float(size);
        seen.entity_x = (way_x - dot3(unit, way_x) * unit) * scale;
        seen.entity_y = (way_y - dot3(unit, way_y) * unit) * scale;
    }
    return seen;
}

#if !defined(SHAPES_IN_BEAMS) || defined(MESHES_IN_CELLS)
#define HAS_MESH_TEXELS
uvec4 mesh_texel(uint at);

// Returns the surface with coordinates that a map has for itself, which are read here: few maps have any.
Surface at_own_uv(const MapUv own, Surface surface) {
    VertexAttributes seen = surface.attributes;
    uint at = seen.uv_texel + 2u * own.set;
    vec4 first = uintBitsToFloat(mesh_texel(at));
    vec4 second = uintBitsToFloat(mesh_texel(at + 1u));
    vec3 u = first.xyz;
    vec3 v = vec3(first.w, second.xy);
    real2 uv = real2(dot3(seen.weights, u), dot3(seen.weights, v));
    surface.own_uv = real2(own.row_u.x * uv.x + own.row_u.y * uv.y, own.row_v.x * uv.x + own.row_v.y * uv.y) + own.offset;
    if (FILTERED || BUMPED) {
        vec3 u_way = (seen.weight_a * u.x + seen.weight_b * u.y) + seen.weight_c * u.z;
        vec3 v_way = (seen.weight_a * v.x + seen.weight_b * v.y) + seen.weight_c * v.z;
        surface.own_u = float(own.row_u.x) * u_way + float(own.row_u.y) * v_way;
        surface.own_v = float(own.row_v.x) * u_way + float(own.row_v.y) * v_way;
    }
    return surface;
}
#endif

// Returns the surface with the texture coordinates of one of the material's maps in place of its own.
Surface at_uv_of(const Material material, uint map_bit, Surface surface) {
    if (SECOND_UV && (material.second_uv_maps & map_bit) != 0u) {
        surface.own_uv = surface.attributes.second_uv;
        surface.own_u = surface.attributes.second_u;
        surface.own_v = surface.attributes.second_v;
    }
#ifdef HAS_MESH_TEXELS
    if (MAP_UVS != 0u && (material.own_uv_maps & map_bit) != 0u && surface.attributes.uv_texel != 0u) {
        surface = at_own_uv(map_uv_at(material.first_map_uv + uint(bitCount(material.own_uv_maps & (map_bit - 1u)))), surface);
    }
#endif
    return surface;
}

#if SOURCE != SOURCE_NONE
// Returns the gradients of u and v along the surface, from their changes along two tangents.
void uv_gradients(const UvProjection map, const Ray ray, const Surface surface, out vec3 u, out vec3 v) {
    vec3 n = vec3(surface.geometric_normal);
    vec3 first = any_tangent(n);
    vec3 second = cross3(n, first);
    Footprint print = Footprint(first, second, vec3(0.0), vec3(0.0));
    MapInput seen = map_input(map, ray, surface, print);
    seen.gradients = true;
    TexCoord c = texture_coordinate(map, seen);
    vec3 along_u = first * c.dx.x + second * c.dy.x;
    vec3 along_v = first * c.dx.y + second * c.dy.y;
    u = along_u;
    v = along_v;
}

// Returns true for a map of normals, false for one of heights.
bool is_normal_map(const Material material) {
    return MODE_IS(BUMP_KINDS, BUMP_NORMAL, material.bump_kind) || MODE_IS(BUMP_KINDS, BUMP_NORMAL_DOWN, material.bump_kind);
}

// Returns the points at which a bump map is read, two on each axis, at the distance of a texel or half the
// footprint.
vec2 bump_step(const Material material, const TexCoord c) {
    vec2 texel = 1.0 / vec2(texture_at(material.bump_texture_index).size.xy);
    return max(texel, 0.5 * max(abs(c.dx.xy), abs(c.dy.xy)));
}

// Returns the shading normal after the material's bump map, from the values at those points. Normal map: 2
// rgb - 1 along increasing u, increasing v (or against it) and the normal; along the tangents of a mesh's
// vertices if it has any, which are not normalised between them (Mikkelsen 2008). Bump map: n - grad h, with the
// height's gradient along the surface (Blinn 1978; Mikkelsen 2020), h by central differences.
vec3 bump_normal(const Material material, const UvProjection map, const Ray ray, const Surface shown, vec4 read, vec2 step) {
    Surface surface = at_uv_of(material, SECOND_UV_BUMP, shown);
    float side = surface.inside ? -1.0 : 1.0;
    vec3 n = side * vec3(surface.normal);
    float strength = material.bump_strength;
    vec3 u;
    vec3 v;
    uv_gradients(map, ray, surface, u, v);
    vec3 result;
    if (is_normal_map(material)) {
        vec3 t = cross3(v, n);
        vec3 b = cross3(n, u);
        float handed = dot3(cross3(u, v), n) < 0.0 ? -strength : strength;
        vec3 m = 2.0 * read.xyz - 1.0;
        if (MODE_IS(BUMP_KINDS, BUMP_NORMAL_DOWN, material.bump_kind)) m.y = -m.y;
        vec2 scale = vec2(dot3(t, t), dot3(b, b));
        result = n * m.z;
        bool by_vertices = false;
        if (TANGENTS) {
            vec4 tangent = surface.attributes.tangent;
            by_vertices = tangent.w != 0.0;
            vec3 bitangent = cross3(n, tangent.xyz) * tangent.w;
            if (by_vertices) result += (strength * m.x) * tangent.xyz - (strength * m.y) * bitangent;
        }
        if (!by_vertices) {
            result += t * (scale.x > 0.0 ? handed * m.x * inversesqrt(scale.x) : 0.0);
            result += b * (scale.y > 0.0 ? handed * m.y * inversesqrt(scale.y) : 0.0);
        }
    } else {
        vec2 slope = 0.5 * strength * (read.xz - read.yw) / step;
        result = n - slope.x * u - slope.y * v;
    }
    float squared = dot3(result, result);
    return side * (squared > 0.0 ? result * inversesqrt(squared) : n);
}
#endif

// Returns the share of a shadow ray's light that a surface has, on both of its sides.
float alpha_share(const Material material, float alpha) {
    float share = 1.0;
    if (MODE_IS(ALPHA_MODES, ALPHA_MASK, material.alpha_mode)) share = alpha >= material.alpha_cutoff ? 1.0 : 0.0;
    if (MODE_IS(ALPHA_MODES, ALPHA_BLEND, material.alpha_mode)) share = min(alpha, 1.0);
    return share;
}

// Returns the share of a ray's light that a surface has, by what alpha means. A surface without a back lets rays pass
// that come from behind it.
float covered_share(const Material material, const Surface surface, float alpha) {
    float share = alpha_share(material, alpha);
    if (ONE_SIDED) share = material.one_sided && surface.inside ? 0.0 : share;
    return share;
}

// Returns what the material looks like, after its bump map has changed the normal.
Appearance appearance(const Material material, const UvProjection map, const Ray ray, inout Surface surface, const Footprint print, uvec2 random) {
    Appearance look = Appearance(material.color, material.opacity, material.metallic, material.roughness, material.emission, 1.0,
                                 material.specular, material.edge, TRANSMISSIVE ? material.transmission : 0.0);
    float vertex_alpha = 1.0;
    if (VERTEX_COLORS) {
        look.color *= surface.attributes.color.xyz;
        vertex_alpha = surface.attributes.color.w;
        look.opacity *= vertex_alpha;
    }
#if SOURCE != SOURCE_NONE
    bool bump = BUMPED && material.bump_texture_index != NO_TEXTURE;
    uint taps = 0u;
    if (bump) taps = is_normal_map(material) ? 1u : 4u;
    uint maps = MATERIAL_MAPS != 0u ? maps_of(material) : 0u;
    vec4 read = vec4(0.0);
    vec2 step = vec2(0.0);
    uint tap = 0u;
    if (TEXTURED || BUMPED || MATERIAL_MAPS != 0u) {
        do {
            // lavapipe (Mesa 22.3.6) may run the body on for lanes that have left a loop around another one: nothing may be
            // applied in them any more.
            bool last = tap == taps;
            bool other = MATERIAL_MAPS != 0u && tap > taps && maps != 0u;
            uint kind = 0u;
            if (MATERIAL_MAPS != 0u) {
                kind = uint(findLSB(maps | 1u << 31u));
                maps &= other ? maps - 1u : maps;
            }
            if (bump && last) surface.normal = bump_normal(material, map, ray, surface, read, step);
            if (!UNTEXTURED || !last || material.texture_index != NO_TEXTURE) {
                Surface shown = at_uv_of(material, SECOND_UV_COLOR, surface);
                uvec2 link = uvec2(material.texture_index, material.image_slot);
                uint how = material.sampler_index;
                Footprint under = print;
                if (BUMPED && tap < taps) {
                    shown = at_uv_of(material, SECOND_UV_BUMP, surface);
                    link = uvec2(material.bump_texture_index, material.bump_image_slot);
                    how = material.bump_sampler_index;
                }
                if (MATERIAL_MAPS != 0u) {
                    TextureUse use = use_of(material, kind);
                    if (other) {
                        shown = at_uv_of(material, use.second_uv, surface);
                        link = uvec2(use.texture_index, use.image_slot);
                        how = use.sampler_index;
                    }
                    if (HAS(MATERIAL_MAPS, MATERIAL_MAP_MASK)) {
                        if (other && kind == MATERIAL_MAP_MASK) under = NO_FOOTPRINT;
                    }
                }
                TexCoord c = texture_coordinate(map, map_input(map, ray, shown, under));
                if (BUMPED && tap < taps) {
                    step = bump_step(material, c);
                    if (taps == 4u) c.at[tap >> 1u] += (tap & 1u) == 0u ? step[tap >> 1u] : -step[tap >> 1u];
                }
                vec4 texel = sample_texture(texture_at(link.x), sampler_at(how), link.y, c, random);
                if (BUMPED && tap < taps) {
                    if (taps == 4u) read[tap] = texel.x;
                    else read = texel;
                } else if (MATERIAL_MAPS != 0u && other) {
                    apply_map(kind, texel, material, vertex_alpha, look);
                } else if (last) {
                    vec3 product = look.color * texel.xyz;
                    look.color = product;
                    look.opacity *= texel.w;
                }
            }
            tap++;
        } while ((BUMPED && tap <= taps) || (MATERIAL_MAPS != 0u && (tap <= taps || maps != 0u)));
    }
    if (HAS(MATERIAL_MAPS, MATERIAL_MAP_SPECULAR_TINT)) look.dielectric = min(look.dielectric, vec3(look.edge));
#endif
    return look;
}

#endif
