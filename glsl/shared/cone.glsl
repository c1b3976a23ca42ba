// A cone and the shapes that it touches (Amanatides 1984). A cone is a bundle of straight rays, one for
// each place u of the unit disc: origin + w (x u.x + y u.y) + t (direction + s (x u.x + y u.y)), with w
// its radius at the origin, s the growth of it a unit of t. Lines of space are lines of the disc, so that
// planes and triangles cut it exactly; a sphere is a circle, seen at its distance. The nearest pieces are
// kept and laid over each other: exactly for two that overlap, and for any number that lie side by side.
// Twin: src/oracle/cone.rs.
#ifndef CONE_GLSL
#define CONE_GLSL

#include "coverage.glsl"
#include "footprint.glsl"
#include "intersect.glsl"

// Shapes that a cone keeps: the nearest.
const uint MOST_PIECES = 8u;
const uint PIECES = CONE_SHAPES == DYNAMIC ? MOST_PIECES : CONE_SHAPES;

// Radius of a disc of area 1: a cone has its pixel's area.
const float DISC_RADIUS = 0.56418958;

struct Cone {
    Ray ray;
    vec3 x; // unit, at right angles to the ray
    vec3 y;
    float width; // radius at the origin
    float spread;
};

// A shape in the cone.
struct Piece {
    uint shape;
    float t;     // at the centroid
    float near;  // least and largest t over the disc
    float far;
    float area;  // share of the cone's cross-section
    float seen;  // of that, what nothing nearer hides
    vec2 center; // centroid of what is seen
};

// In order. Only constants index them, so that they are registers: memory that each thread indexes for
// itself is slow.
Piece pieces[MOST_PIECES];
uint piece_count;
float clear; // what pieces that were not kept leave of a place, if they lie anywhere

#define EACH_PIECE(DO) DO(0u) DO(1u) DO(2u) DO(3u) DO(4u) DO(5u) DO(6u) DO(7u)

Piece piece_at(uint index) {
    Piece found = pieces[0];
#define SELECT(k) if (k < PIECES && k == index) found = pieces[k];
    EACH_PIECE(SELECT)
#undef SELECT
    return found;
}

void set_seen(uint index, float seen, vec2 center) {
#define SET(k)                         \
    if (k < PIECES && k == index) {    \
        pieces[k].seen = seen;         \
        pieces[k].center = center;     \
    }
    EACH_PIECE(SET)
#undef SET
}

// Around a ray; of the camera's, `across` is the way to the next pixel, else 0.
Cone cone_of(Ray ray, Beam beam, vec3 across) {
    vec3 unit = ray.direction * inversesqrt(dot3(ray.direction, ray.direction));
    vec3 x = across - dot3(across, unit) * unit;
    float squared = dot3(x, x);
    x = squared > 0.0 ? x * inversesqrt(squared) : any_tangent(unit);
    return Cone(ray, x, cross3(unit, x), DISC_RADIUS * beam.width, DISC_RADIUS * beam.spread);
}

Ray ray_at(Cone cone, vec2 u) {
    vec3 aside = u.x * cone.x + u.y * cone.y;
    vec3 origin = cone.ray.origin + cone.width * aside;
    vec3 direction = cone.ray.direction + cone.spread * aside;
    return Ray(origin, direction, 0.0);
}

// A plane in the cone: the ray at u meets it at t = (height - w tilt·u) / (facing + s tilt·u), both
// positive where it is met.
struct Flat {
    float height;
    float facing;
    vec2 tilt;
};

Flat flat_in(Cone cone, vec3 normal, float height) {
    float above = height - dot3(normal, cone.ray.origin);
    float side = above < 0.0 ? -1.0 : 1.0;
    vec2 tilt = vec2(dot3(normal, cone.x), dot3(normal, cone.y));
    return Flat(side * above, side * dot3(normal, cone.ray.direction), side * tilt);
}

// The plane's own coordinate row·p + row.w lies within ±extent.
void cut_bounds(Cone cone, Flat plane, vec4 row, float extent) {
    float start = dot3(row.xyz, cone.ray.origin) + row.w;
    float along = dot3(row.xyz, cone.ray.direction);
    vec2 aside = vec2(dot3(row.xyz, cone.x), dot3(row.xyz, cone.y));
    vec2 tilt = (start * cone.spread - along * cone.width) * plane.tilt;
    tilt += (cone.width * plane.facing + cone.spread * plane.height) * aside;
    vec3 place = vec3(tilt, start * plane.facing + along * plane.height);
    vec3 limit = extent * vec3(cone.spread * plane.tilt, plane.facing);
    cut_by(limit - place);
    cut_by(limit + place);
}

