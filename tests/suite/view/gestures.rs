//! The page by mouse, by fingers and by keys alone, in headless Chromium, where `chromium` is installed: wheel and pinch zoom
//! about their place, the command is copied or marked, and the menus of the display are reached and worked without a mouse.

use serde_json::json;

use super::View;
use super::chromium::Browser;
use crate::browser::{brightness, is_installed};

const DONE: &str = "document.getElementById('state').textContent.includes('done')";
const ZOOM: &str = "Number.parseFloat(document.getElementById('zoom').textContent)";
const PIXEL: &str = "document.getElementById('pixel-title').textContent";
const COMMAND: &str = "document.querySelector('#commands code').textContent";

/// Shows a small picture in a tab of that width.
fn opened(width: u32, dark: bool) -> Option<(View, Browser, String)> {
    if !is_installed() {
        return None;
    }
    let view = View::of("lecture", &["--size", "64x48", "--spp", "4"]);
    let mut browser = Browser::start();
    let page = browser.open(&view.address(), width, dark);
    browser.until(&page, DONE);
    browser.until(&page, "document.getElementById('picture').dataset.b");
    Some((view, browser, page))
}

#[test]
fn the_wheel_zooms_about_the_pixel_under_it() {
    let Some((_view, mut browser, page)) = opened(1400, false) else { return };
    let [x, y] = browser.middle(&page, "#picture");
    let at = [x + 71.0, y - 53.0];
    let mouse = |kind: &str, [x, y]: [f64; 2], wheel: f64| json!({ "type": kind, "x": x, "y": y, "deltaX": 0.0, "deltaY": wheel });
    browser.call(Some(&page), "Input.dispatchMouseEvent", mouse("mouseMoved", at, 0.0));
    browser.until(&page, &format!("{PIXEL} !== 'Pixel'"));
    let (pixel, zoom) = (browser.run(&page, PIXEL), browser.run(&page, ZOOM).as_f64().unwrap());
    for _ in 0..3 {
        browser.call(Some(&page), "Input.dispatchMouseEvent", mouse("mouseWheel", at, -120.0));
    }
    browser.until(&page, &format!("{ZOOM} > {}", 1.8 * zoom));
    let scrolled = browser.run(&page, "scrollY");
    browser.call(Some(&page), "Input.dispatchMouseEvent", mouse("mouseMoved", [at[0] + 40.0, at[1]], 0.0));
    browser.until(&page, &format!("{PIXEL} !== {pixel}"));
    browser.call(Some(&page), "Input.dispatchMouseEvent", mouse("mouseMoved", at, 0.0));
    browser.until(&page, &format!("{PIXEL} === {pixel}"));
    browser.call(Some(&page), "Input.dispatchMouseEvent", mouse("mouseWheel", at, 600.0));
    browser.until(&page, &format!("{ZOOM} < {zoom}"));
    assert_eq!(browser.run(&page, "scrollY"), scrolled, "the wheel scrolls the page, too");
    assert!(browser.complaints.is_empty(), "{:#?}", browser.complaints);
}

#[test]
fn two_fingers_zoom_the_picture_and_not_the_page() {
    let Some((_view, mut browser, page)) = opened(390, true) else { return };
    let touch = json!({ "enabled": true, "maxTouchPoints": 5 });
    browser.call(Some(&page), "Emulation.setTouchEmulationEnabled", touch);
    let [x, y] = browser.middle(&page, "#picture");
    let zoom = browser.run(&page, ZOOM).as_f64().unwrap();
    let fingers = |apart: f64| [[x - apart, y - 30.0], [x + apart, y - 30.0]];
    browser.touch(&page, "touchStart", &fingers(20.0));
    for apart in [30.0, 40.0, 50.0, 60.0] {
        browser.touch(&page, "touchMove", &fingers(apart));
    }
    browser.touch(&page, "touchEnd", &[]);
    browser.until(&page, &format!("Math.abs({ZOOM} / {zoom} - 3) < 0.1"));
    assert_eq!(browser.run(&page, "[visualViewport.scale, scrollX]"), json!([1, 0]));
    // A pinch keeps no pixel; a tap does.
    assert_eq!(browser.run(&page, PIXEL), "Pixel");
    browser.touch(&page, "touchStart", &[[x + 40.0, y]]);
    browser.touch(&page, "touchEnd", &[]);
    browser.until(&page, &format!("{PIXEL} !== 'Pixel'"));
    assert!(browser.complaints.is_empty(), "{:#?}", browser.complaints);
}

