// Model `dielectric`: the way of a refracted ray (Snell) and the share of light that is mirrored (Fresnel).
// Twin: src/oracle/bsdf/dielectric.rs.
#ifndef DIELECTRIC_GLSL
#define DIELECTRIC_GLSL

#include "../math.glsl"

// Square of what of a ray as long as d goes along the normal behind a surface; `ratio` of refractive indices, in
// front over behind. Not above 0 where everything is reflected. Of the sine, not the cosine: 1 - r² (1 - cos²)
// loses all digits where r is large.
real straight_behind(real3 direction, real3 n, real ratio) {
    real3 across = cross3(direction, n);
    real sine = ratio * sqrt(dot3(across, across));
    real size = sqrt(dot3(direction, direction));
    real under = (size - sine) * (size + sine);
    return under;
}

// Snell: the direction behind a surface with unit normal n against the ray. As long as d; d itself where
// everything is reflected.
real3 refracted(real3 direction, real3 n, real ratio) {
    real under = straight_behind(direction, n, ratio);
    real3 along = cross3(n, cross3(direction, n)); // the surface
    real3 result = ratio * along - sqrt(max(under, 0.0)) * n;
    return under > 0.0 ? result : direction;
}

// Share of unpolarised light that is mirrored (Fresnel); 1 beyond the critical angle.
real fresnel_dielectric(real3 direction, real3 n, real ratio) {
    real under = straight_behind(direction, n, ratio);
    if (under <= 0.0) return 1.0;
    real before = abs(dot3(direction, n));
    real behind = sqrt(under);
    real s = (ratio * before - behind) / (ratio * before + behind);
    real p = (before - ratio * behind) / (before + ratio * behind);
    real mean = 0.5 * (s * s + p * p);
    return mean;
}

#endif
