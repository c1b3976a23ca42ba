//! `[camera]` as data: where it is, what it projects through, and how it moves while the shutter is open.

use glam::DVec3;

/// Where the picture is seen from, and through what.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// Where it is.
    pub eye: DVec3,
    /// What is in the middle of the picture.
    pub look_at: DVec3,
    /// What is upwards in it: any direction that is not that of the view.
    pub up: DVec3,
    /// Its angle of view.
    pub projection: Projection,
    /// None: a pinhole.
    pub lens: Option<Lens>,
    /// When the shutter opens and closes, between 0 and 1.
    pub shutter: [f64; 2],
    /// How far eye and look_at move between the times 0 and 1.
    pub motion: [DVec3; 2],
}

/// A thin lens around the eye, across the view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// In scene units.
    pub radius: f64,
    /// Along the view, to the plane in focus.
    pub focus_distance: f64,
}

/// How directions become places on the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Full vertical opening angle in degrees, in (0, 180).
    VerticalFov(f64),
    /// Distance of an image plane of height 1 (the lecture's camera constant).
    CameraConstant(f64),
    /// Parallel rays; the picture's height in scene units.
    Orthographic(f64),
}

impl Camera {
    /// Returns whether it moves while the shutter is open.
    pub fn moves(&self) -> bool {
        self.motion != [DVec3::ZERO; 2]
    }
}
