//! The tags of a TIFF or BigTIFF file (TIFF 6.0, section 2). Reads the entries of the file's first
//! directory as numbers; damaged entries are bounded by the size of the file.

use super::Fault;

pub(super) mod tag {
    pub const NEW_SUBFILE_TYPE: u16 = 254;
    pub const SUBFILE_TYPE: u16 = 255;
    pub const WIDTH: u16 = 256;
    pub const HEIGHT: u16 = 257;
    pub const BITS_PER_SAMPLE: u16 = 258;
    pub const COMPRESSION: u16 = 259;
    pub const PHOTOMETRIC: u16 = 262;
    pub const FILL_ORDER: u16 = 266;
    pub const STRIP_OFFSETS: u16 = 273;
    pub const ORIENTATION: u16 = 274;
    pub const SAMPLES_PER_PIXEL: u16 = 277;
    pub const ROWS_PER_STRIP: u16 = 278;
    pub const STRIP_BYTE_COUNTS: u16 = 279;
    pub const PLANAR_CONFIGURATION: u16 = 284;
    pub const PREDICTOR: u16 = 317;
    pub const COLOR_MAP: u16 = 320;
    pub const TILE_WIDTH: u16 = 322;
    pub const TILE_LENGTH: u16 = 323;
    pub const TILE_OFFSETS: u16 = 324;
    pub const TILE_BYTE_COUNTS: u16 = 325;
    pub const INK_SET: u16 = 332;
    pub const EXTRA_SAMPLES: u16 = 338;
    pub const SAMPLE_FORMAT: u16 = 339;
    pub const JPEG_TABLES: u16 = 347;
    pub const ICC_PROFILE: u16 = 34_675;
    pub const IMAGE_DEPTH: u16 = 32_997;
}

/// The largest number of directories that are followed; a damaged chain may be cyclic.
const MAX_PAGES: usize = 10_000;

/// The encoding of the file's numbers and lengths.
#[derive(Clone, Copy)]
struct Form {
    little: bool,
    /// True for BigTIFF, with offsets and counts of 64 bits.
    big: bool,
}

/// An entry. `at` is the offset of the values, which is inside the entry if they are few.
struct Entry {
    tag: u16,
    kind: u16,
    count: u64,
    at: u64,
}

/// The first directory of a file.
pub(super) struct Directory<'a> {
    file: &'a [u8],
    form: Form,
    entries: Vec<Entry>,
    /// The number of full-size pictures in the chain of directories, including this one.
    pub pages: usize,
}

impl<'a> Directory<'a> {
    pub fn first(file: &'a [u8]) -> Result<Directory<'a>, Fault> {
        let ends = || Fault::damaged("it ends within the header");
        let little = file.first() == Some(&b'I');
        let version = number(file, 2, 2, little).ok_or_else(ends)?;
        if ![42, 43].contains(&version) {
            return Err(Fault::damaged(format!("its version is {version}, not 42 or 43")));
        }
        let form = Form { little, big: version == 43 };
        if form.big && number(file, 4, 2, little) != Some(8) {
            return Err(Fault::damaged("its offsets are not 8 bytes long"));
        }
        let start = if form.big { number(file, 8, 8, little) } else { number(file, 4, 4, little) };
        let start = start.ok_or_else(ends)?;
        let (entries, mut next) = read_entries(file, form, start)
            .ok_or_else(|| Fault::damaged("its directory lies outside the file"))?;
        let mut first = Directory { file, form, entries, pages: 1 };
        let mut seen = vec![start];
        while next != 0 && seen.len() < MAX_PAGES && !seen.contains(&next) {
            seen.push(next);
            let Some((entries, after)) = read_entries(file, form, next) else { break };
            let page = Directory { file, form, entries, pages: 1 };
            first.pages += usize::from(!page.is_reduced());
            next = after;
        }
        Ok(first)
    }

    pub fn little_endian(&self) -> bool {
        self.form.little
    }

    pub fn has(&self, tag: u16) -> bool {
        self.entry(tag).is_some()
    }

    /// Returns true if this picture is a smaller copy of another one in the file, or a mask.
    pub fn is_reduced(&self) -> bool {
        const REDUCED_OR_MASK: u64 = 1 | 4;
        const OLD_REDUCED: u64 = 2;
        let has_bits = |tag, wanted: fn(u64) -> bool| self.number(tag).ok().flatten().is_some_and(wanted);
        has_bits(tag::NEW_SUBFILE_TYPE, |bits| bits & REDUCED_OR_MASK != 0)
            || has_bits(tag::SUBFILE_TYPE, |kind| kind == OLD_REDUCED)
    }

    /// Returns the first value of a tag.
    pub fn number(&self, tag: u16) -> Result<Option<u64>, Fault> {
        Ok(self.numbers_up_to(tag, 1)?.and_then(|values| values.first().copied()))
    }

    pub fn number_or(&self, tag: u16, default: u64) -> Result<u64, Fault> {
        Ok(self.number(tag)?.unwrap_or(default))
    }

    /// Returns all values of a tag.
    pub fn numbers(&self, tag: u16) -> Result<Option<Vec<u64>>, Fault> {
        self.numbers_up_to(tag, u64::MAX)
    }

    fn numbers_up_to(&self, tag: u16, most: u64) -> Result<Option<Vec<u64>>, Fault> {
        let Some(entry) = self.entry(tag) else { return Ok(None) };
        let size = number_bytes(entry.kind)
            .ok_or_else(|| Fault::damaged(format!("tag {tag} has type {}, not whole numbers", entry.kind)))?;
        let bytes = self.bytes_of(entry, size)?;
        let count = entry.count.min(most) as usize;
        let little = self.form.little;
        Ok(Some(bytes.chunks_exact(size).take(count).map(|b| whole(b, little)).collect()))
    }

    /// Returns the values of a tag of one byte each as stored.
    pub fn bytes(&self, tag: u16) -> Result<Option<&'a [u8]>, Fault> {
        self.entry(tag).map(|entry| self.bytes_of(entry, 1)).transpose()
    }

