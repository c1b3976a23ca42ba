//! `moire --version`: what this program was built from and what it reads and writes. In: what the build script found. Out:
//! lines of text, of which `-V` prints the first.

use std::sync::LazyLock;

use crate::gpu::API_VERSION_TEXT;
use crate::output::ENDING_NAMES;
use crate::scene::model_endings;
use crate::texture::formats;

/// Returns the text behind the program's name.
pub fn long() -> &'static str {
    static TEXT: LazyLock<String> = LazyLock::new(text);
    &TEXT
}

fn text() -> String {
    let commit = option_env!("MOIRE_COMMIT").unwrap_or("unknown, as it was not built in a checkout");
    format!(
        "{}\ncommit: {commit}\nbuilt by: {}, for {}\nshaders: GLSL compiled by shaderc {}, SPIR-V 1.5\ndevices: Vulkan {} or \
         later; oracle (float64 on the CPU)\nscenes: .toml {}\ntextures: {}\npictures: {}",
        env!("CARGO_PKG_VERSION"),
        env!("MOIRE_RUSTC"),
        env!("MOIRE_TARGET"),
        env!("MOIRE_SHADERC"),
        API_VERSION_TEXT,
        model_endings().replace(',', ""),
        formats::endings().map(|ending| format!(".{ending}")).collect::<Vec<_>>().join(" "),
        ENDING_NAMES.map(|ending| format!(".{ending}")).join(" "),
    )
}
