//! Invalid textures, samplers, materials and mappings.

use std::path::Path;

use moire::internal::scene::parse;

use super::HEAD;
use super::errors::{PATH, check_behind_head};

#[test]
fn texture_sampler_and_material_rules() {
    let two =
        |kind: &str, extra: &str| format!("[[{kind}]]\nname = 'a'\n{extra}\n[[{kind}]]\nname = 'a'\n{extra}");
    let (textures, samplers, materials) =
        (two("texture", "file = 'f'"), two("sampler", ""), two("material", ""));
    check_behind_head(&[
        ("texture name", "[[texture]]\nfile = 'x'", &[":9:1:", "texture.name", "missing"]),
        ("texture file", "[[texture]]\nname = 'x'", &["texture.file", "missing"]),
        ("empty file", "[[texture]]\nname = 'x'\nfile = ''", &["texture.file", "not empty"]),
        (
            "texture key",
            "[[texture]]\nname = 'x'\nfacs = []",
            &["unknown key \"facs\"", "did you mean \"faces\"", "name, file, faces"],
        ),
        (
            "colour space",
            "[[texture]]\nname = 'x'\nfile = 'y'\ncolor_space = 'sRGB'",
            &["did you mean \"srgb\""],
        ),
        (
            "flip_v",
            "[[texture]]\nname = 'x'\nfile = 'y'\nflip_v = 1",
            &["texture.flip_v", "true or false, found 1"],
        ),
        (
            "orientation",
            "[[texture]]\nname = 'x'\nfile = 'y'\norientation = 'ignored'",
            &["texture.orientation", "did you mean \"ignore\"", "apply, ignore"],
        ),
        (
            "orientation of a ramp",
            "[[texture]]\nname = 'x'\nramp = [[0, 0, 0]]\norientation = 'apply'",
            &["texture.orientation", "these texels come from none"],
        ),
        ("texture twice", &textures, &[":13:8:", "texture.name", "\"a\"", "line 10"]),
        ("sampler twice", &samplers, &["sampler.name", "\"a\"", "line 10"]),
        ("material twice", &materials, &["material.name", "\"a\"", "line 10"]),
        (
            "address",
            "[[sampler]]\nname = 's'\naddress = 'clamp_to_edge'",
            &["did you mean \"clamp-to-edge\""],
        ),
        (
            "address part",
            "[[sampler]]\nname = 's'\naddress = 'border'",
            &["did you mean \"clamp-to-border\""],
        ),
        (
            "four axes",
            "[[sampler]]\nname = 's'\naddress = ['repeat', 'repeat', 'repeat', 'repeat']",
            &["sampler.address", "2 for u and v, or 3 for u, v and w"],
        ),
        (
            "second axis",
            "[[sampler]]\nname = 's'\naddress = ['repeat', 'wrap']",
            &["sampler.address[1]", "\"wrap\""],
        ),
        (
            "filter",
            "[[sampler]]\nname = 's'\nfilter = 'bicubic'",
            &["sampler.filter", "nearest, linear, cubic, stochastic, anisotropic, ewa"],
        ),
        (
            "filter key",
            "[[sampler]]\nname = 's'\nfilter = { mga = 'linear' }",
            &["sampler.filter", "did you mean \"mag\""],
        ),
        (
            "filter mag",
            "[[sampler]]\nname = 's'\nfilter = { mag = 'ewa' }",
            &["sampler.filter.mag", "\"ewa\"", "cannot magnify"],
        ),
        (
            "filter of no device",
            "[[sampler]]\nname = 's'\nfilter = 'ewa'\nmethod = 'hardware'",
            &["sampler.method", "\"ewa\"", "method \"shader\""],
        ),
        ("anisotropy", "[[sampler]]\nname = 's'\nmax_anisotropy = 0", &["sampler.max_anisotropy", "1 to 64"]),
        ("cubic", "[[sampler]]\nname = 's'\ncubic = 'mitchel'", &["sampler.cubic", "\"mitchell\""]),
        (
            "border of 3",
            "[[sampler]]\nname = 's'\nborder_color = [0, 0, 0]",
            &["sampler.border_color", "4 finite"],
        ),
        (
            "border negative",
            "[[sampler]]\nname = 's'\nborder_color = [0, 0, 0, -1]",
            &["border_color", "negative"],
        ),
        ("mip", "[[sampler]]\nname = 's'\nmip = 'liner'", &["sampler.mip", "did you mean \"linear\""]),
        ("method", "[[sampler]]\nname = 's'\nmethod = 'gpu'", &["sampler.method", "shader, hardware"]),
        ("centre", "[[sampler]]\nname = 's'\ntexel_center = 0.5", &["sampler.texel_center", "half, integer"]),
        (
            "model",
            "[[material]]\nname = 'm'\nmodel = 'lambret'",
            &["did you mean \"lambert\"", "unlit, lambert, mirror"],
        ),
        (
            "key of another model",
            "[[material]]\nname = 'm'\nmodel = 'mirror'\nior = 1.5",
            &["material.ior", "only models \"dielectric\" and \"metallic-roughness\" have ior", "\"mirror\""],
        ),
        ("green of nothing", "[[material]]\nname = 'm'\ngreen = 'down'", &["material.green", "normal_map"]),
        (
            "green of heights",
            "[[texture]]\nname = 't'\nfile = 'f'\n[[material]]\nname = 'm'\nbump_map = 't'\ngreen = 'down'",
            &["material.green", "heights"],
        ),
        (
            "green where",
            "[[texture]]\nname = 't'\nfile = 'f'\n[[material]]\nname = 'm'\nnormal_map = 't'\ngreen = 'dwn'",
            &["material.green", "did you mean \"down\"", "up, down"],
        ),
        ("strength of nothing", "[[material]]\nname = 'm'\nstrength = 2", &["material.strength", "bump_map"]),
        (
            "two reliefs",
            "[[texture]]\nname = 't'\nfile = 'f'\n[[material]]\nname = 'm'\nnormal_map = 't'\nbump_map = 't'",
            &["material.bump_map", "normal_map is given too"],
        ),
        (
            "relief of a cube",
            "[[texture]]\nname = 't'\nfile = 'f'\ndimension = 'cube'\n[[material]]\nname = 'm'\nbump_map = 't'",
            &["material.bump_map", "such a map is a 2d texture; this one is cube"],
        ),
        (
            "relief of a pattern",
            "[[texture]]\nname = 't'\nprocedural = 'noise'\n[[material]]\nname = 'm'\nnormal_map = 't'",
            &["material.normal_map", "read from texels"],
        ),
        (
            "colour key",
            "[[material]]\nname = 'm'\ncolour = [1, 1, 1]",
            &[
                ":11:1: unknown key \"colour\" in [[material]]; did you mean \"color\"? allowed: name, model, color",
            ],
        ),
        (
            "colour negative",
            "[[material]]\nname = 'm'\ncolor = [1, 1, -1]",
            &["material.color", "not negative"],
        ),
        (
            "no textures",
            "[[material]]\nname = 'm'\ntexture = 'g'",
            &["material.texture", "has no [[texture]]"],
        ),
        (
            "near texture",
            "[[texture]]\nname = 'ground'\nfile = 'f'\n[[material]]\nname = 'm'\ntexture = 'gruond'",
            &[":14:11:", "material.texture", "\"gruond\"; did you mean \"ground\"?", "known: \"ground\""],
        ),
        (
            "far sampler",
            "[[sampler]]\nname = 'a'\n[[sampler]]\nname = 'b'\n[[material]]\nname = 'm'\nsampler = 'xyz'",
            &["material.sampler", "\"xyz\"; known: \"a\", \"b\""],
        ),
        (
            "shape's material",
            "[[material]]\nname = 'm'\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'n'",
            &["sphere.material", "known: \"m\""],
        ),
        ("[material]", "[material]\nname = 'm'", &["[[material]]", "found the table [material]"]),
        ("array of numbers", "[sampling]\n[[light]]\nkind = 3", &["light.kind", "found 3"]),
    ]);
}

