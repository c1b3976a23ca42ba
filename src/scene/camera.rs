//! `[camera]` as data: position, projection, and motion while the shutter is open.

use glam::DVec3;

/// A camera: its position and projection.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// The position.
    pub eye: DVec3,
    /// The point at the centre of the picture.
    pub look_at: DVec3,
    /// The up vector: any direction except the view direction.
    pub up: DVec3,
    /// The projection, with the angle of view.
    pub projection: Projection,
    /// The lens; `None` is a pinhole.
    pub lens: Option<Lens>,
    /// The times at which the shutter opens and closes, between 0 and 1.
    pub shutter: [f64; 2],
    /// Displacements of `eye` and `look_at` between the times 0 and 1.
    pub motion: [DVec3; 2],
}

/// A thin lens at the eye, perpendicular to the view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// In scene units.
    pub radius: f64,
    /// Along the view direction, to the plane of focus.
    pub focus_distance: f64,
}

/// The projection from directions to the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Vertical field of view in degrees, in (0, 180).
    VerticalFov(f64),
    /// Distance of an image plane of height 1 (the lecture's camera constant).
    CameraConstant(f64),
    /// Parallel rays; the picture's height in scene units.
    Orthographic(f64),
}

impl Camera {
    /// Returns true if it moves while the shutter is open.
    pub fn moves(&self) -> bool {
        self.motion != [DVec3::ZERO; 2]
    }
}
