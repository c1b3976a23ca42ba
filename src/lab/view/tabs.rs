//! The tabs of browsers that show the page, each with two settings of its own. A tab begins with its stream of events
//! and ends with it; its pictures are then rendered no further.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::files::check_files;
use super::queue::Queue;
use super::refinement::Refinement;
use super::settings::{Settings, Source};
use crate::core::error::{Error, Result};
use crate::output::DisplayTransform;
use crate::scene::Setting;

/// Tabs at once.
const MAX_TABS: usize = 16;
/// The longest time between two events, by which a closed tab is noticed.
const HEARTBEAT: Duration = Duration::from_secs(1);
/// The shortest time between two events: a browser draws no faster.
const PACE: Duration = Duration::from_millis(30);
/// Digits of a tab's name.
const NAME_DIGITS: usize = 64;

/// What a side shows: a film that refines, which is that of the other side where the settings of both ask for the same
/// one, and how its light becomes that of a screen.
#[derive(Clone)]
pub struct Side {
    pub refinement: Arc<Refinement>,
    pub display: DisplayTransform,
    settings: Settings,
}

impl Side {
    /// Returns the arguments of `moire render` for its picture of a number of samples.
    pub fn arguments(&self, source: &Source, count: u32) -> Vec<String> {
        self.settings.arguments(source, count)
    }
}

/// A tab and its sides.
struct Tab {
    name: String,
    sides: [Side; 2],
    /// Streams of events that show it: two while a browser opens a new one before the old one is noticed to have ended.
    streams: usize,
}

/// All tabs.
pub struct Tabs {
    source: Source,
    first: Settings,
    queue: Arc<Queue>,
    tabs: Mutex<Vec<Tab>>,
    /// Counts changes of anything that a page shows.
    version: Mutex<u64>,
    changed: Condvar,
}

impl Tabs {
    /// Returns no tabs; new ones begin with these settings.
    pub fn new(source: Source, first: Settings, queue: Arc<Queue>) -> Tabs {
        Tabs {
            source,
            first,
            queue,
            tabs: Mutex::default(),
            version: Mutex::default(),
            changed: Condvar::new(),
        }
    }

    fn tabs(&self) -> MutexGuard<'_, Vec<Tab>> {
        self.tabs.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Wakes all streams.
    pub fn notify(&self) {
        *self.version.lock().unwrap_or_else(PoisonError::into_inner) += 1;
        self.changed.notify_all();
    }

    /// Returns what every page shows: scene and first settings.
    pub fn source(&self) -> &Source {
        &self.source
    }

    pub fn first(&self) -> &Settings {
        &self.first
    }

    /// Opens a tab, or one more stream of it; returns its events.
    pub fn open(self: &Arc<Self>, name: &str) -> Result<Events> {
        if name.is_empty()
            || name.len() > NAME_DIGITS
            || !name.bytes().all(|byte| byte.is_ascii_alphanumeric())
        {
            return Err(Error::new("a tab's name has 1 to 64 letters and digits"));
        }
        // Reading the scene takes its time, in which other tabs go on.
        let is_open = self.tabs().iter().any(|tab| tab.name == name);
        let resolved = (!is_open).then(|| self.first.resolve(&self.source)).transpose()?;
        let display = self.first.display()?;
        let mut tabs = self.tabs();
        match (tabs.iter().position(|tab| tab.name == name), resolved) {
            (Some(at), _) => tabs[at].streams += 1,
            (None, Some(_)) if tabs.len() >= MAX_TABS => {
                return Err(Error::new(format!("{MAX_TABS} tabs are open, the most at once: close one")));
            }
            (None, Some(resolved)) => {
                let refinement = Arc::new(Refinement::new(self.first.of_film(), resolved));
                self.queue.push(refinement.clone());
                let side = Side { refinement, display, settings: self.first.clone() };
                tabs.push(Tab { name: name.into(), sides: [side.clone(), side], streams: 1 });
            }
            (None, None) => return Err(Error::new("this tab has just been closed")),
        }
        Ok(Events { tabs: self.clone(), name: name.into(), seen: None, last: String::new() })
    }

    fn close(&self, name: &str) {
        let mut tabs = self.tabs();
        if let Some(at) = tabs.iter().position(|tab| tab.name == name) {
            tabs[at].streams -= 1;
            if tabs[at].streams == 0 {
                tabs.remove(at).sides.iter().for_each(|side| side.refinement.cancel());
            }
        }
    }

