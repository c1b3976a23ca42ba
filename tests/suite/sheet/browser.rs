//! The page: well-formed and in no need of other files; in headless Chromium, where `chromium` is installed, nothing wider
//! than a phone, and a glass over the same place of all pictures.

use tempfile::tempdir;

use super::{SIZE, record};
use crate::browser::{brightness, is_installed, probed};

const OPTIONS: [&str; 11] = [
    "--vary",
    "filter=nearest,linear,ewa",
    "--vary",
    "method=shader,hardware",
    "--repeats",
    "1",
    "--reference-spp",
    "32",
    "--diff",
    "-o",
    "index.html",
];

#[test]
fn page_is_well_formed_and_names_every_picture() {
    let folder = tempdir().unwrap();
    record(folder.path(), &[&SIZE[..], &OPTIONS, &["--zoom", "4,4,8,8"]].concat());
    let page = std::fs::read_to_string(folder.path().join("index.html")).unwrap();
    for remote in ["http://", "https://", "src=\"/", "@import"] {
        assert!(!page.contains(remote), "the page asks for {remote}");
    }
    let start = page.find("<script>").unwrap();
    let end = page.find("</script>").unwrap();
    let style = page.find("<style>").unwrap()..page.find("</style>").unwrap();
    let markup =
        [&page["<!doctype html>".len()..style.start], "<style>", &page[style.end..start], &page[end + 9..]];
    let page = markup.concat();
    let page = roxmltree::Document::parse(&page).unwrap();
    let all = |tag: &'static str| page.descendants().filter(move |n| n.tag_name().name() == tag);
    // Five cells with their differences, the whole picture and the reference.
    assert_eq!(all("img").count(), 12);
    for img in all("img") {
        assert!(img.attribute("alt").is_some_and(|alt| alt.len() > 10), "a picture without words");
        assert!(img.attribute("src").is_some_and(|src| src.starts_with("data:image/png;base64,")));
    }
    let said = page.root_element().descendants().filter_map(|n| n.text()).collect::<Vec<_>>().join(" ");
    for text in
        ["filter: ewa", "method: hardware", "no device's own sampler has filter", "RMSE", "FLIP", "frame:"]
    {
        assert!(said.contains(text), "{text} is not said");
    }
}

/// Frames as wide as a phone and as a desk's screen.
const PROBE: &str = r#"<!doctype html><title>probe</title>
<iframe id="phone" src="index.html" width="390" height="700"></iframe>
<iframe id="desk" src="index.html" width="1300" height="800"></iframe>
<script>
addEventListener("load", () => {
  const report = {};
  for (const frame of document.querySelectorAll("iframe")) {
    const page = frame.contentDocument, view = frame.contentWindow;
    const seen = [...page.querySelectorAll(".seen")];
    const places = () => seen.map((e) => {
      const glass = e.querySelector(".glass"), box = e.getBoundingClientRect();
      return [view.getComputedStyle(glass).display, parseFloat(glass.style.left) / box.width];
    });
    const box = seen[0].getBoundingClientRect();
    const at = { clientX: box.left + box.width / 4, clientY: box.top + box.height / 2, bubbles: true };
    seen[0].dispatchEvent(new view.PointerEvent("pointermove", at));
    const pointed = places();
    seen[0].dispatchEvent(new view.KeyboardEvent("keydown", { key: "ArrowRight", bubbles: true }));
    const moved = places();
    seen[0].dispatchEvent(new view.PointerEvent("pointerleave"));
    report[frame.id] = {
      width: view.innerWidth,
      scroll: page.documentElement.scrollWidth,
      background: view.getComputedStyle(page.body).backgroundColor,
      text: view.getComputedStyle(page.body).color,
      boxes: [...page.querySelectorAll(".scroll")].every((e) => e.tabIndex === 0 && e.ariaLabel),
      pointed, moved, left: places(),
    };
  }
  const out = document.createElement("pre");
  out.id = "report";
  out.textContent = JSON.stringify(report);
  document.body.append(out);
});
</script>"#;

#[test]
fn page_shows_one_place_of_all_pictures_on_a_phone_and_in_the_dark() {
    if !is_installed() {
        return;
    }
    let folder = tempdir().unwrap();
    record(folder.path(), &[&["--size", "240x180"][..], &OPTIONS].concat());
    for dark in [false, true] {
        let report = probed(folder.path(), PROBE, dark);
        for name in ["phone", "desk"] {
            let found = &report[name];
            let number = |key: &str| found[key].as_f64().unwrap();
            assert!(number("scroll") <= number("width"), "{name}: {} wide", number("scroll"));
            assert_eq!(found["boxes"], true, "boxes that scroll are reached by keyboard and have names");
            assert_eq!(dark, brightness(&found["background"]) < brightness(&found["text"]));
            for (key, place) in [("pointed", 0.25), ("moved", 0.25 + 1.0 / 64.0)] {
                let places = found[key].as_array().unwrap();
                // Five cells with their differences, and the reference.
                assert_eq!(places.len(), 11);
                for glass in places {
                    assert_eq!(glass[0], "block", "{name}: {key}");
                    assert!((glass[1].as_f64().unwrap() - place).abs() < 0.02, "{name}: {key} {glass}");
                }
            }
            assert!(found["left"].as_array().unwrap().iter().all(|glass| glass[0] == "none"));
        }
    }
}
