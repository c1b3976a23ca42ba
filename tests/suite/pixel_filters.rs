//! Pixel filters: samples are distributed by the stated kernel, renders reproduce that kernel on
//! the device and in the oracle, with and without unused features, and invalid filters are refused.

mod agree;
mod convolution;
mod errors;
mod kernels;
mod weights;

use std::path::Path;

use moire::internal::pack::{self, PackedScene, kernel};
use moire::internal::scene::model::{Pattern, PixelFilter, PixelFilterKind, Scene};
use moire::internal::scene::parse;

/// All filters except the box of one pixel.
fn filters() -> Vec<PixelFilter> {
    let own = PixelFilterKind::ALL.iter().filter(|k| **k != PixelFilterKind::Box);
    let mut all: Vec<PixelFilter> = own.map(|&kind| PixelFilter::new(kind, None)).collect();
    all.push(PixelFilter::new(PixelFilterKind::Box, Some(0.8)));
    all.push(PixelFilter::new(PixelFilterKind::Mitchell, Some(1.3)));
    all
}

fn with(mut scene: Scene, filter: PixelFilter) -> Scene {
    scene.pixel_filter = filter;
    scene
}

/// Pixels of one scene unit, (0, 0) the middle of the picture, black but for white squares.
fn squares(size: [u32; 2], filter: PixelFilter, spp: u32, squares: &[([f64; 2], [f64; 2])]) -> PackedScene {
    let plane = |([x, y], [a, b]): &([f64; 2], [f64; 2])| {
        format!(
            "[[plane]]\norigin = [{x:?}, {y:?}, 0]\ntangent = [{a:?}, 0, 0]\nbitangent = [0, {b:?}, 0]\nhalf_extent = 1\nmaterial = 'm'\n"
        )
    };
    let planes: String = squares.iter().map(plane).collect();
    let text = format!(
        "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\northographic_height = {}
[image]\nwidth = {}\nheight = {}\n[[material]]\nname = 'm'\nmodel = 'unlit'\n{planes}",
        size[1], size[0], size[1]
    );
    let mut scene = with(parse(Path::new("squares.toml"), &text).unwrap(), filter);
    scene.sampling.pattern = Pattern::SobolOwen;
    scene.sampling.spp = spp;
    pack::pack(&scene, Vec::new(), None).unwrap()
}

/// ∫ of the normalised kernel from a to b pixels off the middle, by midpoints.
fn integral(filter: PixelFilter, a: f64, b: f64) -> f64 {
    const STEPS: u32 = 20_000;
    let f = |x: f64| kernel(filter.kind, x);
    let sum = |from: f64, to: f64| -> f64 {
        let step = (to - from) / f64::from(STEPS);
        (0..STEPS).map(|i| f(from + (f64::from(i) + 0.5) * step)).sum::<f64>() * step
    };
    let inside = |x: f64| (x / filter.radius).clamp(-1.0, 1.0);
    sum(inside(a), inside(b)) / sum(-1.0, 1.0)
}