#[test]
fn no_menu_of_a_wide_page_cuts_its_words() {
    let Some((_view, mut browser, page)) = opened(1400, false) else { return };
    // A word of each menu in its own font, and the room that it has beside the arrow.
    let cut = "(() => { const pen = document.createElement('canvas').getContext('2d'); const found = []; \
               for (const own of document.querySelectorAll('#menus select')) { const style = getComputedStyle(own); \
               pen.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`; const room = own.clientWidth - \
               parseFloat(style.paddingLeft) - parseFloat(style.paddingRight) - 18; \
               const words = [...own.options].map((option) => option.text).concat('(mirrored-repeat)', '(linear/anisotropic)'); \
               for (const word of words) if (pen.measureText(word).width > room) found.push([own.dataset.option, word, room]); } \
               return found; })()";
    assert_eq!(browser.run(&page, cut), json!([]));
    let options =
        "[...document.querySelectorAll('[data-side=a][data-option]')].map((own) => own.dataset.option)";
    let options = browser.run(&page, options).to_string();
    for name in ["filter.mag", "filter.min", "max_anisotropy", "cubic"] {
        assert!(options.contains(&format!("\"sampler.*.{name}\"")), "{options}");
    }
    let mags = "[...document.querySelector('[data-option=\"sampler.*.filter.mag\"]').options].map((own) => own.value)";
    let mags = browser.run(&page, mags).to_string();
    assert!(mags.contains("\"cubic\"") && !mags.contains("ewa") && !mags.contains("summed"), "{mags}");
}

#[test]
fn settings_wait_for_the_picture_of_those_before_them() {
    let Some((_view, mut browser, page)) = opened(1400, false) else { return };
    // Changes come faster than pictures; each that is sent is seen, and the last one is.
    let change = "(async () => { const old = window.fetch; let sent = 0; const seen = new Set(); \
                  window.fetch = (at, more) => { if (more?.method === 'POST') sent += 1; return old(at, more); }; \
                  const field = document.querySelector('[data-option=seed][data-side=a]'); \
                  const note = () => seen.add(document.getElementById('picture').dataset.a.split('/')[0]); \
                  for (let i = 0; i < 80; i += 1) { field.value = 100 + i; field.dispatchEvent(new Event('change')); note(); \
                  await new Promise((done) => setTimeout(done, 10)); } \
                  for (let i = 0; i < 400 && !document.querySelector('#commands code').textContent.includes('--seed 179'); i += 1) { \
                  note(); await new Promise((done) => setTimeout(done, 10)); } \
                  window.fetch = old; return [sent, seen.size, document.querySelector('#commands code').textContent]; })()";
    let told = browser.run(&page, change);
    assert!(told[2].as_str().unwrap().contains("--seed 179"), "{told}");
    let [sent, seen] = [0, 1].map(|i| told[i].as_u64().unwrap());
    assert!(sent < 60 && seen >= 3, "{told}");
    assert!(browser.complaints.is_empty(), "{:#?}", browser.complaints);
}

