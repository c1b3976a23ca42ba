//! Text of files on a terminal. In: any text. Out: the same without characters that a terminal obeys: they are written as
//! escapes that JSON has, too.

use std::borrow::Cow;
use std::fmt::Write as _;

/// Returns true for characters that move the cursor, change colors, or turn the direction of writing.
fn is_obeyed(c: char) -> bool {
    let turns = matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    (c.is_control() && !matches!(c, '\n' | '\t')) || turns || matches!(c, '\u{2028}' | '\u{2029}')
}

/// Returns the text with such characters as escapes; line breaks and tabs stay.
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(is_obeyed) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if is_obeyed(c) {
            // None of them needs two units of UTF-16.
            let _ = write!(shown, "\\u{:04x}", u32::from(c));
        } else {
            shown.push(c);
        }
    }
    Cow::Owned(shown)
}

/// Returns the text with other characters of as many bytes in place of such ones, so that places in it stay right.
pub fn printable_in_place(text: &str) -> String {
    let stand_in = |c: char| match c.len_utf8() {
        1 => '?',
        2 => '¿',
        _ => '\u{fffd}',
    };
    let mut characters = text.chars().peekable();
    let mut shown = String::with_capacity(text.len());
    while let Some(c) = characters.next() {
        let ends_line = c == '\r' && characters.peek() == Some(&'\n');
        shown.push(if is_obeyed(c) && !ends_line { stand_in(c) } else { c });
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_obeys_is_escaped_and_the_rest_stays() {
        assert!(matches!(printable("grün\n\t🂡"), Cow::Borrowed(_)));
        let bad = "\u{1b}[2J\u{9b}1m\r\u{202e}x\u{7f}\u{7}";
        assert_eq!(printable(bad), "\\u001b[2J\\u009b1m\\u000d\\u202ex\\u007f\\u0007");
        let json = format!("\"{}\"", printable("\u{9b}"));
        assert_eq!(serde_json::from_str::<String>(&json).unwrap(), "\u{9b}");
        let shown = printable_in_place(&format!("{bad}\r\n"));
        assert_eq!((shown.len(), shown.as_str()), (bad.len() + 2, "?[2J¿1m?\u{fffd}x??\r\n"));
    }
}
