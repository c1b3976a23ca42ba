//! How a view ends: by Ctrl-C, also while it renders, and the pictures of a tab with the tab.

use std::time::Duration;

use super::{View, wait_until};
use crate::child::HANG;
use crate::support::untested;

/// A picture that would take hours.
fn endless(device: &str) -> View {
    let scene = std::path::absolute(crate::stage::path("lecture")).unwrap();
    View::of_file(&scene, &["--size", "2048x2048", "--spp", "1048576", "--device", device])
}

/// The most CPU time of each core after Ctrl-C.
const CORE_SECONDS: f64 = 3.0;

fn interrupted(device: &str, opens: bool) {
    let mut view = endless(device);
    let tab = opens.then(|| {
        let mut tab = view.tab("t");
        tab.until(|state| !state["sides"][0]["spp"].is_null());
        tab
    });
    let before = view.running.cpu_seconds();
    view.running.interrupt();
    let mut after = before;
    view.running.wait_until(|running| {
        after = running.cpu_seconds().or(after);
        false
    });
    let output = view.running.output(HANG);
    assert_eq!(output.status.code(), Some(130), "{}", String::from_utf8_lossy(&output.stderr));
    drop(tab);
    let (Some(before), Some(after)) = (before, after) else {
        untested("how soon Ctrl-C ends a view: there is no /proc");
        return;
    };
    let cores = std::thread::available_parallelism().unwrap().get() as f64;
    assert!(after - before < CORE_SECONDS * cores, "{} s on {cores} cores after Ctrl-C", after - before);
}

#[test]
fn ctrl_c_ends_a_view_soon() {
    interrupted(&crate::stage::device_name(), false);
    interrupted(&crate::stage::device_name(), true);
    interrupted("oracle", true);
}

#[test]
fn a_closed_tab_is_rendered_no_further() {
    let view = endless(&crate::stage::device_name());
    let mut tab = view.tab("t");
    tab.until(|state| !state["sides"][0]["spp"].is_null());
    if view.running.cpu_seconds().is_none() {
        untested("whether a closed tab is rendered further: there is no /proc");
        return;
    }
    drop(tab);
    wait_until(|| {
        let before = view.running.cpu_seconds().unwrap();
        std::thread::sleep(Duration::from_millis(700));
        view.running.cpu_seconds().unwrap() - before < 0.05
    });
    assert_eq!(view.get("pixel?tab=t&side=a&x=0&y=0").status, 404);
    assert_eq!(view.get("").status, 200);
}
