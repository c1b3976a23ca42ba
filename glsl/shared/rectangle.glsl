// Samples a rectangle uniformly in solid angle from a point: Ureña, Fajardo & King 2013, "An Area-Preserving
// Parametrization for Spherical Rectangles". First strips of equal solid angle across the longer edge, then
// the position along the strip. Written so that f32 keeps its digits if the point almost touches the
// rectangle's plane: differences of angles are angles of quotients, and everything is mirrored so that the
// rectangle's centre has positive x and y. Twin: src/oracle/rectangle.rs.
#ifndef RECTANGLE_GLSL
#define RECTANGLE_GLSL

#include "math.glsl"

// A smaller solid angle is too flat for f32, whose angles are off by 1.6e-7, and sampling its area is as
// good.
const float MIN_SOLID_ANGLE = 1.0 / 1024.0;

// Returns y1 r0 - y0 r1, where r² = y² + d².
float height_gap(vec2 y, vec2 r, float squared) {
    float sum = y.y * r.x + y.x * r.y;
    return y.x > 0.0 ? squared * ((y.y - y.x) * (y.y + y.x)) / sum : y.y * r.x - y.x * r.y;
}

// Returns the solid angle of the half strip between x = 0 and x, as sine and cosine times a length; r are the
// distances of its corners.
vec2 half_strip(float x, vec2 y, float z, vec2 r) {
    return vec2(x * z * height_gap(y, r, x * x + z * z), z * z * r.x * r.y + x * x * y.x * y.y);
}

// Returns the same for the quarter plane beyond x > 0 between 0 and y; l = y² + z², r² = l + x².
vec2 beyond(float x, float y, float z, float l, float r) {
    return vec2(y * z * l, (r + x) * (z * z * r + x * y * y));
}

// Returns the angle of a less that of b.
float angle_between(vec2 a, vec2 b) {
    return atan2_accurate(a.x * b.y - b.x * a.y, b.y * a.y + b.x * a.x);
}

// Takes the `middle` of the rectangle along its edges, `half_sides`, and the `height` of the point above its
// plane. Returns the sample along the edges and below the point, and in w the solid angle.
vec4 on_rectangle(vec2 middle, vec2 half_sides, float height, vec2 square) {
    vec2 size = abs(middle) + half_sides;
    float reach = max(max(size.x, size.y), height);
    float z = height / reach;
    bvec2 flipped = lessThan(middle, vec2(0.0));
    vec2 rest = mix(1.0 - square, square, flipped);
    // The difference of two numbers of similar magnitude is exact (Sterbenz 1974), before the division.
    vec2 low = (abs(middle) - half_sides) / reach;
    vec2 high = size / reach;
    vec2 x = vec2(low.x, high.x);
    vec2 y = vec2(low.y, high.y);
    vec2 l = y * y + z * z;
    vec2 near = sqrt(x.x * x.x + l);
    vec2 far = sqrt(x.y * x.y + l);
    float solid_angle = angle_between(half_strip(x.y, y, z, far), half_strip(x.x, y, z, near));
    // It exceeds half of all directions only if the rectangle extends to both sides.
    solid_angle += x.x < 0.0 && solid_angle < 0.0 ? 2.0 * PI : 0.0;

    // Twice the half is the solid angle beyond the sample in the infinite strip. With T that of the strip
    // from x = 0 to the sample and B to its end, x / z is sin T over the root of (cos T - cos B) (cos T + cos
    // C), where C is the sum of the strip's angles; here as products, without the distances that cancel.
    float half_rest = 0.5 * (angle_between(beyond(x.y, y.y, z, l.y, far.y), beyond(x.y, y.x, z, l.x, far.x)) + rest.x * solid_angle);
    float s = sine_turns(half_rest * (0.5 / PI));
    float t = sine_turns(half_rest * (0.5 / PI) + 0.25);
    float sine_b = z * (y.y - y.x);
    float cosine_b = z * z + y.x * y.y;
    float sine = sine_b * (1.0 - 2.0 * s * s) - cosine_b * (2.0 * s * t);
    float squared = (sine_b * t - cosine_b * s) * s * ((z * t + y.y * s) * (z * t - y.x * s));
    float along = clamp(0.5 * z * sine * inversesqrt(max(squared, 1e-30)), x.x, x.y);

    // Sines of the angles to the sample's ends, less than 1 by e.
    float d = along * along + z * z;
    vec2 r = sqrt(d + y * y);
    float e1 = d / (r.y * (r.y + y.y));
    float e0 = y.x > 0.0 ? d / (r.x * (r.x + y.x)) : 1.0 - y.x / r.x;
    float e = e1 + rest.y * (e0 - e1);
    float across = clamp((1.0 - e) * sqrt(d / max(e * (2.0 - e), 1e-30)), y.x, y.y);
    vec2 place = mix(vec2(along, across), -vec2(along, across), flipped);
    return vec4(vec3(place, -z) * reach, solid_angle);
}

#endif
