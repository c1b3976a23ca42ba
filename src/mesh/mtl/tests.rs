//! Statements of MTL, and what is said of those that are wrong.

#![allow(clippy::unwrap_used)]
use super::*;

#[test]
fn reads_materials() {
    let text = "# Made by hand\r\nKd 9 9 9\nnewmtl red wall \r\n\tKd 0.8 0.1 0.1 # red\nKs 0.5\nKs spectral a.rfl 1\n\
                Ns 1e2\nNi 1.5\nillum 2\nd -halo .25\nTr 0\nKe 0 1 2\nmap_kd\nrefl a.png\nnewmtl b\nKd \\\n 1 2 3";
    let red = MtlMaterial {
        name: "red wall".into(),
        diffuse: Some([0.8, 0.1, 0.1]),
        specular: Some([0.5; 3]),
        exponent: Some(100.0),
        ior: Some(1.5),
        illumination: Some(2),
        opacity: Some(0.25),
        emission: Some([0.0, 1.0, 2.0]),
        notes: vec![
            "line 6: Ks is given by a spectrum or in XYZ, which is not read".into(),
            "line 13: map_kd names no file".into(),
            "line 14: refl is not drawn".into(),
        ],
        ..MtlMaterial::default()
    };
    let other = MtlMaterial { name: "b".into(), diffuse: Some([1.0, 2.0, 3.0]), ..MtlMaterial::default() };
    assert_eq!(read(text.as_bytes()).unwrap(), [red, other]);
    assert_eq!(read(b"").unwrap(), []);
}

#[test]
fn reads_what_passes_and_physically_based_statements() {
    let text = "newmtl a\nTr 0.75\nTf 0.5 1 1\nPr 0.25\nPm 1\nmap_Pr r.png\nmap_Pm -clamp on m.png\n\
                newmtl b\nTr 0.9\nd -halo 0.5\nTr 0.25";
    let [a, b] = <[MtlMaterial; 2]>::try_from(read(text.as_bytes()).unwrap()).unwrap();
    assert_eq!((a.opacity, a.filter), (Some(0.25), Some([0.5, 1.0, 1.0])));
    assert_eq!((a.roughness, a.metallic), (Some(0.25), Some(1.0)));
    assert_eq!(a.roughness_map.unwrap().file, "r.png");
    assert!(a.metallic_map.unwrap().clamp);
    assert_eq!(b.opacity, Some(0.5));
}

#[test]
fn reads_options_of_textures() {
    let text = "newmtl a\nmap_Kd -blendu off -s 2 3 1 -mm 0 1 -o .5 -clamp on tex\\my wood.png\n\
                map_Bump -bm 0.3 -imfchan l -t 1 1 1 -s 2 7\nnorm -odd.png";
    let material = read(text.as_bytes()).unwrap().remove(0);
    let plain = |file: &str, line| MtlMap::of_file(file.into(), line);
    let wood = MtlMap { scale: [2.0, 3.0], offset: [0.5, 0.0], clamp: true, ..plain("tex/my wood.png", 2) };
    assert_eq!(material.diffuse_map, Some(wood));
    let bump = MtlMap { scale: [2.0, 1.0], strength: Some(0.3), ..plain("7", 3) };
    assert_eq!(material.bump_map, Some(bump));
    assert_eq!(material.normal_map, Some(plain("-odd.png", 4)));
}

#[test]
fn faults_name_the_line() {
    for (text, fault) in [
        ("Kd 1 2", "line 2: colour has 2 numbers; it needs 1 or 3"),
        ("Kd 1 -0.5 0", "line 2: colour has -0.5; numbers from 0 are allowed"),
        ("Tr 1.5", "line 2: 1.5 is out of range; 0 to 1 is allowed"),
        ("Kd", "line 2: colour has 0 numbers; it needs 1 or 3"),
        ("Ns abc", "line 2: \"abc\" is no number"),
        ("Ni", "line 2: \"\" is no number"),
        ("illum 2.5", "line 2: \"2.5\" is no whole number from 0"),
        ("bump -bm", "line 2: \"\" is no number"),
        ("map_Kd -s a.png", "line 2: \"a.png\" is no number"),
        ("map_Kd -clamp a.png", "line 2: \"a.png\" is neither on nor off"),
    ] {
        assert_eq!(read(format!("newmtl a\n{text}").as_bytes()).unwrap_err().to_string(), fault);
    }
    assert!(read(b"\xff\xfen\0").is_err());
}
