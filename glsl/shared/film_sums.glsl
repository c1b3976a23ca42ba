// The end of a block of samples of a pixel: its sum is added to the film. Entries are described by render_main.glsl.
#ifndef FILM_SUMS_GLSL
#define FILM_SUMS_GLSL

#include "slice.glsl"

// `lost`: the part that rounding has added to the sum. `signs`: the sum of the samples' signs; `negative`: of those with a
// negative one, without the sign.
void add_to_film(const Header header, uint at, vec3 sum, vec3 lost, float signs, vec3 negative) {
    uint pixels = header.film_size.x * slice.band_height;
    if (MODE_IS(PIXEL_FILTERS, PIXEL_FILTER_MITCHELL, header.pixel_filter)) {
        uint behind = at + (COMPENSATED ? 2u : 1u) * pixels;
        vec4 sums = vec4(negative, 0.0);
        film[behind] = first_sample() > 0u ? film[behind] + sums : sums;
    }
    if (COMPENSATED && first_sample() > 0u) {
        vec3 term = sum - (film[at + pixels].xyz + lost);
        vec3 total = film[at].xyz + term;
        lost = (total - film[at].xyz) - term;
        if (SIGNED) signs += film[at].w;
        sum = total;
    }
    // A block that had to be divided.
    if (!COMPENSATED && LOOPS_END && first_sample() > 0u) {
        sum += film[at].xyz;
        signs += film[at].w;
    }
    if (COMPENSATED) film[at + pixels] = vec4(lost, 0.0);
    film[at] = vec4(sum, SIGNED ? signs : 0.0);
}

#endif
