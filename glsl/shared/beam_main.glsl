// One beam a pixel (Heckbert & Hanrahan 1984): the pixel's square, cut along the edges of the polygons that it
// meets and where they pass through each other; of each visible piece the exact area in the pixel, and the
// exact integral of its colour. Mirrors send the piece on. What this cannot do is left to samples:
// film[pixel].w = 1. Twin: src/oracle/beam.rs.
#ifndef BEAM_MAIN_GLSL
#define BEAM_MAIN_GLSL

#include "features.glsl"
#include "rows.glsl"
#include "slice.glsl"

layout(std430, set = 0, binding = 0) buffer Film { vec4 film[]; };

const uint MAX_MET = 8u;      // shapes that a beam may meet
const uint MAX_PIECES = 12u;  // pieces that wait at a time
const uint MAX_BEAMS = 6u;    // mirrored beams that wait at a time
const uint MOST_CELLS = 40000u; // of textures that a pixel's edges may cross
// Planes whose nearness differs by less, relatively, lie in each other: the first of the list is seen.
const float COPLANAR = 4e-6;

// How the rays of a part of the pixel go.
struct Beam {
    Frame frame;
    vec3 carried;
    uint skip;  // the mirror that it left, and that one's nearness
    vec3 limit;
    uint depth;
};

// What a piece is painted with.
struct Paint {
    Material record;
    Quotient quotient;
    vec4 plane;
    Frame frame;
    vec3 near;
};

// Lists of one thread. Too much for a beam: it gives up.
Region met[MAX_MET + 1u]; // the last: of a shadow
uint met_shapes[MAX_MET];
uint met_count;
uint stages[MAX_PIECES]; // a waiting piece: how many tests are done
uint waiting;
Beam beams[MAX_BEAMS];
uint waiting_beams;
bool gave_up;
uint crossed;

// Polygons: the waiting pieces with room for one more, those of waiting beams, and
const uint BEAMS_AT = MAX_PIECES + 1u;
const uint WHOLE = BEAMS_AT + MAX_BEAMS; // of the beam
const uint PIECE = WHOLE + 1u;           // that was taken from the waiting ones
const uint OTHER = PIECE + 1u;           // the piece with the next part cut away
const uint SEEN = OTHER + 1u;            // a visible one
const uint STRIP = SEEN + 1u;            // of a piece

// The polygon at the end of the waiting ones becomes one of them.
void keep_piece(uint stage) {
    if (waiting < MAX_PIECES) stages[waiting++] = stage;
    else gave_up = true;
}

void push_piece(uint polygon, uint stage) {
    copy(polygon, waiting);
    keep_piece(stage);
}

// Takes the last of them as PIECE; what is returned is its stage.
uint pop_piece() {
    waiting--;
    copy(waiting, PIECE);
    return stages[waiting];
}

// Material and map.
uvec2 links(Header header, uint shape) {
    uint planes = COUNT(PLANES, header.counts.x);
    if (TRIANGLES == 0u || shape < planes) return plane_at(shape).link.xy;
    return triangle_at(shape - planes - COUNT(SPHERES, header.counts.y)).link.xy;
}

bool is_smooth(Header header, uint shape) {
    uint planes = COUNT(PLANES, header.counts.x);
    if (!SMOOTH_NORMALS || TRIANGLES == 0u || shape < planes) return false;
    return triangle_at(shape - planes - COUNT(SPHERES, header.counts.y)).v.w != 0.0;
}

const uint STEPPED = (1u << FILTER_NEAREST) | (1u << FILTER_LINEAR);
const uint TILED = (1u << ADDRESS_REPEAT) | (1u << ADDRESS_MIRRORED_REPEAT) | (1u << ADDRESS_CLAMP_TO_EDGE);

// Whether the integral of a shape's colour is known: of one that is unlit, diffuse or a plane mirror, with a
// checker or a flat texture that is affine on it.
bool is_simple(Header header, uint shape, Material record, Map map) {
    bool unlit = MODE_IS(MODELS, MODEL_UNLIT, record.link.x);
    bool mirror = MODE_IS(MODELS, MODEL_MIRROR, record.link.x);
    bool plain = mirror || MODE_IS(MODELS, MODEL_LAMBERT, record.link.x);
    if (!unlit && (!plain || is_smooth(header, shape))) return false;
    if (BUMPED && record.detail.x != NO_TEXTURE) return false;
    if (record.link.y == NO_TEXTURE) return true;
    bool flat_map = MODE_IS(MAPPINGS, MAP_PLANE, map.link.x) || MODE_IS(MAPPINGS, MAP_VERTEX_UV, map.link.x) ||
                    MODE_IS(MAPPINGS, MAP_AFFINE, map.link.x);
    if (!flat_map || map.link.y != ENTITY_POSITION || mirror) return false;
    Texture image = texture_at(record.link.y);
    if (MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_PROCEDURAL, image.link.w)) {
        uvec4 link = procedural_at(image.place.x).link;
        return MODE_IS(PROCEDURAL_KINDS, PROCEDURAL_CHECKER, link.x) && link.w < 3u;
    }
    Sampler how = sampler_at(record.link.z);
    bool tiled = HAS(TILED, how.modes.x) && HAS(TILED, how.modes.y);
    return HAS(STEPPED, how.modes.z) && tiled && word(int(record.link.y)) > 0;
}

