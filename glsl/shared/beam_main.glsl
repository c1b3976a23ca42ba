// One beam per pixel (Heckbert & Hanrahan 1984): the pixel's square is cut along the edges of the polygons
// that it meets and along their intersections; each visible fragment contributes its exact area in the pixel
// and the exact integral of its colour. Mirrors reflect the fragment's beam. Pixels beyond this are left to
// samples: film[pixel].w = 1. Twin: src/oracle/beam.rs.
#ifndef BEAM_MAIN_GLSL
#define BEAM_MAIN_GLSL

#define HIDE_UNIFORMS
#define SHAPES_IN_BEAMS
#include "features.glsl"
#include "shading_integral.glsl"
#include "slice.glsl"
#include "loops.glsl"

const uint MAX_MET = 8u;      // most shapes that a beam may meet
// Planes whose inverse depths differ by a smaller relative amount are coplanar: the first in the list is
// visible.
const float COPLANAR = 4e-6;

// The rays of a part of the pixel.
struct PixelBeam {
    PixelFrustum frame;
    vec3 carried;
    uint skip;  // the mirror that it left, and that mirror's inverse depth
    vec3 limit;
    uint depth;
};

// State of one thread. The pixel is too complex for a beam, which gives up.
ConvexRegion met[MAX_MET + 1u]; // the last: of a shadow
uint met_shapes[MAX_MET];
uint met_count;
uint stages[MAX_FRAGMENTS]; // of a pending fragment: the number of tests that are done
uint waiting;
PixelBeam beams[MAX_BEAMS];
uint waiting_beams;

// The pixel's colour so far. Contributions are added here, not returned through the loops, where NVIDIA's
// compiler (driver 580) loses sums of some threads.
vec3 color;

// Pushes the polygon after the pending ones.
void keep_piece(uint stage) {
    if (waiting < MAX_FRAGMENTS) stages[waiting++] = stage;
    else gave_up = true;
}

void push_piece(uint polygon, uint stage) {
    copy(polygon, waiting);
    keep_piece(stage);
}

// Pops the last pending fragment as PIECE; returns its stage.
uint pop_piece() {
    waiting--;
    copy(waiting, PIECE);
    return stages[waiting];
}

// Returns the difference of inverse depths below which planes count as coplanar.
float negligible(vec3 inverse_depth, uint polygon) {
    vec2 ends = range(polygon, inverse_depth);
    return COPLANAR * max(ends.y, -ends.x);
}

// Finds all shapes that the beam may meet. For a beam from a mirror these are clipped to the mirror's front:
// anything behind it is neither visible nor an occluder.
void find_shapes(const Header header, PixelBeam beam) {
    uint shapes = shape_count();
    met_count = 0u;
    bool mirrored = BOUNCES && beam.skip != NO_SHAPE;
    float least = mirrored ? negligible(beam.limit, WHOLE) : 0.0;
    for (uint shape = 0u; shape < shapes; shape++) {
        if (shape == beam.skip) continue;
        if (!has_region(shape)) {
            if (may_meet(header, beam.frame, WHOLE, shape)) gave_up = true;
            continue;
        }
        ConvexRegion region = shape_region(header, beam.frame, shape);
        if (mirrored) {
            vec3 beyond = beam.limit - region.inverse_depth;
            vec2 ends = range(WHOLE, beyond);
            if (ends.y <= least) continue;
            if (ends.x < 0.0) region.lines[region.count++] = beyond;
        }
        bool touches = true;
        for (uint k = 0u; k < region.count; k++) touches = touches && range(WHOLE, region.lines[k]).y > 0.0;
        if (!touches) continue;
        if (met_count < MAX_MET) {
            met[met_count].count = region.count;
            met[met_count].inverse_depth = region.inverse_depth;
            for (uint k = 0u; k < region.count; k++) met[met_count].lines[k] = region.lines[k];
            met_shapes[met_count] = shape;
            met_count++;
        } else {
            gave_up = true;
        }
    }
}

// Returns a function that is positive where `by` is nearer than `own`.
vec3 before(uint by, uint own, uint polygon) {
    vec3 apart = met[by].inverse_depth - met[own].inverse_depth;
    vec2 ends = range(polygon, apart);
    if (max(ends.y, -ends.x) > negligible(met[own].inverse_depth, polygon)) return apart;
    return vec3(0.0, 0.0, by < own ? 1.0 : -1.0);
}

// Cuts PIECE along the lines of a shape, preceded by the line `first`. If `kept`, the part within all lines
// is kept, otherwise the parts outside.
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
        if (!kept && area(waiting) > MIN_AREA) keep_piece(stage + 1u);
        rest = inside;
        gone = area(rest) <= MIN_AREA;
    }
    if (kept && !gone) push_piece(rest, stage + 1u);
}

