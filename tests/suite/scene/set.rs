//! Values given beside a scene's file: how keys are found, what values mean, and what is answered where they are wrong.

use std::fs;
use std::path::Path;

use moire::internal::core::error::Error;
use moire::internal::scene::model::*;
use moire::internal::scene::{Reading, Setting, load_as};
use moire::internal::texture::sampler_spec::{Address, Filter};
use tempfile::tempdir;

use super::HEAD;

const REST: &str = r#"
[[texture]]
name = "grass"
file = "grass.png"

[[sampler]]
name = "tiled"

[[sampler]]
name = "0"
filter = "nearest"

[[material]]
name = "a.b=c"
texture = "grass"
sampler = "tiled"

[[material]]
name = "red"
color = [1, 0, 0]

[[sphere]]
center = [0, 1, 0]
radius = 1.0
material = "red"

[[light]]
kind = "point"
position = [0, 3, 0]
intensity = [1, 1, 1]
"#;

fn load_with(settings: &[&str]) -> Result<Scene, Error> {
    let folder = tempdir().unwrap();
    let path = folder.path().join("s.toml");
    fs::write(&path, format!("{HEAD}{REST}")).unwrap();
    let settings: Vec<Setting> =
        settings.iter().map(|text| Setting::parse(text)).collect::<Result<_, _>>()?;
    load_as(&path, &Reading { settings: &settings, ..Reading::default() })
}

fn set(settings: &[&str]) -> Scene {
    load_with(settings).unwrap()
}

fn refused(settings: &[&str]) -> String {
    load_with(settings).unwrap_err().to_string()
}

#[test]
fn a_value_replaces_that_of_the_file_and_a_missing_key_is_added() {
    let scene = set(&[
        "sampling.spp=64",
        "camera.eye=[0, 1, 4]",
        "sampler.tiled.address=clamp-to-edge",
        "material.\"a.b=c\".mapping.rotate=30",
        "background.color=[0.5, 0.25, 1]",
        "light.0.intensity=[2, 2, 2]",
    ]);
    assert_eq!((scene.sampling.spp, scene.camera.eye.z), (64, 4.0));
    assert_eq!(scene.samplers[0].address, [Address::ClampToEdge; 2]);
    assert_eq!((scene.materials[0].mapping.rotate, scene.background.color.y), (30.0, 0.25));
    assert!(matches!(scene.lights[0], Light::Point { intensity, .. } if intensity.x == 2.0));
    assert_eq!(scene.settings.len(), 6);
}

#[test]
fn items_are_found_by_name_before_number_and_a_star_is_all() {
    let filters = |setting| set(&[setting]).samplers.iter().map(|s| s.mag).collect::<Vec<_>>();
    assert_eq!(filters("sampler.0.filter=cubic"), [Filter::Linear, Filter::Cubic]);
    assert_eq!(filters("sampler.1.filter=cubic"), [Filter::Linear, Filter::Cubic]);
    assert_eq!(filters("sampler.tiled.filter=cubic"), [Filter::Cubic, Filter::Nearest]);
    assert_eq!(filters("sampler.*.filter=cubic"), [Filter::Cubic, Filter::Cubic]);
}

#[test]
fn one_half_of_a_filter_is_set_and_the_other_one_stays() {
    let filters =
        |settings: &[&str]| set(settings).samplers.iter().map(|s| [s.mag, s.min]).collect::<Vec<_>>();
    let [nearest, linear, ewa] = [Filter::Nearest, Filter::Linear, Filter::Ewa];
    assert_eq!(filters(&["sampler.*.filter.min=ewa"]), [[linear, ewa], [nearest, ewa]]);
    assert_eq!(filters(&["sampler.0.filter.mag=cubic"]), [[linear, linear], [Filter::Cubic, nearest]]);
    let both = ["sampler.tiled.filter=ewa", "sampler.tiled.filter.mag=nearest"];
    assert_eq!(filters(&both)[0], [nearest, ewa]);
    assert_eq!(filters(&["sampler.0.filter=ewa", "sampler.0.filter.min=linear"])[1], [linear, linear]);
    let wrong = refused(&["sampler.0.filter.mag=ewa"]);
    assert!(wrong.contains("cannot magnify"), "{wrong}");
    let wrong = refused(&["sampler.0.filter=eva", "sampler.0.filter.mag=linear"]);
    assert!(wrong.contains("has no keys"), "{wrong}");
}

#[test]
fn later_settings_see_what_earlier_ones_did() {
    let scene =
        set(&["sampler.tiled.name=t", "material.0.sampler=t", "sampler.t.filter=ewa", "sampling.spp=4"]);
    assert_eq!(scene.samplers[0].min, Filter::Ewa);
    assert_eq!(set(&["sampling.spp=4", "sampling.spp=9"]).sampling.spp, 9);
}

