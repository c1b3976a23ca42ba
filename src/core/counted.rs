//! Counts with their nouns: `1 sample`, `16 samples`.

/// Returns the number with its noun, in the plural unless there is exactly one.
pub fn counted(number: impl TryInto<u128>, noun: &str) -> String {
    let number = number.try_into().unwrap_or(u128::MAX);
    format!("{number} {}", plural(number, noun))
}

/// Returns the noun alone, in the number that fits `number`.
pub fn plural(number: impl TryInto<u128>, noun: &str) -> String {
    match number.try_into() {
        Ok(1) => noun.to_owned(),
        _ if noun.ends_with(['s', 'x']) || noun.ends_with("sh") || noun.ends_with("ch") => {
            format!("{noun}es")
        }
        _ => format!("{noun}s"),
    }
}

/// Returns the verb in the number that fits `number`: `1 pixel is`, `2 pixels are`.
pub fn verb(number: impl TryInto<u128>, one: &'static str, many: &'static str) -> &'static str {
    if matches!(number.try_into(), Ok(1)) { one } else { many }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_one_thing_is_singular() {
        let said = [0u32, 1, 2].map(|n| counted(n, "sample"));
        assert_eq!(said, ["0 samples", "1 sample", "2 samples"]);
        assert_eq!(counted(1usize, "pass"), "1 pass");
        assert_eq!([counted(3u64, "pass"), counted(3u64, "look-up")], ["3 passes", "3 look-ups"]);
        assert_eq!([verb(1u64, "is", "are"), verb(0u64, "is", "are")], ["is", "are"]);
    }
}