void cut_plane(Cone cone, Plane plane) {
    Flat seen = flat_in(cone, plane.normal.xyz, plane.normal.w);
    cut_by(vec3(-cone.width * seen.tilt, seen.height));
    if (BOUNDED_PLANES && plane.link.w != 0u) {
        // Together they leave nothing above the horizon.
        float extent = uintBitsToFloat(plane.link.z);
        cut_bounds(cone, seen, plane.axis_u, extent);
        cut_bounds(cone, seen, plane.axis_v, extent);
    } else {
        cut_by(vec3(cone.spread * seen.tilt, seen.facing));
    }
}

// A point as a place of the disc, homogeneous.
vec3 in_disc(Cone cone, vec3 point) {
    vec3 p = point - cone.ray.origin;
    float t = dot3(cone.ray.direction, p) / dot3(cone.ray.direction, cone.ray.direction);
    return vec3(dot3(cone.x, p), dot3(cone.y, p), cone.width + cone.spread * t);
}

// Two triangles at a shared edge get the same line with opposite sign.
void cut_triangle(Cone cone, Triangle triangle) {
    vec3 a = in_disc(cone, triangle.a.xyz);
    vec3 b = in_disc(cone, triangle.b.xyz);
    vec3 c = in_disc(cone, triangle.c.xyz);
    float height = triangle.normal.w - dot3(triangle.normal.xyz, cone.ray.origin);
    float side = height < 0.0 ? -1.0 : 1.0;
    vec2 tilt = vec2(dot3(triangle.normal.xyz, cone.x), dot3(triangle.normal.xyz, cone.y));
    cut_by(vec3((-side * cone.width) * tilt, side * height));
    cut_by(side * cross3(a, b));
    cut_by(side * cross3(b, c));
    cut_by(side * cross3(c, a));
}

// A sphere as a circle of the disc.
struct Circle {
    vec2 middle;
    float radius;
    float edge; // the radius less the middle's distance; 1 and more covers the disc
};

Circle circle_of(Cone cone, Sphere sphere) {
    vec3 f = cone.ray.origin - sphere.ball.xyz;
    float radius = sphere.ball.w;
    float t = -dot3(f, cone.ray.direction) / dot3(cone.ray.direction, cone.ray.direction);
    // From the inside it is all around, from behind nowhere.
    if (dot3(f, f) <= radius * radius) return Circle(vec2(0.0), 1e6, 1e6);
    if (!(t > 0.0)) return Circle(vec2(0.0), 1.0, -2.0);
    vec3 closest = f + t * cone.ray.direction;
    float reach = cone.width + cone.spread * t;
    float scale = 1.0 / (reach < 0.0 ? min(reach, -1e-20) : max(reach, 1e-20));
    vec2 middle = vec2(dot3(cone.x, closest), dot3(cone.y, closest)) * -scale;
    float apart = sqrt(dot3(closest, closest));
    return Circle(middle, radius * abs(scale), (radius - apart) * abs(scale));
}

// Cuts the disc to what the shape covers; false for a ball that no line stands for: smaller than the cone.
bool cut_shape(Header header, Cone cone, uint shape) {
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    if (planes > 0u && (spheres + triangles == 0u || shape < planes)) {
        cut_plane(cone, plane_at(shape));
    } else if (spheres > 0u && (triangles == 0u || shape < planes + spheres)) {
        Circle circle = circle_of(cone, sphere_at(shape - planes));
        cut_by(circle_line(circle.middle, circle.radius, circle.edge));
        return circle.radius >= 1.0;
    } else if (triangles > 0u) {
        cut_triangle(cone, triangle_at(shape - planes - spheres));
    }
    return true;
}

// What the shape covers.
Covered covered_by(Header header, Cone cone, uint shape) {
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    if (spheres > 0u && shape >= planes && shape < planes + spheres) {
        Circle circle = circle_of(cone, sphere_at(shape - planes));
        return ball_overlap(circle.middle, circle.radius, circle.edge);
    }
    if (planes + triangles == 0u) return NOTHING;
    whole_disc();
    cut_shape(header, cone, shape);
    return cut_disc();
}

