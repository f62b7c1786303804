//! `tab`: operations on a page. Evaluate script, click, press keys, wait for a condition, take a screenshot,
//! collect its errors.

use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::browser::{Browser, BrowserError};

/// A condition that does not come within this time never comes: a busy machine is no failure.
const GIVES_UP_AFTER: Duration = Duration::from_mins(5);

/// A page in the browser.
pub struct Tab<'b> {
    browser: &'b mut Browser,
    session: String,
}

impl<'b> Tab<'b> {
    pub(crate) fn new(
        browser: &'b mut Browser,
        session: String,
        url: &str,
        width: u32,
        height: u32,
    ) -> Result<Self, BrowserError> {
        let mut tab = Self { browser, session };
        for domain in ["Page.enable", "Runtime.enable", "Log.enable", "Network.enable"] {
            tab.ask(domain, &json!({}))?;
        }
        tab.resize(width, height, false)?;
        tab.go(url)?;
        Ok(tab)
    }

    fn ask(&mut self, method: &str, what: &Value) -> Result<Value, BrowserError> {
        self.browser.ask(Some(&self.session), method, what)
    }

    /// Loads an address, without waiting until it is loaded.
    pub fn go(&mut self, url: &str) -> Result<(), BrowserError> {
        self.ask("Page.navigate", &json!({ "url": url })).map(drop)
    }

    /// Changes its size, CSS pixels; as a telephone or as a screen.
    pub fn resize(&mut self, width: u32, height: u32, telephone: bool) -> Result<(), BrowserError> {
        let scale = if telephone { 2 } else { 1 };
        let what =
            json!({ "width": width, "height": height, "deviceScaleFactor": scale, "mobile": telephone });
        self.ask("Emulation.setDeviceMetricsOverride", &what).map(drop)
    }

    /// The value of a piece of script.
    pub fn eval(&mut self, script: &str) -> Result<Value, BrowserError> {
        let what = json!({ "expression": script, "returnByValue": true, "awaitPromise": true });
        let answer = self.ask("Runtime.evaluate", &what)?;
        match answer.get("exceptionDetails") {
            Some(details) => Err(BrowserError::Answer(format!("{script}: {details}"))),
            None => Ok(answer["result"]["value"].clone()),
        }
    }

