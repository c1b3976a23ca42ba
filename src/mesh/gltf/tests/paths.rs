//! Files beside the glTF file: which paths are asked for, and which are refused without asking.

use serde_json::json;

use super::super::read;
use super::super::uri::Uri;
use super::build::{Build, MOST, fault_with};

#[test]
fn asks_for_each_file_once() {
    let mut build = Build::triangle();
    let bytes = build.bytes.clone();
    build.set("/buffers/0/uri", json!("my%20data.bin"));
    build.set("/buffers/1", json!({ "uri": "./x/../my data.bin", "byteLength": 5 }));
    build.set("/images", json!([{ "uri": "not opened.png" }]));
    let mut asked = Vec::new();
    let model = read(build.json.to_string().as_bytes(), MOST, &mut |path| {
        asked.push(path.to_owned());
        Ok(bytes.clone())
    });
    assert_eq!(model.unwrap().instances.len(), 1);
    assert_eq!(asked, ["my data.bin"]);
    let fault =
        read(build.json.to_string().as_bytes(), MOST, &mut |_| Err("no such file".into())).unwrap_err();
    assert_eq!(fault.to_string(), "/buffers/0/uri: no such file");
    let fault = read(build.json.to_string().as_bytes(), MOST, &mut |_| Ok(vec![0; 35])).unwrap_err();
    assert_eq!(fault.to_string(), "/buffers/0/byteLength: it is 36, but the data has 35 bytes");
}

#[test]
fn needs_no_data_for_buffers_of_extensions() {
    let mut build = Build::triangle();
    build.set("/buffers/1", json!({ "byteLength": 100 }));
    build.set("/bufferViews/1", json!({ "buffer": 1, "byteLength": 100 }));
    assert!(build.read().is_ok());
    build.set("/accessors/0/bufferView", json!(1));
    assert_eq!(
        build.fault(),
        "/buffers/1: it has no data: neither a uri, nor is it the first one of a .glb file with a binary chunk; /accessors/0 \
         needs it"
    );
}

#[test]
fn keeps_paths_in_the_folder() {
    for (uri, path) in [
        ("a.bin", "a.bin"),
        ("./a//b/./c.bin", "a/b/c.bin"),
        ("a/../b.bin", "b.bin"),
        ("%61%2Fb%2ebin", "a/b.bin"),
        ("100%.bin", "100%.bin"),
        ("50%zz.bin", "50%zz.bin"),
        ("a#b?c.bin", "a#b?c.bin"),
        ("..a/b..", "..a/b.."),
        ("%252e%252e/a", "%2e%2e/a"),
    ] {
        assert_eq!(Uri::read(uri), Ok(Uri::Path(path.into())), "{uri}");
    }
    let absolute = "is an absolute path; it has to be relative";
    let leaves = "leaves the folder of the file";
    let colon = "has a colon; only relative paths and data URIs are read";
    let control = "has a backslash or a control character";
    for (uri, why) in [
        ("/etc/passwd", absolute),
        ("%2fetc/passwd", absolute),
        ("//host/a", absolute),
        ("../a.bin", leaves),
        ("a/../../b.bin", leaves),
        ("%2e%2e/a.bin", leaves),
        ("..%2fa.bin", leaves),
        ("C:a.bin", colon),
        ("C%3A/a.bin", colon),
        ("http://host/a", colon),
        ("file:a", colon),
        ("a\\b.bin", control),
        ("..%5ca.bin", control),
        ("a%00.bin", control),
        ("a\n.bin", control),
        ("", "names no file"),
        (".", "names no file"),
        ("a/..", "names no file"),
        ("%ff.bin", "is not a path in UTF-8"),
    ] {
        let message = format!("{uri:?} {why}");
        assert_eq!(Uri::read(uri), Err(message.clone()));
        assert_eq!(fault_with("/images", json!([{ "uri": uri }])), format!("/images/0/uri: {message}"));
        assert_eq!(fault_with("/buffers/0/uri", json!(uri)), format!("/buffers/0/uri: {message}"));
    }
}

#[test]
fn decodes_data() {
    let data = |bytes: &[u8], mime: &str| Ok(Uri::Data(bytes.into(), mime.into()));
    assert_eq!(Uri::read("data:image/png;base64,AAE="), data(&[0, 1], "image/png"));
    assert_eq!(Uri::read("data:;base64,AAE"), data(&[0, 1], ""));
    assert_eq!(Uri::read("data:a/b;x=y;base64,AAE%3D"), data(&[0, 1], "a/b"));
    assert_eq!(Uri::read("data:text/plain,a%00b"), data(b"a\0b", "text/plain"));
    assert_eq!(Uri::read("data:text/plain"), Err("its data URI has no comma".into()));
    let wrong = Uri::read("data:;base64,A*").unwrap_err();
    assert!(wrong.starts_with("its base64 data is wrong: "), "{wrong}");
}
