// The part of a disc that is covered, and its centroid: the unit disc cut by straight lines, or overlapped by
// a circle. Exact: the area inside a closed border is half the integral of x dy - y dx along it, its first
// moment a third of that of (x, y) (x dy - y dx); the border consists of line segments and arcs of the disc's
// boundary. All arcs together span the angle about the centre that the segments leave, and the integrals over
// an arc depend on its ends alone, so that nothing is sorted. Twin: src/oracle/coverage.rs.
#ifndef COVERAGE_GLSL
#define COVERAGE_GLSL

#include "math.glsl"

// Fraction of the disc's area, and the centroid of the covered part.
struct Covered {
    float share;
    vec2 center;
};

const Covered NOTHING = Covered(0.0, vec2(0.0));
const Covered EVERYTHING = Covered(1.0, vec2(0.0));

// Smaller fractions count as 0.
const float MIN_SHARE = 1e-5;

// The lines that cross the disc, the newest first: covered is a x + b y + c >= 0, where (a, b) has unit
// length. Registers, as arrays with an index that differs between threads are slow. With more lines than
// these, which only pairs of shapes have, the oldest are left out.
const vec3 NO_CUT = vec3(0.0, 0.0, 2.0);
vec3 cut_a;
vec3 cut_b;
vec3 cut_c;
vec3 cut_d;
vec3 cut_e;
vec3 cut_f;
bool cut_away; // some line leaves nothing

float dot2(vec2 a, vec2 b) {
    float sum = a.x * b.x + a.y * b.y;
    return sum;
}

void whole_disc() {
    cut_a = NO_CUT;
    cut_b = NO_CUT;
    cut_c = NO_CUT;
    cut_d = NO_CUT;
    cut_e = NO_CUT;
    cut_f = NO_CUT;
    cut_away = false;
}

const float BESIDE = 1e-9;

void cut_by(vec3 line) {
    float squared = dot2(line.xy, line.xy);
    vec3 unit = line * inversesqrt(squared > 0.0 ? squared : 1.0);
    // A line through the centre is moved beside it, so that its segment subtends an angle there.
    if (abs(unit.z) < BESIDE) unit.z = BESIDE;
    // A line at infinity leaves everything or nothing.
    float beyond = squared > 0.0 ? unit.z : (line.z > 0.0 ? 1.0 : -1.0);
    cut_away = cut_away || !(beyond > -1.0);
    bool crosses = beyond > -1.0 && beyond < 1.0;
    cut_f = crosses ? cut_e : cut_f;
    cut_e = crosses ? cut_d : cut_e;
    cut_d = crosses ? cut_c : cut_d;
    cut_c = crosses ? cut_b : cut_c;
    cut_b = crosses ? cut_a : cut_b;
    cut_a = crosses ? unit : cut_a;
}

// A line's share of the border: twice the area between it and the disc's centre, the angle that it subtends
// there, and six times the moment.
struct Border {
    float twice_area;
    float turn;
    vec2 moment;
};

// Lines with a smaller sine between them count as parallel: their intersection is inaccurate, and the border
// must close.
const float PARALLEL = 1e-4;

// Returns the part of a line's segment, from x to y from its foot point, that another line leaves.
vec2 clipped(vec2 fragment, vec3 line, vec3 other, bool again) {
    vec2 way = vec2(line.y, -line.x); // with the covered side on its left
    float slope = dot2(other.xy, way);
    float cosine = dot2(other.xy, line.xy);
    bool parallel = abs(slope) < PARALLEL;
    float end = (line.z * cosine - other.z) / (parallel ? 1.0 : slope);
    float from = !parallel && slope > 0.0 ? max(fragment.x, end) : fragment.x;
    float to = !parallel && slope < 0.0 ? min(fragment.y, end) : fragment.y;
    // Of two equal lines the second has no segment; two opposite ones see the same gap.
    float gap = cosine > 0.0 ? other.z - line.z : other.z + line.z;
    bool empty = parallel && (gap < 0.0 || (again && gap == 0.0 && cosine > 0.0));
    return vec2(from, empty ? from : to);
}

void add_border(inout Border sum, vec3 line, vec2 fragment) {
    float rim = sqrt(max(1.0 - line.z * line.z, 0.0));
    if (fragment.x < fragment.y) {
        vec2 way = vec2(line.y, -line.x);
        vec2 foot = -line.z * line.xy;
        vec2 p = foot + fragment.x * way;
        vec2 q = foot + fragment.y * way;
        float twice = line.z * (fragment.y - fragment.x);
        sum.twice_area += twice;
        sum.turn += atan2_accurate(twice, dot2(p, q));
        vec2 moment = twice * (p + q);
        if (fragment.x == -rim) moment += 2.0 * vec2(p.y, -p.x);
        if (fragment.y == rim) moment -= 2.0 * vec2(q.y, -q.x);
        sum.moment += moment;
    }
}

// Returns the segment of a line within the disc and five others; `true` follows those that precede it.
#define BORDER(line, o1, n1, o2, n2, o3, n3, o4, n4, o5, n5)                      \
    {                                                                            \
        float rim = sqrt(max(1.0 - line.z * line.z, 0.0));                       \
        vec2 fragment = clipped(vec2(-rim, rim), line, o1, n1);                      \
        fragment = clipped(fragment, line, o2, n2);                                     \
        fragment = clipped(fragment, line, o3, n3);                                     \
        fragment = clipped(fragment, line, o4, n4);                                     \
        fragment = clipped(fragment, line, o5, n5);                                     \
        add_border(border, line, fragment);                                          \
    }