    /// Waits until a piece of script is true: however busy the machine is, it must become so.
    pub fn wait(&mut self, script: &str) -> Result<(), BrowserError> {
        let begun = Instant::now();
        loop {
            // A page that is not loaded yet throws: that counts as false.
            let last = self.eval(&format!("Boolean({script})"));
            if matches!(last, Ok(Value::Bool(true))) {
                return Ok(());
            }
            if begun.elapsed() > GIVES_UP_AFTER {
                return Err(BrowserError::Answer(format!(
                    "`{script}` is not so after {} s: {last:?}",
                    GIVES_UP_AFTER.as_secs()
                )));
            }
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// Clicks on the middle of the first element of that selector, as a mouse does.
    pub fn click(&mut self, selector: &str) -> Result<(), BrowserError> {
        let at = self.middle(selector)?.map(|pixel| json!(pixel));
        self.mouse("mousePressed", &at[0], &at[1], 1)?;
        self.mouse("mouseReleased", &at[0], &at[1], 1)
    }

    /// Writes `text` instead of what is in a field, key by key, and leaves it.
    pub fn write(&mut self, selector: &str, text: &str) -> Result<(), BrowserError> {
        self.click(selector)?;
        // Backwards from its end: keys that select are not the same on every system.
        self.key("End")?;
        let script = format!("document.querySelector({selector:?}).value.length");
        for _ in 0..self.eval(&script)?.as_u64().unwrap_or(0) {
            self.key("Backspace")?;
        }
        for letter in text.chars() {
            self.key(letter.encode_utf8(&mut [0; 4]))?;
        }
        self.key("Tab")
    }

    /// Drags from one point to another, CSS pixels.
    pub fn drag(&mut self, from: [f64; 2], to: [f64; 2]) -> Result<(), BrowserError> {
        self.mouse("mousePressed", &json!(from[0]), &json!(from[1]), 1)?;
        for step in 1..=8 {
            let share = f64::from(step) / 8.0;
            let at = [0, 1].map(|i| from[i] + (to[i] - from[i]) * share);
            self.mouse("mouseMoved", &json!(at[0]), &json!(at[1]), 1)?;
            std::thread::sleep(Duration::from_millis(60));
        }
        self.mouse("mouseReleased", &json!(to[0]), &json!(to[1]), 1)
    }

    /// Emulates a touch screen with two points from now on.
    pub fn emulate_touch(&mut self) -> Result<(), BrowserError> {
        self.ask("Emulation.setTouchEmulationEnabled", &json!({ "enabled": true, "maxTouchPoints": 2 }))
            .map(drop)
    }

    /// Taps the middle of the first element of that selector with a finger.
    pub fn tap(&mut self, selector: &str) -> Result<(), BrowserError> {
        let at = self.middle(selector)?;
        self.tap_at(at)
    }

    /// Taps a point with a finger, CSS pixels.
    pub fn tap_at(&mut self, at: [f64; 2]) -> Result<(), BrowserError> {
        self.touch("touchStart", &[at])?;
        self.touch("touchEnd", &[])
    }

    /// Moves one finger or two, each from its first point to its second, CSS pixels.
    pub fn swipe(&mut self, ways: &[[[f64; 2]; 2]]) -> Result<(), BrowserError> {
        for step in 0..=8 {
            let share = f64::from(step) / 8.0;
            let at: Vec<_> =
                ways.iter().map(|[from, to]| [0, 1].map(|i| from[i] + (to[i] - from[i]) * share)).collect();
            self.touch(if step == 0 { "touchStart" } else { "touchMove" }, &at)?;
            std::thread::sleep(Duration::from_millis(60));
        }
        self.touch("touchEnd", &[])
    }

    fn touch(&mut self, kind: &str, at: &[[f64; 2]]) -> Result<(), BrowserError> {
        let points: Vec<_> =
            at.iter().enumerate().map(|(id, [x, y])| json!({ "x": x, "y": y, "id": id })).collect();
        self.ask("Input.dispatchTouchEvent", &json!({ "type": kind, "touchPoints": points })).map(drop)
    }

    /// The middle of the first element of that selector, scrolled into view, CSS pixels; once it lies in the
    /// same place in two frames: what a page shows for the first time moves what is below it.
    fn middle(&mut self, selector: &str) -> Result<[f64; 2], BrowserError> {
        let script = format!(
            "(async () => {{
              for (let before = '';;) {{
                const e = document.querySelector({selector:?});
                e.scrollIntoView({{ block: 'nearest' }});
                const b = e.getBoundingClientRect();
                const at = [b.x + b.width / 2, b.y + b.height / 2];
                if (String(at) === before) return at;
                before = String(at);
                await new Promise(requestAnimationFrame);
              }}
            }})()"
        );
        let at = self.eval(&script)?;
        match [at[0].as_f64(), at[1].as_f64()] {
            [Some(x), Some(y)] => Ok([x, y]),
            _ => Err(BrowserError::Answer(format!("{selector} lies at {at}"))),
        }
    }

    fn mouse(&mut self, kind: &str, x: &Value, y: &Value, buttons: u8) -> Result<(), BrowserError> {
        let what =
            json!({ "type": kind, "x": x, "y": y, "button": "left", "buttons": buttons, "clickCount": 1 });
        self.ask("Input.dispatchMouseEvent", &what).map(drop)
    }

    /// Presses a key of one letter, or one by its name, such as `Enter` and `ArrowLeft`.
    pub fn key(&mut self, key: &str) -> Result<(), BrowserError> {
        // What the browser itself does with a key goes by its code, which letters do without.
        let (text, code) = match key {
            "Enter" => ("\r", 13),
            " " => (" ", 32),
            "Backspace" => ("", 8),
            "Tab" => ("", 9),
            "End" => ("", 35),
            "Home" => ("", 36),
            "ArrowDown" => ("", 40),
            // A key with a name writes nothing.
            _ if key.len() > 1 => ("", 0),
            _ => (key, 0),
        };
        for kind in ["keyDown", "keyUp"] {
            let text = if kind == "keyDown" { text } else { "" };
            let what = json!({ "type": kind, "key": key, "text": text, "windowsVirtualKeyCode": code });
            self.ask("Input.dispatchKeyEvent", &what)?;
        }
        Ok(())
    }

    /// Writes a PNG screenshot.
    pub fn picture(&mut self, file: &Path) -> Result<(), BrowserError> {
        let answer = self.ask("Page.captureScreenshot", &json!({ "format": "png" }))?;
        let bytes = decode(answer["data"].as_str().unwrap_or_default());
        std::fs::write(file, bytes)
            .map_err(|error| BrowserError::Answer(format!("{}: {error}", file.display())))
    }

    /// Errors that the page has written to its console so far: exceptions, `console.error`, failed loads.
    pub fn errors(&mut self) -> Vec<String> {
        let mine = self.browser.events.iter().filter(|(session, ..)| *session == self.session);
        let reported = |(_, method, what): &(String, String, Value)| match method.as_str() {
            "Runtime.exceptionThrown" => Some(what["exceptionDetails"].to_string()),
            "Runtime.consoleAPICalled" if what["type"] == "error" => Some(what["args"].to_string()),
            "Log.entryAdded" if what["entry"]["level"] == "error" => Some(what["entry"].to_string()),
            _ => None,
        };
        mine.filter_map(reported).collect()
    }
}

/// Decodes Base64, the protocol's encoding of screenshots.
fn decode(text: &str) -> Vec<u8> {
    let value = |letter: u8| match letter {
        b'A'..=b'Z' => Some(letter - b'A'),
        b'a'..=b'z' => Some(letter - b'a' + 26),
        b'0'..=b'9' => Some(letter - b'0' + 52),
        b'+' => Some(62),
        b'/' => Some(63),
        _ => None,
    };
    let mut out = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut have) = (0_u32, 0);
    for six in text.bytes().filter_map(value) {
        bits = bits << 6 | u32::from(six);
        have += 6;
        if have >= 8 {
            have -= 8;
            out.push((bits >> have) as u8);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_decodes_the_examples_of_its_standard() {
        // RFC 4648, section 10.
        for (text, bytes) in
            [("", ""), ("Zg==", "f"), ("Zm8=", "fo"), ("Zm9v", "foo"), ("Zm9vYmFy", "foobar")]
        {
            assert_eq!(decode(text), bytes.as_bytes(), "{text}");
        }
    }
}
