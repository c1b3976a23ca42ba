// Colours of procedural textures, from a point in texture space and a footprint. dx and dy span the footprint
// (full widths; zero evaluates the point itself). Patterns with hard edges are averaged analytically over
// boxes along the footprint's major axis; patterns made of noise fade to their mean as the footprint grows.
// Twin: src/oracle/procedural.rs.
#ifndef PROCEDURAL_GLSL
#define PROCEDURAL_GLSL

#include "noise.glsl"

// Most boxes along a footprint's major axis.
// Wider footprints are averaged as if they had this width.
const float WIDEST = 1e9;

real3 bounded_point(real3 at) { return mix(real3(0.0), at, lessThanEqual(abs(at), real3(1e15))); }

vec3 bounded_width(vec3 d) { return mix(vec3(WIDEST), d, lessThanEqual(abs(d), vec3(WIDEST))); }

// Returns orthogonal axes with the parallelogram's second moments, the longer first: one rotation of Jacobi's
// method. Orthogonal dx and dy are unchanged.
void principal_axes(vec3 dx, vec3 dy, out vec3 major, out vec3 minor) {
    float xx = dot3(dx, dx);
    float yy = dot3(dy, dy);
    float xy = dot3(dx, dy);
    float t = 0.0;
    if (abs(xy) > 1e-30) { // smaller ones divide by a value that devices flush to 0
        float zeta = (yy - xx) / (2.0 * xy);
        t = (zeta >= 0.0 ? 1.0 : -1.0) / (abs(zeta) + sqrt(1.0 + zeta * zeta));
    }
    float c = inversesqrt(1.0 + t * t);
    vec3 a = c * dx - (c * t) * dy;
    vec3 b = c * dy + (c * t) * dx;
    bool swap = dot3(b, b) > dot3(a, a);
    major = swap ? b : a;
    minor = swap ? a : b;
}

// Returns the number of boxes that approximate the footprint, not rounded up: enough that each is about as
// long as the footprint is wide, if it is oblique to the pattern's axes, and no more than edges can show.
float box_count(vec3 major, vec3 minor) {
    vec3 reach = abs(major);
    float oblique = max(min(reach.x, reach.y), min(max(reach.x, reach.y), reach.z)); // the median
    float ratio = oblique / max(sqrt(dot3(minor, minor)), 1e-20);
    return clamp(min(ratio, 1.0 + float(MAX_BOXES) * oblique), 1.0, float(MAX_BOXES));
}

// Returns the mean over [x - w/2, x + w/2] of a pulse train: 1 within duty/2 of integer x, otherwise 0. Whole
// periods are subtracted first, and the fraction before any sum, so that neither far nor tiny boxes cancel.
float pulse_mean(float x, float w, float duty) {
    float s = x - roundEven(x);
    float half_duty = 0.5 * duty;
    float inside = (s >= -half_duty && s < half_duty) || duty >= 1.0 ? 1.0 : 0.0;
    if (!PROCEDURAL_FILTERED || !(w > 1e-30)) return inside;
    float periods = floor(w);
    float rest = w - periods;
    // An odd number of periods, subtracted at one end, moves the centre of the rest by half of one.
    float q = periods - 2.0 * floor(0.5 * periods) != 0.0 ? 0.5 - abs(s) : abs(s);
    float first = clamp((half_duty - q) + 0.5 * rest, 0.0, min(rest, duty));
    float second = max((q - (1.0 - half_duty)) + 0.5 * rest, 0.0);
    float mean = (periods * duty + (first + second)) / w;
    return mean;
}

// Returns the figure's share in a box around `at`; bricks have x in units of bricks here.
float box_share(const Procedural what, vec3 at, vec3 w) {
    uint kind = what.kind;
    float width = float(what.width);
    if (MODE_IS(PROCEDURAL_KINDS, PROCEDURAL_CHECKER, kind)) {
        // The mean of a product of square waves of ±1 is the product of their means.
        vec3 middle = 0.5 * (at - 1.5);
        float wave = 1.0 - 2.0 * pulse_mean(middle.x, 0.5 * w.x, 0.5);
        wave *= 1.0 - 2.0 * pulse_mean(middle.y, 0.5 * w.y, 0.5);
        wave *= 1.0 - 2.0 * pulse_mean(middle.z, 0.5 * w.z, 0.5);
        return 0.5 - 0.5 * wave;
    }
    if (MODE_IS(PROCEDURAL_KINDS, PROCEDURAL_STRIPES, kind)) {
        float middle = at.x - 0.5 * width;
        return pulse_mean(middle, w.x, width);
    }
    if (MODE_IS(PROCEDURAL_KINDS, PROCEDURAL_GRID, kind)) {
        float between = (1.0 - pulse_mean(at.x, w.x, width)) * (1.0 - pulse_mean(at.y, w.y, width));
        if (what.dimensions == 3u) between *= 1.0 - pulse_mean(at.z, w.z, width);
        float lines = 1.0 - between;
        return lines;
    }
    float row = 0.5 * (at.y - 0.5);
    float column = at.x - 0.5;
    float shifted = column - float(what.offset);
    float duty_x = 1.0 - width / float(what.aspect);
    float duty_y = 0.5 * (1.0 - width);
    float bricks = pulse_mean(row, 0.5 * w.y, duty_y) * pulse_mean(column, w.x, duty_x)
                         + pulse_mean(row - 0.5, 0.5 * w.y, duty_y) * pulse_mean(shifted, w.x, duty_x);
    return bricks;
}

