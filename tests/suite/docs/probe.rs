//! What the reader of scenes says that it takes, asked by planted mistakes: the keys of a table from the error
//! about an unknown one, the values of a key from the error about a wrong one. In: a table's context. Out: keys
//! and values in the reader's own words, so that no table of the code is copied here.

use std::path::Path;

use moire::internal::core::error::Error;
use moire::internal::scene::model::Scene;
use moire::internal::scene::{Reading, Setting, parse, parse_as};

/// A table of the format, with the least that it takes to be read.
pub struct Context {
    /// The heading of its table in the reference.
    pub heading: &'static str,
    /// Its header: `[camera]`, `[[plane]]`.
    pub header: &'static str,
    /// Keys that it needs, with values.
    pub body: &'static [(&'static str, &'static str)],
    /// For an inline table: the key of the table above that holds it, and what it needs itself.
    pub inline: Option<(&'static str, &'static [(&'static str, &'static str)])>,
    /// (key, what has to stand beside it)
    pub beside: &'static [(&'static str, &'static [(&'static str, &'static str)])],
    /// (key, what must not stand beside it)
    pub without: &'static [(&'static str, &'static str)],
    /// A key whose words decide which other keys there are.
    pub kinds: Option<&'static str>,
}

const REST: [(&str, &str); 3] = [
    ("[camera]", "eye = [0.0, 0.0, 1.0]\nlook_at = [0.0, 0.0, 0.0]\nvertical_fov = 40.0\n"),
    ("[image]", "width = 4\nheight = 4\n"),
    ("[[texture]]", "name = \"t\"\nfile = \"t.png\"\n"),
];

/// A word that no vocabulary has.
pub const NO_WORD: &str = "\"?\"";

impl Context {
    /// Returns the scene with `key = value` in the table, in place of what is there; without a value the key is left out.
    fn scene(&self, kind: Option<&str>, key: &str, value: Option<&str>) -> String {
        let own = self.inline.map_or(self.body, |(_, inner)| inner);
        let beside = self.beside.iter().filter(|(k, _)| *k == key).flat_map(|(_, b)| b.iter().copied());
        let mut entries: Vec<(&str, String)> = own
            .iter()
            .copied()
            .chain(beside)
            .filter(|(k, _)| *k != key && !self.without.contains(&(key, k)))
            .map(|(k, v)| (k, v.to_string()))
            .collect();
        if let (Some(kind), Some(kinds)) = (kind, self.kinds.filter(|kinds| *kinds != key)) {
            entries.retain(|(k, _)| *k != kinds);
            entries.push((kinds, format!("\"{kind}\"")));
        }
        entries.extend(value.map(|value| (key, value.to_string())));
        let lines = |entries: &[(&str, String)], end: &str| {
            entries.iter().map(|(k, v)| format!("{} = {v}", quoted(k))).collect::<Vec<_>>().join(end)
        };
        let table = match self.inline {
            None => lines(&entries, "\n"),
            Some((holder, _)) => {
                let mut outer: Vec<(&str, String)> =
                    self.body.iter().map(|(k, v)| (*k, v.to_string())).collect();
                outer.push((holder, format!("{{ {} }}", lines(&entries, ", "))));
                lines(&outer, "\n")
            }
        };
        let rest = REST.iter().filter(|(header, _)| *header != self.header || header.starts_with("[["));
        let rest: String = rest.map(|(header, body)| format!("{header}\n{body}")).collect();
        format!("{rest}{}\n{table}\n", self.header)
    }

    /// Returns what the reader says of that scene, if it refuses it.
    pub fn error(&self, kind: Option<&str>, key: &str, value: Option<&str>) -> Option<String> {
        parse(Path::new("scene.toml"), &self.scene(kind, key, value)).err().map(|e| e.to_string())
    }

    /// Returns the words that a key takes, as TOML has them.
    pub fn words_of(&self, key: &str) -> Vec<String> {
        let able = self.able(key);
        let kind = able.first().filter(|_| able.len() < self.words().len()).map(String::as_str);
        let told = self.error(kind, key, Some(NO_WORD)).filter(|told| told.contains("unknown value"));
        told.map_or(Vec::new(), |told| listed(&told)).iter().map(|word| format!("\"{word}\"")).collect()
    }

    /// Returns what a setting of a key says of the scene, and what the file says with the same value, of the first kind that
    /// has the key.
    pub fn set_and_written(&self, key: &str, value: &str) -> [Result<String, String>; 2] {
        let able = self.able(key);
        let kind = able.first().filter(|_| able.len() < self.words().len()).map(String::as_str);
        let header = self.header.trim_matches(['[', ']']);
        let item = match (self.header.starts_with("[["), header) {
            (false, _) => header.to_owned(),
            // Behind that of the rest of the scene.
            (true, "texture") => "texture.1".to_owned(),
            (true, _) => format!("{header}.0"),
        };
        let holder = self.inline.map_or(String::new(), |(holder, _)| format!("{holder}."));
        let setting = Setting::parse(&format!("{item}.{holder}{}={value}", quoted(key))).unwrap();
        let reading = Reading { settings: &[setting], ..Reading::default() };
        let path = Path::new("scene.toml");
        let of = |scene: Result<Scene, Error>| {
            let scene = scene.map(|scene| format!("{:?}", Scene { settings: Vec::new(), ..scene }));
            scene.map_err(|error| error.to_string())
        };
        let (without, with) = (self.scene(kind, key, None), self.scene(kind, key, Some(value)));
        [of(parse_as(path, &without, &reading)), of(parse(path, &with))]
    }

