//! Invalid shapes and lights, and too many of them.

use std::path::Path;

use moire::internal::scene::parse;

use super::HEAD;
use super::errors::{PATH, check, check_behind_head};

#[test]
fn shape_rules() {
    let plane = |t: &str, b: &str, rest: &str| {
        format!("[[plane]]\norigin = [0, 0, 0]\ntangent = {t}\nbitangent = {b}\n{rest}")
    };
    let triangle = |vertices: &str, rest: &str| format!("[[triangle]]\nvertices = {vertices}\n{rest}");
    let good = "[[0, 0, 0], [1, 0, 0], [0, 1, 0]]";
    let cases: Vec<(&str, String, &[&str])> = vec![
        ("tangent zero", plane("[0, 0, 0]", "[0, 0, 1]", ""), &[":11:11:", "plane.tangent", "not zero"]),
        ("bitangent zero", plane("[1, 0, 0]", "[0, 0, -0.0]", ""), &["plane.bitangent", "not zero"]),
        ("axes parallel", plane("[1, 2, 3]", "[-2, -4, -6]", ""), &["plane.bitangent", "parallel"]),
        (
            "extent zero",
            plane("[1, 0, 0]", "[0, 0, 1]", "half_extent = 0"),
            &["plane.half_extent", "above 0"],
        ),
        (
            "extent inf",
            plane("[1, 0, 0]", "[0, 0, 1]", "half_extent = inf"),
            &["half_extent", "finite", "inf"],
        ),
        (
            "tangent missing",
            "[[plane]]\norigin = [0, 0, 0]\nbitangent = [0, 0, 1]".into(),
            &["\"plane.tangent\" is missing"],
        ),
        (
            "key misspelt",
            "[[plane]]\norgin = [0, 0, 0]".into(),
            &["\"orgin\" in [[plane]]; did you mean \"origin\""],
        ),
        (
            "radius zero",
            "[[sphere]]\ncenter = [0, 0, 0]\nradius = 0".into(),
            &["sphere.radius", "above 0", "found 0"],
        ),
        ("radius negative", "[[sphere]]\ncenter = [0, 0, 0]\nradius = -1".into(), &["above 0", "found -1"]),
        ("radius missing", "[[sphere]]\ncenter = [0, 0, 0]".into(), &["sphere.radius", "missing"]),
        ("centre far", "[[sphere]]\ncenter = [1e31, 0, 0]\nradius = 1".into(), &["sphere.center", "1e30"]),
        (
            "disc without normal",
            "[[disc]]\ncenter = [0, 0, 0]\nradius = 1".into(),
            &["\"disc.normal\" is missing"],
        ),
        (
            "disc of normal zero",
            "[[disc]]\ncenter = [0, 0, 0]\nnormal = [0, 0, 0]\nradius = 1".into(),
            &[":11:10:", "disc.normal", "not zero"],
        ),
        (
            "disc of radius zero",
            "[[disc]]\ncenter = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 0".into(),
            &["disc.radius", "above 0"],
        ),
        (
            "uv unknown",
            "[[disc]]\ncenter = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 1\nuv = 'radial'".into(),
            &["disc.uv", "allowed: planar, polar"],
        ),
        ("vertices missing", "[[triangle]]".into(), &["triangle.vertices", "missing"]),
        ("two vertices", triangle("[[0, 0, 0], [1, 0, 0]]", ""), &["triangle.vertices", "3 vertices"]),
        (
            "flat vertex",
            triangle("[[0, 0, 0], [1, 0], [0, 1, 0]]", ""),
            &["triangle.vertices[1]", "found [1, 0]"],
        ),
        (
            "nan vertex",
            triangle("[[0, 0, 0], [1, 0, 0], [0, nan, 0]]", ""),
            &[":10:39:", "vertices[2]", "nan"],
        ),
        ("uvs of two", triangle(good, "uvs = [[0, 0], [1, 0]]"), &["triangle.uvs", "3 texture coordinates"]),
        (
            "uv inf",
            triangle(good, "uvs = [[0, 0], [1, inf], [0, 1]]"),
            &["triangle.uvs[1]", "2 finite numbers"],
        ),
        (
            "normal zero",
            triangle(good, "normals = [[0, 1, 0], [0, 0, 0], [0, 1, 0]]"),
            &["triangle.normals[1]", "not zero"],
        ),
        ("normals of one", triangle(good, "normals = [[0, 1, 0]]"), &["triangle.normals", "3 normals"]),
    ];
    let cases: Vec<_> = cases.iter().map(|(r, t, f)| (*r, t.as_str(), *f)).collect();
    check_behind_head(&cases);
}

