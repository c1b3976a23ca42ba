//! Layer selection in OpenEXR files. Chooses the part and the channels of one layer from the
//! headers of the parts and an optional layer name, or returns an error that lists the layers.
//!
//! A layer is the set of channels of one part that share the name before the last dot
//! (`diffuse.R`); the part's name is prefixed if there are several parts.

use std::path::Path;

use exr::meta::header::Header;

use crate::core::error::{Error, Result};

/// The largest number of layers that a message lists.
const MAX_LISTED: usize = 12;

/// The channels of a layer as indices into the channels of one part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Colors {
    Grey(usize),
    /// Red, green and blue; also positions and directions X, Y and Z.
    Rgb([usize; 3]),
    /// Luminance Y with chroma RY and BY.
    LuminanceChroma([usize; 3]),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Layer {
    pub part: usize,
    pub colors: Colors,
    pub alpha: Option<usize>,
}

impl Layer {
    /// Returns the file's channel for each channel of a texel, without those that the file lacks.
    pub fn channels(&self) -> Vec<usize> {
        let colors = match &self.colors {
            Colors::Grey(channel) => std::slice::from_ref(channel),
            Colors::Rgb(channels) | Colors::LuminanceChroma(channels) => channels,
        };
        colors.iter().copied().chain(self.alpha).collect()
    }
}

/// The channels that share part and prefix.
struct Group {
    part: usize,
    part_name: Option<String>,
    /// Part and prefix as a scene names them; empty for channels without either.
    name: String,
    prefix: String,
    /// The channel's name after the prefix, and its index.
    channels: Vec<(String, usize)>,
}

/// Returns the layer of this name; without a name the only layer with colours, or the unnamed one.
pub(super) fn choose(headers: &[Header], wanted: Option<&str>, path: &Path) -> Result<Layer> {
    let groups = groups(headers);
    match wanted {
        Some(wanted) => named(&groups, wanted, path),
        None => unnamed(&groups, path),
    }
}

/// Returns the names of the layers that have colours.
pub(super) fn colored(headers: &[Header]) -> Vec<String> {
    groups(headers).into_iter().filter(|group| group.colors().is_some()).map(|group| group.name).collect()
}

fn groups(headers: &[Header]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (part, header) in headers.iter().enumerate() {
        let part_name = header.own_attributes.layer_name.as_ref().map(ToString::to_string);
        for (index, channel) in header.channels.list.iter().enumerate() {
            let full = channel.name.to_string();
            let (prefix, base) = full.rsplit_once('.').unwrap_or(("", &full));
            let same = groups.iter_mut().find(|g| g.part == part && g.prefix == prefix);
            if let Some(group) = same {
                group.channels.push((base.to_owned(), index));
                continue;
            }
            let of_part = part_name.clone().filter(|_| headers.len() > 1).unwrap_or_default();
            groups.push(Group {
                part,
                part_name: part_name.clone(),
                name: joined(&of_part, prefix),
                prefix: prefix.to_owned(),
                channels: vec![(base.to_owned(), index)],
            });
        }
    }
    groups
}

/// Joins the names of part and prefix, omitting the part's name if the prefix repeats it.
fn joined(part: &str, prefix: &str) -> String {
    let repeats = prefix.strip_prefix(part).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
    match (part, prefix) {
        ("", _) => prefix.to_owned(),
        (_, "") => part.to_owned(),
        _ if repeats => prefix.to_owned(),
        _ => format!("{part}.{prefix}"),
    }
}

impl Group {
    fn find(&self, names: &[&str]) -> Option<usize> {
        let is_one = |base: &str| names.iter().any(|name| base.eq_ignore_ascii_case(name));
        self.channels.iter().find(|(base, _)| is_one(base)).map(|(_, index)| *index)
    }

    fn find_three(&self, names: [&[&str]; 3]) -> Option<[usize; 3]> {
        let [first, second, third] = names.map(|names| self.find(names));
        Some([first?, second?, third?])
    }

    /// Returns the layer that the channel names form, or `None` if they are no colour channels.
    fn colors(&self) -> Option<Layer> {
        const RGB: [&[&str]; 3] = [&["R", "red"], &["G", "green"], &["B", "blue"]];
        let has = |name| self.find(&[name]).is_some();
        let colors =
            if let Some(rgb) = self.find_three(RGB).or_else(|| self.find_three([&["X"], &["Y"], &["Z"]])) {
                Colors::Rgb(rgb)
            } else if let Some(ryb) = self.find_three([&["Y"], &["RY"], &["BY"]]) {
                Colors::LuminanceChroma(ryb)
            } else if has("X") || has("RY") || has("BY") {
                return None;
            } else {
                Colors::Grey(self.find(&["Y"])?)
            };
        Some(Layer { part: self.part, colors, alpha: self.alpha() })
    }

    /// Like [`colors`](Self::colors), but a single channel of any name counts as grey.
    fn colors_or_one(&self) -> Option<Layer> {
        let alpha = self.alpha();
        let mut others = self.channels.iter().map(|(_, index)| *index).filter(|i| Some(*i) != alpha);
        let lone = match (others.next(), others.next()) {
            (Some(channel), None) => Some(Layer { part: self.part, colors: Colors::Grey(channel), alpha }),
            _ => None,
        };
        self.colors().or(lone)
    }

