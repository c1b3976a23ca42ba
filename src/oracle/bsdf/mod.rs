//! The reflection models, one file each, behind the door of [`models`] and, for rays that go on, of [`specular`].

pub mod dielectric;
pub mod facets;
pub mod lambert;
pub mod mirror;
pub mod models;
pub mod phong;
pub mod specular;
pub mod unlit;
