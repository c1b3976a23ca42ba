// One thread a pixel: the mean of a chunk of samples, added to the film. Tiles of 64 × 64 pixels are
// visited in an order that spreads each slice over the picture, so that a slice's time foretells the
// next one's. film[pixel] = sum of radiance (rgb); with COMPENSATED, film[pixel + pixels] holds
// what rounding has lost so far (Kahan 1965), as chunks arrive in a fixed order.
#ifndef RENDER_MAIN_GLSL
#define RENDER_MAIN_GLSL

#include "features.glsl"
#include "layout.glsl"
#include "patterns.glsl"
#include "shade.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z = 1) in;

layout(std430, set = 0, binding = 0) buffer Film { vec4 film[]; };

layout(push_constant) uniform Slice {
    uint tiles_x;      // tiles across the picture
    uint tiles;        // tiles in this band
    uint tile_stride;  // coprime to `tiles`: the visiting order
    uint first_tile;
    uint band_y;       // first row of the band
    uint band_height;
    uint first_sample;
    uint sample_count;
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

void main() {
    Header header = load_header();
    hold_scene();
    uvec2 place = film_pixel();
    if (place.x >= header.size.x || place.y >= slice.band_height) return;
    uvec2 pixel = uvec2(place.x, place.y + slice.band_y) + header.image.zw;
    uvec2 key = pixel_key(pixel, header.sampling.w, header.key.x != 0u);
    Points points = pixel_points(header, pixel, key);

    // One loop for samples and bounces: a turn follows one ray, and a pixel whose path has ended
    // starts its next sample while its neighbours' paths go on.
    vec3 sum = vec3(0.0);
    uint s = slice.first_sample;
    uint end = s + slice.sample_count;
    Path path;
    path.goes_on = false;
    while (s < end) {
        if (!BOUNCES || !path.goes_on) {
            uvec2 position = sample_point(points, s);
            Ray ray = camera_ray(header, pixel, position);
            // Bits that have nothing to do with the sample's position.
            uvec2 random = RANDOM ? pcg2d(sample_bits(key, s) ^ 0x5BD1E995u) : uvec2(0u);
            path = camera_path(ray, camera_beam(header, ray), random);
        }
        sum += advance(header, path);
        s += path.goes_on ? 0u : 1u;
    }

    uint at = place.y * header.size.x + place.x;
    if (COMPENSATED && slice.first_sample > 0u) {
        uint lost_at = at + header.size.x * slice.band_height;
        vec3 term = sum - film[lost_at].xyz;
        vec3 total = film[at].xyz + term;
        vec3 lost = (total - film[at].xyz) - term;
        film[lost_at] = vec4(lost, 0.0);
        sum = total;
    } else if (COMPENSATED) {
        film[at + header.size.x * slice.band_height] = vec4(0.0);
    }
    film[at] = vec4(sum, 0.0);
}

#endif