    /// Returns a side, 0 or 1.
    pub fn side(&self, name: &str, side: usize) -> Option<Side> {
        self.tabs().iter().find(|tab| tab.name == name)?.sides.get(side).cloned()
    }

    /// Gives a side other settings. A film that either side has is kept, and shown as they say; one that no side shows
    /// any more is rendered no further. Returns the film's number.
    pub fn set(&self, name: &str, side: usize, settings: Settings) -> Result<u64> {
        let gone = || Error::new("this tab is not open");
        let own = self.side(name, side).ok_or_else(gone)?;
        if own.settings == settings && own.refinement.is_usable() {
            return Ok(own.refinement.number);
        }
        let is_new = |text: &&String| !self.first.set.contains(text);
        for text in settings.set.iter().filter(is_new) {
            check_files(&Setting::parse(text)?, &self.source)?;
        }
        let (display, of_film) = (settings.display()?, settings.of_film());
        let mut resolved = None;
        let number = loop {
            let mut tabs = self.tabs();
            let tab = tabs.iter_mut().find(|tab| tab.name == name).ok_or_else(gone)?;
            let films = tab.sides.iter().map(|side| &side.refinement);
            let mut known = films.filter(|film| film.settings == of_film && film.is_usable());
            let refinement = match (known.next().cloned(), resolved.take()) {
                (Some(known), _) => known,
                (None, Some(resolved)) => {
                    let fresh = Arc::new(Refinement::new(of_film.clone(), resolved));
                    self.queue.push(fresh.clone());
                    fresh
                }
                (None, None) => {
                    // Reading the scene takes its time, in which other tabs go on.
                    drop(tabs);
                    resolved = Some(of_film.resolve(&self.source)?);
                    continue;
                }
            };
            let number = refinement.number;
            let old = std::mem::replace(&mut tab.sides[side], Side { refinement, display, settings });
            if tab.sides.iter().all(|side| side.refinement.number != old.refinement.number) {
                old.refinement.cancel();
            }
            break number;
        };
        self.notify();
        Ok(number)
    }

    /// Exchanges the sides of a tab.
    pub fn swap(&self, name: &str) -> Result<()> {
        let mut tabs = self.tabs();
        let tab = tabs.iter_mut().find(|tab| tab.name == name);
        tab.ok_or_else(|| Error::new("this tab is not open"))?.sides.reverse();
        drop(tabs);
        self.notify();
        Ok(())
    }

    /// Returns what a tab shows.
    fn described(&self, name: &str) -> Option<Value> {
        let sides = self.tabs().iter().find(|tab| tab.name == name)?.sides.clone();
        let described = sides.each_ref().map(|side| {
            let mut described = side.refinement.described();
            let count = side.refinement.shown().map(|shown| shown.count);
            described["command"] = count.map(|count| side.settings.command(&self.source, count)).into();
            described["display"] = side.settings.display_words().into();
            described
        });
        let [a, b] = &sides;
        Some(json!({ "sides": described, "difference": a.refinement.difference(&b.refinement) }))
    }
}

/// What happens in a tab, as JSON. Waits between events; an empty one says that nothing has happened for a while.
pub struct Events {
    tabs: Arc<Tabs>,
    name: String,
    /// The version of the last event.
    seen: Option<u64>,
    last: String,
}

impl Iterator for Events {
    type Item = String;

    fn next(&mut self) -> Option<String> {
        if self.seen.is_some() {
            std::thread::sleep(PACE);
        }
        let start = Instant::now();
        let mut version = self.tabs.version.lock().unwrap_or_else(PoisonError::into_inner);
        while self.seen == Some(*version) {
            let left = HEARTBEAT.saturating_sub(start.elapsed());
            if left.is_zero() {
                return Some(String::new());
            }
            version = self.tabs.changed.wait_timeout(version, left).unwrap_or_else(PoisonError::into_inner).0;
        }
        self.seen = Some(*version);
        drop(version);
        let text = self.tabs.described(&self.name)?.to_string();
        // Others' changes wake this stream, too.
        if text == self.last {
            return Some(String::new());
        }
        self.last.clone_from(&text);
        Some(text)
    }
}

impl Drop for Events {
    fn drop(&mut self) {
        self.tabs.close(&self.name);
    }
}
