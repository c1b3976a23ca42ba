// One thread a pixel: the sum of a chunk of samples, added to the film. Tiles of 64 × 64 pixels are
// visited in an order that spreads each slice over the picture, so that a slice's time foretells the
// next one's. film[pixel] = sum of radiance (rgb); with COMPENSATED, film[pixel + pixels] holds
// what rounding has lost so far (Kahan 1965), as chunks arrive in a fixed order.
#ifndef RENDER_MAIN_GLSL
#define RENDER_MAIN_GLSL

#include "features.glsl"
#include "layout.glsl"
#include "choices.glsl"
#include "shade.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z = 1) in;

layout(std430, set = 0, binding = 0) buffer Film { vec4 film[]; };

// Samples of single pixels: place (x | y << 16), half and JOB_BARE, first sample, count. A film of jobs holds two halves,
// each with sums of radiance and of its square's mean over the channels.
layout(std430, set = 0, binding = 4) readonly buffer Jobs { uvec4 jobs[]; };

layout(push_constant) uniform Slice {
    uint tiles_x;      // tiles across the picture
    uint tiles;        // tiles in this band
    uint tile_stride;  // coprime to `tiles`: the visiting order
    uint first_tile;
    uint band_y;       // first row of the band
    uint band_height;
    uint first_sample;
    uint sample_count;
    uint schedule;     // tiles of the film, or a list of `tiles` jobs
} slice;

const uint TILE = 64u;

// Thread -> pixel of the film. Workgroups of a tile follow each other in x, tiles in y.
uvec2 film_pixel() {
    uint tile = ((slice.first_tile + gl_WorkGroupID.y) * slice.tile_stride) % slice.tiles;
    uvec2 origin = uvec2(tile % slice.tiles_x, tile / slice.tiles_x) * TILE;
    uint across = TILE / gl_WorkGroupSize.x;
    uvec2 group = uvec2(gl_WorkGroupID.x % across, gl_WorkGroupID.x / across);
    return origin + group * gl_WorkGroupSize.xy + gl_LocalInvocationID.xy;
}

// What one thread does: samples of one pixel, into one place of the film.
struct Task {
    uvec2 place; // in the band
    uint part; // of a job: which half of the samples, and JOB_BARE
    uint first;
    uint end;
};

Task tile_task() {
    return Task(film_pixel(), 0u, slice.first_sample, slice.first_sample + slice.sample_count);
}

// Jobs fill tiles one after the other, in the order of the list.
Task job_task() {
    uint thread = gl_WorkGroupID.x * gl_WorkGroupSize.x * gl_WorkGroupSize.y + gl_LocalInvocationIndex;
    uint i = (slice.first_tile + gl_WorkGroupID.y) * (TILE * TILE) + thread;
    if (i >= slice.tiles) return Task(uvec2(0u, slice.band_height), 0u, 0u, 0u);
    uvec4 job = jobs[i];
    return Task(uvec2(job.x & 0xFFFFu, job.x >> 16u), job.y, job.z, job.z + job.w);
}

void main() {
    Header header = load_header();
    hold_scene();
    bool is_job = MODE_IS(SCHEDULES, SCHEDULE_JOBS, slice.schedule);
    Task task;
    if (is_job) task = job_task();
    else task = tile_task();
    if (task.place.x >= header.size.x || task.place.y >= slice.band_height) return;
    uvec2 pixel = uvec2(task.place.x, task.place.y + slice.band_y) + header.image.zw;
    // Of a job, a sample's share of the pixel is by the samples that the pixel has at its end.
    if (FILTERED && is_job) header.step_x.w = (task.part & JOB_BARE) != 0u ? 0.0 : inversesqrt(2.0 * float(task.end));
    // The second half is as good as another seed.
    uint part = task.part & 1u;
    uvec2 key = pixel_key(pixel, header.sampling.w + part * 0x9E3779B9u, header.key.x != 0u);
    Points points = pixel_points(header, pixel, key);

    // One loop for samples and bounces: a turn follows one ray, and a pixel whose path has ended
    // starts its next sample while its neighbours' paths go on.
    vec3 sum = vec3(0.0);
    float squares = 0.0;   // of a job
    vec3 seen = vec3(0.0); // of a job: by the current path
    uint s = task.first;
    Path path;
    path.goes_on = false;
    while (s < task.end) {
        bool starts = !BOUNCES || !path.goes_on;
        Choices choices = NO_CHOICES;
        if (CHOICES != 0u) choices = choose(header, points, s, starts ? 0u : path.depth, starts);
        if (starts) {
            uvec2 position;
            if (CHOICES == 0u) position = sample_point(points, s);
            else position = choices.place;
            Header camera = header;
            float time = 0.0;
            if (TIMED) time = header.lens.z + header.lens.w * unit_square(choices.time).x;
            if (MOVING_CAMERA) {
                if (header.chances.z != 0u) camera = camera_at(header, time);
            }
            Ray ray = camera_ray(camera, pixel, position);
            if (LENS) {
                if (header.lens.x > 0.0) ray = through_lens(camera, ray, unit_square(choices.lens));
            }
            if (TIMED) ray.time = time;
            if (MOVING_CAMERA) {
                if (header.chances.z != 0u) ray.origin += time * header.eye_motion.xyz;
            }
            // Bits that have nothing to do with the sample's position.
            uvec2 random = RANDOM ? pcg2d(sample_bits(key, s) ^ 0x5BD1E995u) : uvec2(0u);
            path = camera_path(ray, camera_beam(camera, ray), random);
        }
        vec3 more = advance(header, points, choices, path);
        sum += more;
        if (is_job) {
            seen += more;
            if (!path.goes_on) {
                squares += dot3(seen, seen) * (1.0 / 3.0);
                seen = vec3(0.0);
            }
        }
        s += path.goes_on ? 0u : 1u;
    }

    uint at = task.place.y * header.size.x + task.place.x;
    uint pixels = header.size.x * slice.band_height;
    if (is_job) {
        at += part * pixels;
        vec4 sums = vec4(sum, squares);
        film[at] = task.first > 0u ? film[at] + sums : sums;
        return;
    }
    if (COMPENSATED && slice.first_sample > 0u) {
        vec3 term = sum - film[at + pixels].xyz;
        vec3 total = film[at].xyz + term;
        vec3 lost = (total - film[at].xyz) - term;
        film[at + pixels] = vec4(lost, 0.0);
        sum = total;
    } else if (COMPENSATED) {
        film[at + pixels] = vec4(0.0);
    }
    film[at] = vec4(sum, 0.0);
}

#endif
