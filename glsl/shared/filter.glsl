// (texture, sampler, coordinate, footprint) -> linear RGBA. A footprint of less than a texel is
// magnification; wider ones choose a level (Williams 1983), walk the major axis with several look-ups
// (McCormack et al. 1999, as texture units do), or weigh all texels of an ellipse (EWA: Heckbert 1989).
// Method hardware: the device's own sampler at our level. Twin: src/oracle/filter.rs.
#ifndef FILTER_GLSL
#define FILTER_GLSL

#include "rng.glsl"
#include "texture.glsl"

#if SOURCE != SOURCE_NONE

// ---- The footprint in texels

// Squares of the footprint's axes (singular values of its Jacobian) in texels of level 0, and the unit
// vector whose combination of dx and dy is the major axis.
struct Spread {
    float major;
    float minor;
    vec2 along;
};

// What is not a number, or endless, is as wide as the widest.
float bounded(float squared) { return squared < 1e30 ? squared : 1e30; }

// A direction on the cube as a place on its face; a flat or solid coordinate as it is.
Coordinate in_texture(Texture image, Coordinate c, out uint face) {
    face = 0u;
    if (!MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_CUBE, image.link.w)) return c;
    vec3 stm = on_cube_face(c.at, face);
    Coordinate on_face = Coordinate(vec3(face_uv(stm), 0.0), vec3(0.0), vec3(0.0));
    if (FILTERED) {
        on_face.dx.xy = face_uv_change(stm, along_cube_face(c.dx, face));
        on_face.dy.xy = face_uv_change(stm, along_cube_face(c.dy, face));
    }
    return on_face;
}

Spread texel_spread(Texture image, Coordinate c) {
    vec3 size = vec3(image.place.yz, MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_VOLUME, image.link.w) ? image.link.z : 0u);
    precise vec3 x = c.dx * size;
    precise vec3 y = c.dy * size;
    float xx = bounded(dot3(x, x));
    float yy = bounded(dot3(y, y));
    float xy = dot3(x, y);
    precise float middle = 0.5 * (xx + yy);
    precise float half_difference = 0.5 * (xx - yy);
    precise float radius = sqrt(half_difference * half_difference + xy * xy);
    precise float major = middle + radius;
    precise float minor = max(xx * (yy / major) - xy * (xy / major), 0.0);
    // Of two forms of the eigenvector the one that does not cancel.
    vec2 along = half_difference >= 0.0 ? vec2(half_difference + radius, xy) : vec2(xy, radius - half_difference);
    float squared = along.x * along.x + along.y * along.y;
    along = squared > 0.0 ? along / sqrt(squared) : vec2(1.0, 0.0);
    return Spread(bounded(major), minor >= 0.0 ? minor : 0.0, along);
}

// ---- One level

vec4 linear_flat(Texture image, Sampler how, uint slot, Level level, vec2 texel) {
    // floor(texel); where texel is whole, perhaps the one before, with weight 1 on its neighbour.
    precise vec2 shifted = (texel - 0.5) + ROUND;
    precise vec2 low = shifted - ROUND;
    precise vec2 b = texel - low;
    precise vec2 a = 1.0 - b;
    ivec2 first = floatBitsToInt(shifted) - floatBitsToInt(ROUND);
    if (POLES) {
        vec4 sum = (a.x * a.y) * flat_texel(image, how, slot, level, first);
        sum = fma(vec4(b.x * a.y), flat_texel(image, how, slot, level, first + ivec2(1, 0)), sum);
        sum = fma(vec4(a.x * b.y), flat_texel(image, how, slot, level, first + ivec2(0, 1)), sum);
        return fma(vec4(b.x * b.y), flat_texel(image, how, slot, level, first + ivec2(1, 1)), sum);
    }
    ivec2 u = ivec2(addressed_texel(ADDRESSES_U, how.modes.x, first.x, level.size.x),
                    addressed_texel(ADDRESSES_U, how.modes.x, first.x + 1, level.size.x));
    ivec2 v = ivec2(addressed_texel(ADDRESSES_V, how.modes.y, first.y, level.size.y),
                    addressed_texel(ADDRESSES_V, how.modes.y, first.y + 1, level.size.y));
    // fma by name: fused or not, but alike in every pipeline of a device.
    vec4 sum = (a.x * a.y) * fetch_or_border(image, how, slot, level, ivec3(u.x, v.x, 0));
    sum = fma(vec4(b.x * a.y), fetch_or_border(image, how, slot, level, ivec3(u.y, v.x, 0)), sum);
    sum = fma(vec4(a.x * b.y), fetch_or_border(image, how, slot, level, ivec3(u.x, v.y, 0)), sum);
    return fma(vec4(b.x * b.y), fetch_or_border(image, how, slot, level, ivec3(u.y, v.y, 0)), sum);
}

