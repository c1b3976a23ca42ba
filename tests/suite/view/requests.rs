//! What the server answers, and what it refuses.

use std::io::Write;
use std::net::TcpStream;
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::json;

use super::View;
use crate::stage::device_name;
use crate::support::moire;

fn view() -> View {
    View::of("quad", &["--size", "16x12", "--spp", "1"])
}

#[test]
fn only_the_whole_address_of_this_machine_is_answered() {
    let view = view();
    let (port, token) = (view.port, view.token.clone());
    assert_eq!((token.len(), token.bytes().all(|byte| byte.is_ascii_hexdigit())), (32, true));
    let page = view.get("");
    assert_eq!(page.status, 200);
    assert!(page.text().contains("<title>moire view</title>"));
    for header in ["default-src 'none'", "no-store", "nosniff", "no-referrer", "frame-ancestors 'none'"] {
        assert!(page.head.contains(header), "{header}: {}", page.head);
    }
    let asked =
        |line: &str, headers: &str| view.raw(format!("{line} HTTP/1.1\r\n{headers}\r\n").as_bytes()).status;
    let host = format!("Host: 127.0.0.1:{port}\r\n");
    let page = format!("GET /{token}/");
    assert_eq!(asked(&page, &host), 200);
    // Through a forwarded port, by whatever number.
    assert_eq!(asked(&page, "Host: localhost:8000\r\n"), 200);
    assert_eq!(asked(&page, "Host: [::1]:8000\r\n"), 200);
    for foreign in ["", "Host: evil.example\r\n", "Host: 127.0.0.1.evil.example\r\n", "Host: 192.168.1.1\r\n"]
    {
        assert_eq!(asked(&page, foreign), 421, "{foreign}");
    }
    assert_eq!(asked(&page, &format!("{host}Origin: http://evil.example\r\n")), 403);
    assert_eq!(asked(&page, &format!("{host}Origin: null\r\n")), 403);
    assert_eq!(asked(&page, &format!("{host}Origin: http://localhost:8000\r\n")), 200);
    let wrong = format!("{}0", &token[..31]);
    let wrong = if wrong == token { format!("{}1", &token[..31]) } else { wrong };
    for path in
        ["/", "/page", &format!("/{wrong}/"), &format!("/{}/", &token[..31]), &format!("/{token}0/"), "//"]
    {
        assert_eq!(asked(&format!("GET {path}"), &host), 403, "{path}");
    }
}

#[test]
fn no_file_is_served() {
    let view = view();
    for path in [
        "../../../../etc/passwd",
        "..%2f..%2fetc/passwd",
        "/etc/passwd",
        "%2e%2e/quad.toml",
        "quad.toml",
        "main.js/../../x",
        "style.css%00",
        "picture?tab=x&side=a",
        "pixel?tab=x&side=a&x=0&y=0",
    ] {
        assert_eq!(view.get(path).status, 404, "{path}");
    }
    for (path, status) in
        [("picture", 400), ("pixel?tab=x&side=c&x=0&y=0", 400), ("events?tab=", 503), ("set", 405)]
    {
        assert_eq!(view.get(path).status, status, "{path}");
    }
    let tab = view.tab("t");
    wait_for_picture(&view);
    for (path, status) in
        [("x=0&y=0", 200), ("x=16&y=0", 404), ("x=-1&y=0", 400), ("x=0", 400), ("x=a&y=0", 400)]
    {
        assert_eq!(view.get(&format!("pixel?tab=t&side=a&{path}")).status, status, "{path}");
    }
    drop(tab);
}

fn wait_for_picture(view: &View) {
    super::wait_until(|| view.get("picture?tab=t&side=a").status == 200);
}

#[test]
fn what_is_no_request_is_refused_and_the_page_goes_on() {
    let view = view();
    let (port, token) = (view.port, &view.token);
    let post = format!("POST /{token}/set HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n");
    let get = format!("GET /{token}/ HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n");
    let long = "x".repeat(1 << 20);
    for (request, status) in [
        (format!("{get}X: {long}\r\n\r\n"), 431),
        (format!("{get}{}\r\n", "X: y\r\n".repeat(200)), 431),
        (format!("GET /{token}/{} HTTP/1.1\r\n\r\n", &long[..8000]), 414),
        (format!("{post}Content-Length: 1048576\r\n\r\n{long}"), 413),
        (format!("{post}Content-Length: -1\r\n\r\n"), 400),
        (format!("{post}\r\n"), 411),
        (format!("{post}Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n"), 501),
        (format!("PUT /{token}/ HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n"), 405),
        (format!("{post}Content-Length: 2\r\n\r\n{{}}").replace("/set", "/page"), 405),
        ("GARBAGE\r\n\r\n".into(), 400),
        ("GET / HTTP/3.0\r\n\r\n".into(), 505),
        ("\u{1}\u{2}\u{3}\r\n\r\n".into(), 400),
    ] {
        let reply = view.raw(request.as_bytes());
        assert_eq!(reply.status, status, "{:.80}: {}", request, reply.text());
        assert_eq!(view.get("").status, 200);
    }
    for body in [
        "",
        "{",
        "[]",
        "{\"options\":1,\"set\":[]}",
        "{\"options\":{},\"set\":[1]}",
        "{\"options\":{\"a\":{}},\"set\":[]}",
    ] {
        let reply = view.raw(format!("{post}Content-Length: {}\r\n\r\n{body}", body.len()).as_bytes());
        assert_eq!(reply.status, 200, "{body}");
        assert!(reply.json()["error"].is_string(), "{body}");
    }
    let deep = "[".repeat(60_000);
    let reply = view.raw(format!("{post}Content-Length: {}\r\n\r\n{deep}", deep.len()).as_bytes());
    assert!(reply.json()["error"].as_str().unwrap().contains("JSON"));
    assert_eq!(view.get("").status, 200);
}

