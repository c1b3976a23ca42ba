//! The kinds of shapes: record, module, list, and what holds of a kind. `planar`: it lies in a plane, so that a ray
//! never meets again the one that it leaves. `polygonal`: straight lines bound it, so that beams know its outline.
//! `curved`: its shading normal may change. `listed`: tile culling lists it. `concave`: a ray that leaves it outwards may
//! meet it again. Shapes are numbered in this order.

/// Hands the table to another macro, behind arguments of its own in brackets where there are any.
macro_rules! with_shapes {
    ($consumer:ident $(, $($argument:tt)+)?) => {
        $consumer! {
            $(($($argument)+))?
            Plane plane planes [planar polygonal];
            Sphere sphere spheres [curved listed];
            Triangle triangle triangles [planar polygonal curved listed];
            Disc disc discs [planar listed];
            Mesh mesh meshes [curved concave];
        }
    };
}
pub(crate) use with_shapes;