// All that the beam may meet.
void find_shapes(Header header, Beam beam) {
    uint planes = COUNT(PLANES, header.counts.x);
    uint before_triangles = planes + COUNT(SPHERES, header.counts.y);
    uint shapes = before_triangles + COUNT(TRIANGLES, header.counts.z);
    met_count = 0u;
    for (uint shape = 0u; shape < shapes; shape++) {
        if (shape == beam.skip) continue;
        if (SPHERES != 0u && shape >= planes && shape < before_triangles) {
            if (may_meet_sphere(header, beam.frame, WHOLE, sphere_at(shape - planes))) gave_up = true;
            continue;
        }
        Region region = shape_region(header, beam.frame, shape);
        bool touches = true;
        for (uint k = 0u; k < region.count; k++) touches = touches && range(WHOLE, region.lines[k]).y > 0.0;
        if (!touches) continue;
        if (met_count < MAX_MET) {
            met[met_count].count = region.count;
            met[met_count].nearness = region.nearness;
            for (uint k = 0u; k < region.count; k++) met[met_count].lines[k] = region.lines[k];
            met_shapes[met_count] = shape;
            met_count++;
        } else {
            gave_up = true;
        }
    }
}

// Positive where `by` lies before `own`.
vec3 before(uint by, uint own, uint polygon) {
    vec3 apart = met[by].nearness - met[own].nearness;
    vec2 ends = range(polygon, apart);
    vec2 sizes = range(polygon, met[own].nearness);
    if (max(ends.y, -ends.x) > COPLANAR * max(sizes.y, -sizes.x)) return apart;
    return vec3(0.0, 0.0, by < own ? 1.0 : -1.0);
}

// Cuts PIECE along the lines of a shape that is met, of which `first` is one more. What lies within them all
// is kept, or all else is.
void carve(uint stage, uint by, bool has_first, vec3 first, bool kept) {
    uint rest = PIECE;
    uint k = has_first ? 0u : 1u;
    bool gone = false;
    uint count = met[by].count;
    for (; k <= count && !gone; k++) {
        vec3 line = first;
        if (k > 0u) line = met[by].lines[k - 1u];
        if (range(rest, line).x >= 0.0) continue;
        uint inside = PIECE + OTHER - rest;
        if (!split(rest, line, inside, waiting)) gave_up = true;
        if (!kept && area(waiting) > LEAST_AREA) keep_piece(stage + 1u);
        rest = inside;
        gone = area(rest) <= LEAST_AREA;
    }
    if (kept && !gone) push_piece(rest, stage + 1u);
}

// A light behind the surface, as its beam sees it, gives nothing.
bool is_lit(Header header, Paint paint, uint polygon, Light light) {
    vec3 way;
    vec3 origin;
    ray_at(header, paint.frame, middle(polygon), way, origin);
    bool point_light = MODE_IS(LIGHT_KINDS, LIGHT_POINT, light.link.x);
    float above = dot3(paint.plane.xyz, light.place.xyz) - (point_light ? paint.plane.w : 0.0);
    return above * dot3(paint.plane.xyz, way) < 0.0;
}

// Irradiance over pi at the middle of a strip, of a light that it sees.
vec3 irradiance(Header header, Paint paint, uint strip, Light light) {
    vec3 n = paint.plane.xyz;
    vec3 power = light.power.xyz * (1.0 / PI);
    if (!MODE_IS(LIGHT_KINDS, LIGHT_POINT, light.link.x)) return power * abs(dot3(n, light.place.xyz));
    vec3 way = light.place.xyz - point_at(header, paint.frame, paint.near, middle(strip));
    float squared = dot3(way, way);
    return power * (abs(dot3(n, way)) / (squared * sqrt(squared)));
}

// False where no way from the piece to the light can pass the sphere.
bool may_shade(Header header, Paint paint, uint polygon, Light light, Sphere sphere) {
    vec3 from = point_at(header, paint.frame, paint.near, middle(polygon));
    float wide = 0.0;
    for (uint k = 0u; k < counts[polygon]; k++) {
        vec3 apart = point_at(header, paint.frame, paint.near, corner(polygon, k)) - from;
        wide = max(wide, sqrt(dot3(apart, apart)));
    }
    bool point_light = MODE_IS(LIGHT_KINDS, LIGHT_POINT, light.link.x);
    vec3 way = point_light ? light.place.xyz - from : light.place.xyz;
    vec3 to = sphere.ball.xyz - from;
    float ahead = max(dot3(to, way) / dot3(way, way), 0.0);
    vec3 aside = to - (point_light ? min(ahead, 1.0) : ahead) * way;
    return sqrt(dot3(aside, aside)) <= sphere.ball.w + wide;
}

