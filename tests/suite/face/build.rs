//! Scenes built in code: the same scene as from a file, and the same rules, each reported with its item and key.

use moire::model::*;
use moire::{RenderOptions, Renderer, Scene, SceneBuilder};

fn builder() -> SceneBuilder {
    Scene::builder(Camera::looking([0.0, 1.0, 5.0], [0.0, 1.0, 0.0], 60.0), 64, 48)
}

fn plane() -> Plane {
    Plane::new([0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
}

fn refused(change: impl FnOnce(&mut SceneBuilder)) -> String {
    let mut scene = builder();
    change(&mut scene);
    scene.build().map(drop).expect_err("it breaks a rule").to_string()
}

type Change = fn(&mut SceneBuilder);

#[test]
fn every_kind_of_rule_stands_for_scenes_in_code() {
    let cases: &[(&str, Change, &[&str])] = &[
        (
            "camera",
            |s| *s = Scene::builder(Camera::looking([0.0; 3], [0.0; 3], 60.0), 64, 48),
            &["camera 0: look_at", "where the eye is"],
        ),
        (
            "fov",
            |s| *s = Scene::builder(Camera::looking([0.0; 3], [1.0, 0.0, 0.0], 180.0), 8, 8),
            &["vertical_fov", "found 180"],
        ),
        (
            "size",
            |s| *s = Scene::builder(Camera::looking([0.0; 3], [1.0, 0.0, 0.0], 60.0), 0, 8),
            &["image 0: width", "1 to 16384, found 0"],
        ),
        (
            "lens",
            |s| {
                let mut c = Camera::looking([0.0; 3], [1.0, 0.0, 0.0], 60.0);
                c.lens = Some(Lens { radius: -1.0, focus_distance: 1.0 });
                *s = Scene::builder(c, 8, 8)
            },
            &["lens_radius", "not negative", "found -1"],
        ),
        (
            "nan",
            |s| {
                s.shape(Sphere::new([0.0, f64::NAN, 0.0], 1.0));
            },
            &["sphere 0: center[1]", "3 finite numbers, found NaN"],
        ),
        (
            "infinite",
            |s| {
                s.shape(Sphere::new([0.0; 3], f64::INFINITY));
            },
            &["sphere 0: radius", "a finite number"],
        ),
        (
            "parallel",
            |s| {
                s.shape(plane()).shape(Plane { bitangent: [2.0, 0.0, 0.0].into(), ..plane() });
            },
            &["plane 1: bitangent", "parallel"],
        ),
        (
            "zero normal",
            |s| {
                let t = Triangle::new([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
                s.shape(Triangle { normals: Some([[0.0; 3].into(); 3]), ..t });
            },
            &["triangle 0: normals[0]", "not zero"],
        ),
        (
            "light",
            |s| {
                s.light(Light::Sun {
                    direction: [0.0, 1.0, 0.0].into(),
                    angle: 200.0,
                    irradiance: [1.0; 3].into(),
                });
            },
            &["light 0: angle", "0 to 180"],
        ),
        (
            "samples",
            |s| {
                s.sampling(Sampling { spp: 15, ..Sampling::default() });
            },
            &["sampling 0: spp", "no square; use 9 or 16"],
        ),
        (
            "material",
            |s| {
                s.shape(plane().with_material(3));
            },
            &["plane 0: material", "no material 3"],
        ),
        (
            "texture",
            |s| {
                s.material(Material { texture: Some(7), ..Material::default() });
            },
            &["material 0: texture", "no texture 7"],
        ),
        (
            "roughness",
            |s| {
                s.material(Material { model: Model::Mirror, roughness: 1.5, ..Material::default() });
            },
            &["material 0: roughness", "0 to 1, found 1.5"],
        ),
        (
            "sampler",
            |s| {
                s.sampler(SamplerSpec { mag: Filter::Ewa, ..SamplerSpec::default() });
            },
            &["sampler 0: filter.mag", "cannot magnify"],
        ),
        (
            "border",
            |s| {
                s.sampler(SamplerSpec { border_color: [0.0, 0.0, -1.0, 0.0], ..SamplerSpec::default() });
            },
            &["border_color[2]", "not negative"],
        ),
        (
            "gain",
            |s| {
                let mut p = Procedural::new(ProceduralKind::Fbm);
                p.gain = 0.001;
                s.texture(TextureSource {
                    content: TextureContent::Procedural(p),
                    ..TextureSource::rgba8("p", [1, 1], vec![0; 4], ColorSpace::Srgb)
                });
            },
            &["texture 0: gain", "0.01 to 1"],
        ),
        (
            "texels",
            |s| {
                s.texture(TextureSource::rgba8("t", [2, 2], vec![0; 15], ColorSpace::Srgb));
            },
            &["texture 0: texels", "16 bytes; 15 were given"],
        ),
        (
            "dimension",
            |s| {
                s.texture(TextureSource {
                    dimension: Dimension::Cube,
                    ..TextureSource::rgba8("t", [1, 1], vec![0; 4], ColorSpace::Srgb)
                });
            },
            &["texture 0: dimension", "contradicts texels"],
        ),
        (
            "bounds",
            |s| {
                let m = s.material(Material {
                    mapping: Mapping {
                        kind: MappingKind::Planar,
                        space: Space::Bounds,
                        ..Mapping::default()
                    },
                    ..Material::default()
                });
                s.shape(plane().with_material(m));
            },
            &["plane 0: half_extent", "infinite plane has no bounds"],
        ),
        (
            "scale",
            |s| {
                s.material(Material {
                    mapping: Mapping { scale: [1.0, 0.0].into(), ..Mapping::default() },
                    ..Material::default()
                });
            },
            &["material 0: mapping.scale[1]", "other than 0"],
        ),
        (
            "environment",
            |s| {
                let t = s.texture(TextureSource::rgba8("t", [1, 1], vec![0; 4], ColorSpace::Srgb));
                s.background(Background {
                    color: [1.0; 3].into(),
                    environment: Some(Environment {
                        texture: t,
                        sampler: DEFAULT,
                        layout: EnvironmentLayout::Cube,
                        rotate: 0.0,
                        idle_address: None,
                        mirror: false,
                    }),
                });
            },
            &["background 0: layout", "needs layout \"equirectangular\""],
        ),
    ];
    for (rule, change, fragments) in cases {
        let message = refused(change);
        for fragment in *fragments {
            assert!(message.contains(fragment), "{rule}: {fragment:?} is not in: {message}");
        }
    }
}

#[test]
fn limits_of_single_precision_are_met_exactly() {
    let mut scene = builder();
    let mut pattern = Procedural::new(ProceduralKind::Fbm);
    (pattern.gain, pattern.aspect) = (0.01, 0.01);
    let source = TextureSource::rgba8("p", [1, 1], vec![0; 4], ColorSpace::Srgb);
    scene.texture(TextureSource { content: TextureContent::Procedural(pattern), ..source });
    scene.sampler(SamplerSpec { border_color: [1e30; 4], ..SamplerSpec::default() });
    scene.build().unwrap();
}

#[test]
fn too_many_shapes_are_refused_at_the_first_one_over() {
    let message = refused(|scene| {
        for _ in 0..65535 {
            scene.shape(Sphere::new([0.0; 3], 1.0));
        }
        scene.shape(plane());
    });
    assert!(message.starts_with("plane 0: 65536 shapes"), "{message}");
}

#[test]
fn what_has_no_extent_is_simplified_and_told() {
    let mut scene = builder();
    scene.shape(Triangle::new([[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]));
    scene.shape(Sphere::new([0.0; 3], 1.0));
    let scene = scene.build().unwrap();
    let options = RenderOptions::new().device("oracle").samples(1).size(4, 4);
    let (_, report) = Renderer::new(options)
        .unwrap()
        .render_with(&scene, &moire::internal::core::progress::NoProgress)
        .unwrap();
    assert!(report.warnings.iter().any(|w| w.contains("a triangle (number 0) has no area")), "{report:?}");
}

/// The same scene from a file and from code, down to the last pixel.
#[test]
fn code_and_file_make_one_scene() {
    let text = "[camera]\neye = [0, 1, 5]\nlook_at = [0, 1, 0]\nvertical_fov = 60\n[image]\nwidth = 64\nheight = 48\n\
        [[texture]]\nname = 'r'\nramp = [[1, 0, 0], [0, 1, 0]]\n\
        [[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 'r'\n\
        [[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, 1]\nmaterial = 'm'\n\
        [[sphere]]\ncenter = [0, 1, 0]\nradius = 0.5\n[[light]]\nkind = 'directional'\ndirection = [0, 1, 1]\nirradiance = [3, 3, 3]\n";
    let mut built = builder();
    let colors = vec![[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]];
    let source = TextureSource::rgba8("r", [1, 1], vec![0; 4], ColorSpace::Linear);
    let ramp = TextureSource { content: TextureContent::Ramp(colors), dimension: Dimension::One, ..source };
    let texture = Some(built.texture(ramp));
    let material = Material { name: "m".into(), model: Model::Unlit, texture, ..Material::default() };
    let material = built.material(material);
    built.shape(plane().with_material(material)).shape(Sphere::new([0.0, 1.0, 0.0], 0.5));
    built.light(Light::Directional { direction: [0.0, 1.0, 1.0].into(), irradiance: [3.0; 3].into() });
    let renderer = Renderer::new(RenderOptions::new().device("oracle").samples(4)).unwrap();
    let render = |scene: &Scene| renderer.render(scene).unwrap();
    let film = render(&Scene::from_toml(text).unwrap());
    assert!(film.pixels.iter().any(|p| p[0] > 0.5) && film.pixels.iter().any(|p| p[1] > 0.5));
    assert_eq!(render(&built.build().unwrap()), film);
}