// Weights of the four texels around a place t in [0, 1] between the middle two (Mitchell & Netravali
// 1988): B = 0, C = 1/2 is Catmull-Rom, B = 1, C = 0 the B-spline.
vec4 cubic_weights(float t, vec2 bc) {
    float b = bc.x;
    float c = bc.y;
    float r = 1.0 - t;
    float tt = t * t;
    float rr = r * r;
    vec4 outer = vec4(b * (1.0 / 6.0), -c, 0.0, 0.0);
    float w0 = rr * (outer.x * r + outer.y * t);
    float w3 = tt * (outer.x * t + outer.y * r);
    float w1 = 1.0 - b * (1.0 / 3.0) + tt * ((-3.0 + 2.0 * b + c) + (2.0 - 1.5 * b - c) * t);
    return vec4(w0, w1, ((1.0 - w0) - w1) - w3, w3);
}

vec4 cubic_flat(Texture image, Sampler how, uint slot, Level level, vec2 texel) {
    precise vec2 low = floor(texel);
    precise vec2 t = texel - low;
    vec2 bc = uintBitsToFloat(how.more.zw);
    vec4 wx = cubic_weights(t.x, bc);
    vec4 wy = cubic_weights(t.y, bc);
    ivec2 first = ivec2(low) - 1;
    vec4 sum = vec4(0.0);
    for (int j = 0; j < 4; j++) {
        for (int i = 0; i < 4; i++) {
            ivec2 at = first + ivec2(i, j);
            if (!POLES || how.more.y == 0u) {
                at.x = wrapped_texel(ADDRESSES_U, how.modes.x, at.x, level.size.x);
                at.y = wrapped_texel(ADDRESSES_V, how.modes.y, at.y, level.size.y);
            }
            vec4 value = POLES ? flat_texel(image, how, slot, level, at)
                               : fetch_or_border(image, how, slot, level, ivec3(at, 0));
            sum = fma(vec4(wx[i] * wy[j]), value, sum);
        }
    }
    return sum;
}

vec4 linear_volume(Texture image, Sampler how, uint slot, Level level, vec3 texel) {
    precise vec3 low = floor(texel);
    precise vec3 t = texel - low;
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 8; k++) {
        ivec3 corner = ivec3(k & 1, (k >> 1) & 1, k >> 2);
        ivec3 at = ivec3(low) + corner;
        at = ivec3(addressed_texel(ADDRESSES_U, how.modes.x, at.x, level.size.x),
                   addressed_texel(ADDRESSES_V, how.modes.y, at.y, level.size.y),
                   addressed_texel(ADDRESSES_W, how.more.x, at.z, level.size.z));
        vec3 w = mix(1.0 - t, t, vec3(corner));
        sum = fma(vec4(w.x * w.y * w.z), fetch_or_border(image, how, slot, level, at), sum);
    }
    return sum;
}

// The direction from a cube's centre to a place of a face's plane, (s, t) in [-1, 1] on the face.
vec3 face_direction(uint face, vec2 st) {
    float side = (face & 1u) != 0u ? -1.0 : 1.0;
    return face < 2u ? vec3(side, -st.y, -side * st.x)
                     : (face < 4u ? vec3(st.x, side, side * st.y) : vec3(side * st.x, -st.y, side));
}

// A place of a face's plane, on the face that lies behind it.
vec3 refaced(vec3 at, inout uint face) {
    uint other;
    vec3 stm = on_cube_face(face_direction(face, 2.0 * at.xy - 1.0), other);
    face = other;
    return vec3(face_uv(stm), 0.0);
}

