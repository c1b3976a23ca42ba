// The colour of a visible fragment: decides which materials have a closed-form integral, and computes it, of
// texture times irradiance over strips of the fragment. Twin: src/oracle/shading_integral.rs.
#ifndef SHADING_INTEGRAL_GLSL
#define SHADING_INTEGRAL_GLSL

#include "features.glsl"
#include "bsdf/models.glsl"
#include "filter/kinds.glsl"
#include "geometry/beams.glsl"
#include "prefix_sums.glsl"
#include "sample_dimensions.glsl"

const uint MAX_FRAGMENTS = 12u;  // pending ones
const uint MAX_BEAMS = 6u;    // pending mirrored beams

// Indices of polygons: the pending fragments with room for one more, those of pending beams, and
const uint BEAMS_AT = MAX_FRAGMENTS + 1u;
const uint WHOLE = BEAMS_AT + MAX_BEAMS; // of the beam
const uint PIECE = WHOLE + 1u;           // the fragment being processed
const uint OTHER = PIECE + 1u;           // the fragment with the next part cut away
const uint SEEN = OTHER + 1u;            // a visible fragment
const uint STRIP = SEEN + 1u;            // of a fragment

const uint MAX_CELLS = 40000u; // of textures that a pixel's edges may cross

// State of one thread: the pixel is too complex for a beam, and the cells that its edges have crossed.
bool gave_up;
uint crossed;

const Light NO_LIGHT = Light(vec3(0.0), 0.0, vec3(0.0), 0.0, 0.0, 0.0, 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0u);

// The material and geometry of a fragment.
struct ShadingIntegral {
    Material record;
    vec3 carried; // its colour times those of the mirrors that show it
    RationalMap quotient;
    vec4 plane;
    PixelFrustum frame;
    vec3 near;
};

const uint TILED = (1u << ADDRESS_REPEAT) | (1u << ADDRESS_MIRRORED_REPEAT) | (1u << ADDRESS_CLAMP_TO_EDGE);

// Returns true if the integral of a shape's colour is known: its material supports that, with a checker or a
// 2D texture whose coordinates are affine on the shape.
bool is_simple(uint shape, const Material record, const UvProjection map) {
    if (!is_integrable_over_region(record, is_smooth(shape))) return false;
    if (BUMPED && record.bump_texture_index != NO_TEXTURE) return false;
    if (record.texture_index == NO_TEXTURE) return true;
    bool flat_map = MODE_IS(MAPPINGS, MAP_PLANE, map.kind) || MODE_IS(MAPPINGS, MAP_VERTEX_UV, map.kind) ||
                    MODE_IS(MAPPINGS, MAP_AFFINE, map.kind);
    if (!flat_map || map.entity != ENTITY_POSITION || is_specular(record.model)) return false;
    Texture image = texture_at(record.texture_index);
    if (MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_PROCEDURAL, image.kind)) {
        Procedural what = procedural_at(image.procedural);
        return MODE_IS(PROCEDURAL_KINDS, PROCEDURAL_CHECKER, what.kind) && what.dimensions < 3u;
    }
    Sampler how = sampler_at(record.sampler_index);
    bool tiled = HAS(TILED, how.address_u) && HAS(TILED, how.address_v);
    return is_integrable(how) && tiled && word(int(record.texture_index)) > 0;
}

// Returns false for a light behind the surface as seen by the beam, which contributes nothing.
bool is_facing(const Header header, const ShadingIntegral paint, uint polygon, const Light light) {
    vec3 way;
    vec3 origin;
    ray_at(header, paint.frame, middle(polygon), way, origin);
    bool point_light = MODE_IS(LIGHT_KINDS, LIGHT_POINT, light.kind);
    float above = point_light ? dot3(paint.plane.xyz, light.position) - paint.plane.w : dot3(paint.plane.xyz, light.direction);
    return above * dot3(paint.plane.xyz, way) < 0.0;
}

