// The path with which a sample begins: its place in the pixel, its time and its point of the lens in, the ray in the scene
// and its differential out. Twin: src/oracle/camera_sample.rs.
#ifndef CAMERA_SAMPLE_GLSL
#define CAMERA_SAMPLE_GLSL

#include "sample_dimensions.glsl"
#include "pixel_filter.glsl"
#include "shade.glsl"

// The place of a sample in its pixel.
Place sample_place(const Header header, const Points points, uint s) {
    uvec2 position;
    if (SAMPLE_DIMENSIONS == 0u) position = sample_point(points, s, false);
    else position = choose(header, points, s, 0u, true).place;
    return filtered_place(header, position);
}

// `dimensions`: of the sample, its place among them. `sign`: of its weight.
Path camera_sample(const Header header, uvec2 pixel, PixelCorner corner, uvec2 key, const Points points, uint s,
                   const SampleDimensions dimensions, const Candidates candidates, out float sign) {
    uvec2 position = dimensions.place;
    Header camera = header;
    float time = 0.0;
    if (TIMED) time = header.shutter_opens + header.shutter_time * unit_square(dimensions.time).x;
    if (MOVING_CAMERA) {
        if (header.camera_moves) {
            camera = camera_at(header, time);
            corner = pixel_corner(camera, pixel);
        }
    }
    Place place = filtered_place(header, position);
    sign = place.sign;
    Ray ray = camera_ray(camera, corner, place.inside);
    if (LENS) {
        if (header.lens_radius > 0.0) ray = through_lens(camera, ray, unit_square(dimensions.lens));
    }
    if (TIMED) ray.time = time;
    if (MOVING_CAMERA) {
        if (header.camera_moves) ray.origin += time * header.eye_motion;
    }
    // Bits that are independent of the sample's position.
    uvec2 random = RANDOM ? pcg2d(sample_bits(key, s) ^ 0x5BD1E995u) : uvec2(0u);
    return camera_path(ray, camera_differential(camera, ray), random, candidates);
}

#endif