// The texel of a cube at a place of a face, or beyond its edge: of the neighbour that the extended
// plane of the face reaches there.
ivec3 cube_texel(uint face, ivec2 at, int size) {
    if (all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(size)))) return ivec3(at, face);
    precise vec2 st = (2.0 * vec2(at) + 1.0) / float(size) - 1.0;
    uint other;
    vec2 uv = face_uv(on_cube_face(face_direction(face, st), other));
    return ivec3(clamp(ivec2(floor(uv * float(size))), ivec2(0), ivec2(size - 1)), other);
}

// Beyond a corner there is no texel: its weight goes to the three that meet there.
vec4 linear_cube(Texture image, uint slot, Level level, uint face, vec2 texel) {
    int size = level.size.x;
    precise vec2 low = floor(texel);
    precise vec2 t = texel - low;
    ivec2 first = ivec2(low);
    float missing = 0.0;
    for (int k = 0; k < 4; k++) {
        ivec2 at = first + ivec2(k & 1, k >> 1);
        bool corner = (at.x < 0 || at.x >= size) && (at.y < 0 || at.y >= size);
        vec2 w = mix(1.0 - t, t, vec2(k & 1, k >> 1));
        missing += corner ? w.x * w.y : 0.0;
    }
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 4; k++) {
        ivec2 at = first + ivec2(k & 1, k >> 1);
        bool corner = (at.x < 0 || at.x >= size) && (at.y < 0 || at.y >= size);
        vec2 w = mix(1.0 - t, t, vec2(k & 1, k >> 1));
        float weight = corner ? 0.0 : w.x * w.y + missing * (1.0 / 3.0);
        sum = fma(vec4(weight), fetch_texel(image, slot, level, cube_texel(face, at, size)), sum);
    }
    return sum;
}

// A place of one level by one filter; `dice` in [0, 1) are of the stochastic one.
vec4 filtered_level(Texture image, Sampler how, uint slot, uint mode, Level level, vec3 at, uint face, vec3 dice) {
    bool cube = MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_CUBE, image.link.w);
    bool volume = MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_VOLUME, image.link.w);
    precise vec3 texel;
    if (cube) {
        texel = at * float(level.size.x);
    } else {
        texel = vec3(reduced_coordinate(ADDRESSES_U, how.modes.x, at.x, float(level.size.x)),
                     reduced_coordinate(ADDRESSES_V, how.modes.y, at.y, float(level.size.y)),
                     volume ? reduced_coordinate(ADDRESSES_W, how.more.x, at.z, float(level.size.z)) : 0.0);
        // Integer centres move texel i from i + 1/2 to i: half a texel is added before addressing.
        if (MODE_IS(TEXEL_CENTERS, TEXEL_CENTER_INTEGER, how.modes.w)) texel += 0.5;
    }
    // Linear weights as chances: the nearest texel of a place moved by up to half a texel.
    if (MODE_IS(FILTERS, FILTER_STOCHASTIC, mode)) texel += dice - 0.5;
    if (MODE_IS(FILTERS, FILTER_NEAREST, mode) || MODE_IS(FILTERS, FILTER_STOCHASTIC, mode)) {
        ivec3 nearest = ivec3(floor(texel));
        if (cube) {
            // Beyond a corner: one of the three texels there, by the clamped place.
            bool corner = (nearest.x < 0 || nearest.x >= level.size.x) && (nearest.y < 0 || nearest.y >= level.size.x);
            if (corner && dice.z < 2.0 / 3.0) {
                nearest.x = dice.z < 1.0 / 3.0 ? clamp(nearest.x, 0, level.size.x - 1) : nearest.x;
                nearest.y = dice.z < 1.0 / 3.0 ? nearest.y : clamp(nearest.y, 0, level.size.x - 1);
            } else if (corner) {
                nearest.xy = clamp(nearest.xy, ivec2(0), ivec2(level.size.x - 1));
            }
            return fetch_texel(image, slot, level, cube_texel(face, nearest.xy, level.size.x));
        }
        if (!volume) return flat_texel(image, how, slot, level, nearest.xy);
        return fetch_or_border(image, how, slot, level,
                               ivec3(addressed_texel(ADDRESSES_U, how.modes.x, nearest.x, level.size.x),
                                     addressed_texel(ADDRESSES_V, how.modes.y, nearest.y, level.size.y),
                                     addressed_texel(ADDRESSES_W, how.more.x, nearest.z, level.size.z)));
    }
    texel -= 0.5;
    if (cube) return linear_cube(image, slot, level, face, texel.xy);
    if (volume) return linear_volume(image, how, slot, level, texel);
    if (MODE_IS(FILTERS, FILTER_CUBIC, mode)) return cubic_flat(image, how, slot, level, texel.xy);
    return linear_flat(image, how, slot, level, texel.xy);
}