#[test]
fn head_is_answered_like_get_without_a_body() {
    let view = view();
    let _tab = view.tab("t");
    wait_for_picture(&view);
    let (port, token) = (view.port, &view.token);
    for path in
        ["", "style.css", "page", "picture?tab=t&side=a", "pixel?tab=t&side=a&x=0&y=0", "nothing", "set"]
    {
        let head = format!("HEAD /{token}/{path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n");
        let (head, get) = (view.raw(head.as_bytes()), view.get(path));
        assert_eq!((head.status, head.body.len()), (get.status, 0), "{path}");
        assert_eq!(head.head, get.head, "{path}");
        assert!(path == "set" || !get.body.is_empty(), "{path}");
    }
    let events = format!("HEAD /{token}/events?tab=other HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n");
    let events = view.raw(events.as_bytes());
    assert!(events.status == 200 && events.head.contains("text/event-stream") && events.body.is_empty());
}

#[test]
fn silent_connections_hold_up_no_other() {
    let view = view();
    let silent: Vec<TcpStream> = (0..50).map(|_| view.connect()).collect();
    let half: Vec<TcpStream> = (0..50)
        .map(|_| {
            let mut stream = view.connect();
            stream.write_all(b"GET / HT").unwrap();
            stream
        })
        .collect();
    let start = Instant::now();
    assert_eq!(view.get("").status, 200);
    assert_eq!(view.set("none", "a", json!({}), &[]).as_deref(), Some("this tab is not open"));
    // Far less than the time that they are given.
    assert!(start.elapsed() < Duration::from_secs(8), "{:?}", start.elapsed());
    drop((silent, half));
}

#[test]
fn more_silent_connections_than_there_is_room_for_make_room() {
    let view = view();
    let _tab = view.tab("t");
    let silent: Vec<TcpStream> = (0..300).map(|_| view.connect()).collect();
    let start = Instant::now();
    assert_eq!(view.get("").status, 200);
    wait_for_picture(&view);
    assert!(start.elapsed() < Duration::from_secs(8), "{:?}", start.elapsed());
    drop(silent);
}

#[test]
fn a_built_in_scene_is_served_without_a_file() {
    let view =
        View::of_file(Path::new("@lecture"), &["--size", "16x12", "--spp", "1", "--device", &device_name()]);
    let state = view.tab("t").done();
    assert!(
        state["sides"][0]["command"].as_str().unwrap().starts_with("moire render @lecture --spp 1"),
        "{state}"
    );
    assert_eq!(view.get("page").json()["scene"], "@lecture");
    let refused = moire().args(["view", "@lectur"]).output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("lecture"));
}

#[test]
fn there_are_so_many_tabs_and_each_name_is_checked() {
    let view = view();
    let mut open: Vec<_> = (0..16).map(|n| view.tab(&format!("t{n}"))).collect();
    let reply = view.get("events?tab=more");
    assert_eq!((reply.status, reply.text().contains("16 tabs are open")), (503, true));
    open.pop();
    super::wait_until(|| view.get("pixel?tab=t15&side=a&x=0&y=0").status == 404);
    drop(view.tab("more"));
    for name in ["a/b", "a%20b", &"a".repeat(65)] {
        assert_eq!(view.get(&format!("events?tab={name}")).status, 503, "{name}");
    }
}

#[test]
fn what_cannot_be_served_is_refused_before_the_device_starts() {
    let refused = |arguments: &[&str]| {
        let output = moire().arg("view").args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(output.stdout.is_empty());
        String::from_utf8(output.stderr).unwrap()
    };
    let scene = crate::stage::path("quad").display().to_string();
    assert!(refused(&["-"]).contains("needs a scene file"));
    assert!(refused(&[&scene, "--budget", "1"]).contains("takes no --budget"));
    assert!(refused(&[&scene, "--set", "camera.eyes=1"]).contains("eyes"));
    assert!(refused(&[&scene, "--pattern", "grid", "--spp", "7"]).contains("--spp"));
    assert!(refused(&[&scene, "--port", "99999"]).contains("99999"));
    assert!(refused(&["no such scene.toml"]).contains("no such scene.toml"));
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let told = refused(&[&scene, "--port", &port]);
    assert!(told.contains(&format!("port {port} of 127.0.0.1")) && told.contains("--port"), "{told}");
}
