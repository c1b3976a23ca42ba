//! What is refused of a plan before a device starts. Input: the plan. Output: nothing, or an error: no cell that can be
//! rendered, a part or a reference that does not fit, more pixels than a sheet takes.

use super::plan::{Plan, ReferenceChoice};
use super::views::views;
use crate::core::error::{Error, Result};
use crate::core::range::Rect;

/// The most pixels of all pictures of a sheet, in millions: 12 bytes each, twice while they are put together.
const MAX_MEGAPIXELS: u64 = 40;

/// Refuses a plan of which nothing can be shown.
pub fn check(plan: &Plan) -> Result<()> {
    if plan.jobs().next().is_none() {
        let why = plan.cells.iter().find_map(|cell| cell.job.as_ref().err());
        return Err(Error::with_help(
            format!("no cell of this sheet can be rendered: {}", why.map_or("", String::as_str)),
            "vary another setting, or give the scene the settings that all cells need",
        ));
    }
    for job in plan.jobs() {
        let size = [job.scene.width, job.scene.height];
        if let Some(zoom) = plan.view.zoom {
            zoom.check_within(size).map_err(|_| outside(zoom, size))?;
        }
        if let ReferenceChoice::File { name, film } = &plan.reference
            && [film.width, film.height] != size
        {
            return Err(Error::with_help(
                format!(
                    "reference {name}: {}×{} pixels, and the sheet renders {}×{}",
                    film.width, film.height, size[0], size[1]
                ),
                "name a reference of the same size, or set the pictures' with --size",
            ));
        }
    }
    check_pixels(plan)
}

fn check_pixels(plan: &Plan) -> Result<()> {
    let each = if plan.view.difference { 2 } else { 1 };
    let shown = |size: [u32; 2]| {
        let [width, height] = plan.view.shown(size).map(u64::from);
        width * height
    };
    let sizes = || plan.jobs().map(|job| [job.scene.width, job.scene.height]);
    let largest = sizes().map(shown).max().unwrap_or(0);
    let cells = sizes().map(|size| each * shown(size)).sum::<u64>();
    let beside = match plan.reference {
        ReferenceChoice::None => 0,
        _ => largest,
    };
    // Finding the views takes longer.
    let at_most = cells + beside * sizes().count() as u64;
    if at_most <= MAX_MEGAPIXELS * 1_000_000 {
        return Ok(());
    }
    let pixels = cells + beside * views(plan).len() as u64;
    if pixels <= MAX_MEGAPIXELS * 1_000_000 {
        return Ok(());
    }
    Err(Error::with_help(
        format!(
            "the pictures of this sheet have {} million pixels, of which it takes {MAX_MEGAPIXELS} million",
            pixels.div_ceil(1_000_000)
        ),
        "show a part with --zoom, narrower pictures with --cell, smaller ones with --size, or no references with \
         --reference none",
    ))
}

fn outside(zoom: Rect, [width, height]: [u32; 2]) -> Error {
    Error::with_help(
        format!(
            "--zoom {},{},{},{} reaches outside the picture of {width}×{height} pixels",
            zoom.x, zoom.y, zoom.width, zoom.height
        ),
        "name a part of the picture: the pixel of its top left corner, its width and its height",
    )
}
