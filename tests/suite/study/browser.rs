//! The page in headless Chromium, where `chromium` is installed: no console message, plots and
//! pictures visible, nothing wider than a phone, dark mode, working legends.

use serde_json::Value;
use tempfile::tempdir;

use super::studied;
use crate::browser::{brightness, is_installed, probed};

/// Frames as wide as a phone and as a desk's screen; what is found in them ends up in the document.
const PROBE: &str = r#"<!doctype html><title>probe</title>
<iframe id="phone" src="index.html" width="360" height="700"></iframe>
<iframe id="desk" src="index.html" width="1200" height="800"></iframe>
<script>
addEventListener("load", () => {
  const report = {};
  for (const frame of document.querySelectorAll("iframe")) {
    const page = frame.contentDocument, view = frame.contentWindow;
    const box = (e) => e.getBoundingClientRect();
    const key = page.querySelector("svg .key");
    const pressed = () => key.getAttribute("aria-pressed") + page.querySelectorAll("svg .series.off").length;
    const states = [pressed()];
    key.dispatchEvent(new view.MouseEvent("click", { bubbles: true }));
    states.push(pressed());
    key.dispatchEvent(new view.KeyboardEvent("keydown", { key: "Enter", bubbles: true }));
    states.push(pressed());
    report[frame.id] = {
      width: view.innerWidth,
      scroll: page.documentElement.scrollWidth,
      background: view.getComputedStyle(page.body).backgroundColor,
      text: view.getComputedStyle(page.body).color,
      plots: [...page.querySelectorAll("svg.plot")].filter((e) => box(e).width > 0).map((e) => [box(e).width, box(e).height]),
      letters: Math.min(...[...page.querySelectorAll("svg.plot text")].filter((e) => box(e).width > 0)
        .map((e) => parseFloat(view.getComputedStyle(e).fontSize) * e.getScreenCTM().a || 99)),
      captions: [...page.querySelectorAll("caption > span")].filter((e) => box(e).right > box(e.closest(".scroll")).right).length,
      rows: Math.max(...[...page.querySelectorAll("[aria-labelledby=points-h] tbody tr, [aria-labelledby=answer-h] tbody tr")].map((e) => box(e).height)),
      hidden: [...page.querySelectorAll("[aria-labelledby=answer-h] tr > :nth-child(3)")]
        .filter((e) => box(e).right > box(e.closest(".scroll")).right + 1).length,
      marks: [...page.querySelectorAll("svg .mark")].filter((e) => box(e).width > 2).length,
      pictures: [...page.images].map((e) => [e.naturalWidth, box(e).width]),
      boxes: [...page.querySelectorAll(".scroll")].every((e) => e.tabIndex === 0 && e.ariaLabel),
      states,
      guides: [...page.querySelectorAll("svg.plot")].filter((e) => box(e).width > 0).flatMap((svg) => {
        const marks = [...svg.querySelectorAll(".mark")].map(box);
        return [...svg.querySelectorAll(".small.name:not([class*=t])")].map(box).filter((a) => marks.some((b) =>
          a.left < b.right - 2 && b.left < a.right - 2 && a.top + 3 < b.bottom && b.top < a.bottom - 3));
      }).length,
      names: [...page.querySelectorAll("svg")].map((svg) => [...svg.querySelectorAll(".name")].map(box))
        .flatMap((all) => all.filter((a, i) => all.slice(0, i).some((b) => a.left < b.right - 1 && b.left < a.right - 1
          && a.top < b.bottom - 4 && b.top < a.bottom - 4))).length,
      outside: [...page.querySelectorAll("svg text")].filter((e) => {
        const own = box(e), all = box(e.ownerSVGElement);
        return own.left < all.left - 1 || own.right > all.right + 1;
      }).map((e) => e.textContent),
      tables: [...page.querySelectorAll("table")].filter((e) => {
        const own = e.closest(".scroll");
        return !own || box(own).right > view.innerWidth;
      }).length,
    };
  }
  const out = document.createElement("pre");
  out.id = "report";
  out.textContent = JSON.stringify(report);
  document.body.append(out);
});
</script>"#;

fn numbers(pair: &Value) -> [f64; 2] {
    [0, 1].map(|i| pair[i].as_f64().unwrap())
}

fn check(found: &Value, phone: bool) {
    let [width, scroll] = ["width", "scroll"].map(|k| found[k].as_f64().unwrap());
    assert!(scroll <= width, "the page is {scroll} wide in a window of {width}");
    let plots = found["plots"].as_array().unwrap();
    assert_eq!(plots.len(), 3);
    for plot in plots {
        let [w, h] = numbers(plot);
        // On a phone there are plots of its width.
        assert!(if phone { w > 280.0 && w < width } else { w > 500.0 } && h > 80.0, "a plot of {w}×{h}");
    }
    assert!(found["letters"].as_f64().unwrap() > 10.0, "letters of {} pixels", found["letters"]);
    assert!(found["rows"].as_f64().unwrap() < 100.0, "rows of {} pixels", found["rows"]);
    assert!(found["marks"].as_u64().unwrap() >= 20, "{} marks", found["marks"]);
    let pictures = found["pictures"].as_array().unwrap();
    assert!(pictures.len() >= 10);
    assert!(pictures.iter().map(numbers).all(|[own, shown]| own > 0.0 && shown > 100.0), "{pictures:?}");
    assert_eq!(found["boxes"], true, "boxes that scroll are reached by keyboard and have names");
    let states: Vec<&str> = found["states"].as_array().unwrap().iter().map(|s| s.as_str().unwrap()).collect();
    for (key, what) in [
        ("names", "names of lines cover each other"),
        ("tables", "tables are cut, and in no box that scrolls"),
        ("captions", "captions of tables are cut"),
        ("hidden", "times of the answer are not in sight"),
        ("guides", "names of guides lie on marks"),
    ] {
        assert_eq!(found[key], 0, "{what}");
    }
    let cut = found["outside"].as_array().unwrap();
    assert!(cut.is_empty(), "texts are cut at a plot's ends: {cut:?}");
    // Off by pointer in two plots and their keys, wide and narrow, on again by keyboard.
    assert!(["false8", "false6"].contains(&states[1]), "{states:?}");
    assert_eq!([states[0], states[2]], ["true0", "true0"]);
}

#[test]
fn page_works_in_a_browser_on_a_phone_and_in_the_dark() {
    if !is_installed() {
        return;
    }
    let folder = tempdir().unwrap();
    let methods = "center,grid,random,stratified,stratified+cone+anisotropic";
    let asked = ["--methods", methods, "--spp", "1,4,16", "--repeats", "2", "--budget", "10s"];
    studied(folder.path(), &asked);
    for dark in [false, true] {
        let report = probed(folder.path(), PROBE, dark);
        for name in ["phone", "desk"] {
            let found = &report[name];
            check(found, name == "phone");
            let (ground, ink) = (brightness(&found["background"]), brightness(&found["text"]));
            assert_eq!(dark, ground < ink, "dark {dark}: ground {ground}, ink {ink}");
            assert!(ground.abs_diff(ink) > 500, "contrast of {ground} and {ink}");
        }
    }
}
