// One thread per pixel, with one cone: film[pixel] = radiance (rgb) and the dropped weight. With COMPENSATED
// the film has a second half, where no rounding errors are stored.
#ifndef CONE_MAIN_GLSL
#define CONE_MAIN_GLSL

#define SHAPES_IN_CONES
#include "features.glsl"
#include "layout.glsl"
#include "cone_shade.glsl"
#include "slice.glsl"
#include "loops.glsl"

const vec2 MIDDLE = vec2(8388608.0); // of a pixel, in units of 2^-24

void main() {
    Header header = load_header();
    preload_records();
    clear_notices();
    uvec2 place = film_pixel();
    if (!in_film(header, place)) return;
    uvec2 pixel = picture_pixel(header, place);
    Ray ray = camera_ray(header, pixel_corner(header, pixel), MIDDLE);
    uint at = film_index(header, place);
    film[at] = trace_cone(header, ray, camera_differential(header, ray));
    if (loops_were_ended()) leave_unfinished(at);
    if (COMPENSATED) film[at + header.film_size.x * slice.band_height] = vec4(0.0);
    report_notices();
}

#endif