// Returns the irradiance over pi at the centre of a strip, by an unoccluded light.
vec3 irradiance(const Header header, const ShadingIntegral paint, uint strip, const Light light) {
    vec3 n = paint.plane.xyz;
    vec3 power = light.power * (1.0 / PI);
    if (!MODE_IS(LIGHT_KINDS, LIGHT_POINT, light.kind)) return power * abs(dot3(n, light.direction));
    // The vector to the light times the inverse depth: towards the horizon both stay finite.
    vec3 direction;
    vec3 origin;
    ray_at(header, paint.frame, middle(strip), direction, origin);
    float near = at(paint.near, middle(strip));
    bool parallel = is_parallel(header);
    vec3 way = parallel ? (light.position - origin) + near * direction : near * (light.position - origin) - direction;
    float squared = dot3(way, way);
    float scale = parallel ? 1.0 : near * near;
    return power * (scale * abs(dot3(n, way)) / (squared * sqrt(squared)));
}

// Number of strips of a fragment: the root of STRIPS times the logarithm of the ratio of depths.
const float STRIPS = 2000.0;
const float MAX_STRIPS = 64.0;
// Everything e^7 times as deep as the fragment's nearest part is one strip.
const float DEEPEST = 7.0;
const float LOG2_E = 1.44269504088896;
// Cells that an edge of a strip may cross, and a further number that is divided among the strips of a
// fragment.
const float CELLS_OF_AN_EDGE = 32.0;
const float CELLS_OF_ALL = 512.0;

vec3 mean_color(const Material record, Grid grid, uint strip, const RationalMap quotient, float most, inout bool ended) {
    float reach = longest_edge(strip, in_grid(grid, quotient, ivec2(0)));
    // The level at which the edge is short enough.
    if (reach > most) grid = coarser(grid, int(ceil(log2_accurate(reach / most))));
    if (grid.unknown) {
        gave_up = true;
        return vec3(0.0);
    }
    vec3 mean = mean_over(grid, strip, quotient, reach < SMALLEST, crossed, ended);
    if (grid.checker) {
        Procedural what = procedural_at(texture_at(record.texture_index).procedural);
        return what.background + mean.x * (what.figure - what.background);
    }
    return vec3(grid.least) + grid.step * mean;
}

// Returns texture times irradiance / pi, integrated over PIECE, in strips of almost constant depth, within
// which equal areas of the texture are equal areas of the picture.
vec3 integral(const Header header, const ShadingIntegral paint, bool has_light, const Light light) {
    bool textured = TEXTURED && paint.record.texture_index != NO_TEXTURE;
    vec3 depth = textured ? paint.quotient.below : below(header, paint.near);
    vec2 ends = range(PIECE, depth);
    float span = min(log2_accurate(ends.y / max(ends.x, 1e-30 * ends.y)) / LOG2_E, DEEPEST);
    float strips = 1.0;
    if (textured || has_light) strips = clamp(ceil(sqrt(STRIPS * span)), 1.0, MAX_STRIPS);
    float most = CELLS_OF_AN_EDGE + CELLS_OF_ALL / strips;
    Grid grid = checker_grid();
    if (textured) {
        Texture image = texture_at(paint.record.texture_index);
        bool checker = MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_PROCEDURAL, image.kind);
        if (!checker) grid = texture_grid(paint.record.texture_index, image, sampler_at(paint.record.sampler_index));
    }
    uint rest = PIECE;
    vec3 sum = vec3(0.0);
    bool ended = true;
    float k = 1.0;
    for (; k <= strips && !gave_up; k += 1.0) {
        // Nothing is beyond the last strip.
        float limit = k < strips ? ends.y * exp2_accurate(-span * k / strips * LOG2_E) : -1.0;
        uint beyond = PIECE + OTHER - rest;
        if (!split(rest, depth - vec3(0.0, 0.0, limit), STRIP, beyond)) gave_up = true;
        rest = beyond;
        float share = area(STRIP);
        if (!(share > 0.0)) continue;
        vec3 color = vec3(1.0);
        if (textured) color = mean_color(paint.record, grid, STRIP, paint.quotient, most, ended);
        if (crossed > MAX_CELLS) gave_up = true;
        if (LIGHTS != 0u && has_light) color *= irradiance(header, paint, STRIP, light);
        sum += share * color;
    }
    if (!ended || k <= strips) gave_up = true;
    return sum;
}

#endif