    fn alpha(&self) -> Option<usize> {
        self.find(&["A", "alpha"])
    }

    /// Returns true if `wanted` is the layer's full name or the part of it that identifies it.
    fn is_called(&self, wanted: &str) -> bool {
        let of_part = self.prefix.is_empty() && self.part_name.as_deref() == Some(wanted);
        self.name == wanted || self.prefix == wanted || of_part
    }

    /// Returns a description for messages: the name, or its absence, and the channels.
    fn described(&self) -> String {
        let bases: Vec<&str> = self.channels.iter().map(|(base, _)| base.as_str()).collect();
        let name =
            if self.name.is_empty() { "one without a name".into() } else { format!("\"{}\"", self.name) };
        format!("{name} ({})", bases.join(", "))
    }
}

fn unnamed(groups: &[Group], path: &Path) -> Result<Layer> {
    let colored: Vec<(&Group, Layer)> = groups.iter().filter_map(|g| Some((g, g.colors()?))).collect();
    let plain = || colored.iter().filter(|(group, _)| group.prefix.is_empty());
    let in_color = || plain().filter(|(_, layer)| !matches!(layer.colors, Colors::Grey(_)));
    for (count, first) in [
        (colored.len(), colored.first()),
        (in_color().count(), in_color().next()),
        (plain().count(), plain().next()),
    ] {
        if let (1, Some((_, layer))) = (count, first) {
            return Ok(*layer);
        }
    }
    if colored.is_empty() {
        return Err(no_colors(groups, path));
    }
    Err(Error::with_help(
        format!("{}: the file has several layers: {}", path.display(), listed(groups)),
        "choose one by its name: layer = \"…\" in [[texture]]",
    ))
}

fn named(groups: &[Group], wanted: &str, path: &Path) -> Result<Layer> {
    let shown = path.display();
    let exact: Vec<&Group> = groups.iter().filter(|g| g.name == wanted).collect();
    let called: Vec<&Group> = groups.iter().filter(|g| g.is_called(wanted)).collect();
    match (exact.as_slice(), called.as_slice()) {
        ([group], _) | ([], [group]) => group.colors_or_one().ok_or_else(|| {
            Error::with_help(
                format!("{shown}: the channels of layer {} are no colours together", group.described()),
                "choose one channel: layer = \"NAME\" with its whole name reads it as grey",
            )
        }),
        ([], []) => channel(groups, wanted, path),
        ([], several) | (several, _) => {
            Err(ambiguous(wanted, several.iter().map(|g| g.name.clone()).collect(), path))
        }
    }
}

/// Returns one channel as grey by its name in the file, optionally prefixed with the part's name.
fn channel(groups: &[Group], wanted: &str, path: &Path) -> Result<Layer> {
    let all =
        groups.iter().flat_map(|group| group.channels.iter().map(move |(base, index)| (group, base, *index)));
    let called = all.filter(|(group, base, _)| {
        joined(&group.name, base) == wanted || joined(&group.prefix, base) == wanted
    });
    match called.collect::<Vec<_>>().as_slice() {
        [(group, _, index)] => Ok(Layer { part: group.part, colors: Colors::Grey(*index), alpha: None }),
        [] => {
            let near = near(wanted, groups.iter().map(|g| g.name.as_str()));
            let end = if near.is_empty() { ";" } else { "" };
            Err(Error::with_help(
                format!(
                    "{}: no layer is named \"{wanted}\"{near}{end} its layers: {}",
                    path.display(),
                    listed(groups)
                ),
                "name one of them, or a single channel, which is read as grey",
            ))
        }
        several => {
            Err(ambiguous(wanted, several.iter().map(|(g, base, _)| joined(&g.name, base)).collect(), path))
        }
    }
}

fn ambiguous(wanted: &str, names: Vec<String>, path: &Path) -> Error {
    Error::with_help(
        format!("{}: \"{wanted}\" may mean each of {}", path.display(), names.join(", ")),
        "give the whole name of one",
    )
}

fn listed(groups: &[Group]) -> String {
    let names: Vec<String> = groups.iter().take(MAX_LISTED).map(Group::described).collect();
    let rest = match groups.len().saturating_sub(MAX_LISTED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    names.join(", ") + &rest
}

/// Returns a suggestion of the most similar name, if there is one.
fn near<'a>(wanted: &str, names: impl Iterator<Item = &'a str>) -> String {
    let wanted = wanted.to_lowercase();
    let scored = names.map(|name| (strsim::jaro_winkler(&wanted, &name.to_lowercase()), name));
    match scored.max_by(|a, b| a.0.total_cmp(&b.0)) {
        Some((score, name)) if score > 0.85 => format!("; did you mean \"{name}\"?"),
        _ => String::new(),
    }
}

fn no_colors(groups: &[Group], path: &Path) -> Error {
    let channels = |group: &Group| -> Vec<String> {
        group.channels.iter().map(|(base, _)| joined(&group.name, base)).collect()
    };
    let names: Vec<String> = groups.iter().flat_map(channels).collect();
    Error::with_help(
        format!(
            "{}: no layer that can be read; the file's channels are {}",
            path.display(),
            names.join(", ")
        ),
        "write a flat layer with the channels R, G, B and perhaps A, or Y for grey; or choose one channel, which \
         is read as grey: layer = \"NAME\" in [[texture]]",
    )
}