// Where a ray within the shape's outline meets it; rounding may have put it just beside.
Hit meet(Header header, Ray ray, uint shape) {
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    Hit hit = Hit(-1.0, shape, vec3(0.0));
    vec4 plane = vec4(0.0);
    if (planes > 0u && (spheres + triangles == 0u || shape < planes)) {
        Plane found = plane_at(shape);
        plane = found.normal;
        plane_distance(found, ray, false, hit.local);
    } else if (spheres > 0u && (triangles == 0u || shape < planes + spheres)) {
        Sphere sphere = sphere_at(shape - planes);
        hit.t = sphere_distance(sphere, ray, false);
        float nearest = dot3(sphere.ball.xyz - ray.origin, ray.direction) / dot3(ray.direction, ray.direction);
        hit.t = hit.t > 0.0 ? hit.t : nearest;
        return hit;
    } else if (triangles > 0u) {
        Triangle found = triangle_at(shape - planes - spheres);
        plane = found.normal;
        triangle_distance(found, ray, false, hit.local);
    }
    float above = plane.w - dot3(plane.xyz, ray.origin);
    hit.t = above / dot3(plane.xyz, ray.direction);
    return hit;
}

// How deep a shape lies over the disc: its own plane, that which touches a ball, and where a ball ends
// its distance alone.
Flat depth_of(Header header, Cone cone, uint shape, float t, float area) {
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    vec4 plane = vec4(0.0);
    bool ends = false;
    if (planes > 0u && (spheres + triangles == 0u || shape < planes)) {
        plane = plane_at(shape).normal;
    } else if (spheres > 0u && (triangles == 0u || shape < planes + spheres)) {
        Sphere sphere = sphere_at(shape - planes);
        vec3 out_of = (cone.ray.origin + t * cone.ray.direction) - sphere.ball.xyz;
        vec3 normal = out_of * inversesqrt(dot3(out_of, out_of));
        float height = dot3(normal, sphere.ball.xyz) + sphere.ball.w;
        plane = vec4(normal, height);
        ends = area < 1.0;
    } else if (triangles > 0u) {
        plane = triangle_at(shape - planes - spheres).normal;
    }
    Flat depth = flat_in(cone, plane.xyz, plane.w);
    if (ends) depth = Flat(t, 1.0, vec2(0.0));
    return depth;
}

// t of a flat at the two ends of the disc between which it changes.
vec2 depths(Cone cone, Flat depth) {
    float tilt = sqrt(dot2(depth.tilt, depth.tilt));
    vec2 high = depth.height - vec2(tilt, -tilt) * cone.width;
    vec2 facing = depth.facing + vec2(tilt, -tilt) * cone.spread;
    float first = facing.x > 0.0 ? max(high.x / facing.x, 0.0) : FAR;
    float second = facing.y > 0.0 ? max(high.y / facing.y, 0.0) : FAR;
    return vec2(min(first, second), max(first, second));
}

// Keeps the piece among the nearest.
void keep(Header header, Cone cone, uint shape, Covered covered, float t_max) {
    float t = meet(header, ray_at(cone, covered.center), shape).t;
    if (!(covered.share > LEAST_SHARE && t > 0.0 && t < t_max)) return;
    vec2 range = depths(cone, depth_of(header, cone, shape, t, covered.share));
    Piece next = Piece(shape, t, range.x, range.y, covered.share, covered.share, covered.center);
#define INSERT(k)                              \
    if (k < PIECES && next.t < pieces[k].t) {  \
        Piece here = pieces[k];                \
        pieces[k] = next;                      \
        next = here;                           \
    }
    EACH_PIECE(INSERT)
#undef INSERT
    clear *= 1.0 - next.area;
    piece_count = min(piece_count + 1u, PIECES);
}

// Whether the cone may touch the shape.
bool touched(Header header, Cone cone, uint shape) {
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    if (spheres > 0u && (planes + triangles == 0u || (shape >= planes && shape < planes + spheres))) {
        Circle circle = circle_of(cone, sphere_at(shape - planes));
        vec2 apart = abs(circle.middle);
        bool reaches = max(apart.x, apart.y) < SQUARE * (1.0 + circle.radius);
        return circle.edge > -1.0 || (circle.radius < 1.0 && reaches);
    }
    whole_disc();
    cut_shape(header, cone, shape);
    return !cut_away;
}

const uint BATCH = 32u;

