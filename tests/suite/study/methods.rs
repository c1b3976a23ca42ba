//! Names of methods, their effect on a scene, the methods of a scene, and the counts that are
//! measured.

use moire::internal::lab::study::method::Method;
use moire::internal::lab::study::plan::{Forecast, next_count, points};
use moire::internal::scene::check_spp;
use moire::internal::scene::model::{Algorithm, Footprint, Pattern, Scene};
use moire::internal::texture::sampler_spec::{Filter, MipMode};

use crate::stage;

fn every_method() -> Vec<Method> {
    let mut methods = Vec::new();
    for &pattern in Pattern::ALL {
        let plain = Method::of_pattern(pattern);
        methods.push(plain.clone());
        for &footprint in Footprint::ALL.iter().filter(|f| **f != Footprint::None) {
            methods.push(Method { footprint, ..plain.clone() });
            methods.extend(Filter::ALL.iter().map(|&f| Method {
                footprint,
                filter: Some(f),
                ..plain.clone()
            }));
        }
    }
    methods
}

#[test]
fn every_name_is_read_back_as_the_method_it_was_written_from() {
    for method in every_method() {
        assert_eq!(Method::parse(&method.name()), Ok(method));
    }
    for &algorithm in Algorithm::ALL {
        assert_eq!(Method::parse(algorithm.name()).unwrap().algorithm, algorithm);
    }
}

#[test]
fn methods_have_the_names_of_the_field_and_none_has_two() {
    let said = |name: &str| Method::parse(name).unwrap().label(Pattern::Stratified);
    assert_eq!(said("stratified+cone+linear"), "trilinear, cone footprint");
    assert_eq!(said("random+cone+ewa"), "EWA, cone footprint, random");
    assert_eq!(said("stratified+differentials"), "ray differentials");
    assert_eq!(["center", "sobol-owen", "cone"].map(said), ["pixel centres", "Sobol-Owen", "cones"]);
    assert_eq!(["adaptive+sobol-owen", "adaptive+halton"].map(said), ["adaptive", "adaptive, Halton"]);
    let mut all: Vec<String> = every_method().iter().map(|m| m.label(Pattern::Stratified)).collect();
    let count = all.len();
    all.sort_unstable();
    all.dedup();
    assert_eq!(all.len(), count);
}

#[test]
fn words_in_wrong_places_are_errors_that_list_the_names() {
    for wrong in [
        "",
        "jitter",
        "stratified+ewa",
        "ewa",
        "stratified+cone+cone",
        "stratified++cone",
        "stratified+cone+ewa+linear",
    ] {
        let why = Method::parse(wrong).unwrap_err();
        for names in [Pattern::NAMES, Footprint::NAMES, Filter::NAMES, Algorithm::NAMES] {
            names.iter().for_each(|name| assert!(why.contains(name), "{wrong}: {name} is not in: {why}"));
        }
    }
}

fn scene(name: &str) -> Scene {
    let mut scene = stage::scene(name);
    moire::internal::scene::prune::prune(&mut scene);
    scene
}

#[test]
fn default_set_has_every_pattern_and_filters_where_there_are_textures() {
    let (methods, notes) = Method::all_for(&scene("s1a"));
    for &pattern in Pattern::ALL {
        assert!(methods.contains(&Method::of_pattern(pattern)), "{pattern} is missing");
    }
    for filter in ["linear", "anisotropic", "ewa"] {
        for pattern in ["stratified", "center"] {
            let name = format!("{pattern}+cone+{filter}");
            assert!(methods.iter().any(|m| m.name() == name), "{name} is missing");
        }
    }
    assert!(notes.is_empty(), "{notes:?}");
    let bare = Scene { textures: Vec::new(), ..scene("s1a") };
    assert!(Method::all_for(&bare).0.iter().all(|m| m.footprint == Footprint::None));
}

#[test]
fn what_is_the_same_picture_is_one_method_by_the_name_of_its_filter() {
    let mut own = scene("s1a");
    own.sampling.footprint = Footprint::Cone;
    for sampler in &mut own.samplers {
        (sampler.mag, sampler.min) = Filter::Anisotropic.both();
        sampler.mip = MipMode::Linear;
    }
    let names =
        |scene: &Scene| -> Vec<String> { Method::all_for(scene).0.iter().map(Method::name).collect() };
    let found = names(&own);
    for pattern in ["stratified", "center"] {
        assert!(found.contains(&format!("{pattern}+cone+anisotropic")), "{found:?}");
        assert!(!found.contains(&format!("{pattern}+cone")), "twice in {found:?}");
    }
    // A filter of the scene's that no other method has is measured as it is.
    own.samplers.iter_mut().for_each(|sampler| sampler.mip = MipMode::Nearest);
    let found = names(&own);
    assert!(
        found.contains(&"stratified+cone".to_owned()) && found.contains(&"center+cone".to_owned()),
        "{found:?}"
    );
    // The scene's pattern is the centre: nothing is there twice.
    own.sampling.pattern = Pattern::Center;
    let mut found = names(&own);
    let count = found.len();
    found.sort_unstable();
    found.dedup();
    assert_eq!(found.len(), count, "{found:?}");
}

