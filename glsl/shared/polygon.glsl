// Convex polygons in the plane of the picture, and affine functions of the place in it ("forms"): where a
// line cuts a polygon, its area, its middle. Twin: src/oracle/polygon.rs.
#ifndef POLYGON_GLSL
#define POLYGON_GLSL

#include "math.glsl"

const uint MAX_CORNERS = 12u;

// What is smaller is dropped, in pixels².
const float LEAST_AREA = 1e-7;

// Corners in order; fewer than three are no area.
struct Polygon {
    uint count;
    vec2 corners[MAX_CORNERS];
};

// f(x, y) = f.x x + f.y y + f.z.
float at(vec3 form, vec2 place) { return (form.x * place.x + form.y * place.y) + form.z; }

// The whole pixel.
Polygon unit_square() {
    Polygon square;
    square.count = 4u;
    square.corners[0] = vec2(0.0, 0.0);
    square.corners[1] = vec2(1.0, 0.0);
    square.corners[2] = vec2(1.0, 1.0);
    square.corners[3] = vec2(0.0, 1.0);
    return square;
}

void push(inout Polygon polygon, vec2 corner) {
    if (polygon.count < MAX_CORNERS) polygon.corners[polygon.count] = corner;
    polygon.count++;
}

// Copies the corners that there are: some compilers move whole lists lane by lane.
void copy(Polygon from, out Polygon to) {
    to.count = from.count;
    for (uint k = 0u; k < from.count; k++) to.corners[k] = from.corners[k];
}

// Where the form is positive, and where it is negative. A side with more than MAX_CORNERS corners has lost
// some.
void split(Polygon polygon, vec3 form, out Polygon inside, out Polygon outside) {
    inside.count = 0u;
    outside.count = 0u;
    vec2 a = polygon.corners[0];
    float fa = at(form, a);
    for (uint k = 1u; k <= polygon.count; k++) {
        vec2 b = polygon.corners[k == polygon.count ? 0u : k];
        float fb = at(form, b);
        bool cuts = (fa < 0.0 && fb > 0.0) || (fa > 0.0 && fb < 0.0);
        // First the corner, then the place where the edge is cut.
        for (uint turn = 0u; turn < (cuts ? 2u : 1u); turn++) {
            bool first = turn == 0u;
            vec2 corner = first ? a : a + (b - a) * (fa / (fa - fb));
            if (!first || fa >= 0.0) push(inside, corner);
            if (!first || fa <= 0.0) push(outside, corner);
        }
        a = b;
        fa = fb;
    }
}

// Signed area by the shoelace formula, counted from the first corner.
float area(Polygon polygon) {
    float twice = 0.0;
    vec2 first = polygon.corners[0];
    vec2 a = polygon.corners[1] - first;
    for (uint k = 2u; k < polygon.count; k++) {
        vec2 b = polygon.corners[k] - first;
        twice += a.x * b.y - a.y * b.x;
        a = b;
    }
    return 0.5 * twice;
}

// The mean of the corners.
vec2 middle(Polygon polygon) {
    vec2 sum = vec2(0.0);
    for (uint k = 0u; k < polygon.count; k++) sum += polygon.corners[k];
    return sum / float(polygon.count);
}

// The least and the greatest value of a form on a polygon.
vec2 range(Polygon polygon, vec3 form) {
    vec2 ends = vec2(3e38, -3e38);
    for (uint k = 0u; k < polygon.count; k++) {
        float value = at(form, polygon.corners[k]);
        ends = vec2(min(ends.x, value), max(ends.y, value));
    }
    return ends;
}

#endif
