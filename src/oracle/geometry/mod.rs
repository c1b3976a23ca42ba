//! The kinds of shapes, one file each, behind the doors of [`rays`], [`cones`] and [`beams`]: outside this folder a shape
//! is a number.

pub mod beams;
pub mod cones;
pub mod hit;
pub mod kinds;
mod mesh_search;
pub(super) mod mesh_tests;
pub mod rays;

use crate::schema::shapes::with_shapes;

macro_rules! kinds {
    ($($kind:ident $module:ident $list:ident [$($property:ident)*];)+) => {
        $(pub mod $module;)+
    };
}
with_shapes!(kinds);
