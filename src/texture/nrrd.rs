//! NRRD volumes (teem, "Definition of NRRD File Format", versions 1 to 5): three axes, or four with
//! 1 to 4 channels on the first, of integers of 8 to 64 bits or floats of 32 or 64, raw or gzip,
//! after the header or in a separate file. Fields that only position the volume in the world
//! (spacings, space, kinds of the other axes, …) are ignored. Errors name line and field.

use std::collections::HashMap;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use flate2::bufread::MultiGzDecoder;

use super::open_file::open;
use super::read_file::{Texels, unreadable};
use super::scalar::{NumberKind, Scalar};
use super::source::Endian;
use super::volume::RawTexels;
use crate::core::built_in::Opened;
use crate::core::error::{Error, Result};

/// The length limit of a header line: a longer one is not a header.
const MAX_LINE_BYTES: u64 = 64 << 10;
/// The maximum compression ratio of Deflate.
const MAX_GZIP_RATIO: u64 = 1032;
const MAX_LINES: usize = 10_000;

pub(super) fn read(path: &Path) -> Result<(Texels, u32)> {
    let mut file = BufReader::new(open(path)?);
    let header = Header::read(&mut file, path)?;
    let layout = header.layout()?;
    let (endian, skips) = (header.endian(layout.scalar)?, header.skips()?);
    let gzip = header.choice("encoding", &[("raw", false), ("gzip", true), ("gz", true)])?;
    let depth = layout.size[2];
    let data_file = header.data_file()?;
    let (source, path) = match &data_file {
        Some(data) => (BufReader::new(open(data)?), data.as_path()),
        None => (file, path),
    };
    let texels = read_data(source, &layout, endian, skips, gzip, path)?;
    Ok((texels, depth))
}

/// The lines, then bytes, before the data; −1 bytes means that the data ends at the end of the
/// file.
#[derive(Clone, Copy)]
struct Skips {
    lines: u32,
    bytes: i64,
}

fn read_data(
    mut source: BufReader<Opened>,
    layout: &RawTexels,
    endian: Endian,
    skips: Skips,
    gzip: bool,
    path: &Path,
) -> Result<Texels> {
    let failed = |e: io::Error| unreadable(path, &e);
    for _ in 0..skips.lines {
        source.skip_until(b'\n').map_err(failed)?;
    }
    let length = source.get_ref().length().map_err(failed)?;
    if skips.bytes < 0 {
        source.seek(SeekFrom::Start(length.saturating_sub(layout.bytes()))).map_err(failed)?;
    }
    let mut source: Box<dyn Read> =
        if gzip { Box::new(MultiGzDecoder::new(source)) } else { Box::new(source) };
    let before = u64::try_from(skips.bytes).unwrap_or(0);
    io::copy(&mut source.by_ref().take(before), &mut io::sink()).map_err(failed)?;
    let available = if gzip { length.saturating_mul(MAX_GZIP_RATIO) } else { length };
    layout.read(source, endian, available, path)
}

struct Header<'a> {
    path: &'a Path,
    /// Line number and content of each field by its name in lower case.
    fields: HashMap<String, (usize, String)>,
}

