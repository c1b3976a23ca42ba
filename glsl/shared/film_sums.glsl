// The end of a block of samples of a pixel: its sum is added to the film. Entries are described by render_main.glsl.
#ifndef FILM_SUMS_GLSL
#define FILM_SUMS_GLSL

#include "tile_culling.glsl"
#include "pixel_filter.glsl"
#include "quantities.glsl"
#include "slice.glsl"

// Long sums are divided into blocks: a block's samples are added directly, the blocks with compensation.
uint block_of(uint count) { return count > MAX_PLAIN ? SAMPLES_PER_BLOCK : MAX_PLAIN; }

// Cells say where the background alone is seen, which is the same for all samples.
const bool BACKGROUND_IS_SUMMED = TILE_CULLED && !SIGNED && !MEASURES && !DIAGNOSED;

bool is_empty(uint list) {
    if (list == NO_LIST) return false;
    return tile_lists[list + 1u] == CELL_EMPTY;
}

// The sum of the samples of a pixel that sees the background alone, rounded as if each were taken from `begun` on; and of a
// batch.
void sum_background(const Header header, uint count, vec3 begun, out vec3 sum, out vec3 lost, out float squares) {
    float square = dot3(header.background, header.background) * (1.0 / 3.0);
    uint block = BLOCKS ? block_of(count) : count;
    sum = vec3(0.0);
    lost = vec3(0.0);
    squares = 0.0;
    uint left = count;
    while (left > 0u) {
        vec3 part = left == count ? begun : vec3(0.0);
        for (uint k = min(left, block); k > 0u; k--) {
            part += header.background;
            squares += square;
        }
        vec3 term = part - lost;
        vec3 total = sum + term;
        lost = (total - sum) - term;
        sum = total;
        left -= min(left, block);
    }
}

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
    // The rest of samples that had to be divided; a short sum begins with what is there.
    if (!COMPENSATED && LOOPS_END && first_sample() > 0u) {
        if (BLOCKS) sum += film[at].xyz;
        signs += film[at].w;
    }
    if (COMPENSATED) film[at + pixels] = vec4(lost, 0.0);
    film[at] = vec4(sum, SIGNED ? signs : 0.0);
}

#endif
