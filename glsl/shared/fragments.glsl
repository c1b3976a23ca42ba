// The shapes that a cone meets, in order of depth, and the visible part of each. The nearest fragments are
// kept and composited: exactly for two that overlap or intersect, and for any number side by side. Twin:
// src/oracle/fragments.rs.
#ifndef FRAGMENTS_GLSL
#define FRAGMENTS_GLSL

#include "geometry/cones.glsl"

// Planes whose depths differ by a smaller relative amount are coplanar: the first in the list is visible.
const float COPLANAR = 4e-6;
const uint FRAGMENTS = CONE_SHAPES == DYNAMIC ? MAX_CONE_FRAGMENTS : CONE_SHAPES;

// A shape in the cone.
struct Fragment {
    uint shape;
    float t;     // at the centroid
    float near;  // least and largest t over the disc
    float far;
    float area;  // fraction of the cone's cross-section
    float seen;  // the part of it that nothing nearer hides
    vec2 center; // centroid of the visible part
};

// In order. Only constants index them, so that they stay in registers: memory that each thread indexes by
// itself is slow.
Fragment fragments[MAX_CONE_FRAGMENTS];
uint piece_count;
float clear; // transmittance of the fragments that were not kept

#define EACH_PIECE(DO) DO(0u) DO(1u) DO(2u) DO(3u) DO(4u) DO(5u) DO(6u) DO(7u)

Fragment piece_at(uint index) {
    Fragment found = fragments[0];
#define SELECT(k) if (k < FRAGMENTS && k == index) found = fragments[k];
    EACH_PIECE(SELECT)
#undef SELECT
    return found;
}

void set_seen(uint index, float seen, vec2 center) {
#define SET(k)                         \
    if (k < FRAGMENTS && k == index) {    \
        fragments[k].seen = seen;         \
        fragments[k].center = center;     \
    }
    EACH_PIECE(SET)
#undef SET
}

// Returns t of a plane at the two ends of the disc between which it varies.
vec2 depths(const Cone cone, Flat depth) {
    float tilt = sqrt(dot2(depth.tilt, depth.tilt));
    vec2 high = depth.height - vec2(tilt, -tilt) * cone.width;
    vec2 facing = depth.facing + vec2(tilt, -tilt) * cone.spread;
    float first = facing.x > 0.0 ? max(high.x / facing.x, 0.0) : FAR;
    float second = facing.y > 0.0 ? max(high.y / facing.y, 0.0) : FAR;
    return vec2(min(first, second), max(first, second));
}

// Inserts the fragment if it is among the nearest.
void keep(const Cone cone, uint shape, Covered covered, float t_max) {
    Ray ray = ray_at(cone, covered.center);
    float t = meet(ray, shape).t;
    if (!(covered.share > MIN_SHARE && t > 0.0 && t < t_max)) return;
    if (!rises_to(cone, ray.origin + t * ray.direction)) return;
    vec2 range = depths(cone, depth_of(cone, shape, t, covered.share));
    Fragment next = Fragment(shape, t, range.x, range.y, covered.share, covered.share, covered.center);
#define INSERT(k)                              \
    if (k < FRAGMENTS && next.t < fragments[k].t) {  \
        Fragment here = fragments[k];                \
        fragments[k] = next;                      \
        next = here;                           \
    }
    EACH_PIECE(INSERT)
#undef INSERT
    clear *= 1.0 - next.area;
    piece_count = min(piece_count + 1u, FRAGMENTS);
}

const uint BATCH = 32u;

// Collects the nearest shapes except `skip` that the cone meets before t_max, in order. Most shapes are
// missed, which is tested first: computing coverage takes longer, and all threads wait while one does so.
void collect_fragments(const Cone cone, uint skip, float t_max) {
    uint shapes = shape_count();
    piece_count = 0u;
    clear = 1.0;
#define CLEAR(k) fragments[k] = Fragment(NO_SHAPE, FAR, FAR, FAR, 0.0, 0.0, vec2(0.0));
    EACH_PIECE(CLEAR)
#undef CLEAR
    for (uint first = 0u; first < shapes; first += BATCH) {
        uint found = 0u;
        for (uint i = 0u; i < BATCH && first + i < shapes; i++) {
            if (first + i != skip && touched(cone, first + i)) found |= 1u << i;
        }
        while (found != 0u) {
            uint shape = first + uint(findLSB(found));
            found &= found - 1u;
            keep(cone, shape, covered_by(cone, shape), t_max);
        }
    }
    // Nothing behind the first fragment that covers everything is visible, unless part of it is nearer.
    float far = FAR;
    uint count = 0u;
#define TRIM(k)                                                                \
    if (k < FRAGMENTS && k < piece_count) {                                       \
        count = fragments[k].near < far ? k + 1u : count;                         \
        far = fragments[k].area >= 1.0 ? min(far, fragments[k].far) : far;           \
    }
    EACH_PIECE(TRIM)
#undef TRIM
    piece_count = count;
}

