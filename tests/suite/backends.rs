//! Several backends render one picture: the distribution of its parts is invisible, and depends on nothing but their
//! positions. Tested with two sessions on the device under test, and with the device beside the oracle.

use moire::internal::core::error::{Error, Result};
use moire::internal::core::film::Film;
use moire::internal::core::progress::{NoProgress, Progress};
use moire::internal::core::range::{Range, Rect};
use moire::internal::gpu::DeviceSelect;
use moire::internal::lab::metrics::compare;
use moire::internal::render::{
    DeviceBackend, EstimateChoice, On, Options, Picture, Session, Tuning, render_scene,
};
use moire::internal::sampling::{Backend, FilmSums, HalfSums, PilotRun, Scheduler};
use moire::internal::scene::cone::adapt_for_cone;
use moire::internal::scene::model::{Algorithm, Pattern, PixelFilter, PixelFilterKind, Scene};
use moire::internal::scene::prune::prune;
use moire::internal::schema::layout::{PixelBatch, TILE};

use crate::stage::{assert_same_bits, cut, device, device_name, packed, small};

fn on_device() -> On {
    On::Device(DeviceSelect::parse(&device_name()).unwrap())
}

/// Renders as `moire render` does, but for sampling to a goal: of a picture that several devices share the host keeps the
/// pixels, and so it does here for a single one.
fn rendered(mut scene: Scene, on: &[On]) -> Picture {
    prune(&mut scene);
    adapt_for_cone(&mut scene);
    let tuning = Tuning { estimates: EstimateChoice::Host, ..Tuning::default() };
    let options = Options { tuning, ..Options::default() };
    let picture = render_scene(&scene, &options, on, &NoProgress).unwrap();
    assert!(picture.messages.is_empty(), "validation: {:?}", picture.messages);
    picture
}

/// Scenes of several strips of rows, one for each algorithm.
fn variants() -> Vec<(&'static str, Scene)> {
    let of = |name: &str, algorithm, spp| {
        let mut scene = small(name, 150, 4);
        (scene.width, scene.height) = (70, 150);
        (scene.sampling.algorithm, scene.sampling.spp) = (algorithm, spp);
        if let Algorithm::Adaptive = algorithm {
            (scene.sampling.pattern, scene.sampling.shared) = (Pattern::SobolOwen, false);
        }
        scene
    };
    let mut filtered = of("s1a", Algorithm::Samples, 4);
    filtered.pixel_filter = PixelFilter { kind: PixelFilterKind::Mitchell, radius: 2.0 };
    vec![
        ("samples", of("lecture", Algorithm::Samples, 4)),
        ("samples in several blocks", of("s1a", Algorithm::Samples, 400)),
        ("signed samples", filtered),
        ("beams", of("s2", Algorithm::Beam, 4)),
        ("cones", of("cones", Algorithm::Cone, 4)),
        ("adaptive", of("s2", Algorithm::Adaptive, 16)),
    ]
}

#[test]
fn two_devices_of_one_kind_render_the_picture_of_one() {
    for (what, scene) in variants() {
        let one = rendered(scene.clone(), &[on_device()]);
        let two = rendered(scene, &[on_device(), on_device()]);
        assert_same_bits(&two.film, &one.film, what);
        assert_eq!(two.device, format!("{0} + {0}", one.device));
        assert_eq!(two.report.sampled_pixels, one.report.sampled_pixels, "{what}");
        let reached = |p: &Picture| p.report.outcome.map(|o| (o.passes, o.mean_samples, o.estimated_rmse));
        assert_eq!(reached(&two), reached(&one), "{what}");
        assert!(two.report.slices > one.report.slices || what == "adaptive", "{what}: one has done it all");
    }
}

/// The strip of tile rows that begins at row `y`.
fn strip(film: &Film, y: u32) -> Film {
    cut(film, Rect { x: 0, y, width: film.width, height: TILE.min(film.height - y) })
}

#[test]
fn beside_the_oracle_each_strip_is_the_one_that_its_backend_alone_would_render() {
    for (what, scene) in variants().into_iter().filter(|(what, _)| !["adaptive", "beams"].contains(what)) {
        let alone = [on_device(), On::Oracle].map(|on| rendered(scene.clone(), &[on]).film);
        let both = rendered(scene, &[on_device(), On::Oracle]).film;
        for (y, owner) in (0..both.height).step_by(TILE as usize).zip([0, 1, 0]) {
            assert_same_bits(&strip(&both, y), &strip(&alone[owner], y), &format!("{what}, row {y}"));
        }
        // The two differ in some bits, otherwise the strips would show nothing.
        assert_ne!(strip(&alone[0], TILE).pixels, strip(&alone[1], TILE).pixels, "{what}");
    }
}

