// Functions whose built-in versions are too inaccurate, and dot products in a fixed order. No product is
// fused with a sum except by `fma` (build/uncontracted.rs), and a reciprocal root is `inversesqrt`, which
// drivers substitute for a quotient in one pipeline and not in another. atan: minimax polynomial of degree 17
// on [0, 1], error below 2e-8 in exact arithmetic. exp2: Taylor series of degree 6. log2: exponent from the
// bits, artanh series of the mantissa, error below 1e-7 (2 ulp of the result).
#ifndef MATH_GLSL
#define MATH_GLSL

#include "real.glsl"

const float PI = 3.14159265358979;
#ifdef F64_MATH
const double REAL_PI = 3.14159265358979323846lf;
#else
const float REAL_PI = PI;
#endif

// Returns x y z summed from the left, so that all devices round alike.
#define DOT3(scalar, vector)                                                                     \
    scalar dot3(vector a, vector b) {                                                            \
        scalar sum = fma(a.z, b.z, fma(a.y, b.y, a.x * b.x));                                    \
        return sum;                                                                              \
    }

// Returns row.xyz · p + row.w.
#define AFFINE(scalar, row_vector, vector)                                                       \
    scalar affine(row_vector row, vector p) {                                                    \
        scalar sum = fma(row.z, p.z, fma(row.y, p.y, row.x * p.x)) + row.w;                      \
        return sum;                                                                              \
    }

#define CROSS3(vector)                                                                           \
    vector cross3(vector a, vector b) {                                                          \
        vector c = vector(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);  \
        return c;                                                                                \
    }

DOT3(float, vec3)
AFFINE(float, vec4, vec3)
CROSS3(vec3)

float inverse_root(float x) { return inversesqrt(x); }

// Returns atan(x) for x in [0, 1].
float atan_unit(float x) {
    float y = x * x;
    float sum = 0.002849889771088515;
    sum = sum * y - 0.01606862956664404;
    sum = sum * y + 0.042691520265489;
    sum = sum * y - 0.07504294623787518;
    sum = sum * y + 0.10640934065394224;
    sum = sum * y - 0.14203644476771696;
    sum = sum * y + 0.19992619392945368;
    sum = sum * y - 0.33333073345113357;
    sum = sum * y + 0.999999984765776;
    return sum * x;
}

// Returns the angle of (x, y) from +x towards +y, in (-pi, pi]; 0 at the origin.
#define ATAN2(scalar, pi)                                                                        \
    scalar atan2_accurate(scalar y, scalar x) {                                                  \
        scalar ax = abs(x);                                                                      \
        scalar ay = abs(y);                                                                      \
        scalar high = max(ax, ay);                                                               \
        if (high == 0.0) return 0.0;                                                             \
        scalar angle = atan_unit(min(ax, ay) / high);                                            \
        if (ay > ax) angle = 0.5 * pi - angle;                                                   \
        if (x < 0.0) angle = pi - angle;                                                         \
        return y < 0.0 ? -angle : angle;                                                         \
    }

ATAN2(float, PI)

#ifdef F64_MATH
DOT3(double, dvec3)
AFFINE(double, dvec4, dvec3)
CROSS3(dvec3)

double inverse_root(double x) { return inversesqrt(x); }

// The angle of the f32 polynomial plus a correction: with s and c of that angle by Taylor series to degree
// 17, tan(correction) = (y c - x s) / (x c + y s); the correction is below 1e-7, so that its cube is
// negligible.
double atan_unit(double x) {
    double angle = double(atan_unit(float(x)));
    double y = angle * angle;
    double s = 2.8114572543455206e-15lf;
    s = s * y - 7.6471637318198164e-13lf;
    s = s * y + 1.6059043836821614e-10lf;
    s = s * y - 2.5052108385441719e-8lf;
    s = s * y + 2.7557319223985891e-6lf;
    s = s * y - 1.9841269841269841e-4lf;
    s = s * y + 8.3333333333333333e-3lf;
    s = s * y - 1.6666666666666667e-1lf;
    s = (s * y + 1.0lf) * angle;
    double c = 4.7794773323873853e-14lf;
    c = c * y - 1.1470745597729725e-11lf;
    c = c * y + 2.0876756987868099e-9lf;
    c = c * y - 2.7557319223985891e-7lf;
    c = c * y + 2.4801587301587302e-5lf;
    c = c * y - 1.3888888888888889e-3lf;
    c = c * y + 4.1666666666666667e-2lf;
    c = c * y - 0.5lf;
    c = c * y + 1.0lf;
    return angle + (x * c - s) / (c + x * s);
}

ATAN2(double, REAL_PI)
#endif

// Returns sin(2 pi t): the fraction of t, folded to [0, 1/4], in a minimax polynomial of degree 9, error
// below 4e-9 in exact arithmetic.
float sine_turns(float t) {
    float s = t - roundEven(t);
    float a = abs(s);
    a = min(a, 0.5 - a);
    float y = a * a;
    float sum = 39.53670776604566;
    sum = sum * y - 76.54978257470793;
    sum = sum * y + 81.60100408945674;
    sum = sum * y - 41.341655031788335;
    sum = sum * y + 6.283185160092155;
    float sine = sum * a;
    return s < 0.0 ? -sine : sine;
}

// Returns 2^x, to 2 ulp for |x| < 126: the nearest integer power times the Taylor series of the remainder.
float exp2_accurate(float x) {
    float whole = floor(x + 0.5);
    float t = (x - whole) * 0.69314718;
    float sum = 0.00138889;
    sum = sum * t + 0.00833333;
    sum = sum * t + 0.04166667;
    sum = sum * t + 0.16666667;
    sum = sum * t + 0.5;
    sum = sum * t + 1.0;
    sum = sum * t + 1.0;
    return intBitsToFloat((int(whole) + 127) << 23) * sum;
}

// Returns log2(x) for normal positive x: x = 2^e m with m in [1/√2, √2), log2 m = 2 / ln 2 ·
// artanh((m-1)/(m+1)).
float log2_accurate(float x) {
    int bits = floatBitsToInt(x);
    int e = (bits - 0x3F3504F3) >> 23;
    float m = intBitsToFloat(bits - (e << 23));
    float t = (m - 1.0) / (m + 1.0);
    float y = t * t;
    float sum = 0.3205989;
    sum = sum * y + 0.41219859;
    sum = sum * y + 0.57707802;
    sum = sum * y + 0.96179669;
    sum = sum * y + 2.88539008;
    sum = sum * t + float(e);
    return sum;
}

// Returns a unit vector perpendicular to the unit vector n (Duff et al. 2017).
vec3 any_tangent(vec3 n) {
    float side = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (side + n.z);
    return vec3(1.0 + side * n.x * n.x * a, side * n.x * n.y * a, -side * n.x);
}

#endif