    /// Returns the scene as it is read, of the first kind that has the key.
    pub fn read(&self, key: &str, value: Option<&str>) -> Option<String> {
        let able = self.able(key);
        let kind = able.first().filter(|_| able.len() < self.words().len());
        let text = self.scene(kind.map(String::as_str), key, value);
        parse(Path::new("scene.toml"), &text).ok().map(|scene| format!("{scene:?}"))
    }

    /// Returns the keys that the table may have, in the code's order. Those of another kind of table of the same name,
    /// which stand in a table of their own in the reference, are left out.
    pub fn keys(&self) -> Vec<String> {
        let told = self.error(None, "?", Some("1")).unwrap_or_default();
        let is_known = |key: &String| {
            let of =
                |kind: Option<&str>| self.error(kind, key, Some(NO_WORD)).is_some_and(|e| is_unknown(&e));
            !of(None) || self.words().iter().any(|kind| !of(Some(kind)))
        };
        listed(&told).into_iter().filter(is_known).collect()
    }

    /// Returns the words of the key that decides.
    fn words(&self) -> Vec<String> {
        self.kinds.and_then(|key| self.error(None, key, Some(NO_WORD))).map_or(Vec::new(), |e| listed(&e))
    }

    /// Returns the kinds that have a key.
    fn able(&self, key: &str) -> Vec<String> {
        let has = |kind: &String| !self.error(Some(kind), key, Some(NO_WORD)).is_some_and(|e| is_refused(&e));
        self.words().into_iter().filter(has).collect()
    }

    /// Returns what a key takes, as the reference states it; of some kinds only where it is so.
    pub fn values(&self, key: &str) -> String {
        let able = self.able(key);
        if able.len() == self.words().len() {
            return self.values_of(None, key);
        }
        let kinds: Vec<String> = able.iter().map(|kind| format!("`{kind}`")).collect();
        format!("of {}: {}", kinds.join(", "), self.values_of(able.first().map(String::as_str), key))
    }

    fn values_of(&self, kind: Option<&str>, key: &str) -> String {
        let Some(told) = self.error(kind, key, Some(NO_WORD)) else { return "a string".into() };
        if told.contains("unknown value") {
            return listed(&told).iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ");
        }
        if let Some((_, rest)) = told.split_once("no [[") {
            return format!("the name of a `[[{}]]`", rest.split("]]").next().unwrap_or(""));
        }
        let wanted = expected(&told).unwrap_or_else(|| panic!("{} {key}: {told}", self.heading));
        // What is a number, but not one that the key takes, is answered with its limits.
        let count = wanted.split_once(" finite numbers").map(|(n, _)| n.parse::<usize>().unwrap_or(0));
        let tried = |number: &str| match count {
            Some(n @ 1..) => Some(format!("[{}]", vec![number; n].join(", "))),
            None if wanted == "a finite number" => Some(number.to_string()),
            _ => None,
        };
        let limits = |number| {
            let told = self.error(kind, key, Some(&tried(number)?))?;
            expected(&told).filter(|said| said != &wanted)
        };
        let said: Option<String> = ["-1e31", "1e31", "0"].into_iter().find_map(limits);
        let zero = if count == Some(3) { limits("0").filter(|s| s.contains("not zero")) } else { None };
        let said = said.unwrap_or(wanted);
        zero.map_or(said.clone(), |_| format!("{said}, not all 0"))
    }

    /// Tells whether the reader asks for this key alone where it is missing.
    pub fn is_required(&self, key: &str) -> bool {
        let told = self.error(None, key, None).unwrap_or_default();
        told.contains("is missing in ") && !told.contains("give ") && told.contains(&format!(".{key}\""))
    }
}

fn quoted(key: &str) -> String {
    if key.chars().all(|c| c.is_alphanumeric() || c == '_') { key.into() } else { format!("{key:?}") }
}

/// Returns the names after "allowed:".
pub fn listed(told: &str) -> Vec<String> {
    let list = told.split_once("allowed: ").map_or("", |(_, list)| list);
    let line = list.lines().next().unwrap_or("");
    line.split(", ").filter(|word| !word.is_empty()).map(String::from).collect()
}

fn expected(told: &str) -> Option<String> {
    let (_, rest) = told.split_once("expected ")?;
    Some(rest.split(", found ").next().unwrap_or(rest).to_string())
}

fn is_unknown(told: &str) -> bool {
    told.contains("unknown key") || told.contains("keep procedural or this")
}

/// Tells whether the key is not one of this kind of table.
fn is_refused(told: &str) -> bool {
    is_unknown(told)
        || told.contains("; this one is")
        || told.contains(" has it")
        || told.contains(" have it")
}
