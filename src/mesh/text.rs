//! Lines and words of OBJ and MTL files. Input: the bytes of a file. Output: its lines with their numbers, the words of
//! each, and numbers.

use std::borrow::Cow;

use super::Fault;

/// Reads a finite number.
pub(super) fn number(word: &[u8]) -> Result<f64, String> {
    float(word).ok().filter(|number| number.is_finite()).ok_or_else(|| no_number(word))
}

/// Reads a number that may be infinite, or none.
pub(super) fn float(word: &[u8]) -> Result<f64, String> {
    let parsed = std::str::from_utf8(word).ok().and_then(|word| word.parse::<f64>().ok());
    parsed.ok_or_else(|| no_number(word))
}

fn no_number(word: &[u8]) -> String {
    format!("{} is no number", quoted(word))
}

/// Quotes a word for a message, shortened if it is long.
pub(super) fn quoted(word: &[u8]) -> String {
    format!("{:?}", String::from_utf8_lossy(word.get(..40).unwrap_or(word)))
}

/// Returns the words of a line up to a comment.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    let all = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    all.take_while(|word| !word.starts_with(b"#"))
}

/// Returns the first word of a line, and the rest, trimmed.
pub(super) fn first_word(line: &[u8]) -> (&[u8], &[u8]) {
    let line = line.trim_ascii();
    let end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
    let (word, rest) = line.split_at_checked(end).unwrap_or((line, &[]));
    (word, rest.trim_ascii_start())
}

/// Returns the lines of a text with their numbers, those that a backslash continues joined by a space, or a fault if
/// it is no text of single bytes.
pub(super) fn lines(bytes: &[u8]) -> Result<impl Iterator<Item = (usize, Cow<'_, [u8]>)>, Fault> {
    let marked = bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff");
    // Without a mark, every other byte of Latin text is zero.
    if marked || bytes.iter().take(2).any(|byte| *byte == 0) {
        return Err(Fault::new("", "it is binary or UTF-16 text; save it as UTF-8"));
    }
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    // Of programs on old Macintoshes, a carriage return alone ends a line.
    let end = if text.contains(&b'\n') { b'\n' } else { b'\r' };
    let mut numbered = (1..).zip(text.split(move |byte| *byte == end).map(<[u8]>::trim_ascii));
    Ok(std::iter::from_fn(move || {
        let (number, first) = numbered.next()?;
        let mut line = Cow::Borrowed(first);
        // A comment may end with a path; it must not swallow the statement below it.
        while line.ends_with(b"\\") && !line.starts_with(b"#") {
            let whole = line.to_mut();
            whole.pop();
            whole.push(b' ');
            whole.extend_from_slice(numbered.next().map(|(_, next)| next).unwrap_or_default());
        }
        Some((number, line))
    }))
}
