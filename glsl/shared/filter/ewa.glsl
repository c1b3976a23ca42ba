// Filter `ewa`, the elliptical weighted average (Heckbert 1989): all texels under the footprint, weighted by
// a Gaussian, on the level where the minor axis is about a texel. Twin: src/oracle/filter/ewa.rs.
#ifndef EWA_GLSL
#define EWA_GLSL

#include "../diagnostics.glsl"
#include "../footprint_axes.glsl"
#include "../texture.glsl"

#if SOURCE != SOURCE_NONE

// On the selected level, the minor axis has a full width between 2^-ELLIPSE_LEVEL texels and twice that.
const float ELLIPSE_LEVEL = 0.0;
// More than the longest ellipse needs, so that every loop ends, whatever its inputs are.
// Largest area over pi: including its rows, fewer texels than steps.
const float MAX_ELLIPSE = 2048.0;

// Returns exp(-2 r²) - exp(-2) for r² in [0, 1], as a polynomial: 1 at the centre up to scale, 0 at the rim.
float ellipse_weight(float squared) {
    float r = 1.0 - squared;
    return r * (0.2643662 + r * (0.3266478 + r * (0.0257909 + r * 0.2473448)));
}

// Returns the level on which an ellipse of this minor axis, squared in texels of level 0, is averaged.
int ellipse_level(float minor, int last) {
    return clamp(int(floor(0.5 * log2_accurate(max(minor, 1e-30)) + ELLIPSE_LEVEL)), 0, last);
}

// Returns the squared minor axis, at least as long as the maximum anisotropy allows.
float widened_minor(const Sampler how, const FootprintEllipse spread) {
    float most = float(how.max_anisotropy);
    return max(spread.minor, spread.major / (most * most));
}

// Returns the average of all texels in the footprint's ellipse, weighted by a Gaussian. On the selected level
// the minor axis is about one texel; if the ellipse exceeds the maximum anisotropy its minor axis grows.
vec4 ellipse(const Texture image, const Sampler how, uint slot, const Coordinate c, const FootprintEllipse spread) {
    float most = float(how.max_anisotropy);
    float minor = widened_minor(how, spread);
    count_diagnostic(DIAGNOSTIC_ANISOTROPY, minor > spread.minor);
    int index = ellipse_level(minor, int(image.levels) - 1);
    Level level = level_at(image, index);
    vec2 size = vec2(level.size.xy);
    // Covariance J Jᵀ on this level; the minor axis is widened along its own direction.
    vec2 x = c.dx.xy * size;
    vec2 y = c.dy.xy * size;
    float shrink = float(level.size.x) / float(image.size.x);
    vec3 m = vec3(x.x * x.x + y.x * y.x, x.x * x.y + y.x * y.y, x.y * x.y + y.y * y.y);
    float scale = shrink * shrink;
    float gap = spread.major - spread.minor;
    float widen = gap > 0.0 ? (minor - spread.minor) / gap : 0.0;
    m += widen * (vec3(spread.major * scale, 0.0, spread.major * scale) - m);
    // There is no coarser level than the last.
    count_diagnostic(DIAGNOSTIC_LEVELS, m.x + m.z > 16.0 * most * most);
    m *= min(1.0, 16.0 * most * most / max(m.x + m.z, 1e-30));
    // If one side of the texture is far longer, levels shrink along that one alone.
    m *= min(1.0, MAX_ELLIPSE * inversesqrt(max(m.x * m.z - m.y * m.y, 1.0)));
    // The texels' own width, which reconstruction adds.
    m += vec3(1.0, 0.0, 1.0);
    float inverse = 1.0 / (m.x * m.z - m.y * m.y);
    float a = m.z * inverse;
    float b = -m.y * inverse;
    float d = m.x * inverse;

    vec2 center = vec2(reduced_coordinate(ADDRESSES_U, how.address_u, c.at.x, size.x),
                               reduced_coordinate(ADDRESSES_V, how.address_v, c.at.y, size.y));
    if (!MODE_IS(TEXEL_CENTERS, TEXEL_CENTER_INTEGER, how.texel_center)) center -= 0.5;
    float reach = sqrt(m.z);
    int row = int(ceil(center.y - reach));
    int last_row = int(floor(center.y + reach));
    int column = 1;
    int last_column = 0;
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    row -= 1;
    // One loop over rows and columns, so that neighbouring lanes with different ellipses stay busy.
    for (int turn = 0; turn < int(MAX_ELLIPSE_STEPS); turn++) {
        if (column > last_column) {
            row++;
            if (row > last_row) break;
            float h = float(row) - center.y;
            float root = a - (a * d - b * b) * h * h;
            float half_width = sqrt(max(root, 0.0)) / a;
            float middle = center.x - b * h / a;
            column = int(ceil(middle - half_width));
            last_column = int(floor(middle + half_width));
        } else {
            vec2 offset = vec2(float(column), float(row)) - center;
            float squared = a * offset.x * offset.x + 2.0 * b * offset.x * offset.y + d * offset.y * offset.y;
            float weight = ellipse_weight(clamp(squared, 0.0, 1.0));
            ivec2 at = ivec2(column, row);
            if (!POLES || !how.crosses_poles) {
                at.x = wrapped_texel(ADDRESSES_U, how.address_u, at.x, level.size.x);
                at.y = wrapped_texel(ADDRESSES_V, how.address_v, at.y, level.size.y);
            }
            vec4 value = POLES ? flat_texel(image, how, slot, level, at)
                               : fetch_or_border(image, how, slot, level, ivec3(at, 0));
            sum = add_weighted(weight, value, sum);
            weights += weight;
            column++;
        }
    }
    return sum / max(weights, 1e-20);
}
#endif

#endif