// Returns the part of the disc that the lines leave.
Covered cut_disc() {
    Border border = Border(0.0, 0.0, vec2(0.0));
    BORDER(cut_a, cut_b, false, cut_c, false, cut_d, false, cut_e, false, cut_f, false)
    BORDER(cut_b, cut_a, true, cut_c, false, cut_d, false, cut_e, false, cut_f, false)
    BORDER(cut_c, cut_a, true, cut_b, true, cut_d, false, cut_e, false, cut_f, false)
    BORDER(cut_d, cut_a, true, cut_b, true, cut_c, true, cut_e, false, cut_f, false)
    BORDER(cut_e, cut_a, true, cut_b, true, cut_c, true, cut_d, true, cut_f, false)
    BORDER(cut_f, cut_a, true, cut_b, true, cut_c, true, cut_d, true, cut_e, true)
    float least = min(min(min(cut_a.z, cut_b.z), min(cut_c.z, cut_d.z)), min(cut_e.z, cut_f.z));
    float arcs = (least >= 0.0 ? 2.0 * PI : 0.0) - border.turn;
    float share = cut_away ? 0.0 : min((border.twice_area + arcs) * (0.5 / PI), 1.0);
    if (cut_a.z > 1.0) share = cut_away ? 0.0 : 1.0;
    bool some = share > MIN_SHARE;
    vec2 center = border.moment * (1.0 / (6.0 * PI)) / (some ? share : 1.0);
    return some ? Covered(share, center) : NOTHING;
}

// Returns phi - sin phi cos phi from sine and cosine in [0, 1]: a circular segment over the square of its
// radius. Small angles use the series, as the two terms cancel.
float segment(float sine, float cosine) {
    float y = sine * sine;
    float series = sine * y * (2.0 / 3.0 + y * (0.2 + y * (3.0 / 28.0 + y * (5.0 / 72.0))));
    float plain = atan2_accurate(sine, cosine) - sine * cosine;
    return y < 0.09 ? series : plain;
}

// Returns the overlap of the disc with a circle around `middle`; `edge` is the radius less the distance of
// `middle` from the disc's centre, which the caller computes without cancellation.
Covered circle_overlap(vec2 middle, float radius, float edge) {
    if (!(edge > -1.0)) return NOTHING;
    if (edge >= 1.0) return EVERYTHING;
    float apart = sqrt(dot2(middle, middle));
    if (radius + apart <= 1.0) {
        float share = radius * radius;
        if (!(share > MIN_SHARE)) return NOTHING;
        return Covered(share, middle);
    }
    // The chord through both intersections, from the disc's centre.
    float chord = (1.0 - edge * (radius + apart)) / (2.0 * apart);
    float half_length = sqrt(max(1.0 - chord * chord, 0.0));
    float own = segment(half_length, abs(chord));
    own = chord < 0.0 ? PI - own : own;
    // The circle's part on the side of the disc's centre.
    float sine = min(half_length / radius, 1.0);
    float other = segment(sine, min(abs(apart - chord) / radius, 1.0));
    other = (apart < chord ? PI - other : other) * (radius * radius);
    float share = min((own + other) * (1.0 / PI), 1.0);
    if (!(share > MIN_SHARE)) return NOTHING;
    // The moments of the two segments about their circles' centres cancel.
    vec2 center = middle * (other / (PI * share));
    return Covered(share, center);
}

// Returns the overlap with a small circle, both replaced by squares of equal area: squares tile the picture,
// so a moving ball keeps its total, which discs with gaps between pixels would not preserve.
const float SQUARE = 0.88622693; // half the side of a square with the disc's area

Covered small_overlap(vec2 middle, float radius) {
    float side = SQUARE * radius;
    vec2 from = max(middle - side, -SQUARE);
    vec2 to = min(middle + side, SQUARE);
    vec2 size = max(to - from, 0.0);
    float share = size.x * size.y * (1.0 / PI);
    if (!(share > MIN_SHARE)) return NOTHING;
    return Covered(share, 0.5 * (from + to));
}

// Returns the overlap with a circle of any size: blends from one to the other between half the disc's radius
// and all of it.
Covered ball_overlap(vec2 middle, float radius, float edge) {
    float large = clamp(2.0 * radius - 1.0, 0.0, 1.0);
    Covered a = small_overlap(middle, min(radius, 1.0));
    Covered b = circle_overlap(middle, radius, edge);
    float from_a = (1.0 - large) * a.share;
    float share = from_a + large * b.share;
    if (!(share > MIN_SHARE)) return NOTHING;
    vec2 center = (from_a * a.center + (large * b.share) * b.center) / share;
    return large >= 1.0 ? b : Covered(share, center);
}

// Returns a line that leaves about as much as the circle.
vec3 circle_line(vec2 middle, float radius, float edge) {
    float apart = sqrt(dot2(middle, middle));
    if (!(edge > -1.0) || edge >= 1.0) return vec3(0.0, 0.0, edge);
    float chord = (1.0 - edge * (radius + apart)) / (2.0 * apart);
    float rise = max(1.0 - chord * chord, 0.0) / (3.0 * radius); // two thirds of the arc's height over it
    return vec3(middle / apart, rise - chord);
}

#endif
