//! What the reader passed over. Input: remarks with their places, as they come up. Output: one sentence for each kind,
//! with how often it came up and where first.

/// Remarks on a file.
#[derive(Default)]
pub(super) struct Notes {
    kinds: Vec<Kind>,
}

/// One kind of remark.
struct Kind {
    what: &'static str,
    count: usize,
    place: String,
}

impl Notes {
    /// Adds a remark. The place is found only for the first of its kind.
    pub(super) fn add(&mut self, what: &'static str, place: impl FnOnce() -> String) {
        self.add_many(what, 1, place);
    }

    /// Adds a remark that comes up `count` times.
    pub(super) fn add_many(&mut self, what: &'static str, count: usize, place: impl FnOnce() -> String) {
        match self.kinds.iter_mut().find(|kind| kind.what == what) {
            Some(kind) => kind.count += count,
            None => self.kinds.push(Kind { what, count, place: place() }),
        }
    }

    /// Returns how often a remark came up.
    pub(super) fn count(&self, what: &str) -> usize {
        self.kinds.iter().find(|kind| kind.what == what).map_or(0, |kind| kind.count)
    }

    /// Returns the sentences.
    pub(super) fn sentences(self) -> impl Iterator<Item = String> {
        self.kinds.into_iter().map(|Kind { what, count, place }| match count {
            1 => format!("{what} (at {place})"),
            _ => format!("{what} ({count} times, first at {place})"),
        })
    }
}