// All shapes but `skip` that the cone touches before t_max; the nearest ones, in order. Most are missed,
// which is found out first: measuring what is covered takes longer, for all threads while one does it.
void gather(Header header, Cone cone, uint skip, float t_max) {
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    uint shapes = planes + spheres + triangles;
    piece_count = 0u;
    clear = 1.0;
#define CLEAR(k) pieces[k] = Piece(NO_SHAPE, FAR, FAR, FAR, 0.0, 0.0, vec2(0.0));
    EACH_PIECE(CLEAR)
#undef CLEAR
    for (uint first = 0u; first < shapes; first += BATCH) {
        uint found = 0u;
        for (uint i = 0u; i < BATCH && first + i < shapes; i++) {
            if (first + i != skip && touched(header, cone, first + i)) found |= 1u << i;
        }
        while (found != 0u) {
            uint shape = first + uint(findLSB(found));
            found &= found - 1u;
            keep(header, cone, shape, covered_by(header, cone, shape), t_max);
        }
    }
    // Nothing behind the first that covers all is seen, if nothing of it lies before that.
    float far = FAR;
    uint count = 0u;
#define TRIM(k)                                                                \
    if (k < PIECES && k < piece_count) {                                       \
        count = pieces[k].near < far ? k + 1u : count;                         \
        far = pieces[k].area >= 1.0 ? min(far, pieces[k].far) : far;           \
    }
    EACH_PIECE(TRIM)
#undef TRIM
    piece_count = count;
}

// How two pieces lie over each other: where a hides b, or where b hides a.
Covered hidden(Header header, Cone cone, Piece a, Piece b, bool turned, out bool crossing) {
    whole_disc();
    crossing = false;
    bool a_has_lines = true;
    bool b_has_lines = true;
    Flat p = Flat(0.0, 0.0, vec2(0.0));
    Flat q = p;
    // The shapes in turn, by the same code.
    for (uint k = 0u; k < 2u; k++) {
        Piece piece = b;
        if (k == 0u) piece = a;
        bool has_lines = true;
        if (piece.area < 1.0) has_lines = cut_shape(header, cone, piece.shape);
        p = q;
        a_has_lines = b_has_lines;
        q = depth_of(header, cone, piece.shape, piece.t, piece.area);
        b_has_lines = has_lines;
    }
    vec2 tilt = (q.height * cone.spread + cone.width * q.facing) * p.tilt;
    tilt -= (p.height * cone.spread + cone.width * p.facing) * q.tilt;
    vec3 before = vec3(tilt, q.height * p.facing - p.height * q.facing);
    cut_by(turned ? -before : before);
    Covered both = cut_disc();
    if (!a_has_lines || !b_has_lines) {
        // As good as anywhere.
        both = Covered(turned ? 0.0 : a.area * b.area, a_has_lines ? b.center : a.center);
    } else {
        crossing = before.z * before.z < dot2(before.xy, before.xy);
    }
    return both;
}

vec2 within_disc(vec2 center) {
    float outside = dot2(center, center);
    return outside > 1.0 ? center * inversesqrt(outside) : center;
}

// What is seen of each piece, and its centroid; what nothing covers, and that centroid, is the answer. A
// piece that is seen in part hides in proportion. One loop over all pairs: a turn looks at one.
Covered lay_over(Header header, Cone cone) {
    float rest = 1.0 - (piece_count > 0u ? pieces[0].area : 0.0);
    uint i = 1u;
    uint j = 0u;
    bool turned = false;
    float seen = 0.0;
    vec2 moment = vec2(0.0);
    while (PIECES > 1u && i < piece_count) {
        Piece piece = piece_at(i);
        Piece other = piece_at(j);
        if (j == 0u && !turned) {
            seen = piece.area;
            moment = piece.area * piece.center;
        }
        bool crossing = false;
        Covered lost = hidden(header, cone, other, piece, turned, crossing);
        float weight = turned ? piece.seen / piece.area : other.seen / other.area;
        lost.share *= weight;
        if (turned) {
            // The piece behind comes through the one before it.
            float left = max(other.seen - lost.share, 0.0);
            vec2 lost_moment = other.seen * other.center - lost.share * lost.center;
            set_seen(j, left, left > LEAST_SHARE ? lost_moment / left : other.center);
            rest += other.seen - left;
        } else {
            seen -= lost.share;
            moment -= lost.share * lost.center;
        }
        turned = crossing && !turned;
        j += turned ? 0u : 1u;
        if (j == i) {
            seen = min(seen, rest);
            seen = seen > LEAST_SHARE ? seen : 0.0;
            set_seen(i, seen, seen > 0.0 ? within_disc(moment / seen) : piece.center);
            rest -= seen;
            i++;
            j = 0u;
        }
    }
    if (!(rest > LEAST_SHARE)) return NOTHING;
    vec2 rest_moment = vec2(0.0);
#define SUBTRACT(k) if (k < PIECES && k < piece_count) rest_moment -= pieces[k].seen * pieces[k].center;
    EACH_PIECE(SUBTRACT)
#undef SUBTRACT
    return Covered(rest, within_disc(rest_moment / rest));
}

#endif
