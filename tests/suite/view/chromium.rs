//! Headless Chromium, spoken to by its protocol over pipes: pages are opened, expressions evaluated, and mouse, touch and keys
//! are those of a person, not events that a script makes. What the console says is kept.

use std::io::{BufRead, BufReader, Write};
use std::process::{ChildStdin, ChildStdout, Command, Stdio};

use serde_json::{Value, json};
use tempfile::{TempDir, tempdir};

use crate::child::Running;

/// A browser, spoken to by JSON with zeros between messages.
pub struct Browser {
    _process: Running,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    number: u64,
    pub complaints: Vec<String>,
    _profile: TempDir,
}

impl Browser {
    pub fn start() -> Browser {
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

    pub fn call(&mut self, session: Option<&str>, method: &str, params: Value) -> Value {
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
    pub fn open(&mut self, address: &str, width: u32, dark: bool) -> String {
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
    pub fn run(&mut self, session: &str, expression: &str) -> Value {
        let params = json!({ "expression": expression, "awaitPromise": true, "returnByValue": true });
        let result = self.call(Some(session), "Runtime.evaluate", params);
        assert!(result["exceptionDetails"].is_null(), "{expression}: {result}");
        result["result"]["value"].clone()
    }

    /// Waits until an expression is true, and returns it.
    pub fn until(&mut self, session: &str, expression: &str) -> Value {
        let poll = format!(
            "(async () => {{ for (let i = 0; i < 6000; i += 1) {{ let v = null; try {{ v = {expression}; }} catch {{ v = null; }} \
             if (v) return v; await new Promise((done) => setTimeout(done, 50)); }} return null; }})()"
        );
        let value = self.run(session, &poll);
        assert!(!value.is_null(), "never: {expression}; {:#?}", self.complaints);
        value
    }

    /// Clicks in the middle of the first element of a selector.
    pub fn click(&mut self, session: &str, selector: &str) {
        let [x, y] = self.middle(session, selector);
        for kind in ["mousePressed", "mouseReleased"] {
            let event = json!({ "type": kind, "x": x, "y": y, "button": "left", "clickCount": 1 });
            self.call(Some(session), "Input.dispatchMouseEvent", event);
        }
    }

    /// Scrolls to the first element of a selector, and returns its middle.
    pub fn middle(&mut self, session: &str, selector: &str) -> [f64; 2] {
        let middle = self.run(
            session,
            &format!(
                "(() => {{ const own = document.querySelector('{selector}'); own.scrollIntoView({{ block: 'center' }}); \
                 const box = own.getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; }})()"
            ),
        );
        [0, 1].map(|i| middle[i].as_f64().unwrap())
    }

    /// Presses a key where the focus is.
    pub fn press(&mut self, session: &str, key: &str) {
        let code = match key {
            "Tab" => 9,
            "Enter" => 13,
            "ArrowLeft" => 37,
            "ArrowRight" => 39,
            "End" => 35,
            _ => 0,
        };
        let text = match key {
            "Enter" => "\r",
            _ if key.chars().count() == 1 => key,
            _ => "",
        };
        let down = if text.is_empty() { "rawKeyDown" } else { "keyDown" };
        for kind in [down, "keyUp"] {
            let mut event = json!({ "type": kind, "key": key, "windowsVirtualKeyCode": code });
            if kind == "keyDown" {
                event["text"] = text.into();
            }
            self.call(Some(session), "Input.dispatchKeyEvent", event);
        }
    }

    /// Presses Tab until an expression of the element with the focus, `own`, is true.
    pub fn tab_to(&mut self, session: &str, wanted: &str) {
        for _ in 0..120 {
            self.press(session, "Tab");
            let found =
                format!("(() => {{ const own = document.activeElement; return Boolean({wanted}); }})()");
            if self.run(session, &found) == true {
                return;
            }
        }
        panic!("Tab never comes to {wanted}");
    }

    /// Touches a page with fingers, each at a place; none lets go.
    pub fn touch(&mut self, session: &str, kind: &str, places: &[[f64; 2]]) {
        let points: Vec<Value> =
            places.iter().enumerate().map(|(id, [x, y])| json!({ "x": x, "y": y, "id": id })).collect();
        self.call(Some(session), "Input.dispatchTouchEvent", json!({ "type": kind, "touchPoints": points }));
    }
}
