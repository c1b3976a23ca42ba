//! Texture lookups on the device against the oracle: every address mode, filter, texel centre,
//! format and colour space, over random and error-prone coordinates, from both texel sources, by
//! the shader and by the device's own samplers.

pub mod bench;
mod hardware;
mod lanczos;
mod planted;
mod shader;

/// Returns the first failures, and their number.
fn assert_none(complaints: &[String], of: usize) {
    let first = complaints.iter().take(5).cloned().collect::<Vec<_>>().join("\n");
    assert!(complaints.is_empty(), "{} of {of} look-ups are wrong:\n{first}", complaints.len());
}
