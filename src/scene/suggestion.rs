//! Names in messages. Input: a word, and the names that it may be. Output: the word in quotes; the name that is most likely
//! meant.

use super::synonyms::meant;

/// Longest excerpt or name that a message repeats, in characters.
pub(super) const LONGEST_EXCERPT: usize = 60;

/// Returns a text, cut where it is too long for a message.
pub(super) fn shorten(text: &str) -> String {
    match text.char_indices().nth(LONGEST_EXCERPT) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// Returns a name in quotes.
pub(super) fn quoted(name: &str) -> String {
    format!("\"{}\"", shorten(name))
}

/// Returns `; did you mean "x"?` for the candidate that `word` is a synonym or the most likely misspelling of, or
/// nothing.
pub fn suggestion<'c>(word: &str, candidates: impl IntoIterator<Item = &'c str> + Clone) -> String {
    nearest(word, candidates).map_or_else(String::new, |(name, also)| {
        let also = also.map_or(String::new(), |(key, value)| format!(" with {key} = \"{value}\""));
        format!("; did you mean {}{also}?", quoted(name))
    })
}

/// Returns the candidate that `word` is a synonym or the most likely misspelling of, with a setting that the synonym implies.
pub fn nearest<'c>(
    word: &str,
    candidates: impl IntoIterator<Item = &'c str> + Clone,
) -> Option<(&'c str, Option<(&'static str, &'static str)>)> {
    let word = word.to_lowercase();
    let by_meaning = meant(&word, candidates.clone());
    by_meaning.or_else(|| {
        let near =
            candidates.into_iter().filter_map(|candidate| Some((unlikeness(&word, candidate)?, candidate)));
        near.min_by_key(|(unlikeness, _)| *unlikeness).map(|(_, candidate)| (candidate, None))
    })
}

/// Returns a measure of the difference; `None` for unrelated words. Misspellings (by edit distance) come before words
/// that share a part.
fn unlikeness(word: &str, candidate: &str) -> Option<usize> {
    let lower = candidate.to_lowercase();
    let (length, wanted) = (word.chars().count(), lower.chars().count());
    // The distance costs the product of both lengths.
    if length.max(wanted) > LONGEST_EXCERPT {
        return None;
    }
    // A different first letter in a short word is more often another word ("cone", "none").
    let other_start = length.min(wanted) <= 4 && word.chars().next() != lower.chars().next();
    let allowed = if wanted <= 4 { 1 } else { wanted.div_ceil(3) };
    let distance = strsim::damerau_levenshtein(word, &lower);
    if distance <= allowed && !other_start {
        return Some(distance);
    }
    // "fov" in "vertical_fov", "rotation" for "rotate".
    let common = word.chars().zip(lower.chars()).take_while(|(a, b)| a == b).count();
    let shares_part = length >= 3 && (lower.contains(word) || (common >= 4 && 4 * common >= 3 * wanted));
    shares_part.then_some(LONGEST_EXCERPT + wanted)
}