    fn entry(&self, tag: u16) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.tag == tag)
    }

    fn bytes_of(&self, entry: &Entry, size: usize) -> Result<&'a [u8], Fault> {
        let end = entry.count.checked_mul(size as u64).and_then(|length| entry.at.checked_add(length));
        let range =
            end.and_then(|end| self.file.get(usize::try_from(entry.at).ok()?..usize::try_from(end).ok()?));
        range.ok_or_else(|| Fault::damaged(format!("the values of tag {} lie outside the file", entry.tag)))
    }
}

/// Returns the entries of a directory and the offset of the next one, or `None` if it lies outside
/// the file.
fn read_entries(file: &[u8], form: Form, start: u64) -> Option<(Vec<Entry>, u64)> {
    let (word, entry_bytes) = if form.big { (8, 20) } else { (4, 12) };
    let count_bytes = if form.big { 8 } else { 2 };
    let count = number(file, start, count_bytes, form.little)?;
    let from = start.checked_add(count_bytes)?;
    let end = from.checked_add(count.checked_mul(entry_bytes)?)?;
    let table = file.get(usize::try_from(from).ok()?..usize::try_from(end).ok()?)?;
    let mut entries = Vec::with_capacity(count as usize);
    for (i, entry) in table.chunks_exact(entry_bytes as usize).enumerate() {
        let field = |at, size| number(entry, at, size, form.little);
        let (tag, kind, count) = (field(0, 2)? as u16, field(2, 2)? as u16, field(4, word)?);
        let inline = from + i as u64 * entry_bytes + 4 + word;
        let fits = type_bytes(kind).is_some_and(|size| count.checked_mul(size).is_some_and(|n| n <= word));
        entries.push(Entry { tag, kind, count, at: if fits { inline } else { field(4 + word, word)? } });
    }
    // Some writers omit the offset if there is no next directory.
    let next = number(file, end, word, form.little).unwrap_or(0);
    Some((entries, next))
}

/// Returns the bytes per value of each type.
fn type_bytes(kind: u16) -> Option<u64> {
    Some(match kind {
        1 | 2 | 6 | 7 => 1,
        3 | 8 => 2,
        4 | 9 | 11 | 13 => 4,
        5 | 10 | 12 | 16 | 17 | 18 => 8,
        _ => return None,
    })
}

/// Returns the bytes per value of an integer type. Signed types are accepted too: no tag here has
/// negative values.
fn number_bytes(kind: u16) -> Option<usize> {
    match kind {
        2 | 5 | 7 | 10..=12 => None,
        _ => type_bytes(kind).map(|n| n as usize),
    }
}

fn number(bytes: &[u8], at: u64, size: u64, little: bool) -> Option<u64> {
    let at = usize::try_from(at).ok()?;
    Some(whole(bytes.get(at..at.checked_add(size as usize)?)?, little))
}

fn whole(bytes: &[u8], little: bool) -> u64 {
    let digit = |value: u64, byte: &u8| value << 8 | u64::from(*byte);
    if little { bytes.iter().rev().fold(0, digit) } else { bytes.iter().fold(0, digit) }
}