// ---- Ellipses

// The level on which the minor axis, full width, lies between 2^-ELLIPSE_LEVEL and twice that in texels.
const float ELLIPSE_LEVEL = 0.0;
// Beyond the longest ellipse: no loop is endless, whatever its numbers are.
const int MAX_ELLIPSE_STEPS = 8192;

// exp(-2 r²) - exp(-2) for r² in [0, 1], as a polynomial: 1 at the centre but for scale, 0 at the rim.
float ellipse_weight(float squared) {
    float r = 1.0 - squared;
    return r * (0.2643662 + r * (0.3266478 + r * (0.0257909 + r * 0.2473448)));
}

// All texels of the footprint's ellipse, weighted by a Gaussian. The level is that on which the minor
// axis is about one texel; where the ellipse is longer than the maximum anisotropy its minor axis grows.
vec4 ellipse(Texture image, Sampler how, uint slot, Coordinate c, Spread spread) {
    float most = float(how.link.w);
    float minor = max(spread.minor, spread.major / (most * most));
    int index = clamp(int(floor(0.5 * log2_accurate(max(minor, 1e-30)) + ELLIPSE_LEVEL)), 0, int(image.link.y) - 1);
    Level level = level_at(image, index);
    vec2 size = vec2(level.size.xy);
    // Covariance J Jᵀ on this level; the thin axis is widened along its own direction.
    vec2 x = c.dx.xy * size;
    vec2 y = c.dy.xy * size;
    float shrink = float(level.size.x) / float(image.place.y);
    vec3 m = vec3(x.x * x.x + y.x * y.x, x.x * x.y + y.x * y.y, x.y * x.y + y.y * y.y);
    float scale = shrink * shrink;
    float gap = spread.major - spread.minor;
    float widen = gap > 0.0 ? (minor - spread.minor) / gap : 0.0;
    m += widen * (vec3(spread.major * scale, 0.0, spread.major * scale) - m);
    // On the last level there is nothing wider to see.
    m *= min(1.0, 16.0 * most * most / (m.x + m.z));
    // The texels' own width, which reconstruction adds.
    m += vec3(1.0, 0.0, 1.0);
    float inverse = 1.0 / (m.x * m.z - m.y * m.y);
    float a = m.z * inverse;
    float b = -m.y * inverse;
    float d = m.x * inverse;

    precise vec2 center = vec2(reduced_coordinate(ADDRESSES_U, how.modes.x, c.at.x, size.x),
                               reduced_coordinate(ADDRESSES_V, how.modes.y, c.at.y, size.y));
    if (!MODE_IS(TEXEL_CENTERS, TEXEL_CENTER_INTEGER, how.modes.w)) center -= 0.5;
    float reach = sqrt(m.z);
    int row = int(ceil(center.y - reach));
    int last_row = int(floor(center.y + reach));
    int column = 1;
    int last_column = 0;
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    row -= 1;
    // One loop over rows and columns: neighbouring lanes whose ellipses differ stay busy.
    for (int turn = 0; turn < MAX_ELLIPSE_STEPS; turn++) {
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
            if (!POLES || how.more.y == 0u) {
                at.x = wrapped_texel(ADDRESSES_U, how.modes.x, at.x, level.size.x);
                at.y = wrapped_texel(ADDRESSES_V, how.modes.y, at.y, level.size.y);
            }
            vec4 value = POLES ? flat_texel(image, how, slot, level, at)
                               : fetch_or_border(image, how, slot, level, ivec3(at, 0));
            sum = fma(vec4(weight), value, sum);
            weights += weight;
            column++;
        }
    }
    return sum / max(weights, 1e-20);
}

// ---- Everything together