// Strips that a piece is cut into: the root of STRIPS times the logarithm of the ratio of depths.
const float STRIPS = 2000.0;
const float MOST_STRIPS = 64.0;
// What lies e^7 times as deep as the piece's nearest part counts as one strip.
const float DEEPEST = 7.0;
const float LOG2_E = 1.44269504088896;
// Cells that an edge of a strip may cross, and what all strips of a piece share beyond that.
const float CELLS_OF_AN_EDGE = 32.0;
const float CELLS_OF_ALL = 512.0;

vec3 mean_color(Material record, Grid grid, uint strip, Quotient quotient, float most, inout bool ended) {
    float reach = longest_edge(strip, in_grid(grid, quotient, ivec2(0)));
    // The level at which it is short enough.
    if (reach > most) grid = coarser(grid, int(ceil(log2_accurate(reach / most))));
    if (grid.unknown) {
        gave_up = true;
        return vec3(0.0);
    }
    vec3 mean = mean_over(grid, strip, quotient, reach < SMALLEST, crossed, ended);
    if (grid.checker) {
        Procedural what = procedural_at(texture_at(record.link.y).place.x);
        return what.background.xyz + mean.x * (what.figure.xyz - what.background.xyz);
    }
    return vec3(grid.least) + grid.step * mean;
}

// Texture times irradiance / pi, integrated over PIECE, in strips within which the depth hardly changes: there
// equal areas of the texture are equal areas of the picture.
vec3 integral(Header header, Paint paint, bool has_light, Light light) {
    bool textured = TEXTURED && paint.record.link.y != NO_TEXTURE;
    vec3 depth = textured ? paint.quotient.below : below(header, paint.near);
    vec2 ends = range(PIECE, depth);
    float span = min(log2_accurate(ends.y / max(ends.x, 1e-30 * ends.y)) / LOG2_E, DEEPEST);
    float strips = 1.0;
    if (textured || has_light) strips = clamp(ceil(sqrt(STRIPS * span)), 1.0, MOST_STRIPS);
    float most = CELLS_OF_AN_EDGE + CELLS_OF_ALL / strips;
    Grid grid = checker_grid();
    if (textured) {
        Texture image = texture_at(paint.record.link.y);
        bool checker = MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_PROCEDURAL, image.link.w);
        if (!checker) grid = texture_grid(paint.record.link.y, image, sampler_at(paint.record.link.z));
    }
    uint rest = PIECE;
    vec3 sum = vec3(0.0);
    bool ended = true;
    float k = 1.0;
    for (; k <= strips && !gave_up; k += 1.0) {
        // Beyond the last strip lies nothing.
        float limit = k < strips ? ends.y * exp2_accurate(-span * k / strips * LOG2_E) : -1.0;
        uint beyond = PIECE + OTHER - rest;
        if (!split(rest, depth - vec3(0.0, 0.0, limit), STRIP, beyond)) gave_up = true;
        rest = beyond;
        float share = area(STRIP);
        if (!(share > 0.0)) continue;
        vec3 color = vec3(1.0);
        if (textured) color = mean_color(paint.record, grid, STRIP, paint.quotient, most, ended);
        if (crossed > MOST_CELLS) gave_up = true;
        if (LIGHTS != 0u && has_light) color *= irradiance(header, paint, STRIP, light);
        sum += share * color;
    }
    if (!ended || k <= strips) gave_up = true;
    return sum;
}

// The integral over those parts of SEEN that see the light; without one, over all of it.
vec3 lit_by(Header header, Paint paint, uint shape, bool has_light, Light light) {
    uint planes = COUNT(PLANES, header.counts.x);
    uint before_triangles = planes + COUNT(SPHERES, header.counts.y);
    uint shapes = before_triangles + COUNT(TRIANGLES, header.counts.z);
    vec3 sum = vec3(0.0);
    uint bottom = waiting;
    if (!has_light) push_piece(SEEN, shapes);
    else if (is_lit(header, paint, SEEN, light)) push_piece(SEEN, 0u);
    while (waiting > bottom && !gave_up) {
        uint by = pop_piece();
        if (LIGHTS == 0u || by == shapes) {
            sum += integral(header, paint, has_light, light);
            continue;
        }
        bool is_sphere = SPHERES != 0u && by >= planes && by < before_triangles;
        if (is_sphere && may_shade(header, paint, PIECE, light, sphere_at(by - planes))) gave_up = true;
        if (by == shape || is_sphere) push_piece(PIECE, by + 1u);
        else {
            met[MAX_MET] = shadow_region(header, paint.frame, paint.near, by, light);
            carve(by, MAX_MET, false, vec3(0.0), false);
        }
    }
    return sum;
}

