//! Scenes on the device under test (`MOIRE_DEVICE`, else `cpu`): the list of all scenes of the
//! repository, each loaded, reduced in size, packed and rendered by one line of a test. The device
//! is opened once, with validation, and every test that used it ends by checking the validation
//! messages.

use std::ops::Deref;
use std::path::PathBuf;
use std::sync::OnceLock;

use moire::internal::core::film::Film;
use moire::internal::core::progress::NoProgress;
use moire::internal::core::range::Rect;
use moire::internal::gpu::{DeviceSelect, Gpu, OpenOptions, validation_available};
use moire::internal::oracle;
use moire::internal::pack::{self, PackedScene};
use moire::internal::render::{self, DeviceBackend, Report, Session, Tuning};
use moire::internal::sampling::Backend;
use moire::internal::scene::model::{Pattern, Scene};
use moire::internal::scene::{self, prune::prune};
use moire::internal::schema::layout::{BATCH_APART, PixelBatch};
use moire::internal::texture::load::load;

use crate::support::{data, untested};
use crate::validated::{Using, using};

/// `every_scene! { module: check }` makes one test a scene, `module::NAME`, that calls `check(NAME)`.
macro_rules! every_scene {
    ($module:ident: $check:path) => {
        mod $module {
            $crate::stage::with_scenes! { each_scene $check; }
        }
    };
}
/// Calls a macro with the names of all scenes behind its arguments.
macro_rules! with_scenes {
    ($($call:tt)*) => {
        $crate::stage::dispatch! {
            $($call)* beams centroid cones discs environment environment_cube filters formats glass glossy hardware
            horizon inside lanczos lecture lens lights mappings materials meshes mirrors models motion normal penumbra physical position
            procedural quad ramp reflection rough samplers shared volume zone_plate s1a s1b s2
        }
    };
}
macro_rules! dispatch {
    (each_scene $check:path; $($scene:ident)*) => {
        $(#[test]
        fn $scene() {
            $check(stringify!($scene));
        })*
    };
    (names $($scene:ident)*) => { [$(stringify!($scene)),*] };
}
pub(crate) use {dispatch, every_scene, with_scenes};

#[test]
fn every_scene_file_is_in_the_list_of_scenes() {
    let stems = |folder: &str| {
        let entries = std::fs::read_dir(data().join(folder)).unwrap().map(|e| e.unwrap().path());
        let scenes = entries.filter(|p| p.extension().is_some_and(|e| e == "toml"));
        let mut stems: Vec<String> =
            scenes.map(|p| p.file_stem().unwrap().to_str().unwrap().into()).collect();
        stems.sort();
        stems
    };
    assert_eq!([stems("scenes"), stems("scenes/bench")].concat(), with_scenes! { names });
}

pub fn path(name: &str) -> PathBuf {
    let file = format!("{name}.toml");
    let scene = data().join("scenes").join(&file);
    if scene.is_file() { scene } else { data().join("scenes/bench").join(file) }
}

pub fn scene(name: &str) -> Scene {
    scene::load(&path(name)).unwrap()
}

/// At most `side` pixels along each side, at most `spp` samples (a square).
pub fn small(name: &str, side: u32, spp: u32) -> Scene {
    let mut scene = scene(name);
    let longest = scene.width.max(scene.height).max(side);
    scene.width = (scene.width * side / longest).max(1);
    scene.height = (scene.height * side / longest).max(1);
    scene.sampling.spp = scene.sampling.spp.min(spp);
    scene
}

pub fn packed(mut scene: Scene, crop: Option<Rect>) -> PackedScene {
    prune(&mut scene);
    scene::cone::adapt_for_cone(&mut scene);
    let textures = scene.textures.iter().map(|t| load(t).unwrap()).collect();
    pack::pack(&scene, textures, crop).unwrap()
}

/// The scene with this number of samples at random positions.
pub fn with_random(mut scene: Scene, spp: u32) -> Scene {
    scene.sampling.pattern = Pattern::Random;
    scene.sampling.shared = false;
    scene.sampling.spp = spp;
    scene
}

