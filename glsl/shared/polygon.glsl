// Convex polygons in the picture plane, and affine functions of the position in it ("forms"): clipping by a
// line, area, centre. Twin: src/oracle/polygon.rs.
#ifndef POLYGON_GLSL
#define POLYGON_GLSL

#include "math.glsl"

const uint MAX_CORNERS = 12u;

// Smaller areas are dropped, in pixels².
const float MIN_AREA = 1e-7;

// A thread's polygons are in one list and are passed by index: compilers copy structures with arrays element
// by element. Corners in order; fewer than three have no area.
const uint MAX_POLYGONS = 24u;
vec2 corners[MAX_POLYGONS * MAX_CORNERS];
uint counts[MAX_POLYGONS];

vec2 corner(uint polygon, uint k) { return corners[polygon * MAX_CORNERS + k]; }

// Returns the successor of corner k - 1: the first one follows the last.
vec2 next_corner(uint polygon, uint k) { return corner(polygon, k == counts[polygon] ? 0u : k); }

// f(x, y) = f.x x + f.y y + f.z.
float at(vec3 form, vec2 place) { return (form.x * place.x + form.y * place.y) + form.z; }

// Returns the whole pixel.
void unit_square(uint polygon) {
    counts[polygon] = 4u;
    for (uint k = 0u; k < 4u; k++) {
        corners[polygon * MAX_CORNERS + k] = vec2(k == 1u || k == 2u ? 1.0 : 0.0, k > 1u ? 1.0 : 0.0);
    }
}

void push(uint polygon, vec2 corner) {
    uint count = counts[polygon];
    if (count < MAX_CORNERS) corners[polygon * MAX_CORNERS + count] = corner;
    counts[polygon] = count + 1u;
}

void copy(uint from, uint to) {
    counts[to] = counts[from];
    for (uint k = 0u; k < counts[from]; k++) corners[to * MAX_CORNERS + k] = corner(from, k);
}

// Splits into the parts where the form is positive, and where it is negative. Returns false if a part has
// more than MAX_CORNERS corners and has lost some.
bool split(uint polygon, vec3 form, uint inside, uint outside) {
    counts[inside] = 0u;
    counts[outside] = 0u;
    vec2 a = corner(polygon, 0u);
    float fa = at(form, a);
    for (uint k = 1u; k <= counts[polygon]; k++) {
        vec2 b = next_corner(polygon, k);
        float fb = at(form, b);
        bool cuts = (fa < 0.0 && fb > 0.0) || (fa > 0.0 && fb < 0.0);
        vec2 place = a;
        bool first = true;
        // First the corner, then the intersection with the edge.
        for (uint turn = 0u; turn < (cuts ? 2u : 1u); turn++) {
            if (!first || fa >= 0.0) push(inside, place);
            if (!first || fa <= 0.0) push(outside, place);
            place = a + (b - a) * (fa / (fa - fb));
            first = false;
        }
        a = b;
        fa = fb;
    }
    return max(counts[inside], counts[outside]) <= MAX_CORNERS;
}

// Returns the signed area by the shoelace formula, relative to the first corner.
float area(uint polygon) {
    float twice = 0.0;
    vec2 first = corner(polygon, 0u);
    vec2 a = vec2(0.0);
    for (uint k = 1u; k < counts[polygon]; k++) {
        vec2 b = corner(polygon, k) - first;
        twice += a.x * b.y - a.y * b.x;
        a = b;
    }
    return 0.5 * twice;
}

// Returns the mean of the corners.
vec2 middle(uint polygon) {
    vec2 sum = vec2(0.0);
    for (uint k = 0u; k < counts[polygon]; k++) sum += corner(polygon, k);
    return sum / float(counts[polygon]);
}

// Returns the least and the greatest value of a form on a polygon.
vec2 range(uint polygon, vec3 form) {
    vec2 ends = vec2(3e38, -3e38);
    for (uint k = 0u; k < counts[polygon]; k++) {
        float value = at(form, corner(polygon, k));
        ends = vec2(min(ends.x, value), max(ends.y, value));
    }
    return ends;
}

#endif
