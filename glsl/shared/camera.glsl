// Generates camera rays from a pixel and a position in it, relative to the eye. Perspective: all rays start
// at 0 and the direction is forward + (sx - width/2) step_x + (sy - height/2) step_y, not normalised.
// Orthographic: that sum without `forward` is the origin, and `forward` the direction.
#ifndef CAMERA_GLSL
#define CAMERA_GLSL

#include "sample_dimensions.glsl"
#include "disk_sampling.glsl"

struct Ray {
    real3 origin;
    real3 direction;
    float time;
};

// What all rays of a pixel have in common: its corner, and the steps of 2^-24 of a pixel from there. Drivers do not move it
// out of the loop over the samples by themselves (lavapipe, Mesa 22.3.6).
struct PixelCorner {
    real3 point;
    real3 fine_x;
    real3 fine_y;
};

PixelCorner pixel_corner(const Header header, uvec2 pixel) {
    vec2 corner = vec2(pixel) - 0.5 * vec2(header.image_size);
    bool orthographic = MODE_IS(PROJECTIONS, PROJECTION_ORTHOGRAPHIC, header.projection);
    real3 start = orthographic ? real3(0.0) : header.forward;
    real3 point = (start + corner.x * header.step_x) + corner.y * header.step_y;
    return PixelCorner(point, header.step_x * (1.0 / 16777216.0), header.step_y * (1.0 / 16777216.0));
}

// Returns the pinhole camera's ray; `inside` counts from the pixel's corner, in units of 2^-24 of a pixel.
Ray camera_ray(const Header header, const PixelCorner corner, vec2 inside) {
    bool orthographic = MODE_IS(PROJECTIONS, PROJECTION_ORTHOGRAPHIC, header.projection);
    real3 along = fma(real3(inside.x), corner.fine_x, corner.point);
    real3 point = fma(real3(inside.y), corner.fine_y, along);
    return orthographic ? Ray(point, header.forward, 0.0) : Ray(real3(0.0), point, 0.0);
}

// Returns the thin lens's ray: from a point on the lens to the point where the pinhole's ray meets the plane
// of focus (Cook, Porter & Carpenter 1984). Per unit of t both advance equally along the view direction, so
// that a step of a pixel changes the direction as it does without a lens.
Ray through_lens(const Header header, const Ray ray, vec2 square) {
    vec2 place = header.lens_radius * concentric_disc(square);
    real3 aside = place.x * header.step_x + place.y * header.step_y;
    return Ray(ray.origin + aside, ray.direction - header.inverse_focus_distance * aside, ray.time);
}

// Returns the camera at a time between 0 and 1: the eye and the point that it looks at have moved, and the
// axes are recomputed. Rays still start relative to the eye at that time.
Header camera_at(Header header, float time) {
    real3 view = header.view + time * header.view_motion;
    real3 forward = view * inverse_root(dot3(view, view));
    real3 across = cross3(forward, header.up);
    real3 right = across * inverse_root(dot3(across, across));
    real pixel = header.pixel_side;
    header.forward = forward;
    header.step_x = pixel * right;
    header.step_y = pixel * cross3(forward, right);
    return header;
}

#endif