/// The argument of `--device` that selects the device under test.
pub fn device_name() -> String {
    std::env::var("MOIRE_DEVICE").unwrap_or_else(|_| "cpu".into())
}

/// The device under test. A message of the validation layer fails the test that is running, which with several at a
/// time may be a neighbour of the one that caused it.
pub struct Device(&'static Gpu, Using);

pub fn device() -> Device {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    // Nobody uses it before it is open, and those who open others wait for this turn.
    let turn = using();
    let gpu = GPU.get_or_init(|| {
        let select = DeviceSelect::parse(&device_name()).unwrap();
        let gpu = Gpu::open_with(&select, OpenOptions { validation: true }).unwrap();
        assert_eq!(gpu.validation_active(), validation_available());
        if !gpu.validation_active() {
            untested("what the validation layer would say: it is not installed");
        }
        gpu
    });
    Device(gpu, turn)
}

impl Deref for Device {
    type Target = Gpu;

    fn deref(&self) -> &Gpu {
        self.0
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            let messages = self.0.messages();
            assert!(messages.is_empty(), "validation: {messages:#?}");
        }
    }
}

pub fn render_with(scene: &PackedScene, keep_everything: bool, tuning: &Tuning) -> (Film, Report) {
    render::render(&device(), scene.clone(), keep_everything, tuning, &NoProgress).unwrap()
}

pub fn render(scene: &PackedScene) -> Film {
    render_with(scene, false, &Tuning::default()).0
}

/// Returns batches of both halves of all pixels, of which neighbours have different numbers of samples.
pub fn unequal_batches(scene: &PackedScene) -> Vec<PixelBatch> {
    let [width, height] = scene.header.film_size.to_array();
    let batch = |i: u32| PixelBatch {
        place: PixelBatch::place_of(i / 2, width),
        part: PixelBatch::part_of(i % 2) | BATCH_APART,
        first: i % 3,
        count: [1, 4, 8, 24, 33, 64, 96][i as usize % 7],
    };
    (0..2 * width * height).map(batch).collect()
}

/// Returns the sums of batches on the device.
pub fn sums_apart(scene: &PackedScene, batches: &[PixelBatch], tuning: &Tuning) -> Vec<[f32; 4]> {
    let gpu = device();
    let session = Session::open(&gpu, scene.clone(), false, tuning).unwrap();
    let prepared = session.prepare().unwrap();
    let mut backend = DeviceBackend::new(&prepared).unwrap();
    backend.sample_apart(batches, &NoProgress).unwrap()
}

pub fn render_on_oracle(scene: &PackedScene) -> Film {
    oracle::backend::render(scene, &NoProgress).unwrap()
}

/// Returns the pixels of `crop`, as rendering with that crop would.
pub fn cut(film: &Film, crop: Rect) -> Film {
    let mut part = Film::new(crop.width, crop.height, film.samples);
    for (y, row) in part.pixels.chunks_mut(crop.width as usize).enumerate() {
        let first = (crop.y as usize + y) * film.width as usize + crop.x as usize;
        row.copy_from_slice(&film.pixels[first..first + crop.width as usize]);
    }
    part
}

/// Fails with the first pixel that differs in any bit.
pub fn assert_same_bits(a: &Film, b: &Film, what: &str) {
    assert_eq!((a.width, a.height, a.samples), (b.width, b.height, b.samples), "{what}");
    let bits = |p: &[f32; 3]| p.map(f32::to_bits);
    let differing: Vec<usize> =
        (0..a.pixels.len()).filter(|&i| bits(&a.pixels[i]) != bits(&b.pixels[i])).collect();
    if let Some(&first) = differing.first() {
        let (x, y) = (first % a.width as usize, first / a.width as usize);
        panic!(
            "{what}: {} of {} pixels differ, the first at ({x}, {y}): {:?} and {:?}",
            differing.len(),
            a.pixels.len(),
            a.pixels[first],
            b.pixels[first]
        );
    }
}
