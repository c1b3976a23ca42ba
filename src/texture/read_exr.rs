//! OpenEXR into texels: the first flat layer with channels R, G, B (and A), else Y (and A), half
//! and float alike as f32. The picture is the display window; what the data window leaves out is
//! black, and transparent where the file has alpha. Or it is what both windows have, and where that lies.

use std::io::{BufRead, Seek};
use std::path::Path;

use exr::meta::header::Header;
use exr::prelude::*;

use super::data::{Component, TexelFormat};
use super::read_file::{Texels, check_memory, check_size, damaged};
use crate::error::{Error, Result};
use crate::film::Placement;

/// Where a layer lies in the picture.
#[derive(Clone, Copy)]
struct Window {
    width: usize,
    height: usize,
    /// Data window's corner within the picture.
    offset: (i32, i32),
    channels: usize,
}

impl Window {
    /// Byte offset of a data-window pixel's texel; none outside the picture.
    fn texel(&self, at: Vec2<usize>) -> Option<usize> {
        let x = usize::try_from(self.offset.0 as i64 + at.0 as i64).ok()?;
        let y = usize::try_from(self.offset.1 as i64 + at.1 as i64).ok()?;
        (x < self.width && y < self.height).then(|| (y * self.width + x) * self.channels * 4)
    }

    fn bytes(&self) -> usize {
        self.width * self.height * self.channels * 4
    }
}

/// Which part of the file is the picture.
#[derive(Clone, Copy, PartialEq)]
pub enum Part {
    Display,
    /// What the data window has of the display window.
    Data,
}

pub(super) fn read(source: impl BufRead + Seek, path: &Path, part: Part) -> Result<(Texels, Placement)> {
    let reader = exr::block::read(source, false).map_err(|e| exr_error(path, e))?;
    let headers = reader.headers();
    let layer_with =
        |names: &[&str]| headers.iter().find(|h| !h.deep && names.iter().all(|name| has_channel(h, name)));
    let (header, grey) = match (layer_with(&["R", "G", "B"]), layer_with(&["Y"])) {
        (Some(header), _) => (header, false),
        (None, Some(header)) => (header, true),
        (None, None) => return Err(no_layer(path, headers)),
    };

    let has_alpha = has_channel(header, "A");
    let display = header.shared_attributes.display_window;
    let layer = header.layer_size;
    check_size(path, layer.0 as u64, layer.1 as u64, 4)?;
    let channels = if !grey { 4 } else { 1 + usize::from(has_alpha) };
    let corner = header.own_attributes.layer_position - display.position;
    let (first, size) = match part {
        Part::Display => ([0; 2], display.size),
        Part::Data => shared_part(corner, layer, display.size).ok_or_else(|| {
            Error::with_help(
                format!("{}: its data window lies outside its display window", path.display()),
                "write the picture again with a data window that the display window shows",
            )
        })?,
    };
    check_size(path, size.0 as u64, size.1 as u64, channels * 4)?;
    let offset = (corner.0 - first[0] as i32, corner.1 - first[1] as i32);
    let window = Window { width: size.0, height: size.1, offset, channels };
    let placement =
        Placement { corner: first, full: [display.size.0, display.size.1].map(|side| side as u32) };

    check_memory(path, window.bytes())?;
    let read_layer = exr::prelude::read().no_deep_data().largest_resolution_level();
    let mut bytes = if grey {
        read_layer
            .specific_channels()
            .required("Y")
            .optional("A", 1f32)
            .collect_pixels(
                move |_, _| vec![0; window.bytes()],
                move |bytes: &mut Vec<u8>, at, (y, a): (f32, f32)| put(bytes, window, at, &[y, a]),
            )
            .first_valid_layer()
            .all_attributes()
            .from_chunks(reader)
            .map(|image| image.layer_data.channel_data.pixels)
    } else {
        read_layer
            .rgba_channels(
                move |_, _| vec![0; window.bytes()],
                move |bytes: &mut Vec<u8>, at, (r, g, b, a): (f32, f32, f32, f32)| {
                    put(bytes, window, at, &[r, g, b, a]);
                },
            )
            .first_valid_layer()
            .all_attributes()
            .from_chunks(reader)
            .map(|image| image.layer_data.channel_data.pixels)
    }
    .map_err(|e| exr_error(path, e))?;
    // Afterwards, so that a damaged header cannot make the program fill gigabytes.
    if !grey && !has_alpha && layer != display.size {
        bytes.chunks_exact_mut(16).for_each(|t| t[12..].copy_from_slice(&1f32.to_ne_bytes()));
    }

    let texels = Texels {
        width: window.width as u32,
        height: window.height as u32,
        format: TexelFormat::new(channels, Component::Float32),
        file_channels: if grey { channels } else { 3 + usize::from(has_alpha) },
        bytes,
    };
    Ok((texels, placement))
}

/// Corner and size of what a data window at `corner` has of a display window at the origin.
fn shared_part(
    corner: Vec2<i32>,
    data: Vec2<usize>,
    display: Vec2<usize>,
) -> Option<([u32; 2], Vec2<usize>)> {
    let along = |corner: i32, data: usize, display: usize| {
        let first = i64::from(corner).max(0);
        let end = (i64::from(corner) + data as i64).min(display as i64);
        (end > first).then_some((first as u32, (end - first) as usize))
    };
    let (x, width) = along(corner.0, data.0, display.0)?;
    let (y, height) = along(corner.1, data.1, display.1)?;
    Some(([x, y], Vec2(width, height)))
}

fn put(bytes: &mut [u8], window: Window, at: Vec2<usize>, values: &[f32]) {
    if let Some(start) = window.texel(at) {
        let texel = bytes[start..start + window.channels * 4].chunks_exact_mut(4);
        texel.zip(values).for_each(|(to, value)| to.copy_from_slice(&value.to_ne_bytes()));
    }
}

fn has_channel(header: &Header, name: &str) -> bool {
    header.channels.find_index_of_channel(&Text::from(name)).is_some()
}

fn no_layer(path: &Path, headers: &[Header]) -> Error {
    let names: Vec<String> = headers
        .iter()
        .flat_map(|h| h.channels.list.iter().map(move |c| (h.deep, c.name.to_string())))
        .map(|(deep, name)| if deep { format!("{name} (deep)") } else { name })
        .collect();
    Error::with_help(
        format!(
            "{}: no layer that can be read; the file's channels are {}",
            path.display(),
            names.join(", ")
        ),
        "write a flat layer with the channels R, G, B and perhaps A, or Y for grey",
    )
}

fn exr_error(path: &Path, error: exr::error::Error) -> Error {
    match error {
        exr::error::Error::NotSupported(what) => Error::with_help(
            format!("{}: this kind of OpenEXR file is not supported: {what}", path.display()),
            "convert it to flat scan lines with ZIP, ZIPS, PIZ, RLE or no compression",
        ),
        other => damaged(path, "OpenEXR", &other),
    }
}