/// Counts follow the estimates of both, which are rounded differently.
#[test]
fn beside_the_oracle_adaptive_pictures_and_beams_are_those_of_the_device_but_for_rounding() {
    for (what, scene) in variants().into_iter().filter(|(what, _)| ["adaptive", "beams"].contains(what)) {
        let device = rendered(scene.clone(), &[on_device()]);
        let both = rendered(scene, &[on_device(), On::Oracle]);
        let apart = compare(&both.film, &device.film).unwrap().rmse;
        let noise = device.report.outcome.map_or(2e-3, |o| o.estimated_rmse);
        assert!(apart < 0.5 * noise, "{what}: {apart:e} of {noise:e}");
    }
}

#[test]
fn ranges_of_samples_on_a_device_add_up_to_the_whole_in_whatever_order_they_arrive() {
    let mut scene = small("s1a", 40, 4);
    (scene.sampling.pattern, scene.sampling.spp) = (Pattern::SobolOwen, 700);
    let scene = packed(scene, None);
    let gpu = device();
    let session = Session::open(&gpu, scene.clone(), false, &Tuning::default()).unwrap();
    let prepared = session.prepare().unwrap();
    let mut backend = DeviceBackend::new(&prepared).unwrap();
    let [width, height] = scene.header.film_size.to_array();
    let whole = Range { pixels: Rect::whole([width, height]), samples: 0..700 };
    let parts: Vec<FilmSums> =
        whole.by_samples(256).map(|range| backend.sum(&range, &NoProgress).unwrap()).collect();
    let film_of = |parts: &mut dyn Iterator<Item = &FilmSums>| {
        let mut sums = FilmSums::default();
        parts.for_each(|part| sums.merge(part.clone()).unwrap());
        sums.to_film([width, height], 700).unwrap()
    };
    let film = film_of(&mut parts.iter());
    assert_same_bits(&film_of(&mut parts.iter().rev()), &film, "backwards");
    let at_once = backend.sum(&whole, &NoProgress).unwrap().to_film([width, height], 700).unwrap();
    let apart = compare(&film, &at_once).unwrap();
    assert!(apart.max < 1e-6, "{:e}", apart.max);
    // A sample beyond the number of samples has no position in its pattern.
    let beyond = Range { samples: 0..701, ..whole };
    assert!(backend.sum(&beyond, &NoProgress).is_err());
}

#[test]
fn a_session_refuses_a_second_render_while_one_is_not_finished() {
    let gpu = device();
    let session = Session::open(&gpu, packed(small("s2", 8, 1), None), false, &Tuning::default()).unwrap();
    let prepared = session.prepare().unwrap();
    let first = DeviceBackend::new(&prepared).unwrap();
    let refused = DeviceBackend::new(&prepared).err().unwrap().to_string();
    assert!(refused.contains("one is not finished"), "{refused}");
    first.finish().unwrap();
    prepared.render(&NoProgress).unwrap();
}

/// Fails, or waits to be cancelled.
struct Unable {
    fails: bool,
}

impl Backend for Unable {
    fn name(&self) -> String {
        "unable".into()
    }

    fn prefilters(&self) -> bool {
        false
    }

    fn sum(&mut self, _: &Range, progress: &dyn Progress) -> Result<FilmSums> {
        if self.fails {
            return Err(Error::new("out of order"));
        }
        while !progress.cancelled() {
            std::thread::yield_now();
        }
        Err(Error::Interrupted)
    }

    fn resolve(&mut self, _: Rect, _: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        Ok(Vec::new())
    }

    fn pilot(&mut self, _: &dyn Progress) -> Result<Option<PilotRun>> {
        Ok(None)
    }

    fn sample(&mut self, _: &[PixelBatch], _: &dyn Progress) -> Result<()> {
        Ok(())
    }

    fn sample_apart(&mut self, _: &[PixelBatch], _: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        Ok(Vec::new())
    }

    fn read(&mut self, _: &mut HalfSums) -> Result<()> {
        Ok(())
    }
}

#[test]
fn where_one_backend_fails_the_others_stop_and_its_error_is_told() {
    let range = Range { pixels: Rect::whole([64, 256]), samples: 0..1 };
    for order in [[false, true], [true, false]] {
        let [mut a, mut b] = order.map(|fails| Unable { fails });
        let mut both = Scheduler::new(vec![&mut a, &mut b]).unwrap();
        assert_eq!(both.sum(&range, &NoProgress).unwrap_err().to_string(), "out of order");
    }
    assert!(Scheduler::new(Vec::new()).is_err());
}
