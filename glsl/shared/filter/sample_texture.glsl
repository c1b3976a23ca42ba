// (texture, sampler, coordinate, footprint) -> linear RGBA. A footprint of less than a texel is
// magnification; wider ones select a level (Williams 1983), take several look-ups along the major axis
// (McCormack et al. 1999, as texture units do), or weight all texels of an ellipse (EWA: Heckbert 1989).
// Method hardware: the device's own sampler at our level. Twin: src/oracle/filter/sample_texture.rs.
#ifndef SAMPLE_TEXTURE_GLSL
#define SAMPLE_TEXTURE_GLSL

#include "../diagnostics.glsl"
#include "../footprint_axes.glsl"
#include "../procedural.glsl"
#include "anisotropic.glsl"
#include "ewa.glsl"
#include "levels.glsl"
#include "summed_area.glsl"

#if SOURCE != SOURCE_NONE

// A look-up reads one level at one position. Written with bits: the shader compiler fails to simplify negated
// chains of && and || over specialization constants.
const uint LEVEL_BLENDS = MIPMAPPED ? MIPS & (1u << MIP_LINEAR) : 0u;
const bool ONE_PLACE = (LEVEL_BLENDS | (FILTERS & (1u << FILTER_ANISOTROPIC))) == 0u;

// Returns the level that the footprint needs, whichever there are. A look-up is at least as wide as the minor
// axis, even if there are more along the major axis than needed.
float needed_level(const FootprintEllipse spread, uint probes, float last) {
    float least = probes > 1u ? spread.minor : 0.0;
    float level = 0.5 * log2_accurate(max(spread.major / float(probes * probes), least));
    count_diagnostic(DIAGNOSTIC_LEVELS, level > last);
    return level;
}

// Returns the level that the sampler reads for a footprint; between two levels if it blends them.
float read_level(const Texture image, const Sampler how, const FootprintEllipse spread) {
    bool magnified = spread.major <= 1.0;
    uint mode = magnified ? how.mag_filter : how.min_filter;
    int last = int(image.levels) - 1;
    if (HAS(FILTERS, FILTER_EWA) && mode == FILTER_EWA) return float(ellipse_level(widened_minor(how, spread), last));
    uint probes = 1u;
    if (HAS(FILTERS, FILTER_ANISOTROPIC) && mode == FILTER_ANISOTROPIC) probes = anisotropic_probes(how, spread);
    float level = 0.0;
    if (!magnified && MIPMAPPED) level = clamp(needed_level(spread, probes, float(last)), 0.0, float(last));
    if (HAS(FILTERS, FILTER_SUMMED_AREA) && mode == FILTER_SUMMED_AREA) level = 0.0;
    if (MODE_IS(MIPS, MIP_NEAREST, how.mip_mode)) level = ceil(level + 0.5) - 1.0;
    if (MODE_IS(MIPS, MIP_NONE, how.mip_mode)) level = 0.0;
    return level;
}

// Returns what is read without a footprint: level 0 by the filter of magnification.
vec4 sample_magnified(const Texture image, const Sampler how, uint slot, const TexCoord mapped, uvec2 random) {
    if (MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_PROCEDURAL, image.kind)) {
        return vec4(procedural_color(procedural_at(image.procedural), mapped.at, mapped.dx, mapped.dy), 1.0);
    }
    count_diagnostic(DIAGNOSTIC_COORDINATES, no_number(mapped.at));
    Coordinate place = near_coordinate(image, how, mapped);
#if HAS_IMAGES
    if (MODE_IS(METHODS, METHOD_HARDWARE, how.method)) return read_sampled(image, how, slot, place, 0.0);
#endif
    vec3 dice = vec3(0.0);
    if (HAS(FILTERS, FILTER_STOCHASTIC)) dice = look_up_dice(random);
    uint face;
    Coordinate c = in_texture(image, place, face);
    return filtered_level(image, how, slot, how.mag_filter, level_at(image, 0), c.at, face, dice);
}

