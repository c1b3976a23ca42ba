//! The public interface, as another program uses it: a dozen names, scenes from files and from code under the same
//! rules, renders equal to those of the command line, errors with kinds, and the examples.

mod build;
mod names;

use std::path::Path;

use moire::model::{Algorithm, Camera, Material, Model, Pattern, Plane, Sphere, TextureSource};
use moire::{ErrorKind, Film, Progress, RenderOptions, Renderer, Scene};

use crate::stage;
use crate::support::data;

#[allow(dead_code)]
#[path = "../../examples/compare_filters.rs"]
mod compare_filters;
#[allow(dead_code)]
#[path = "../../examples/render_file.rs"]
mod render_file;

/// The device under test.
fn device() -> String {
    std::env::var("MOIRE_DEVICE").unwrap_or_else(|_| "cpu".into())
}

fn scene_file() -> std::path::PathBuf {
    data().join("scenes/bench/s1a.toml")
}

#[test]
fn a_file_renders_to_the_pixels_of_the_command_line() {
    let options = RenderOptions::new().device(device()).size(48, 32).samples(4).pattern(Pattern::Grid);
    let renderer = Renderer::new(options).unwrap();
    let (film, report) =
        renderer.render_with(&Scene::from_file(scene_file()).unwrap(), &Counted::default()).unwrap();
    let mut scene = stage::scene("s1a");
    (scene.width, scene.height, scene.sampling.spp, scene.sampling.pattern) = (48, 32, 4, Pattern::Grid);
    assert_eq!(film.pixels, stage::render(&stage::packed(scene, None)).pixels);
    assert_eq!((report.samples, report.reached, report.estimated_rmse), (4.0, true, None));
    assert_eq!(report.device, renderer.device());
}

#[test]
fn a_goal_is_reached_and_told() {
    let options = RenderOptions::new().device("oracle").size(16, 16).target_error(0.1);
    let scene = Scene::from_file(scene_file()).unwrap();
    let (_, report) = Renderer::new(options).unwrap().render_with(&scene, &Counted::default()).unwrap();
    assert!(report.reached && report.estimated_rmse.unwrap() <= 0.1, "{report:?}");
}

#[test]
fn a_crop_has_the_pixels_of_the_whole() {
    let render = |options: RenderOptions| {
        let renderer = Renderer::new(options.device("oracle").size(16, 12).samples(1)).unwrap();
        renderer.render(&Scene::from_file(scene_file()).unwrap()).unwrap()
    };
    let (whole, part) = (render(RenderOptions::new()), render(RenderOptions::new().crop([3, 2, 5, 4])));
    assert_eq!([part.width, part.height], [5, 4]);
    for y in 0..4 {
        for x in 0..5 {
            assert_eq!(part.pixels[y * 5 + x], whole.pixels[(y + 2) * 16 + x + 3], "{x}, {y}");
        }
    }
}

#[derive(Default)]
struct Counted {
    stop: bool,
}

impl Progress for Counted {
    fn advance(&self, done: f64) {
        assert!((0.0..=1.0).contains(&done));
    }

    fn cancelled(&self) -> bool {
        self.stop
    }
}