// Returns the overlap in which one of two fragments hides the other: a hides b, or b hides a if `turned`.
// `turns` becomes true if b is in front of a anywhere on the disc: because their planes intersect, or because
// b's centroid is behind a's although b is in front where both are.
Covered hidden(const Cone cone, Fragment a, Fragment b, bool turned, out bool turns) {
    whole_disc();
    turns = false;
    bool a_has_lines = true;
    bool b_has_lines = true;
    Flat p = Flat(0.0, 0.0, vec2(0.0));
    Flat q = p;
    // Both shapes in turn, by the same code.
    for (uint k = 0u; k < 2u; k++) {
        Fragment fragment = b;
        if (k == 0u) fragment = a;
        bool has_lines = true;
        if (fragment.area < 1.0) has_lines = cut_shape(cone, fragment.shape);
        p = q;
        a_has_lines = b_has_lines;
        q = depth_of(cone, fragment.shape, fragment.t, fragment.area);
        b_has_lines = has_lines;
    }
    vec2 tilt = (q.height * cone.spread + cone.width * q.facing) * p.tilt;
    tilt -= (p.height * cone.spread + cone.width * p.facing) * q.tilt;
    vec3 before = vec3(tilt, q.height * p.facing - p.height * q.facing);
    if (abs(before.x) + abs(before.y) + abs(before.z) <= COPLANAR * abs(q.height * p.facing)) {
        before = vec3(0.0, 0.0, a.shape < b.shape ? 1.0 : -1.0);
    }
    cut_by(turned ? -before : before);
    Covered both = cut_disc();
    if (!a_has_lines || !b_has_lines) {
        // The position hardly matters.
        both = Covered(turned ? 0.0 : a.area * b.area, a_has_lines ? b.center : a.center);
    } else {
        turns = before.z < sqrt(dot2(before.xy, before.xy));
    }
    return both;
}

vec2 within_disc(vec2 center) {
    float outside = dot2(center, center);
    return outside > 1.0 ? center * inversesqrt(outside) : center;
}

// Composites the fragments: computes the visible part of each and its centroid, and returns the part that
// nothing covers, with its centroid. A partly visible fragment hides others in proportion. One loop over all
// pairs: an iteration processes one.
Covered composite(const Cone cone) {
    float rest = 1.0 - (piece_count > 0u ? fragments[0].area : 0.0);
    uint i = 1u;
    uint j = 0u;
    bool turned = false;
    float seen = 0.0;
    vec2 moment = vec2(0.0);
    while (FRAGMENTS > 1u && i < piece_count) {
        Fragment fragment = piece_at(i);
        Fragment other = piece_at(j);
        if (j == 0u && !turned) {
            seen = fragment.area;
            moment = fragment.area * fragment.center;
        }
        bool turns = false;
        Covered lost = hidden(cone, other, fragment, turned, turns);
        float weight = turned ? fragment.seen / fragment.area : other.seen / other.area;
        lost.share *= weight;
        if (turned) {
            float left = max(other.seen - lost.share, 0.0);
            vec2 left_moment = other.seen * other.center - lost.share * lost.center;
            set_seen(j, left, left > MIN_SHARE ? within_disc(left_moment / left) : other.center);
            rest += other.seen - left;
        } else {
            seen -= lost.share;
            moment -= lost.share * lost.center;
        }
        turned = turns && !turned;
        j += turned ? 0u : 1u;
        if (j == i) {
            seen = min(seen, rest);
            seen = seen > MIN_SHARE ? seen : 0.0;
            set_seen(i, seen, seen > 0.0 ? within_disc(moment / seen) : fragment.center);
            rest -= seen;
            i++;
            j = 0u;
        }
    }
    // Nothing is visible through a covered place, however many fragments overlap there: the excess belongs to
    // the hidden ones.
    float most = 0.0;
    float concealed = 0.0;
#define CONCEAL(k)                                     \
    if (k < FRAGMENTS && k < piece_count) {               \
        most = max(most, fragments[k].area);              \
        concealed += fragments[k].area - fragments[k].seen;  \
    }
    EACH_PIECE(CONCEAL)
#undef CONCEAL
    float excess = rest - (1.0 - most);
    if (excess > MIN_SHARE && concealed > 0.0) {
        float shown = excess / concealed;
#define SHOW(k) if (k < FRAGMENTS && k < piece_count) fragments[k].seen += shown * (fragments[k].area - fragments[k].seen);
        EACH_PIECE(SHOW)
#undef SHOW
        rest -= excess;
    }
    if (!(rest > MIN_SHARE)) return NOTHING;
    vec2 rest_moment = vec2(0.0);
#define SUBTRACT(k) if (k < FRAGMENTS && k < piece_count) rest_moment -= fragments[k].seen * fragments[k].center;
    EACH_PIECE(SUBTRACT)
#undef SUBTRACT
    return Covered(rest, within_disc(rest_moment / rest));
}

#endif
