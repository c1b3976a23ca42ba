//! The kinds of shapes, and what each one answers. Outside this folder nobody knows them: a shape is a number, and those
//! of one kind follow each other. Twin of `glsl/shared/geometry/kinds.glsl`.

use glam::{DVec2, DVec3, DVec4};

use super::hit::{Hit, Surface, at_rest};
use crate::oracle::camera::Ray;
use crate::oracle::cone::Cone;
use crate::oracle::coverage::{Covered, Cuts};
use crate::oracle::polygon::{AffineFunction, Polygon};
use crate::oracle::projective::{ConvexRegion, PixelFrustum, RationalMap};
use crate::pack::PackedScene;
use crate::schema::layout::{Header, Light, UvProjection};
use crate::schema::shapes::with_shapes;

/// What a ray looks for on a shape of many parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Search {
    /// The nearest part that is seen from where the ray comes.
    Nearest,
    /// The nearest part, from whichever side: of a shadow ray that surfaces may let pass.
    NearestOfBothSides,
    /// Some part, from whichever side: of a shadow ray.
    Any,
}

/// A ray and what it looks for.
pub struct Query<'a> {
    pub scene: &'a PackedScene,
    pub ray: &'a Ray,
    /// A flat shape of this number is not met.
    pub skip: u32,
    pub search: Search,
}

impl Query<'_> {
    /// Distance and own coordinates of where a shape is met before `most`; none on a miss.
    fn meets(&self, record: &impl Shape, shape: u32, most: f64) -> Option<(f64, DVec2)> {
        let (t, local) =
            record.distance_to(self.scene, &at_rest(self.scene, self.ray, shape), most, self.search);
        let is_left = shape == self.skip && record.plane_of().is_some();
        (t > 0.0 && t < most && !is_left).then_some((t, local))
    }
}

/// A shape, as rays and cones use it.
pub trait Shape {
    /// Material and map.
    fn links(&self) -> [u32; 2];

    /// Distance and own coordinates of where the ray meets it; not above 0 on a miss. A shape of many parts may leave
    /// out what is not before `most`.
    fn distance_to(&self, scene: &PackedScene, ray: &Ray, most: f64, search: Search) -> (f64, DVec2);

    /// Replaces the hit by the nearest one on these shapes, the first of which has this number, if that is nearer; of hits
    /// at the same t the lowest shape.
    fn nearest(shapes: &[Self], first: u32, query: &Query, hit: &mut Hit)
    where
        Self: Sized,
    {
        for (shape, record) in (first..).zip(shapes) {
            if let Some((t, local)) = query.meets(record, shape, hit.t) {
                *hit = Hit { t, shape, local };
            }
        }
    }

    /// True when one of these shapes lies before `t_max`.
    fn occlude(shapes: &[Self], first: u32, query: &Query, t_max: f64) -> bool
    where
        Self: Sized,
    {
        (first..).zip(shapes).any(|(shape, record)| query.meets(record, shape, t_max).is_some())
    }

    fn surface_of(&self, scene: &PackedScene, point: DVec3, local: DVec2) -> Surface;

    /// Cuts the disc to what it covers; false for one that no lines stand for.
    fn cut_by_shape(&self, cuts: &mut Cuts, cone: &Cone) -> bool;

    /// A hit of a ray within the outline; rounding may have put it just beside.
    fn complete(&self, scene: &PackedScene, ray: &Ray, hit: &mut Hit);

    /// The plane that touches it at t.
    fn tangent_plane(&self, cone: &Cone, t: f64) -> DVec4;

    /// False where no ray of the polygon can meet it.
    fn may_meet(&self, header: &Header, frame: &PixelFrustum, polygon: &Polygon) -> bool;

    /// Unit normal, and height over the eye, where it lies in a plane: a ray never meets again the one that it leaves.
    fn plane_of(&self) -> Option<DVec4>;

    /// A ray that leaves it outwards may meet it again.
    fn is_concave(&self) -> bool {
        false
    }

    /// Returns its family, by its outline.
    fn form(&self) -> Form<'_>;
}

/// The two families of shapes.
pub enum Form<'a> {
    Polygonal(&'a dyn Polygonal),
    Round(&'a dyn Round),
}

/// A shape in a plane within straight lines: beams know its outline.
pub trait Polygonal {
    fn has_smooth_normals(&self) -> bool;

    /// Adds the lines around it.
    fn add_outline(&self, frame: &PixelFrustum, near: AffineFunction, region: &mut ConvexRegion);

    /// Texture coordinates by a map of its own coordinates.
    fn own_coordinates(&self, frame: &PixelFrustum, near: AffineFunction, map: &UvProjection) -> RationalMap;

    /// Adds the lines around it on another surface of this inverse depth, seen from the light. `rise`: of the light
    /// before the plane, or of a way's length towards it.
    fn add_shadow(
        &self,
        surface: (&PixelFrustum, AffineFunction),
        light: &Light,
        rise: f64,
        region: &mut ConvexRegion,
    );
}

/// Any other shape.
pub trait Round {
    fn covered_by(&self, scene: &PackedScene, cone: &Cone) -> Covered;

    /// False where no way from the polygon on a surface of this inverse depth to the light can pass it.
    fn may_shade(&self, surface: (&PixelFrustum, AffineFunction), polygon: &Polygon, light: &Light) -> bool;
}

/// For the list of each kind: `$body` with the number of its first shape.
macro_rules! each_list {
    (
        ($scene:expr, |$first:ident, $records:ident| $body:expr)
        $($kind:ident $module:ident $list:ident [$($property:ident)*];)+
    ) => {{
        let mut first = 0;
        $({
            let ($first, $records) = (first, &$scene.records.$list);
            first += $records.len() as u32;
            $body
        })+
        let _ = first;
    }};
}
pub(super) use each_list;

pub fn shape_of(scene: &PackedScene, shape: u32) -> &dyn Shape {
    with_shapes!(each_list, scene, |first, list| {
        if let Some(record) = list.get((shape - first) as usize) {
            return record;
        }
    });
    unreachable!("a hit names a shape of its scene");
}

pub fn shape_count(scene: &PackedScene) -> u32 {
    let mut count = 0;
    with_shapes!(each_list, scene, |_first, list| count += list.len() as u32);
    count
}