#[test]
fn light_rules() {
    check_behind_head(&[
        ("kind missing", "[[light]]\nposition = [0, 0, 0]", &["light.kind", "missing"]),
        ("kind unknown", "[[light]]\nkind = 'lamp'", &["light.kind", "allowed: point, directional"]),
        (
            "position missing",
            "[[light]]\nkind = 'point'\nintensity = [1, 1, 1]",
            &["light.position", "missing"],
        ),
        (
            "intensity missing",
            "[[light]]\nkind = 'point'\nposition = [0, 0, 0]",
            &["light.intensity", "missing"],
        ),
        (
            "intensity negative",
            "[[light]]\nkind = 'point'\nposition = [0, 0, 0]\nintensity = [1, 1, -1]",
            &["light.intensity", "not negative"],
        ),
        (
            "irradiance missing",
            "[[light]]\nkind = 'directional'\ndirection = [0, 1, 0]",
            &["light.irradiance", "missing"],
        ),
        (
            "direction zero",
            "[[light]]\nkind = 'directional'\ndirection = [0, 0, 0]\nirradiance = [1, 1, 1]",
            &["light.direction", "not zero"],
        ),
        (
            "direction of a point",
            "[[light]]\nkind = 'point'\ndirection = [0, 1, 0]",
            &["\"direction\" in [[light]] of kind \"point\"", "allowed: kind, position, intensity"],
        ),
        (
            "position of a sun",
            "[[light]]\nkind = 'directional'\nposition = [0, 1, 0]",
            &["of kind \"directional\"", "kind, direction, irradiance"],
        ),
    ]);
}

#[test]
fn too_many_shapes_or_textures_are_refused_at_the_first_one_over() {
    let spheres =
        |count: usize| format!("{HEAD}{}", "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n".repeat(count));
    let plane = "[[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\n";
    assert!(parse(Path::new(PATH), &spheres(65535)).is_ok());
    let over = format!("{}{plane}", spheres(65535));
    check(&[("shapes", &over, &[":196614:1:", "65536 shapes", "65535 at most"])]);

    let textures = |count: usize| {
        let each = (0..count).map(|i| format!("[[texture]]\nname = 't{i}'\nfile = 'f'\n"));
        format!("{HEAD}{}", each.collect::<String>())
    };
    assert!(parse(Path::new(PATH), &textures(1024)).is_ok());
    check(&[("textures", &textures(1025), &[":3081:1:", "1025 textures", "1024 at most"])]);
}

#[test]
fn triangles_without_area_are_dropped_with_a_count() {
    let triangle = |vertices: &str| format!("[[triangle]]\nvertices = {vertices}\n");
    let flat = [
        "[[0, 0, 0], [1, 0, 0], [1, 0, 0]]",
        "[[1, 1, 1], [1, 1, 1], [1, 1, 1]]",
        "[[0.1, 0.1, 0.1], [0.2, 0.2, 0.2], [0.3, 0.3, 0.3]]",
    ];
    let good = triangle("[[0, 0, 0], [1, 0, 0], [0, 1, 0]]");
    let text = format!("{HEAD}{good}{}{good}", flat.map(triangle).concat());
    let scene = parse(Path::new(PATH), &text).unwrap();
    assert_eq!((scene.shapes.triangles.len(), scene.dropped_triangles), (2, 3));
    let first = text.lines().position(|line| line.contains("[1, 0, 0], [1, 0, 0]")).unwrap();
    // The table's header is the line before.
    assert_eq!(scene.first_dropped, format!("line {first}"));
    let told = moire::internal::scene::advice::of_scene(&scene);
    assert!(
        told.iter().any(|t| t.contains("3 triangles") && t.contains(&format!("line {first}"))),
        "{told:?}"
    );
    let whole = parse(Path::new(PATH), &format!("{HEAD}{good}")).unwrap();
    assert_eq!(whole.dropped_triangles, 0);
}
