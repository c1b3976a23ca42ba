//! The page in headless Chromium, where `chromium` is installed: pictures arrive, a menu changes them, keys move wipe and
//! crosshair, nothing is wider than a phone, and the console is silent. Two tabs at once.

use serde_json::json;

use super::View;
use super::chromium::Browser;
use crate::browser::{brightness, is_installed};

/// Chooses a value in a menu of a side.
fn choose(option: &str, side: &str, value: &str) -> String {
    format!(
        "(() => {{ const field = document.querySelector('[data-option=\"{option}\"][data-side=\"{side}\"]'); \
         field.value = '{value}'; field.dispatchEvent(new Event('change')); return field.value; }})()"
    )
}

fn key(of: &str, key: &str) -> String {
    format!("document.getElementById('{of}').dispatchEvent(new KeyboardEvent('keydown', {{ key: '{key}' }}))")
}

const PICTURE: &str = "document.getElementById('picture').dataset";

/// Bytes of a side's picture as the page fetches it, as text.
const BYTES: &str = "(async () => { const [link] = [...document.querySelectorAll('#commands a')].slice(-1); \
    return [...new Uint8Array(await (await fetch(link.href)).arrayBuffer())].join(); })()";

#[test]
fn page_works_in_a_browser_in_two_tabs_on_a_phone_and_in_the_dark() {
    if !is_installed() {
        return;
    }
    let view = View::of("lecture", &["--size", "64x48", "--spp", "4"]);
    let mut browser = Browser::start();
    let desk = browser.open(&view.address(), 1400, false);
    let phone = browser.open(&view.address(), 390, true);
    for (session, dark) in [(&desk, false), (&phone, true)] {
        browser.until(session, &format!("{PICTURE}.a?.split('/')[1] === '4' && {PICTURE}.b"));
        browser.until(session, "document.getElementById('state').textContent.includes('done')");
        let wide = browser.run(session, "[document.documentElement.scrollWidth, innerWidth]");
        assert!(wide[0].as_f64() <= wide[1].as_f64(), "{wide}");
        let colors = browser.run(
            session,
            "[getComputedStyle(document.body).backgroundColor, getComputedStyle(document.body).color]",
        );
        let (ground, ink) = (brightness(&colors[0]), brightness(&colors[1]));
        assert!((ground < ink) == dark && ground.abs_diff(ink) > 500, "{colors}");
        let unnamed = "[...document.querySelectorAll('button, input, select, textarea, a, [tabindex=\"0\"]')].filter((own) => \
                       !(own.ariaLabel || own.labels?.length || own.textContent.trim())).map((own) => own.outerHTML)";
        assert_eq!(browser.run(session, unnamed), json!([]));
    }
    // A menu changes the picture of its side and tab, and no other.
    let before = browser.run(&desk, BYTES);
    let [a, b, other] = [(&desk, "a"), (&desk, "b"), (&phone, "b")]
        .map(|(session, side)| browser.run(session, &format!("{PICTURE}.{side}")));
    assert_eq!(browser.run(&desk, &choose("filter", "b", "nearest")), "nearest");
    browser.until(&desk, &format!("{PICTURE}.b !== {b} && {PICTURE}.b.split('/')[1] === '4'"));
    browser.until(&desk, "document.getElementById('commands').textContent.includes('--filter nearest')");
    assert_ne!(browser.run(&desk, BYTES), before);
    assert_eq!(browser.run(&desk, &format!("{PICTURE}.a")), a);
    assert_eq!(browser.run(&phone, &format!("{PICTURE}.b")), other);
    browser.until(&desk, "document.querySelectorAll('#chart path').length >= 2");
    // The program's own words for what is wrong, and none once it is right.
    let typed = |text: &str| {
        format!(
            "(() => {{ const own = document.getElementById('set-a'); own.value = '{text}'; own.dispatchEvent(new Event('change')); }})()"
        )
    };
    browser.run(&desk, &typed("camera.vertical_fo=1"));
    browser.until(&desk, "document.getElementById('error-a').textContent.includes('vertical_fov')");
    browser.run(&desk, &typed("camera.vertical_fov=31"));
    browser.until(&desk, "document.getElementById('error-a').textContent === ''");
    // The wipe and the crosshair by keys.
    for (pressed, wanted) in [("Home", "0"), ("ArrowRight", "2"), ("End", "100"), ("PageDown", "90")] {
        browser.run(&desk, &key("wipe", pressed));
        assert_eq!(browser.run(&desk, "document.getElementById('wipe').ariaValueNow"), wanted, "{pressed}");
    }
    for pressed in ["ArrowLeft", "ArrowDown", "ArrowDown", "+"] {
        browser.run(&phone, &key("picture", pressed));
    }
    browser.until(&phone, "document.getElementById('pixel-title').textContent === 'Pixel 32, 26'");
    browser.until(&phone, "document.querySelectorAll('#pixel-told circle').length === 4");
    browser.until(&phone, "document.querySelector('#pixel-told').textContent.includes('sRGB')");
    let wide = browser.run(&phone, "[document.documentElement.scrollWidth, innerWidth]");
    assert!(wide[0].as_f64() <= wide[1].as_f64(), "{wide}");
    // Settings are in the address.
    browser.call(Some(&desk), "Page.reload", json!({}));
    browser.until(&desk, "document.querySelector('[data-option=filter][data-side=b]').value === 'nearest'");
    browser.until(&desk, "document.getElementById('commands').textContent.includes('--filter nearest')");
    assert!(browser.complaints.is_empty(), "the console says {:#?}", browser.complaints);
}