#[test]
fn a_filter_without_a_pattern_is_answered_with_a_method_that_has_it() {
    for (wrong, meant) in
        [("trilinear", "linear"), ("ewa", "ewa"), ("linear", "linear"), ("stratified+ewa", "ewa")]
    {
        let why = Method::parse(wrong).unwrap_err();
        assert!(why.contains(&format!("did you mean stratified+cone+{meant}?")), "{wrong}: {why}");
        assert!(Method::parse(&format!("stratified+cone+{meant}")).is_ok());
    }
}

#[test]
fn what_a_scene_cannot_take_is_left_out_and_said() {
    let mut coarse = scene("s1a");
    coarse.samplers[0].mag = Filter::Nearest;
    let (methods, notes) = Method::all_for(&coarse);
    assert!(methods.iter().all(|m| m.filter.is_none()) && notes[0].contains("magnified"), "{notes:?}");
    let (methods, notes) = Method::all_for(&scene("volume"));
    assert!(!methods.iter().any(|m| m.filter == Some(Filter::Ewa)), "volumes have no EWA filter");
    assert!(notes.iter().any(|n| n.contains("ewa") && n.contains("2d")), "{notes:?}");
}

#[test]
fn method_sets_what_its_name_says_and_nothing_else() {
    let base = scene("s1a");
    let applied = Method::parse("random+cone+ewa").unwrap().apply(&base, 7).unwrap();
    assert_eq!((applied.sampling.pattern, applied.sampling.spp), (Pattern::Random, 7));
    assert_eq!(applied.sampling.footprint, Footprint::Cone);
    let sampler = applied.samplers[0];
    assert_eq!((sampler.mag, sampler.min, sampler.mip), (Filter::Linear, Filter::Ewa, MipMode::Linear));
    let plain = Method::parse("stratified").unwrap().apply(&base, 64).unwrap();
    assert_eq!((plain.sampling, &plain.samplers), (base.sampling, &base.samplers));
}

#[test]
fn scene_that_shares_its_displacements_shares_them_with_jittered_strata_only() {
    let base = scene("shared");
    assert!(base.sampling.shared);
    for &pattern in Pattern::ALL {
        let method = Method::of_pattern(pattern);
        let spp = next_count(pattern, 4).unwrap();
        let shared = method.apply(&base, spp).unwrap().sampling.shared;
        assert_eq!(shared, pattern == Pattern::Stratified, "{pattern}");
        assert_eq!(method.arguments(&base, spp).contains(&"--shared".to_owned()), !shared, "{pattern}");
    }
}

#[test]
fn counts_are_rounded_up_to_what_a_pattern_takes_and_measured_once() {
    let scene = scene("s1a");
    for &pattern in Pattern::ALL {
        for asked in [1, 2, 5, 10, 1000] {
            let next = next_count(pattern, asked).unwrap();
            assert!(next >= asked && check_spp(pattern, next).is_ok(), "{pattern}, {asked}: {next}");
            assert!(
                (asked..next).all(|n| check_spp(pattern, n).is_err()),
                "{pattern} takes less than {next}"
            );
        }
    }
    let methods = ["center", "random", "stratified"].map(|name| Method::parse(name).unwrap());
    let plan: Vec<(usize, u32)> =
        points(&methods, &scene, &[4, 1, 3]).unwrap().iter().map(|p| (p.method, p.spp)).collect();
    assert_eq!(plan, [(0, 1), (1, 1), (2, 1), (1, 3), (2, 4), (1, 4)]);
}

#[test]
fn forecast_follows_the_nearest_measured_point() {
    let scene = scene("s1a");
    let methods = [Method::of_pattern(Pattern::Random), Method::of_pattern(Pattern::Stratified)];
    let plan = points(&methods, &scene, &[1, 4, 16]).unwrap();
    let mut forecast = Forecast::default();
    forecast.learn(&plan[0], 0.5);
    forecast.learn(&plan[2], 1.0);
    assert_eq!(forecast.seconds(&plan[2]), 1.0);
    assert_eq!(forecast.seconds(&plan[4]), 4.0, "16 samples after 1 s for 4");
    assert_eq!(forecast.seconds(&plan[5]), 8.0, "as the slowest of the other methods");
}