#[test]
fn the_command_is_copied_or_marked_to_be_copied() {
    let Some((view, mut browser, page)) = opened(1400, false) else { return };
    let origin = format!("http://127.0.0.1:{}", view.port);
    let allow = |browser: &mut Browser, name: &str, setting: &str| {
        let params = json!({ "origin": origin, "permission": { "name": name }, "setting": setting });
        browser.call(None, "Browser.setPermission", params);
    };
    allow(&mut browser, "clipboard-write", "granted");
    allow(&mut browser, "clipboard-read", "granted");
    let command = browser.run(&page, COMMAND);
    assert!(command.as_str().unwrap().starts_with("moire render "), "{command}");
    browser.click(&page, "#commands button");
    browser.until(&page, "document.querySelector('#commands button').textContent === 'Copied'");
    assert_eq!(browser.run(&page, "navigator.clipboard.readText()"), command);
    browser.until(&page, "document.querySelector('#commands button').textContent === 'Copy'");
    allow(&mut browser, "clipboard-write", "denied");
    browser.click(&page, "#commands button");
    browser.until(&page, "document.querySelector('#commands button').textContent.startsWith('Marked')");
    assert_eq!(browser.run(&page, "getSelection().toString()"), command);
    // The button stays the same one, with the focus, while pictures arrive.
    browser.run(&page, "document.querySelector('#commands button').focus()");
    let more = "(() => { const own = document.querySelector('[data-option=spp][data-side=a]'); own.value = '64'; \
                own.dispatchEvent(new Event('change')); })()";
    browser.run(&page, more);
    browser.until(&page, &format!("{COMMAND}.includes('--spp 64')"));
    assert_eq!(
        browser.run(&page, "document.activeElement === document.querySelector('#commands button')"),
        true
    );
    assert!(browser.complaints.is_empty(), "{:#?}", browser.complaints);
}

#[test]
fn the_display_is_changed_by_keys_alone_on_a_phone_in_the_dark() {
    let Some((_view, mut browser, page)) = opened(390, true) else { return };
    browser.tab_to(&page, "own.dataset.slider === 'exposure' && own.dataset.side === 'a'");
    let before = browser.run(&page, "document.getElementById('picture').dataset.a");
    for _ in 0..5 {
        browser.press(&page, "ArrowRight");
    }
    browser.until(&page, &format!("{COMMAND}.includes(' --exposure 0.5')"));
    browser.until(&page, &format!("document.getElementById('picture').dataset.a !== {before}"));
    assert_eq!(browser.run(&page, "document.activeElement.ariaValueText"), "0.5");
    browser.press(&page, "Tab");
    browser.tab_to(&page, "own.dataset.option === 'tone-map' && own.dataset.side === 'b'");
    for key in ["a", "g", "x"] {
        browser.press(&page, key);
    }
    browser.until(
        &page,
        "document.querySelectorAll('#commands code')[1].textContent.includes(' --tone-map agx')",
    );
    browser.until(&page, "document.getElementById('difference').textContent.includes('one film')");
    // The address has it, and the settings of both sides change places.
    browser.tab_to(&page, "own.id === 'swap'");
    browser.press(&page, "Enter");
    browser.until(&page, &format!("{COMMAND}.includes(' --tone-map agx')"));
    let kept = "JSON.parse(decodeURIComponent(location.hash.slice(1)))[1].options.exposure === '0.5'";
    browser.until(&page, kept);
    browser.call(Some(&page), "Page.reload", json!({}));
    browser.until(&page, "document.querySelector('[data-option=exposure][data-side=b]').value === '0.5'");
    browser.until(&page, &format!("{DONE} && {COMMAND}.includes(' --tone-map agx')"));
    let beyond = "[...document.querySelectorAll('body *')].filter((own) => own.getBoundingClientRect().right > innerWidth + 0.5 && \
                  !own.closest('svg')).map((own) => own.outerHTML.slice(0, 80))";
    assert_eq!(browser.run(&page, beyond), json!([]));
    let wide = browser.run(&page, "[document.documentElement.scrollWidth, innerWidth]");
    assert!(wide[0].as_f64() <= wide[1].as_f64(), "{wide}");
    let faint = "['#menus .group', '#menus .group span', '[data-option=gamut]'].map((own) => \
                 [getComputedStyle(document.querySelector(own)).color, getComputedStyle(document.querySelector('#settings')).backgroundColor])";
    for pair in browser.run(&page, faint).as_array().unwrap() {
        assert!(brightness(&pair[0]).abs_diff(brightness(&pair[1])) > 250, "{pair}");
    }
    assert!(browser.complaints.is_empty(), "{:#?}", browser.complaints);
}