// Returns the figure's share in the footprint. A box has the second moments of its part of the footprint.
float footprint_share(const Procedural what, real3 at, vec3 major, vec3 minor) {
    real3 per_unit = real3(1.0);
    if (MODE_IS(PROCEDURAL_KINDS, PROCEDURAL_BRICK, what.kind)) per_unit.x = what.aspect;
    real3 far = at / per_unit;
    vec3 p = vec3(far - 2.0 * roundEven(0.5 * far)); // all patterns repeat after two units
    vec3 unit = vec3(per_unit);
    if (!PROCEDURAL_FILTERED) return box_share(what, p, vec3(0.0));
    major /= unit;
    minor /= unit;
    float count = ceil(box_count(major, minor));
    vec3 step = major / count;
    vec3 w = sqrt(step * step + minor * minor);
    float sum = 0.0;
    for (float i = 0.0; i < count; i++) {
        vec3 middle = p + step * ((i + 0.5) - 0.5 * count);
        sum += box_share(what, middle, w);
    }
    return sum / count;
}

// Returns the ratio of the mean of a sine of period 1 over a box of width w to its value at the centre.
float box_attenuation(float w) {
    float x = abs(w);
    return x < 1e-3 ? 1.0 : sine_turns(0.5 * x) / (PI * x);
}

// Returns the attenuation of a sine by a random phase, in turns: exp(-2 pi² variance), by the start of its
// series.
float phase_attenuation(float variance) {
    float v = 2.0 * PI * PI * variance;
    float series = 1.0 + v * (1.0 + v * (0.5 + v * (1.0 / 6.0)));
    return 1.0 / series;
}

// Veins at integer x + distortion · turbulence.
float marble(const Procedural what, real3 at, vec3 dx, vec3 dy, float size, vec3 widths) {
    vec2 turbulence = octave_sum(what, at, size, widths, true);
    float distortion = what.distortion;
    float phase = float(at.x - roundEven(at.x)) + distortion * turbulence.x;
    float strength = 1.0;
    if (PROCEDURAL_FILTERED) {
        strength = box_attenuation(dx.x) * box_attenuation(dy.x);
        strength *= phase_attenuation(distortion * distortion * turbulence.y);
    }
    float share = 0.5 + 0.5 * strength * sine_turns(phase);
    return share;
}

// Returns the variation of the distance r from the z axis along d: proportional to the radial part, while the
// tangential part counts only if the footprint is not small relative to r.
float radial_width(vec2 at, float r, vec2 d) {
    float along = (at.x * d.x + at.y * d.y) / max(r, 1e-20);
    float square = d.x * d.x + d.y * d.y;
    float across = max(square - along * along, 0.0);
    float width = sqrt(along * along + across * square / max(square + 4.0 * r * r, 1e-30));
    return width;
}

// Rings at integer distances from the z axis + distortion · noise.
float wood(const Procedural what, real3 at, vec3 dx, vec3 dy, float size, vec3 widths) {
    vec2 noise = octave_sum(what, at, size, widths, false);
    float distortion = what.distortion;
    real r = sqrt(at.x * at.x + at.y * at.y);
    float phase = float(r - roundEven(r)) + distortion * noise.x;
    float strength = 1.0;
    if (PROCEDURAL_FILTERED) {
        strength = box_attenuation(radial_width(vec2(at.xy), float(r), dx.xy)) * box_attenuation(radial_width(vec2(at.xy), float(r), dy.xy));
        strength *= phase_attenuation(distortion * distortion * noise.y);
    }
    float share = 0.5 - 0.5 * strength * sine_turns(phase + 0.25);
    return share;
}

// Kinds with hard edges come first.
const uint HARD_EDGED = (2u << PROCEDURAL_BRICK) - 1u;

float figure_share(const Procedural what, real3 at, vec3 dx, vec3 dy) {
    uint kind = what.kind;
    vec3 major = vec3(0.0);
    vec3 minor = vec3(0.0);
    if (PROCEDURAL_FILTERED) principal_axes(dx, dy, major, minor);
    if ((PROCEDURAL_KINDS & HARD_EDGED) != 0u
        && ((PROCEDURAL_KINDS & ~HARD_EDGED) == 0u || kind <= PROCEDURAL_BRICK)) {
        return footprint_share(what, at, major, minor);
    }
    float size = sqrt(dot3(major, major));
    vec3 widths = sqrt(major * major + minor * minor);
    if (MODE_IS(PROCEDURAL_KINDS, PROCEDURAL_TURBULENCE, kind)) return octave_sum(what, at, size, widths, true).x;
    if (MODE_IS(PROCEDURAL_KINDS, PROCEDURAL_MARBLE, kind)) return marble(what, at, dx, dy, size, widths);
    if (MODE_IS(PROCEDURAL_KINDS, PROCEDURAL_WOOD, kind)) return wood(what, at, dx, dy, size, widths);
    if (MODE_IS(PROCEDURAL_KINDS, PROCEDURAL_CELLULAR, kind)) {
        float value = cell_distance(at, what.seed, float(what.jitter));
        if (!PROCEDURAL_FILTERED) return value;
        float keep = kept(size);
        float faded = keep * value + (1.0 - keep) * cell_mean(at, widths, float(what.jitter));
        return faded;
    }
    float share = 0.5 + 0.5 * octave_sum(what, at, size, widths, false).x;
    return share;
}

vec3 procedural_color(const Procedural what, real3 at, vec3 dx, vec3 dy) {
    float share = figure_share(what, bounded_point(at), bounded_width(dx), bounded_width(dy));
    vec3 color = (1.0 - share) * what.background + share * what.figure;
    return color;
}

#endif