vec4 sample_texture(const Texture image, const Sampler how, uint slot, const TexCoord mapped, uvec2 random) {
    if (!FILTERED) return sample_magnified(image, how, slot, mapped, random);
    if (MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_PROCEDURAL, image.kind)) {
        return vec4(procedural_color(procedural_at(image.procedural), mapped.at, mapped.dx, mapped.dy), 1.0);
    }
    count_diagnostic(DIAGNOSTIC_COORDINATES, no_number(mapped.at));
    Coordinate place = near_coordinate(image, how, mapped);
    bool hardware = false;
#if HAS_IMAGES
    hardware = MODE_IS(METHODS, METHOD_HARDWARE, how.method);
#endif
    uint mode = how.mag_filter;
    vec3 dice = vec3(0.0);
    if (HAS(FILTERS, FILTER_STOCHASTIC)) dice = look_up_dice(random);
    uint face;
    Coordinate c = in_texture(image, place, face);
    FootprintEllipse spread = texel_spread(image, c);
    bool magnified = spread.major <= 1.0;
    mode = magnified ? mode : how.min_filter;
    if (HAS(FILTERS, FILTER_EWA) && mode == FILTER_EWA) return ellipse(image, how, slot, c, spread);
#if HAS_TEXELS
    if (HAS(FILTERS, FILTER_SUMMED_AREA) && mode == FILTER_SUMMED_AREA) return summed_area(image, how, c);
#endif
    int last = int(image.levels) - 1;
    uint probes = 1u;
    if (HAS(FILTERS, FILTER_ANISOTROPIC) && mode == FILTER_ANISOTROPIC) {
        probes = anisotropic_probes(how, spread);
    }
    float level = 0.0;
    if (!magnified && (MIPMAPPED || hardware)) {
        level = needed_level(spread, probes, float(last));
        // The device's sampler knows its own last level, and minifies with one level too.
        level = clamp(level, 0.0, hardware ? 32.0 : float(last));
    }
#if HAS_IMAGES
    if (hardware) return read_sampled(image, how, slot, place, level);
#endif
    int low = 0;
    float rest = 0.0; // share of the next level
    if (MIPMAPPED && MODE_IS(MIPS, MIP_LINEAR, how.mip_mode)) {
        low = int(floor(level));
        rest = level - float(low);
    } else if (MIPMAPPED && MODE_IS(MIPS, MIP_NEAREST, how.mip_mode)) {
        low = int(ceil(level + 0.5)) - 1;
    }
    if (HAS(FILTERS, FILTER_STOCHASTIC) && mode == FILTER_STOCHASTIC) {
        stochastic_level(low, rest, dice);
    }
    if (ONE_PLACE) {
        return filtered_level(image, how, slot, mode, level_at(image, low), c.at, face, dice);
    }
    // Look-ups along the major axis. A fraction `rest` of the `probes` reads the next level; the probe at the
    // boundary reads both: one look-up more than probes, and continuous in the level. Iteration 0 is skipped
    // if no probe reads the next level.
    float share = rest * float(probes);
    float whole = rest > 0.0 ? floor(share) : 0.0;
    uint split = uint(whole);
    float part = share - whole;
    float each = 1.0 / float(probes);
    vec4 sum = vec4(0.0);
    for (uint turn = rest > 0.0 ? 0u : 1u; turn <= probes; turn++) {
        bool upper = turn <= split && rest > 0.0;
        uint probe = turn <= split && rest > 0.0 ? turn : turn - 1u;
        float weight = turn == split ? part : (turn == split + 1u ? 1.0 - part : 1.0);
        weight *= each;
        vec3 at = c.at;
        uint at_face = face;
        if (HAS(FILTERS, FILTER_ANISOTROPIC) && mode == FILTER_ANISOTROPIC) {
            at = anisotropic_place(image, c, spread, probe, probes, each, at_face);
        }
        int index = upper ? min(low + 1, last) : low;
        sum = add_weighted(weight, filtered_level(image, how, slot, mode, level_at(image, index), at, at_face, dice), sum);
    }
    return sum;
}
#endif

#endif
