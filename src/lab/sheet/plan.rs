//! What a sheet is to show: axes, cells with their scenes, the reference and the part that is seen. Input: what the
//! command line says. Output: the same as data, with what follows of it: sizes, primaries, the renders of a cell.

use std::collections::BTreeMap;

use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::range::Rect;
use crate::integrators::adaptive::Goal;
use crate::output::{DisplayTransform, Gamut};
use crate::scene::model::Scene;

/// Columns, rows and blocks.
pub const MAX_AXES: usize = 3;
pub const MAX_CELLS: usize = 64;
/// The width in pixels up to which a part is enlarged, unless a factor is given.
const ENLARGED_WIDTH: u32 = 288;
const MAX_FACTOR: u32 = 64;

/// A setting that varies.
#[derive(Clone, Debug)]
pub struct Axis {
    pub name: String,
    /// The values as a person calls them.
    pub labels: Vec<String>,
}

#[derive(Clone, Debug)]
pub struct Cell {
    /// The index into the values of each axis.
    pub at: Vec<usize>,
    /// The varied settings, by their names.
    pub settings: BTreeMap<String, String>,
    /// The command that renders the picture alone.
    pub command: String,
    /// The cell whose film is shown: the first of those that differ only in how they are shown.
    pub film_of: usize,
    /// How the film is shown.
    pub display: DisplayTransform,
    /// What is rendered, or why it cannot be.
    pub job: Result<Job, String>,
}

#[derive(Clone, Debug)]
pub struct Job {
    /// What is rendered, without what the picture does not need.
    pub scene: Scene,
    /// The same view by samples without a prefilter.
    pub reference: Scene,
    /// The end of sampling, if it is no number of samples.
    pub goal: Option<Goal>,
}

/// What errors are measured against.
#[derive(Clone, Debug)]
pub enum ReferenceChoice {
    /// By so many samples of each half, or as many as it takes to judge the cells.
    Rendered {
        samples: Option<u32>,
    },
    File {
        name: String,
        film: Film,
    },
    None,
}

/// How pictures are shown.
#[derive(Clone, Copy, Debug, Default)]
pub struct View {
    /// The part that is shown of each picture.
    pub zoom: Option<Rect>,
    /// How many pixels of the sheet each side of a pixel of the part takes.
    pub factor: Option<u32>,
    /// The most pixels of a picture in a row; wider ones are averaged over squares.
    pub width: Option<u32>,
    /// True if the difference from the reference is shown, too.
    pub difference: bool,
    /// The columns of a sheet with one axis.
    pub columns: Option<u32>,
}

#[derive(Clone, Debug)]
pub struct Plan {
    /// The scene's name, and the settings that do not vary.
    pub title: String,
    pub scene: String,
    pub axes: Vec<Axis>,
    /// All combinations, the first axis fastest.
    pub cells: Vec<Cell>,
    pub reference: ReferenceChoice,
    pub repeats: u32,
    pub view: View,
    /// How everything is shown, but for what varies.
    pub display: DisplayTransform,
}

impl Plan {
    pub fn jobs(&self) -> impl Iterator<Item = &Job> {
        self.cells.iter().filter_map(|cell| cell.job.as_ref().ok())
    }

    /// Returns the cells with a film of their own.
    pub fn with_films(&self) -> impl Iterator<Item = (usize, &Job)> {
        let own = self.cells.iter().enumerate().filter(|(i, cell)| cell.film_of == *i);
        own.filter_map(|(i, cell)| Some((i, cell.job.as_ref().ok()?)))
    }

    /// Returns the cells that show the film of one.
    pub fn showing(&self, index: usize) -> impl Iterator<Item = usize> {
        let own = self.cells.iter().enumerate().filter(move |(_, cell)| cell.film_of == index);
        own.map(|(i, _)| i)
    }

    /// Returns how often each cell is rendered: once if it ends at a time or an error.
    pub fn renders(&self) -> u32 {
        if self.jobs().any(|job| job.goal.is_some()) { 1 } else { self.repeats }
    }

    /// Returns true if films are shown otherwise than they are.
    pub fn is_developed(&self) -> bool {
        self.displays().any(|display| *display != DisplayTransform::default())
    }

    /// Returns the primaries of the sheet: those in which all of its pictures can be shown.
    pub fn gamut(&self) -> Gamut {
        self.displays().map(|display| display.gamut).max().unwrap_or(Gamut::Srgb)
    }

    fn displays(&self) -> impl Iterator<Item = &DisplayTransform> {
        self.cells.iter().map(|cell| &cell.display).chain([&self.display])
    }
}

impl View {
    /// Returns the part that is shown of a picture.
    pub fn part(&self, size: [u32; 2]) -> Rect {
        self.zoom.unwrap_or(Rect::whole(size))
    }

    /// Returns by how much pixels are enlarged.
    pub fn enlarged(&self) -> u32 {
        match (self.factor, self.zoom) {
            (Some(factor), _) => factor,
            (None, Some(zoom)) => {
                (self.width.unwrap_or(ENLARGED_WIDTH) / zoom.width.max(1)).clamp(1, MAX_FACTOR)
            }
            (None, None) => 1,
        }
    }

    /// Returns over how many pixels along each side are averaged.
    pub fn reduced(&self, size: [u32; 2]) -> u32 {
        let part = self.part(size);
        self.width.map_or(1, |most| (part.width * self.enlarged()).div_ceil(most)).max(1)
    }

    /// Returns the pixels of the sheet that a picture takes.
    pub fn shown(&self, size: [u32; 2]) -> [u32; 2] {
        let (part, factor, step) = (self.part(size), self.enlarged(), self.reduced(size));
        let side = |pixels: u32| {
            let all = if step > 1 { pixels / step } else { pixels.saturating_mul(factor) };
            all.max(1)
        };
        [side(part.width), side(part.height)]
    }
}
