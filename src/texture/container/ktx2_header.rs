//! The header of KTX2 files (Khronos, KTX File Format 2.0): sizes, the index of levels, and of the descriptor and the
//! metadata what textures need. Takes the bytes of a file; returns numbers and ranges that lie in the file, or a fault.

use std::ops::Range;

use crate::texture::decoder::Fault;

const HEADER_BYTES: usize = 80;
const LEVEL_BYTES: usize = 24;
/// Transfer functions and codecs (color models) of the data format descriptor.
pub(super) const TRANSFER_LINEAR: u8 = 1;
pub(super) const TRANSFER_SRGB: u8 = 2;
const CODEC_ETC1S: u8 = 163;
const CODEC_UASTC: u8 = 166;

/// The channels of a file of Basis Universal, by its data format descriptor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BasisChannels {
    Color,
    /// One channel, repeated.
    Grey,
    /// Two channels, of which the first is repeated in the colours.
    RedInColorGreenInAlpha,
    RedGreen,
}

/// How the levels of a file are compressed once more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scheme {
    None,
    BasisLz,
    Zstd,
    Zlib,
    Other(u32),
}

pub(super) struct Header {
    /// The format's number in Vulkan; 0 for those of Basis Universal.
    pub format: u32,
    pub width: u32,
    /// 0 for one axis.
    pub height: u32,
    /// 0 for up to two axes.
    pub depth: u32,
    pub layers: u32,
    pub faces: u32,
    pub scheme: Scheme,
    pub levels: Vec<LevelIndex>,
    pub transfer: u8,
    /// The name of the codec of Basis Universal that the descriptor names.
    pub basis: Option<&'static str>,
    pub basis_channels: BasisChannels,
    pub is_premultiplied: bool,
    /// True if the first row is the lowest one.
    pub rows_up: bool,
    /// Which stored channel each of the four is.
    pub swizzle: Option<String>,
}

/// Where a level lies, and its bytes before compression.
#[derive(Clone)]
pub(super) struct LevelIndex {
    pub place: Range<usize>,
    pub bytes: u64,
}

fn word(file: &[u8], at: usize) -> Option<u32> {
    file.get(at..).and_then(|rest| rest.first_chunk()).map(|bytes| u32::from_le_bytes(*bytes))
}

fn long(file: &[u8], at: usize) -> Option<u64> {
    file.get(at..).and_then(|rest| rest.first_chunk()).map(|bytes| u64::from_le_bytes(*bytes))
}

/// Returns a range of the file, or none if it ends elsewhere.
fn range(file: &[u8], start: u64, length: u64) -> Option<Range<usize>> {
    let (start, length) = (usize::try_from(start).ok()?, usize::try_from(length).ok()?);
    let end = start.checked_add(length)?;
    (end <= file.len()).then_some(start..end)
}

impl Header {
    pub fn read(file: &[u8]) -> Result<Header, Fault> {
        let header = file.get(..HEADER_BYTES).ok_or_else(|| Fault::Damaged("the file ends early".into()))?;
        let number = |at| word(header, at).unwrap_or(0);
        let [format, width, height, depth, layers, faces] = [12, 20, 24, 28, 32, 36].map(number);
        let count = number(40).max(1);
        if count > super::MAX_LEVELS {
            return Err(Fault::Damaged(format!("{count} levels")));
        }
        let level = |index: u32| {
            let at = HEADER_BYTES + index as usize * LEVEL_BYTES;
            let [start, length, bytes] = [at, at + 8, at + 16].map(|at| long(file, at));
            let place = range(file, start?, length?)?;
            Some(LevelIndex { place, bytes: bytes? })
        };
        let outside = |index| Fault::Damaged(format!("level {index} lies outside the file"));
        let levels = (0..count).map(|index| level(index).ok_or_else(|| outside(index)));
        let levels = levels.collect::<Result<Vec<_>, Fault>>()?;
        let part = |at: usize| {
            let place = range(file, number(at).into(), number(at + 4).into());
            place
                .map(|place| &file[place])
                .ok_or_else(|| Fault::Damaged("a part lies outside the file".into()))
        };
        let (descriptor, metadata) = (part(48)?, part(56)?);
        let [model, transfer, flags] = [12, 14, 15].map(|at| descriptor.get(at).copied().unwrap_or(0));
        // The types of the channels of the first two samples.
        let samples = [31, 47].map(|at| descriptor.get(at).copied().unwrap_or(0) & 15);
        let basis_channels = match (model, samples) {
            (CODEC_ETC1S, [3, 4]) | (CODEC_UASTC, [5, _]) => BasisChannels::RedInColorGreenInAlpha,
            (CODEC_ETC1S, [3, 0]) | (CODEC_UASTC, [4, _]) => BasisChannels::Grey,
            (CODEC_UASTC, [6, _]) => BasisChannels::RedGreen,
            _ => BasisChannels::Color,
        };
        let basis = match model {
            CODEC_ETC1S => Some("ETC1S"),
            CODEC_UASTC => Some("UASTC"),
            _ => None,
        };
        let value = |key| values(metadata).find(|(found, _)| *found == key).map(|(_, value)| value);
        Ok(Header {
            format,
            width,
            height,
            depth,
            layers,
            faces,
            scheme: match number(44) {
                0 => Scheme::None,
                1 => Scheme::BasisLz,
                2 => Scheme::Zstd,
                3 => Scheme::Zlib,
                other => Scheme::Other(other),
            },
            levels,
            transfer,
            basis,
            basis_channels,
            is_premultiplied: flags & 1 == 1,
            rows_up: value("KTXorientation").is_some_and(|axes| axes.as_bytes().get(1) == Some(&b'u')),
            swizzle: value("KTXswizzle").map(str::to_owned),
        })
    }
}

/// Returns the entries of the metadata whose values are texts, up to the first that is damaged.
fn values(mut metadata: &[u8]) -> impl Iterator<Item = (&str, &str)> {
    std::iter::from_fn(move || {
        loop {
            let length = word(metadata, 0)? as usize;
            let entry = metadata.get(4..length.checked_add(4)?)?;
            metadata = metadata.get(length.checked_add(4)?.next_multiple_of(4)..).unwrap_or_default();
            let text = std::str::from_utf8(entry).ok().and_then(|entry| entry.split_once('\0'));
            if let Some((key, value)) = text {
                return Some((key, value.trim_end_matches('\0')));
            }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metadata_ends_at_the_first_damaged_entry() {
        let entry = |text: &[u8]| {
            let mut bytes = [&(text.len() as u32).to_le_bytes(), text].concat();
            bytes.resize(bytes.len().next_multiple_of(4), 0);
            bytes
        };
        let whole = [entry(b"a\0bc\0"), entry(b"\xff\xff"), entry(b"KTXorientation\0ru\0")].concat();
        let found: Vec<_> = values(&whole).collect();
        assert_eq!(found, [("a", "bc"), ("KTXorientation", "ru")]);
        assert_eq!(values(&[whole, vec![0xff; 9]].concat()).count(), 2);
    }

    #[test]
    fn ranges_end_in_the_file() {
        let file = [0; 10];
        assert_eq!(range(&file, 4, 6), Some(4..10));
        assert!(range(&file, 4, 7).is_none() && range(&file, u64::MAX, 2).is_none());
    }
}