// SEEN, a visible piece: its colour, or the beam that goes on.
vec3 shade(Header header, Beam beam, uint own) {
    uint shape = met_shapes[own];
    uvec2 link = links(header, shape);
    Material record = material_at(link.x);
    Map map = map_at(link.y);
    vec3 near = met[own].nearness;
    if (!is_simple(header, shape, record, map)) {
        gave_up = true;
        return vec3(0.0);
    }
    vec3 carried = beam.carried * record.color.xyz;
    if (MODE_IS(MODELS, MODEL_MIRROR, record.link.x)) {
        if (!BOUNCES || beam.depth >= header.size.w) return vec3(0.0);
        if (waiting_beams == MAX_BEAMS) {
            gave_up = true;
            return vec3(0.0);
        }
        vec4 plane = shape_plane(header, shape);
        Frame frame = mirrored_frame(header, beam.frame, plane.xyz, plane.w);
        copy(SEEN, BEAMS_AT + waiting_beams);
        beams[waiting_beams] = Beam(frame, carried, shape, near, beam.depth + 1u);
        waiting_beams++;
        return vec3(0.0);
    }
    Quotient quotient = Quotient(near, near, near);
    if (TEXTURED && record.link.y != NO_TEXTURE) quotient = coordinates(header, beam.frame, shape, map, near);
    Paint paint = Paint(record, quotient, shape_plane(header, shape), beam.frame, near);
    bool unlit = MODE_IS(MODELS, MODEL_UNLIT, record.link.x);
    uint lights = unlit ? 1u : COUNT(LIGHTS, header.key.y);
    vec3 sum = vec3(0.0);
    uint i = 0u;
    for (; i < lights && !gave_up; i++) {
        Light light = Light(vec4(0.0), vec4(0.0), uvec4(0u));
        if (LIGHTS != 0u && !unlit) light = light_at(i);
        sum += lit_by(header, paint, shape, LIGHTS != 0u && !unlit, light);
    }
    if (i < lights) gave_up = true;
    return carried * sum;
}

// Everything that one beam sees but for what its mirrors send on.
vec3 follow(Header header, Beam beam) {
    find_shapes(header, beam);
    float left = area(WHOLE);
    vec3 sum = vec3(0.0);
    uint own = 0u;
    for (; own < met_count && !gave_up; own++) {
        push_piece(WHOLE, 0u);
        while (waiting > 0u && !gave_up) {
            uint stage = pop_piece();
            // Stage 0 cuts out the shape itself, the others take away what lies before it.
            if (stage > met_count) {
                left -= area(PIECE);
                copy(PIECE, SEEN);
                sum += shade(header, beam, own);
            } else if (stage == own + 1u) {
                push_piece(PIECE, stage + 1u);
            } else {
                bool kept = stage == 0u;
                uint by = kept ? own : stage - 1u;
                bool mirrored = BOUNCES && beam.skip != NO_SHAPE;
                // What lies before the mirror that the beam left is not seen.
                vec3 first = kept ? beam.limit - met[own].nearness : before(by, own, PIECE);
                carve(stage, by, !kept || mirrored, first, kept);
            }
        }
    }
    if (own < met_count || waiting > 0u) gave_up = true;
    if (left > LEAST_AREA) {
        if (ENVIRONMENT && header.counts.w != NO_MATERIAL) gave_up = true;
        sum += left * beam.carried * header.background.xyz;
    }
    return sum;
}

void main() {
    Header header = load_header();
    hold_scene();
    uvec2 place = film_pixel();
    if (place.x >= header.size.x || place.y >= slice.band_height) return;
    uvec2 pixel = uvec2(place.x, place.y + slice.band_y) + header.image.zw;
    gave_up = false;
    crossed = 0u;
    waiting = 0u;
    waiting_beams = 0u;
    vec3 color = vec3(0.0);
    unit_square(WHOLE);
    Beam beam = Beam(pixel_frame(header, pixel), vec3(1.0), NO_SHAPE, vec3(0.0), 0u);
    bool more = true;
    while (more && !gave_up) {
        color += follow(header, beam);
        more = BOUNCES && waiting_beams > 0u;
        if (more) {
            waiting_beams--;
            beam = beams[waiting_beams];
            copy(BEAMS_AT + waiting_beams, WHOLE);
        }
    }
    film[place.y * header.size.x + place.x] = vec4(color, gave_up || more ? 1.0 : 0.0);
}

#endif
