//! What a sheet calls itself and its cells. Input: the options, and those of a cell. Output: the title, and the command that
//! renders a cell alone.

use super::SheetArgs;
use crate::cli::outputs::name_of;
use crate::cli::vary::Combination;
use crate::lab::study::{label, quote};

/// Returns the title: the scene, and what is the same in all cells.
pub(super) fn title(args: &SheetArgs, is_spp_idle: bool) -> String {
    let stem = name_of(&args.scene).to_string_lossy().into_owned();
    let given = [args.overrides.given(), args.display.given()].concat();
    let is_told = |name: &str| name != "size" && !(is_spp_idle && name == "spp");
    let fixed = given.into_iter().filter(|(name, _)| is_told(name));
    let words = fixed.map(|(name, value)| label::setting(name, &value));
    std::iter::once(stem).chain(words).collect::<Vec<_>>().join(", ")
}

/// Returns the command that renders a cell alone.
pub(super) fn command(args: &SheetArgs, combination: &Combination) -> String {
    let mut words = vec!["moire".to_owned(), "render".into(), args.scene.display().to_string()];
    let given = [combination.overrides.given(), combination.display.given()].concat();
    words.extend(given.into_iter().flat_map(|(name, value)| [format!("--{name}"), value]));
    if let Some(device) = &args.device {
        words.extend(["--device".to_owned(), device.clone()]);
    }
    words.extend(["-o".to_owned(), "cell.png".into()]);
    words.iter().map(|word| quote(word)).collect::<Vec<_>>().join(" ")
}