// Adds the integral over the parts of SEEN that see the light; without a light, over all of it.
void lit_by(const Header header, const ShadingIntegral paint, uint shape, bool has_light, const Light light) {
    uint shapes = shape_count();
    uint bottom = waiting;
    if (!has_light) push_piece(SEEN, shapes);
    else if (is_facing(header, paint, SEEN, light)) push_piece(SEEN, 0u);
    float least = is_parallel(header) ? negligible(paint.near, SEEN) : COPLANAR;
    while (waiting > bottom && !gave_up) {
        uint by = pop_piece();
        if (LIGHTS == 0u || by == shapes) {
            color += paint.carried * integral(header, paint, has_light, light);
            continue;
        }
        bool is_round = !has_region(by);
        if (is_round && may_shade(header, paint.frame, paint.near, PIECE, light, by)) gave_up = true;
        if (by == shape || is_round) push_piece(PIECE, by + 1u);
        else {
            met[MAX_MET] = shadow_region(header, paint.frame, paint.near, by, light);
            // A shape in the surface's own plane, or below it, does not occlude the light.
            if (range(PIECE, met[MAX_MET].lines[0]).y <= least) push_piece(PIECE, by + 1u);
            else carve(by, MAX_MET, false, vec3(0.0), false);
        }
    }
}

// Adds the colour of SEEN, a visible fragment, or pushes the mirrored beam.
void shade(const Header header, PixelBeam beam, uint own) {
    uint shape = met_shapes[own];
    uvec2 link = shape_links(shape);
    Material record = material_at(link.x);
    UvProjection map = uv_projection_at(link.y);
    vec3 near = met[own].inverse_depth;
    if (!is_simple(shape, record, map)) {
        gave_up = true;
        return;
    }
    vec3 carried = beam.carried * record.color;
    if (is_specular(record.model)) {
        if (!BOUNCES || beam.depth >= header.max_depth) return;
        if (waiting_beams == MAX_BEAMS) {
            gave_up = true;
            return;
        }
        vec4 plane = shape_plane(shape);
        PixelFrustum frame = mirrored_frame(header, beam.frame, plane.xyz, plane.w);
        copy(SEEN, BEAMS_AT + waiting_beams);
        beams[waiting_beams] = PixelBeam(frame, carried, shape, near, beam.depth + 1u);
        waiting_beams++;
        return;
    }
    RationalMap quotient = RationalMap(near, near, near);
    if (TEXTURED && record.texture_index != NO_TEXTURE) quotient = coordinates(header, beam.frame, shape, map, near);
    ShadingIntegral paint = ShadingIntegral(record, carried, quotient, shape_plane(shape), beam.frame, near);
    bool unlit = !is_lit(record.model);
    uint lights = unlit ? 1u : COUNT(LIGHTS, lengths.lights);
    uint i = 0u;
    for (; i < lights && !gave_up; i++) {
        Light light = NO_LIGHT;
        if (LIGHTS != 0u && !unlit) light = light_at(i);
        // Beams cannot integrate the penumbra of area lights.
        if ((AREA_LIGHTS || RANGED) && light.kind >= LIGHT_SPOT) gave_up = true;
        lit_by(header, paint, shape, LIGHTS != 0u && !unlit, light);
    }
    if (i < lights) gave_up = true;
}

// Adds everything that one beam sees, except through its mirrors.
void follow(const Header header, PixelBeam beam) {
    find_shapes(header, beam);
    float left = area(WHOLE);
    uint own = 0u;
    for (; own < met_count && !gave_up; own++) {
        push_piece(WHOLE, 0u);
        while (waiting > 0u && !gave_up) {
            uint stage = pop_piece();
            // Stage 0 clips to the shape itself, the other stages remove the parts hidden by each shape.
            if (stage > met_count) {
                left -= area(PIECE);
                copy(PIECE, SEEN);
                shade(header, beam, own);
            } else if (stage == own + 1u) {
                push_piece(PIECE, stage + 1u);
            } else {
                bool kept = stage == 0u;
                uint by = kept ? own : stage - 1u;
                vec3 first = vec3(0.0);
                if (!kept) first = before(by, own, PIECE);
                carve(stage, by, !kept, first, kept);
            }
        }
    }
    if (own < met_count || waiting > 0u) gave_up = true;
    if (left > MIN_AREA) {
        if (ENVIRONMENT && header.environment_material != NO_MATERIAL) gave_up = true;
        color += left * beam.carried * header.background;
    }
}

void main() {
    Header header = load_header();
    preload_records();
    uvec2 place = film_pixel();
    if (!in_film(header, place)) return;
    uvec2 pixel = picture_pixel(header, place);
    gave_up = false;
    crossed = 0u;
    waiting = 0u;
    waiting_beams = 0u;
    color = vec3(0.0);
    unit_square(WHOLE);
    PixelBeam beam = PixelBeam(pixel_frame(header, pixel), vec3(1.0), NO_SHAPE, vec3(0.0), 0u);
    bool more = true;
    while (more && !gave_up) {
        follow(header, beam);
        more = BOUNCES && waiting_beams > 0u;
        if (more) {
            waiting_beams--;
            beam = beams[waiting_beams];
            copy(BEAMS_AT + waiting_beams, WHOLE);
        }
    }
    film[film_index(header, place)] = vec4(color, gave_up || more || loops_were_ended() ? 1.0 : 0.0);
}

#endif
