//! Builds a scene in code, a floor of squares to the horizon, and compares two texture filters with a picture of many
//! samples: `cargo run --release --example compare_filters -- [DEVICE]`. Prints the RMSE of each.

use std::process::ExitCode;

use moire::model::{
    Camera, Filter, Footprint, Material, MipMode, Model, Plane, SamplerSpec, Sampling, TextureSource,
};
use moire::{Film, RenderOptions, Renderer, Result, Scene};

fn main() -> ExitCode {
    let device = std::env::args().nth(1).unwrap_or_else(|| "cpu".into());
    match compare(&device, [96, 64]) {
        Ok(errors) => {
            errors.iter().for_each(|(filter, rmse)| println!("{filter:<12} RMSE {rmse:.4}"));
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}

/// Returns each filter and its RMSE at one sample a pixel.
pub fn compare(device: &str, size: [u32; 2]) -> Result<Vec<(Filter, f64)>> {
    // The reference needs no filter: it has enough samples for the smallest texel.
    let reference = render(device, size, None)?;
    let errors = [Filter::Linear, Filter::Ewa].map(|filter| -> Result<(Filter, f64)> {
        let film = render(device, size, Some(filter))?;
        Ok((filter, film.compare(&reference)?.rmse))
    });
    errors.into_iter().collect()
}

fn render(device: &str, [width, height]: [u32; 2], filter: Option<Filter>) -> Result<Film> {
    let camera = Camera::looking([0.0, 1.0, 0.0], [0.0, 0.6, -2.0], 50.0);
    let mut scene = Scene::builder(camera, width, height);
    let squares = scene.texture(TextureSource::rgba_float("squares", [8, 8], &squares()));
    let sampler = scene.sampler(SamplerSpec {
        min: filter.unwrap_or(Filter::Linear),
        mip: if filter.is_some() { MipMode::Linear } else { MipMode::None },
        ..SamplerSpec::default()
    });
    let floor = scene.material(Material {
        name: "floor".into(),
        model: Model::Unlit,
        texture: Some(squares),
        sampler,
        ..Material::default()
    });
    scene.shape(Plane::new([0.0; 3], [2.0, 0.0, 0.0], [0.0, 0.0, -2.0]).with_material(floor));
    scene.sampling(Sampling {
        spp: if filter.is_some() { 1 } else { 256 },
        footprint: if filter.is_some() { Footprint::Differentials } else { Footprint::None },
        ..Sampling::default()
    });
    Renderer::new(RenderOptions::new().device(device))?.render(&scene.build()?)
}

/// 8 × 8 texels, black and white by turns.
fn squares() -> Vec<[f32; 4]> {
    let white = |i: usize| (i % 8 + i / 8) % 2 == 0;
    (0..64).map(|i| if white(i) { [1.0; 4] } else { [0.0, 0.0, 0.0, 1.0] }).collect()
}
