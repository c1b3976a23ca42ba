// One thread per pixel: the sum of a block of samples, added to the film. film[pixel] = sum of radiance
// (rgb); with COMPENSATED, film[pixel + pixels] holds the accumulated rounding error (Kahan 1965), as blocks
// arrive in a fixed order. Samples in negative lobes of the pixel filter count with their sign, film[pixel].w
// is the sum of the signs, and the plane after all others holds the sum of those samples alone, without their
// sign.
#ifndef RENDER_MAIN_GLSL
#define RENDER_MAIN_GLSL

#include "features.glsl"
#include "layout.glsl"
#include "sample_dimensions.glsl"
#include "camera_sample.glsl"
#include "film_sums.glsl"
#include "loops.glsl"
#include "render_team.glsl"

// Samples of single pixels. A film of batches holds two halves, each with sums of radiance and of the mean of
// its squared channels; if the pixel filter has negative lobes two more with the sums of samples in these,
// and two with the sum of the signs and the number of samples. With BATCH_APART the film has one such entry for
// each batch instead of for each half.
layout(std430, set = 0, binding = BINDING_LIST) readonly buffer Batches { PixelBatch batches[]; };

// The work of one thread: samples of one pixel, added to one entry of the film.
struct Task {
    uvec2 place; // in the band
    uint part; // of a batch: the half of the film, BATCH_BARE, BATCH_APART, and the stream of samples
    uint first;
    uint end;
};

#define NO_TASK Task(uvec2(0u, slice.band_height), 0u, 0u, 0u)

Task tile_task() {
    return Task(film_pixel(), 0u, first_sample(), first_sample() + sample_count());
}

// Batches fill tiles one after the other, in the order of the list.
uint batch_index() {
    uint thread = gl_WorkGroupID.x * gl_WorkGroupSize.x * gl_WorkGroupSize.y + gl_LocalInvocationIndex;
    return (slice.first_tile + gl_WorkGroupID.y) * (TILE * TILE) + thread;
}

Task listed_task() {
    uint i = batch_index();
    if (i >= slice.tiles) return NO_TASK;
    PixelBatch batch = batches[i];
    return Task(uvec2(batch.place & 0xFFFFu, batch.place >> 16u), batch.part, batch.first, batch.first + batch.count);
}

// Without a list all pixels have the same batch, both halves of a pixel side by side.
Task batch_task(const Header header) {
    uint i = batch_index();
    if (i >= slice.tiles) return NO_TASK;
    uvec2 place = uvec2((i >> 1u) % header.film_size.x, (i >> 1u) / header.film_size.x);
    uint part = (i & 1u) | (i & 1u) << BATCH_STREAM_SHIFT;
    return Task(place, part, first_sample(), first_sample() + sample_count());
}

