// A workgroup samples its pixels together, a few at once with several samples each, so that its threads test the same
// triangles. Each pixel's samples are added in their order, as by a thread alone: the film is the same to the bit. Pixels
// whose lists are not enough are marked; a later pass finds what they see by the tree.
#ifndef RENDER_TEAM_GLSL
#define RENDER_TEAM_GLSL

#include "camera_sample.glsl"
#include "film_sums.glsl"

const uint TEAM_PIXELS = TEAM / TEAM_SQUARES; // of a square, at once

shared vec3 team_radiance[TEAM];

// In place of whether a pixel is left out: its sum is in the film.
const uint TEAM_SUMMED = 2u;

// Finds the work of the thread's own pixel: lists, or whether there is any.
void begin_for_team(const Header header, uvec2 place, uint member) {
    bool is_there = in_film(header, place);
    uvec2 pixel = picture_pixel(header, place);
    if (TEAMED) {
        Candidates candidates = ANYTHING;
        if (is_there) candidates.list = cell_list(header, place + uvec2(0u, slice.band_y));
        gather_for_team(header, pixel, member, candidates);
        barrier();
        if (SHADES) gather_shades_for_team(header, pixel, member, candidates);
        if (BACKGROUND_IS_SUMMED) {
            if (is_there && is_empty(candidates.list)) {
                vec3 sum;
                vec3 lost;
                float squares;
                sum_background(header, sample_count(), vec3(0.0), sum, lost, squares);
                add_to_film(header, film_index(header, place), sum, lost, 0.0, vec3(0.0));
                team_left_out[member] = TEAM_SUMMED;
            }
        }
        if (!is_there) team_left_out[member] = 1u;
    } else {
        team_left_out[member] = 1u;
        team_counts[member] = 0u;
        if (is_there) team_left_out[member] = film[film_index(header, place)].w == UNFINISHED ? 0u : 1u;
    }
    barrier();
}

void render_as_team(const Header header) {
    uint thread = gl_LocalInvocationIndex;
    uvec2 own = film_pixel();
    uvec2 corner = own - gl_LocalInvocationID.xy;
    begin_for_team(header, own, thread);

    uint turn = thread % TEAM_SAMPLES;
    uint slot = thread / TEAM_SAMPLES;
    uint first = first_sample();
    uint end = first + sample_count();
    // The later pass has a workgroup for each square: few have work, which takes long.
    for (uint square = gl_WorkGroupID.z; square < TEAM_SQUARES; square += gl_NumWorkGroups.z) {
        uvec2 offset = place_of_square(square);
        uint most = 0u; // triangles of a pixel
        bool is_done = true;
        for (uint k = 0u; k < TEAM_PIXELS; k++) {
            uint member = (offset.y + k / TEAM_SIDE) * TEAM_WIDTH + offset.x + k % TEAM_SIDE;
            most = max(most, team_counts[member]);
            is_done = is_done && team_left_out[member] != 0u;
        }
        offset += uvec2(slot % TEAM_SIDE, slot / TEAM_SIDE);
        uint member = offset.y * TEAM_WIDTH + offset.x;
        uvec2 place = corner + offset;
        uvec2 pixel = picture_pixel(header, place);
        bool is_seen = team_left_out[member] == 0u;
        Candidates candidates = ANYTHING;
        if (TEAMED) {
            if (is_seen) candidates.list = cell_list(header, place + uvec2(0u, slice.band_y));
            team_member = member;
            if (SHADES) load_region(member);
            unfinished = false;
        }
        uvec2 key = pixel_key(pixel, header.seed, header.shares_pattern);
        Points points = pixel_points(header, pixel, key);
        PixelCorner of_pixel = pixel_corner(header, pixel);

        // Of the first thread of each pixel.
        vec3 sum = vec3(0.0);
        vec3 lost = vec3(0.0);
        vec3 part = vec3(0.0);
        uint block = block_of(end - first);
        uint stop = BLOCKS ? min(first + block, end) : end;
        for (uint start = first; start < end && !is_done; start += TEAM_SAMPLES) {
            uint s = start + turn;
            SampleDimensions dimensions = NO_CHOICES;
            if (SAMPLE_DIMENSIONS != 0u) dimensions = choose(header, points, s, 0u, true);
            else dimensions.place = sample_point(points, s, false);
            float sign;
            Path path = camera_sample(header, pixel, of_pixel, key, points, s, dimensions, candidates, sign);
            if (TEAMED) {
                team_nearest = FAR;
                team_found = NO_SHAPE;
                for (uint held = 0u; held < most; held += TEAM_SAMPLES) {
                    if (start == first || most > TEAM_SAMPLES) {
                        barrier();
                        hold_for_team(candidates.list, member, held + turn, thread);
                        barrier();
                    }
                    uint count = team_counts[member];
                    find_for_team(path.ray.direction, thread - turn, count > held ? min(count - held, TEAM_SAMPLES) : 0u);
                }
            }
            vec3 radiance = vec3(0.0);
            if (is_seen && s < end) {
                radiance = advance(header, points, dimensions, path);
                count_diagnostic(DIAGNOSTIC_RADIANCE, no_number(radiance));
            }
            team_radiance[thread] = radiance;
            barrier();
            if (turn == 0u) {
                for (uint k = 0u; k < TEAM_SAMPLES && start + k < end; k++) {
                    part += team_radiance[thread + k];
                    if (start + k + 1u == stop) {
                        vec3 term = part - lost;
                        vec3 total = sum + term;
                        lost = (total - sum) - term;
                        sum = total;
                        part = vec3(0.0);
                        stop = min(stop + block, end);
                    }
                }
            }
            barrier();
        }
        if (TEAMED) {
            if (unfinished && is_seen) team_left_out[member] = 1u;
            barrier();
        }
        if (turn == 0u && in_film(header, place) && team_left_out[member] != TEAM_SUMMED) {
            uint at = film_index(header, place);
            if (!TEAMED) {
                if (is_seen) add_to_film(header, at, sum, lost, 0.0, vec3(0.0));
            } else if (team_left_out[member] != 0u) {
                film[at] = vec4(first > 0u ? film[at].xyz : vec3(0.0), UNFINISHED);
            } else {
                add_to_film(header, at, sum, lost, 0.0, vec3(0.0));
            }
        }
    }
    report_notices();
}

#endif