// A look-up reads one level in one place. Spelt with bits: the shader compiler loses track of negated
// chains of && and || over specialization constants.
const uint LEVEL_BLENDS = MIPMAPPED ? MIPS & (1u << MIP_LINEAR) : 0u;
const bool ONE_PLACE = (LEVEL_BLENDS | (FILTERS & (1u << FILTER_ANISOTROPIC))) == 0u;

// Three numbers in [0, 1) from a sample's random bits.
vec3 look_up_dice(uvec2 random) {
    uvec3 bits = pcg3d(uvec3(random, 0x7E41u));
    return vec3(bits >> 8u) * (1.0 / 16777216.0);
}

vec4 look_up(Texture image, Sampler how, uint slot, Coordinate place, uvec2 random) {
    bool hardware = false;
#if HAS_IMAGES
    hardware = MODE_IS(METHODS, METHOD_HARDWARE, how.link.x);
#endif
    uint mode = how.modes.z;
    vec3 dice = vec3(0.0);
    if (HAS(FILTERS, FILTER_STOCHASTIC)) dice = look_up_dice(random);
    uint face;
    Coordinate c = in_texture(image, place, face);
    if (!FILTERED) {
#if HAS_IMAGES
        if (hardware) return read_sampled(image, how, slot, place, 0.0);
#endif
        return filtered_level(image, how, slot, mode, level_at(image, 0), c.at, face, dice);
    }

    Spread spread = texel_spread(image, c);
    bool magnified = spread.major <= 1.0;
    mode = magnified ? mode : how.link.y;
    if (HAS(FILTERS, FILTER_EWA) && mode == FILTER_EWA) return ellipse(image, how, slot, c, spread);
    int last = int(image.link.y) - 1;
    uint probes = 1u;
    if (HAS(FILTERS, FILTER_ANISOTROPIC) && mode == FILTER_ANISOTROPIC) {
        float most = float(how.link.w);
        float ratio = spread.major / max(spread.minor, 1e-30);
        probes = uint(ceil(sqrt(min(ratio, most * most)) - 1e-3));
        probes = max(probes, 1u);
    }
    float level = 0.0;
    if (!magnified && (MIPMAPPED || hardware)) {
        level = 0.5 * log2_accurate(spread.major / float(probes * probes));
        // The device's sampler knows its own last level, and minifies with one level too.
        level = clamp(level, 0.0, hardware ? 32.0 : float(last));
    }
#if HAS_IMAGES
    if (hardware) return read_sampled(image, how, slot, place, level);
#endif
    int low = 0;
    float rest = 0.0; // share of the next level
    if (MIPMAPPED && MODE_IS(MIPS, MIP_LINEAR, how.link.z)) {
        low = int(floor(level));
        rest = level - float(low);
    } else if (MIPMAPPED && MODE_IS(MIPS, MIP_NEAREST, how.link.z)) {
        low = int(ceil(level + 0.5)) - 1;
    }
    if (HAS(FILTERS, FILTER_STOCHASTIC) && mode == FILTER_STOCHASTIC) {
        low += dice.z < rest ? 1 : 0;
        rest = 0.0;
        dice.z = fract(dice.z * 4096.0);
    }
    if (ONE_PLACE) {
        return filtered_level(image, how, slot, mode, level_at(image, low), c.at, face, dice);
    }
    // Look-ups along the major axis. Of `probes` a share `rest` reads the next level, the one between
    // reads both: one look-up more than probes, and smooth in the level. Turn 0 is left out where no
    // probe reads the next level.
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
        if (HAS(FILTERS, FILTER_ANISOTROPIC)) {
            // From both ends inwards.
            uint order = (probe & 1u) != 0u ? probes - 1u - probe / 2u : probe / 2u;
            float way = (float(order) + 0.5) * each - 0.5;
            precise vec3 moved = c.at + way * (spread.along.x * c.dx + spread.along.y * c.dy);
            at = moved;
            if (MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_CUBE, image.link.w)) at = refaced(at, at_face);
        }
        int index = upper ? min(low + 1, last) : low;
        sum = fma(vec4(weight), filtered_level(image, how, slot, mode, level_at(image, index), at, at_face, dice), sum);
    }
    return sum;
}
#endif

#endif