void main() {
    Header header = load_header();
    preload_records();
    clear_notices();
    if (TEAMED || MESH_SEARCH == SEARCH_TEAM_REST) {
        render_as_team(header);
        return;
    }
    bool is_batch = MODE_IS(SCHEDULES, SCHEDULE_BATCHES, schedule());
    Task task;
    bool is_listed = OPAQUE(slice.listed) != 0u;
    if (is_listed) task = listed_task();
    else if (is_batch) task = batch_task(header);
    else task = tile_task();
    if (!in_film(header, task.place)) return;
    uvec2 pixel = picture_pixel(header, task.place);
    // In a batch, a sample's share of the pixel is that of the pixel's number of samples after the batch.
    if (FILTERED && is_batch && header.footprint != FOOTPRINT_NONE) {
        float share = inversesqrt(2.0 * float(task.end)) * filter_width(header);
        header.sample_side = (task.part & BATCH_BARE) != 0u ? 0.0 : share;
    }
    // Streams are as independent as different seeds.
    uint stream = task.part >> BATCH_STREAM_SHIFT;
    uvec2 key = pixel_key(pixel, header.seed + stream * 0x9E3779B9u, header.shares_pattern);
    Points points = pixel_points(header, pixel, key);
    PixelCorner corner = pixel_corner(header, pixel);
    uint at = film_index(header, task.place);
    uint end = task.end;
    bool sees_nothing = false; // but the background
    Candidates candidates = ANYTHING;
    if (TILE_CULLED) {
        uvec2 place = task.place + uvec2(0u, slice.band_y);
        candidates.list = cell_list(header, place);
        if (CONCAVE_SHAPES) {
            if (candidates.list != NO_LIST) mark_in_pixel(header, place, pixel, candidates);
            Candidates marked = candidates;
            if (candidates.list != NO_LIST) hold_in_pixel(candidates);
            // Not all can be held: the pixel is left to the next pass.
            if (HOLDS) {
                unfinished = BY_HELD && any_left(candidates);
                if (SHADES) unfinished = !gather_shades(header, pixel, marked) || unfinished;
                if (unfinished) end = task.first;
            }
        }
        if (BACKGROUND_IS_SUMMED) {
            sees_nothing = is_empty(candidates.list);
            if (sees_nothing) end = task.first;
        }
    }

    // One loop for samples and bounces: an iteration follows one ray, and a pixel whose path has ended starts
    // its next sample while its neighbours' paths continue.
    vec3 sum = vec3(0.0);
    float squares = 0.0;   // of a batch
    vec3 seen = vec3(0.0); // of a batch: by the current path
    float sign = 1.0; // of the current path's sample, and the sum of all
    float signs = 0.0;
    vec3 negative = vec3(0.0); // sum of the samples whose sign is negative, without the sign
    uint s = task.first;
    Path path;
    path.is_alive = false;
    // No do-while: lavapipe (Mesa 22.3.6) loses lanes that leave a loop around another by a condition after
    // its body.
    uint block = block_of(task.end - task.first);
    vec3 lost = vec3(0.0); // the part that rounding has added to the sum
    uint stop = s;
    vec3 begun = vec3(0.0);
    if (LOOPS_END && !BLOCKS && !COMPENSATED && !is_batch) {
        if (first_sample() > 0u) begun = film[at].xyz;
    }
    vec3 part;
    uvec2 position = uvec2(0u);
    if (SAMPLE_DIMENSIONS == 0u) position = sample_point(points, s, false);
    while (true) {
        // Groups divide a block. In these places a condition in place of the choices would have lavapipe (Mesa 22.3.6) add the
        // parts of lanes that are in the middle of a block, if others beside them have fewer samples.
        bool begins = !GROUPED || s == stop;
        uint block_end = BLOCKS ? min(s + block, end) : end;
        stop = begins ? block_end : stop;
        part = begins ? begun : part;
        uint start = s;
        uint until = stop;
        if (GROUPED) {
            until = min(s + GROUP, stop);
            group_sample = 0u;
            for (uint k = 0u; k < GROUP; k++) group_ways[k] = camera_ray(header, corner, sample_place(header, points, s + k).inside).direction;
            find_for_group(candidates);
        }
        while (s < until) {
            bool starts = !BOUNCES || !path.is_alive;
            SampleDimensions dimensions = NO_CHOICES;
            if (SAMPLE_DIMENSIONS != 0u) dimensions = choose(header, points, s, starts ? 0u : path.depth, starts);
            else {
                // The next place is independent of this sample, which leaves processors both to do at once. Beyond the last one
                // there is none: permutations would look for it forever.
                dimensions.place = position;
                uvec2 next = sample_point(points, min(s + 1u, task.end - 1u), false);
                position = starts ? next : position;
            }
            if (starts) {
                path = camera_sample(header, pixel, corner, key, points, s, dimensions, candidates, sign);
                signs += sign;
            }
            vec3 more = advance(header, points, dimensions, path);
            count_diagnostic(DIAGNOSTIC_RADIANCE, no_number(more));
            if (SIGNED) {
                negative += sign < 0.0 ? more : vec3(0.0);
                more *= sign;
            }
            part += more;
            if (is_batch) {
                seen += more;
                if (!path.is_alive) {
                    squares += dot3(seen, seen) * (1.0 / 3.0);
                    seen = vec3(0.0);
                }
            }
            s += path.is_alive ? 0u : 1u;
            if (GROUPED) group_sample = s - start;
        }
        bool ends = !GROUPED || s == stop;
        vec3 term = ends ? part - lost : vec3(0.0);
        vec3 total = sum + term;
        lost = ends ? (total - sum) - term : lost;
        sum = total;
        if ((!BLOCKS && !GROUPED) || s >= end) break;
    }

    if (BY_LISTS || LOOPS_END) {
        if (loops_were_ended() || (BY_LISTS && unfinished)) {
            leave_unfinished(is_listed || is_batch ? batch_index() : at);
            return;
        }
    }
    if (BACKGROUND_IS_SUMMED) {
        if (sees_nothing) sum_background(header, task.end - task.first, begun, sum, lost, squares);
    }
    report_notices();

    uint pixels = header.film_size.x * slice.band_height;
    bool is_signed = MODE_IS(PIXEL_FILTERS, PIXEL_FILTER_MITCHELL, header.pixel_filter);
    if (is_batch) {
        bool apart = (task.part & BATCH_APART) != 0u;
        at = apart ? batch_index() : at + (task.part & 1u) * pixels;
        uint behind = apart ? slice.tiles : 2u * pixels; // stride between kinds of sums
        bool adds = !apart && task.first > 0u;
        vec4 sums = vec4(sum, squares);
        film[at] = adds ? film[at] + sums : sums;
        if (is_signed) {
            vec4 counts = vec4(signs, float(task.end - task.first), 0.0, 0.0);
            vec4 below = vec4(negative, 0.0);
            film[at + behind] = adds ? film[at + behind] + below : below;
            film[at + 2u * behind] = adds ? film[at + 2u * behind] + counts : counts;
        }
        return;
    }
    add_to_film(header, at, sum, lost, signs, negative);
}

#endif