impl<'a> Header<'a> {
    /// Reads up to the empty line before the data, or to the end of a detached header.
    fn read(file: &mut impl BufRead, path: &'a Path) -> Result<Header<'a>> {
        let mut header = Header { path, fields: HashMap::new() };
        for number in 1..=MAX_LINES {
            let mut line = Vec::new();
            file.by_ref()
                .take(MAX_LINE_BYTES)
                .read_until(b'\n', &mut line)
                .map_err(|e| unreadable(path, &e))?;
            let at_end = line.is_empty();
            let line = String::from_utf8_lossy(&line);
            let line = line.trim_end();
            if number == 1 {
                let version = line.strip_prefix("NRRD000").and_then(|v| v.parse::<u32>().ok());
                if !version.is_some_and(|v| (1..=5).contains(&v)) {
                    return Err(not_nrrd(path));
                }
            } else if at_end || line.is_empty() {
                return Ok(header);
            } else if !line.starts_with('#') {
                header.add(number, line)?;
            }
        }
        Err(not_nrrd(path))
    }

    fn add(&mut self, number: usize, line: &str) -> Result<()> {
        // `key:=value` pairs are user-defined.
        let Some((name, content)) = line.split_once(": ").or_else(|| line.split_once(':')) else {
            let excerpt: String = line.chars().take(40).collect();
            return Err(self.error_at(number, &format!("\"{excerpt}\" is no field: expected NAME: VALUE")));
        };
        if content.starts_with('=') {
            return Ok(());
        }
        let name = match name.trim().to_lowercase().as_str() {
            "datafile" => "data file".to_string(),
            "byteskip" => "byte skip".to_string(),
            "lineskip" => "line skip".to_string(),
            name => name.to_string(),
        };
        if let Some((first, _)) = self.fields.get(&name) {
            return Err(self.error_at(number, &format!("field \"{name}\" stands on line {first} already")));
        }
        self.fields.insert(name, (number, content.trim().to_string()));
        Ok(())
    }

    fn layout(&self) -> Result<RawTexels> {
        let scalar = self.scalar()?;
        let dimension = self.choice("dimension", &[("3", 3), ("4", 4)])?;
        let (_, sizes) = self.required("sizes")?;
        let sizes: Vec<u32> = sizes.split_whitespace().map_while(|n| n.parse().ok()).collect();
        if sizes.len() != dimension || sizes.contains(&0) {
            return Err(self.expected("sizes", &format!("{dimension} whole numbers above 0")));
        }
        let channels_first = dimension == 4;
        let kind = self.fields.get("kinds").and_then(|(_, kinds)| kinds.split_whitespace().next());
        let of_place = kind.map(|k| ["domain", "space", "time"].contains(&k.to_lowercase().as_str()));
        let of_value = kind.is_some_and(|k| {
            let kind = k.to_lowercase();
            kind.contains("color") || kind.contains("vector") || kind == "complex"
        });
        match (channels_first, of_place) {
            (true, Some(true)) => Err(self.expected("kinds", "the channels on the first of four axes")),
            (false, _) if of_value => {
                Err(self.expected("kinds", "three axes of space, or four with channels"))
            }
            (true, _) if sizes[0] > 4 => {
                Err(self.expected("sizes", "1 to 4 channels on the first of four axes"))
            }
            _ => {
                let (channels, size) = if channels_first { (sizes[0], &sizes[1..]) } else { (1, &sizes[..]) };
                let size = [size[0], size[1], size[2]];
                Ok(RawTexels { size, channels: channels as usize, scalar })
            }
        }
    }

    /// Returns the number type, for any of the names that the format has for it.
    fn scalar(&self) -> Result<Scalar> {
        const TYPES: [(&[&str], u32, NumberKind); 10] = [
            (&["uchar", "unsigned char", "uint8", "uint8_t"], 8, NumberKind::Unsigned),
            (&["signed char", "int8", "int8_t"], 8, NumberKind::Signed),
            (
                &["ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"],
                16,
                NumberKind::Unsigned,
            ),
            (
                &["short", "short int", "signed short", "signed short int", "int16", "int16_t"],
                16,
                NumberKind::Signed,
            ),
            (&["uint", "unsigned int", "uint32", "uint32_t"], 32, NumberKind::Unsigned),
            (&["int", "signed int", "int32", "int32_t"], 32, NumberKind::Signed),
            (
                &["ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"],
                64,
                NumberKind::Unsigned,
            ),
            (
                &[
                    "longlong",
                    "long long",
                    "long long int",
                    "signed long long",
                    "signed long long int",
                    "int64",
                    "int64_t",
                ],
                64,
                NumberKind::Signed,
            ),
            (&["float"], 32, NumberKind::Float),
            (&["double"], 64, NumberKind::Float),
        ];
        let (_, word) = self.required("type")?;
        let found = TYPES.iter().find(|(names, ..)| names.iter().any(|name| name.eq_ignore_ascii_case(word)));
        found.map(|(_, bits, kind)| Scalar { bits: *bits, kind: *kind }).ok_or_else(|| {
            let names: Vec<&str> = TYPES.iter().map(|(names, ..)| names[0]).collect();
            self.expected("type", &format!("one of {}", names.join(", ")))
        })
    }

    /// Returns the byte order, which the format requires for numbers of more than one byte.
    fn endian(&self, scalar: Scalar) -> Result<Endian> {
        if scalar.bits == 8 {
            return Ok(Endian::Little);
        }
        self.choice("endian", &[("little", Endian::Little), ("big", Endian::Big)])
    }

    fn skips(&self) -> Result<Skips> {
        let number = |name: &str, least: i64| match self.fields.get(name) {
            None => Ok(0),
            Some((_, text)) => {
                let number = text.parse::<i64>().ok().filter(|n| (least..=i64::from(u32::MAX)).contains(n));
                number.ok_or_else(|| self.expected(name, &format!("a whole number from {least} on")))
            }
        };
        let (lines, bytes) = (number("line skip", 0)?, number("byte skip", -1)?);
        let raw = self.fields.get("encoding").is_some_and(|(_, e)| e.eq_ignore_ascii_case("raw"));
        if bytes < 0 && !raw {
            return Err(self.expected("byte skip", "0 or more, as the encoding is not raw"));
        }
        Ok(Skips { lines: lines as u32, bytes })
    }

    /// Returns the path of a separate data file, which is relative to the header.
    fn data_file(&self) -> Result<Option<PathBuf>> {
        let Some((_, name)) = self.fields.get("data file") else { return Ok(None) };
        if name.is_empty() || name.starts_with("LIST") || name.contains('%') {
            return Err(self.expected("data file", "the name of one file"));
        }
        Ok(Some(self.path.parent().unwrap_or(Path::new("")).join(name)))
    }

    fn required(&self, name: &str) -> Result<(usize, &str)> {
        let found = self.fields.get(name).map(|(line, content)| (*line, content.as_str()));
        found.ok_or_else(|| {
            Error::with_help(
                format!("{}: the NRRD header has no field \"{name}\"", self.path.display()),
                "it needs type, dimension, sizes, encoding, and endian for more than 8 bits",
            )
        })
    }

    fn choice<T: Copy>(&self, name: &str, choices: &[(&str, T)]) -> Result<T> {
        let (_, word) = self.required(name)?;
        let found = choices.iter().find(|(choice, _)| choice.eq_ignore_ascii_case(word));
        found.map(|(_, value)| *value).ok_or_else(|| {
            let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
            self.expected(name, &format!("one of {}", names.join(", ")))
        })
    }

    fn expected(&self, name: &str, wanted: &str) -> Error {
        let (line, found) = self.fields.get(name).map_or((1, ""), |(line, text)| (*line, text.as_str()));
        let found: String = found.chars().take(60).collect();
        self.error_at(line, &format!("field \"{name}\": expected {wanted}, found \"{found}\""))
    }

    fn error_at(&self, line: usize, problem: &str) -> Error {
        Error::with_help(
            format!("{}:{line}: {problem}", self.path.display()),
            "convert the volume, for example to raw ushort with three axes",
        )
    }
}

fn not_nrrd(path: &Path) -> Error {
    Error::with_help(
        format!(
            "{}: no NRRD volume: it does not begin with NRRD0001 to NRRD0005 and a header",
            path.display()
        ),
        "give slices = [files] for pictures, or volume = { … } for bare texels",
    )
}