#[test]
fn mapping_rules() {
    let frame = "uses the shape's own coordinates";
    let cases: [(&str, &str, &[&str]); 20] = [
        ("origin on a surface", "{ origin = [0, 0, 0] }", &["material.mapping.origin", frame, "planar"]),
        ("axis on a surface", "{ kind = 'surface', axis = [0, 1, 0] }", &["material.mapping.axis", frame]),
        ("space on a surface", "{ space = 'world' }", &["material.mapping.space", frame]),
        ("entity on a surface", "{ entity = 'position' }", &["material.mapping.entity", frame]),
        (
            "kind",
            "{ kind = 'box' }",
            &[
                "\"box\"; did you mean \"cube\"? allowed: surface, planar, cylindrical, spherical, cube, solid",
            ],
        ),
        ("kind near", "{ kind = 'spheric' }", &["material.mapping.kind", "did you mean \"spherical\""]),
        (
            "entity",
            "{ kind = 'planar', entity = 'tangent' }",
            &["mapping.entity", "normal, centroid, reflection"],
        ),
        (
            "origin of a direction",
            "{ kind = 'planar', entity = 'normal', origin = [0, 0, 0] }",
            &["mapping.origin", "\"normal\" is a direction"],
        ),
        (
            "box of a direction",
            "{ kind = 'cube', entity = 'reflection', space = 'bounds' }",
            &["mapping.space", "\"reflection\" is a direction"],
        ),
        ("space", "{ kind = 'planar', space = 'object' }", &["mapping.space", "allowed: world, bounds"]),
        (
            "axis zero",
            "{ kind = 'planar', axis = [0, 0, 0.0] }",
            &["mapping.axis", "not zero", "[0, 0, 0.0]"],
        ),
        ("scale zero", "{ scale = 0 }", &["material.mapping.scale", "other than 0"]),
        ("scale zero on v", "{ scale = [1, 0] }", &[":11:25:", "mapping.scale", "other than 0"]),
        ("scale of 3", "{ scale = [1, 1, 1] }", &["mapping.scale", "2 finite numbers"]),
        ("scale nan", "{ scale = nan }", &["mapping.scale", "a finite number, found nan"]),
        ("offset number", "{ offset = 1 }", &["mapping.offset", "2 finite numbers, found 1"]),
        ("rotate inf", "{ rotate = inf }", &["mapping.rotate", "a finite number, found inf"]),
        ("rotate text", "{ rotate = '90' }", &["mapping.rotate", "found the string '90'"]),
        (
            "unknown key",
            "{ rotation = 90 }",
            &["\"rotation\" in the table of material.mapping; did you mean \"rotate\""],
        ),
        ("no table", "'planar'", &["\"material.mapping\"", "a table with the keys kind, entity"]),
    ];
    let texts: Vec<String> = cases
        .iter()
        .map(|(_, mapping, _)| format!("[[material]]\nname = 'm'\nmapping = {mapping}"))
        .collect();
    let cases: Vec<_> =
        cases.iter().zip(&texts).map(|((rule, _, f), text)| (*rule, text.as_str(), *f)).collect();
    check_behind_head(&cases);
    let bounds = "[[material]]\nname = 'm'\nmapping = { kind = 'planar', space = 'bounds' }\n[[plane]]\n\
                  origin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm'\n";
    check_behind_head(&[(
        "infinite plane in its bounds",
        bounds,
        &[":12:1:", "plane.half_extent", "\"m\"", "bounds"],
    )]);
    assert!(parse(Path::new(PATH), &format!("{HEAD}{bounds}half_extent = 1\n")).is_ok());
}