#[test]
fn elements_of_lists_have_numbers_and_whole_sections_can_be_given() {
    let scene = set(&["camera.eye.0=.5", "light=[{ kind = \"environment\" }]"]);
    assert_eq!((scene.camera.eye.x, scene.lights.len()), (0.5, 1));
    assert!(matches!(scene.lights[0], Light::Environment));
}

#[test]
fn a_key_takes_the_place_of_those_that_exclude_it() {
    let scene = set(&["camera.orthographic_height=2", "image.size=[8, 4]"]);
    assert!(matches!(scene.camera.projection, Projection::Orthographic(2.0)));
    assert_eq!([scene.width, scene.height], [8, 4]);
    let two = refused(&["camera.orthographic_height=2", "camera.vertical_fov=2"]);
    assert!(two.starts_with("--set camera.orthographic_height=2: ") && two.contains("given too"), "{two}");
}

#[test]
fn paths_of_settings_are_relative_to_the_current_folder() {
    let file = |scene: &Scene| scene.textures[0].content.files()[0].to_owned();
    assert_eq!(file(&set(&["texture.grass.file=a/b.png"])), Path::new("a/b.png"));
    assert!(file(&set(&[])).is_absolute());
}

#[test]
fn words_need_no_quotes_and_dates_are_words() {
    let file = |setting| set(&[setting]).textures[0].content.files()[0].to_owned();
    for (setting, path) in [
        ("texture.0.file=my photo.png", "my photo.png"),
        ("texture.0.file=2024-05-01", "2024-05-01"),
        ("texture.0.file='a\\b'", "a\\b"),
        ("texture.0.file=\"a\\tb\"", "a\tb"),
        ("texture.0.file=größe.png", "größe.png"),
    ] {
        assert_eq!(file(setting), Path::new(path), "{setting}");
    }
}

#[test]
fn mistakes_are_answered_as_in_a_file_at_the_setting() {
    for (setting, said) in [
        ("sampler.tiled.adress=repeat", "unknown key \"adress\" in [[sampler]]; did you mean \"address\"?"),
        ("sampler.tiled.address=clamp", "did you mean \"clamp-to-edge\"?"),
        (
            "sampler.tild.filter=ewa",
            "sampler has no item \"tild\"; did you mean \"tiled\"? known: \"tiled\", \"0\"",
        ),
        ("samplr.tiled.filter=ewa", "unknown key \"samplr\" at the top level; did you mean \"sampler\"?"),
        ("light.1.intensity=[1,1,1]", "light has no item \"1\"; known: 0, or * for all"),
        ("light.intensity=[1,1,1]", "say which before the key, as in light.0.intensity"),
        ("disc.0.radius=1", "the scene has no [[disc]]"),
        ("sampling.spp.x=1", "sampling.spp has no keys"),
        ("sampling.spp=5", "spp = 5 is no square"),
        ("sphere.0.radius=-1", "expected a number"),
        ("camera.eye=[0, 1", "TOML syntax: unclosed array"),
        ("camera.eye=1 2", "expected 3 finite numbers, found the string 1 2"),
        ("camera.eye.1=1e99", "found 1e99"),
        ("material.red.texture=gras", "did you mean \"grass\"?"),
        ("material.red.name=a.b=c", "is taken by the [[material]] of line"),
        ("camera.eye=\"a\nb\"", "TOML syntax"),
        ("sampler.tiled.filter=e\nwa", "unknown value"),
    ] {
        let found = if setting.starts_with("sampling.spp.x") {
            refused(&["sampling.spp=4", setting])
        } else {
            refused(&[setting])
        };
        let place = format!("--set {}: ", setting.replace('\n', "\\n"));
        assert!(found.starts_with(&place) && found.contains(said), "{setting}: {found}");
        assert!(!found.contains('\n'), "{found:?}");
    }
}

#[test]
fn of_a_model_the_view_can_be_set_and_its_surfaces_cannot() {
    let with = |text: &str| {
        let settings = [Setting::parse(text).unwrap()];
        load_as(Path::new("data/models/gem.stl"), &Reading { settings: &settings, ..Reading::default() })
    };
    let plain = load_as(Path::new("data/models/gem.stl"), &Reading::default()).unwrap();
    let scene = with("camera.vertical_fov=20").unwrap();
    assert!(matches!(scene.camera.projection, Projection::VerticalFov(20.0)));
    assert_eq!((scene.camera.eye, scene.lights.len()), (plain.camera.eye, plain.lights.len()));
    assert_eq!(with("image.size=[30, 20]").unwrap().width, 30);
    for (setting, said) in [
        ("camera.vertical_fov=300", "--set camera.vertical_fov=300: key \"camera.vertical_fov\": expected"),
        ("material.0.color=[1,1,1]", "is a model, whose surfaces are its own"),
        ("sphere.0.radius=1", "is a model, whose surfaces are its own"),
        ("light.7.kind=spot", "light has no item \"7\""),
    ] {
        let found = with(setting).unwrap_err().to_string();
        assert!(found.contains(said), "{found}");
    }
}
