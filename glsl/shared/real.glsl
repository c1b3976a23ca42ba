// The type of geometry: f32, or f64 if F64_MATH is defined. Rays, shapes and texture coordinates have this
// type until whole tiles are subtracted; colours, footprints and look-ups are always f32. Records store their
// real vectors in one or two units; F64_RECORDS reads those of f64 and computes in f32.
#ifndef REAL_GLSL
#define REAL_GLSL

#if defined(F64_MATH) || defined(F64_RECORDS)
const uint REAL_UNITS = 2u;
#define READ_DOUBLE(read, at)                                                  \
    dvec4(packDouble2x32(read(at).xy), packDouble2x32(read(at).zw),            \
          packDouble2x32(read((at) + 1u).xy), packDouble2x32(read((at) + 1u).zw))
#define REAL_BITS(link) real(packDouble2x32(link))
#else
const uint REAL_UNITS = 1u;
#define REAL_BITS(link) uintBitsToFloat((link).x)
#endif

#ifdef F64_MATH
#define real double
#define real2 dvec2
#define real3 dvec3
#define real4 dvec4
#define READ_REAL(read, at) READ_DOUBLE(read, at)
#else
#define real float
#define real2 vec2
#define real3 vec3
#define real4 vec4
#ifdef F64_RECORDS
#define READ_REAL(read, at) vec4(READ_DOUBLE(read, at))
#else
#define READ_REAL(read, at) uintBitsToFloat(read(at))
#endif
#endif

#endif