#[test]
fn errors_have_kinds() {
    let tiny = || {
        let camera = Camera::looking([0.0, 0.0, 5.0], [0.0; 3], 40.0);
        let mut scene = Scene::builder(camera, 8, 8);
        scene.shape(Sphere::new([0.0; 3], 1.0));
        scene
    };
    let render = |scene: &Scene, options: RenderOptions| {
        let renderer = Renderer::new(options.device("oracle"))?;
        renderer.render_with(scene, &Counted { stop: true }).map(drop)
    };
    let scene = tiny().build().unwrap();
    let missing = || {
        let mut scene = tiny();
        let texture =
            Some(scene.texture(TextureSource::file("t", "no/such.png", moire::model::ColorSpace::Srgb)));
        let material = scene.material(Material { model: Model::Unlit, texture, ..Material::default() });
        scene.shape(Sphere::new([0.0; 3], 1.0).with_material(material));
        scene.build().unwrap()
    };
    let film = Film::new(2, 2, 1);
    for (case, found, kind) in [
        ("a missing scene", Scene::from_file("no/such.toml").map(drop), ErrorKind::File),
        ("a wrong scene", Scene::from_toml("camera = 1").map(drop), ErrorKind::Scene),
        ("a device", Renderer::new(RenderOptions::new().device("voodoo")).map(drop), ErrorKind::NoDevice),
        ("an option", render(&scene, RenderOptions::new().samples(15)), ErrorKind::Options),
        ("a crop", render(&scene, RenderOptions::new().crop([7, 0, 2, 1])), ErrorKind::Options),
        ("a budget", render(&scene, RenderOptions::new().budget(f64::NAN)), ErrorKind::Options),
        ("a texture", render(&missing(), RenderOptions::new()), ErrorKind::File),
        ("a stop", render(&scene, RenderOptions::new()), ErrorKind::Interrupted),
        ("a folder", film.save(Path::new("no/such/folder.png")), ErrorKind::File),
        ("an ending", film.save("picture.doc"), ErrorKind::File),
        ("a picture", Film::open("no/such.png").map(drop), ErrorKind::File),
    ] {
        let error = found.expect_err(case);
        assert_eq!(error.kind(), kind, "{case}: {error}");
        assert!(!error.kind().is_transient(), "{case}");
    }
}

#[test]
fn films_are_written_and_read() {
    let folder = tempfile::tempdir().unwrap();
    let mut film = Film::new(3, 2, 1);
    film.pixels[4] = [0.25, 1.5, 3.0];
    let path = folder.path().join("a.exr");
    film.save(&path).unwrap();
    let read = Film::open(&path).unwrap();
    assert_eq!(read.pixels, film.pixels);
    assert_eq!(read.compare(&film).unwrap().rmse, 0.0);
}

#[test]
fn the_example_renders_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("a.toml");
    std::fs::write(
        &scene,
        "[camera]\neye = [0, 1, 4]\nlook_at = [0, 0, 0]\nvertical_fov = 40\n[image]\nwidth = 12\nheight = 8\n\
         [[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, 1]\n",
    )
    .unwrap();
    let out = folder.path().join("a.png");
    let path = |path: &Path| path.to_str().unwrap().to_owned();
    render_file::render(&path(&scene), &path(&out), Some("oracle")).unwrap();
    let film = Film::open(&out).unwrap();
    assert_eq!([film.width, film.height], [12, 8]);
}

#[test]
fn the_example_finds_the_filter_that_errs_less() {
    let errors = compare_filters::compare(&device(), [48, 32]).unwrap();
    let [(_, linear), (_, ewa)] = errors[..] else { panic!("{errors:?}") };
    assert!(ewa > 0.0 && ewa < linear, "{errors:?}");
}

#[test]
fn what_is_not_set_is_the_scenes_own() {
    let camera = Camera::looking([0.0, 0.0, 5.0], [0.0; 3], 40.0);
    let mut builder = Scene::builder(camera, 8, 8);
    builder.shape(Plane::new([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
    let scene = builder.build().unwrap();
    assert_eq!(scene.size(), [8, 8]);
    let report = |options: RenderOptions| {
        let renderer = Renderer::new(options.device("oracle")).unwrap();
        renderer.render_with(&scene, &Counted::default()).unwrap().1
    };
    assert_eq!(report(RenderOptions::new()).samples, 16.0);
    assert_eq!(report(RenderOptions::new().samples(9)).samples, 9.0);
    assert!(report(RenderOptions::new()).warnings.iter().any(|w| w.contains("no [[light]]")));
    assert!(report(RenderOptions::new().algorithm(Algorithm::Adaptive)).estimated_rmse.is_some());
}
