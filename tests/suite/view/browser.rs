//! The page in headless Chromium, where `chromium` is installed, by its protocol over pipes: pictures arrive, a menu changes
//! them, keys move wipe and crosshair, nothing is wider than a phone, and the console is silent. Two tabs at once.

use std::io::{BufRead, BufReader, Write};
use std::process::{ChildStdin, ChildStdout, Command, Stdio};

use serde_json::{Value, json};
use tempfile::{TempDir, tempdir};

use super::View;
use crate::browser::{brightness, is_installed};
use crate::child::Running;

/// A browser, spoken to by JSON with zeros between messages.
struct Browser {
    _process: Running,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    number: u64,
    complaints: Vec<String>,
    _profile: TempDir,
}

impl Browser {
    fn start() -> Browser {
        let profile = tempdir().unwrap();
        // Its pipes are the descriptors 3 and 4.
        let line = "exec chromium --headless=new --no-sandbox --disable-gpu --disable-dev-shm-usage --remote-debugging-pipe \
                    --user-data-dir=\"$0\" about:blank 3<&0 4>&1 </dev/null >/dev/null 2>&1";
        let mut command = Command::new("bash");
        command.args(["-c", line]).arg(profile.path()).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut process = Running::start(&mut command);
        let (to, from) = process.pipes();
        let from = BufReader::new(from);
        Browser { _process: process, to, from, number: 0, complaints: Vec::new(), _profile: profile }
    }

    fn call(&mut self, session: Option<&str>, method: &str, params: Value) -> Value {
        self.number += 1;
        let mut message = json!({ "id": self.number, "method": method, "params": params });
        if let Some(session) = session {
            message["sessionId"] = session.into();
        }
        self.to.write_all(format!("{message}\0").as_bytes()).unwrap();
        loop {
            let mut bytes = Vec::new();
            self.from.read_until(0, &mut bytes).unwrap();
            assert_eq!(bytes.pop(), Some(0), "the browser has ended");
            let answer: Value = serde_json::from_slice(&bytes).unwrap();
            if answer["id"] == self.number {
                assert!(answer["error"].is_null(), "{method}: {answer}");
                return answer["result"].clone();
            }
            let is_complaint = match answer["method"].as_str() {
                Some("Runtime.exceptionThrown" | "Runtime.consoleAPICalled") => true,
                Some("Log.entryAdded") => answer["params"]["entry"]["level"] != "verbose",
                _ => false,
            };
            if is_complaint {
                self.complaints.push(answer.to_string());
            }
        }
    }

    /// Opens a page as wide as that; returns its session.
    fn open(&mut self, address: &str, width: u32, dark: bool) -> String {
        let target =
            self.call(None, "Target.createTarget", json!({ "url": "about:blank" }))["targetId"].clone();
        let attach = json!({ "targetId": target, "flatten": true });
        let session =
            self.call(None, "Target.attachToTarget", attach)["sessionId"].as_str().unwrap().to_owned();
        for domain in ["Runtime.enable", "Log.enable", "Page.enable"] {
            self.call(Some(&session), domain, json!({}));
        }
        let size = json!({ "width": width, "height": 900, "deviceScaleFactor": 1, "mobile": false });
        self.call(Some(&session), "Emulation.setDeviceMetricsOverride", size);
        let scheme = if dark { "dark" } else { "light" };
        let media = json!({ "features": [{ "name": "prefers-color-scheme", "value": scheme }] });
        self.call(Some(&session), "Emulation.setEmulatedMedia", media);
        self.call(Some(&session), "Page.navigate", json!({ "url": address }));
        session
    }

    /// Evaluates an expression, a promise too, and returns its value.
    fn run(&mut self, session: &str, expression: &str) -> Value {
        let params = json!({ "expression": expression, "awaitPromise": true, "returnByValue": true });
        let result = self.call(Some(session), "Runtime.evaluate", params);
        assert!(result["exceptionDetails"].is_null(), "{expression}: {result}");
        result["result"]["value"].clone()
    }

    /// Waits until an expression is true, and returns it.
    fn until(&mut self, session: &str, expression: &str) -> Value {
        let poll = format!(
            "(async () => {{ for (let i = 0; i < 6000; i += 1) {{ let v = null; try {{ v = {expression}; }} catch {{ v = null; }} \
             if (v) return v; await new Promise((done) => setTimeout(done, 50)); }} return null; }})()"
        );
        let value = self.run(session, &poll);
        assert!(!value.is_null(), "never: {expression}; {:#?}", self.complaints);
        value
    }
}

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
