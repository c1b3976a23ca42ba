//! Addresses of buffers and images. Input: a URI as the file writes it. Output: the bytes that it holds itself, or a
//! path with `/` between folders that stays in the folder of the file; every other address is refused.

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use crate::mesh::relative::inside;

/// Programs disagree on padding; without it nothing is ambiguous.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

/// Where data is.
#[derive(Debug, PartialEq)]
pub(super) enum Uri {
    /// In the URI itself, with its media type, which may be empty.
    Data(Vec<u8>, String),
    /// In a file of its own.
    Path(String),
}

impl Uri {
    /// Reads an address, or returns what is wrong with it.
    pub(super) fn read(uri: &str) -> Result<Uri, String> {
        match uri.split_at_checked(5) {
            Some((scheme, rest)) if scheme.eq_ignore_ascii_case("data:") => data(rest),
            _ => path(uri).map(Uri::Path),
        }
    }
}

/// Reads what follows `data:`.
fn data(rest: &str) -> Result<Uri, String> {
    let (header, content) = rest.split_once(',').ok_or("its data URI has no comma")?;
    let mime = header.split(';').next().unwrap_or_default().to_owned();
    let encoded = header.split(';').skip(1).any(|part| part.eq_ignore_ascii_case("base64"));
    let bytes = match (encoded, content.contains('%')) {
        (true, false) => BASE64.decode(content),
        (true, true) => BASE64.decode(unescaped(content)),
        (false, _) => Ok(unescaped(content)),
    };
    Ok(Uri::Data(bytes.map_err(|e| format!("its base64 data is wrong: {e}"))?, mime))
}

/// Returns a relative path in normal form, or what is wrong with it.
fn path(uri: &str) -> Result<String, String> {
    let refused = |why: &str| -> Result<String, String> {
        let start: String = uri.chars().take(60).collect();
        Err(format!("{start:?} {why}"))
    };
    let Ok(path) = String::from_utf8(unescaped(uri)) else {
        return refused("is not a path in UTF-8");
    };
    if path.contains(':') {
        return refused("has a colon; only relative paths and data URIs are read");
    }
    if path.contains('\\') || path.contains(char::is_control) {
        return refused("has a backslash or a control character");
    }
    inside(&path).or_else(refused)
}

/// Replaces `%41` by the byte that it stands for. A percent sign without two digits stands for itself, as programs
/// that escape nothing write it.
fn unescaped(text: &str) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        let escape = match rest {
            [b'%', high, low, after @ ..] => digit(*high).zip(digit(*low)).map(|(h, l)| (h * 16 + l, after)),
            _ => None,
        };
        let (byte, after) = escape.unwrap_or((*first, after));
        bytes.push(byte);
        rest = after;
    }
    bytes
}

/// Returns the value of a hexadecimal digit.
fn digit(byte: u8) -> Option<u8> {
    char::from(byte).to_digit(16).and_then(|value| u8::try_from(value).ok())
}
