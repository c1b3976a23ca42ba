//! The page of `moire inspect` in headless Chromium, where it is installed: nothing wider than the window, legends of a size
//! that can be read, in the light and in the dark.

use std::fmt::Write;

use super::command::run;
use super::{DOWN, stage};
use crate::browser::{brightness, is_installed, probed};

/// Frames as wide as a phone, a tablet and a desk's screen.
const PROBE: &str = r#"<!doctype html><title>probe</title>
<iframe id="phone" src="index.html" width="390" height="700"></iframe>
<iframe id="tablet" src="index.html" width="768" height="700"></iframe>
<iframe id="desk" src="index.html" width="1400" height="800"></iframe>
<script>
addEventListener("load", () => {
  const report = {};
  for (const frame of document.querySelectorAll("iframe")) {
    const page = frame.contentDocument, view = frame.contentWindow;
    const box = (e) => e.getBoundingClientRect();
    const entries = [...page.querySelectorAll(".scale li, .entries li")];
    const open = entries.filter((e) => !e.closest("details"));
    report[frame.id] = {
      width: view.innerWidth,
      scroll: page.documentElement.scrollWidth,
      background: view.getComputedStyle(page.body).backgroundColor,
      text: view.getComputedStyle(page.body).color,
      entries: entries.length,
      letters: Math.min(...open.map((e) => parseFloat(view.getComputedStyle(e).fontSize))),
      inside: open.every((e) => box(e).left >= box(e.closest("figure")).left - 1 && box(e).right <= box(e.closest("figure")).right + 1),
      apart: [...page.querySelectorAll(".scale ol")].every((list) => {
        const places = [...list.children].map(box);
        return places.every((place, i) => i == 0 || places[i - 1].right < place.left);
      }),
      pictures: [...page.images].every((e) => box(e).width > 200 && e.alt),
    };
  }
  const out = document.createElement("pre");
  out.id = "report";
  out.textContent = JSON.stringify(report);
  document.body.append(out);
});
</script>"#;

#[test]
fn the_page_fits_windows_and_its_legends_can_be_read() {
    if !is_installed() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let name = format!("{}.toml", "a_scene_with_a_long_name_without_gaps_".repeat(5));
    let mut text = DOWN.to_owned();
    for i in 0..15 {
        let [x, z] = [i % 4, i / 4].map(|k| 0.5 * f64::from(k) - 0.75);
        write!(text, "[[sphere]]\ncenter = [{x}, 0.3, {z}]\nradius = 0.2\nmaterial = \"m\"\n").unwrap();
    }
    std::fs::rename(stage(folder.path(), &text), folder.path().join(&name)).unwrap();
    assert_eq!(run(folder.path(), &["inspect", &name, "--out", "seen"]).0, 0);
    for dark in [false, true] {
        let report = probed(&folder.path().join("seen"), PROBE, dark);
        for window in ["phone", "tablet", "desk"] {
            let found = &report[window];
            assert!(found["scroll"].as_f64() <= found["width"].as_f64(), "{window}: {found}");
            assert!(found["letters"].as_f64().unwrap() >= 13.0, "{window}: {found}");
            for part in ["inside", "apart", "pictures"] {
                assert_eq!(found[part], true, "{window}, {part}: {found}");
            }
            // 16 shapes, a material, and two values at each bar at least.
            assert!(found["entries"].as_u64().unwrap() >= 17 + 14, "{window}: {found}");
            let (ground, ink) = (brightness(&found["background"]), brightness(&found["text"]));
            assert_eq!(dark, ground < ink, "dark {dark}: ground {ground}, ink {ink}");
        }
    }
}
