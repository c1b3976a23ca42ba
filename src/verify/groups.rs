//! Rows → the lines of a table that people read: one for each reader, scale, filter and class of formats,
//! and within it one for all pairs of address modes that fared alike.

use super::report::{Row, Verdict};
use super::variants::{FormatClass, Reader, Scale, Variant};
use super::weights::WeightBits;
use crate::texture::sampler_spec::{Address, Filter};

pub struct Line {
    pub reader: Reader,
    pub scale: Scale,
    pub filter: Filter,
    pub class: FormatClass,
    /// Which pairs of address modes, in words.
    pub address: String,
    pub variants: usize,
    pub look_ups: usize,
    pub wrong: usize,
    /// The worst of all.
    pub error: f64,
    pub beyond: f64,
    pub weights: Option<WeightBits>,
    pub verdict: Verdict,
}

type Key = (Reader, Scale, Filter, FormatClass);
type Pair = [Address; 2];

fn key(v: &Variant) -> Key {
    (v.reader, v.scale, v.filter(), v.class)
}

/// In the order of the vocabularies.
pub fn lines(rows: &[Row]) -> Vec<Line> {
    let mut keys: Vec<Key> = rows.iter().map(|r| key(&r.variant)).collect();
    keys.sort();
    keys.dedup();
    keys.into_iter().flat_map(|k| lines_of(k, rows)).collect()
}

/// Pairs fared alike when the worst verdict and the weights of their rows are the same.
fn lines_of(wanted: Key, rows: &[Row]) -> Vec<Line> {
    let rows: Vec<&Row> = rows.iter().filter(|r| key(&r.variant) == wanted).collect();
    let mut pairs: Vec<Pair> = rows.iter().map(|r| r.variant.spec.address).collect();
    pairs.sort();
    pairs.dedup();
    let of = |pair: Pair| rows.iter().filter(move |r| r.variant.spec.address == pair);
    let fared = |pair: Pair| (of(pair).map(|r| r.verdict).max(), of(pair).filter_map(|r| r.weights).min());
    let mut kinds: Vec<_> = pairs.iter().map(|&p| fared(p)).collect();
    kinds.sort();
    kinds.dedup();
    let line = |kind| {
        let alike: Vec<Pair> = pairs.iter().copied().filter(|&p| fared(p) == kind).collect();
        let members: Vec<&Row> = alike.iter().flat_map(|&p| of(p)).copied().collect();
        let worst = |of: fn(&Row) -> f64| members.iter().map(|r| of(r)).fold(0.0, f64::max);
        let (reader, scale, filter, class) = wanted;
        Line {
            reader,
            scale,
            filter,
            class,
            address: address(&alike, pairs.len()),
            variants: members.len(),
            look_ups: members.iter().map(|r| r.look_ups).sum(),
            wrong: members.iter().map(|r| r.wrong).sum(),
            error: worst(|r| r.worst_error),
            beyond: worst(|r| r.worst_beyond),
            weights: kind.1,
            verdict: kind.0.unwrap_or(Verdict::Within),
        }
    };
    kinds.into_iter().map(line).collect()
}

/// `all 25 pairs`, `repeat × clamp-to-edge` (both modes on either axis), `21 pairs`, `repeat/repeat`.
fn address(pairs: &[Pair], of: usize) -> String {
    let mut modes: Vec<Address> = pairs.iter().flatten().copied().collect();
    modes.sort();
    modes.dedup();
    let names: Vec<&str> = modes.iter().map(|m| m.name()).collect();
    match pairs {
        _ if pairs.len() == of && of > 1 => format!("all {of} pairs"),
        [[u, v]] => format!("{u}/{v}"),
        _ if pairs.len() == modes.len().pow(2) && modes.len() < 3 => names.join(" × "),
        _ => format!("{} pairs", pairs.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Address::{ClampToEdge, Repeat};

    #[test]
    fn pairs_of_address_modes_in_words() {
        assert_eq!(address(&[[Repeat, Repeat]], 25), "repeat/repeat");
        assert_eq!(address(&[[Repeat, ClampToEdge]], 1), "repeat/clamp-to-edge");
        let both =
            [[Repeat, Repeat], [Repeat, ClampToEdge], [ClampToEdge, Repeat], [ClampToEdge, ClampToEdge]];
        assert_eq!(address(&both, 25), "repeat × clamp-to-edge");
        assert_eq!(address(&both[..3], 25), "3 pairs");
        assert_eq!(address(&both, 4), "all 4 pairs");
    }
}
