//! Groups rows into the lines of a readable table: one for each reader, kind of texture, scale and
//! filter, at level 0 for each class of formats and otherwise for each mip mode; within it one for
//! all address modes with equal results.

use super::report::{Row, Verdict};
use super::variants::{FormatClass, Reader, Scale, Variant};
use super::weights::WeightBits;
use crate::texture::data::Dimension;
use crate::texture::sampler_spec::{Address, Filter, MipMode};

pub struct Line {
    pub reader: Reader,
    pub dimension: Dimension,
    pub scale: Scale,
    pub filter: Filter,
    /// The mip mode, if levels other than 0 are read.
    pub mip: Option<MipMode>,
    /// The class of formats at level 0; otherwise the line covers all of them.
    pub class: Option<FormatClass>,
    /// The address modes as text.
    pub address: String,
    pub variants: usize,
    pub look_ups: usize,
    pub wrong: usize,
    /// The largest error of all.
    pub error: f64,
    pub beyond: f64,
    /// The weight bits of the filter at level 0, otherwise of the blend of two levels.
    pub weights: Option<WeightBits>,
    pub verdict: Verdict,
}

type Key = (Reader, Dimension, Scale, Option<MipMode>, Filter, Option<FormatClass>);

fn key(v: &Variant) -> Key {
    let (mip, class) = if v.is_filtered() { (Some(v.spec.mip), None) } else { (None, Some(v.class)) };
    (v.reader, v.dimension, v.scale, mip, v.filter(), class)
}

/// Returns the lines in the order of the vocabularies.
pub fn lines(rows: &[Row]) -> Vec<Line> {
    let mut keys: Vec<Key> = rows.iter().map(|r| key(&r.variant)).collect();
    keys.sort();
    keys.dedup();
    keys.into_iter().flat_map(|k| lines_of(k, rows)).collect()
}

/// Returns the lines of one key. At level 0 address modes are merged if the worst verdict and the
/// weights of their rows are equal; at other levels, where each has its own formats, rows with
/// equal results are merged.
fn lines_of(wanted: Key, rows: &[Row]) -> Vec<Line> {
    let rows: Vec<&Row> = rows.iter().filter(|r| key(&r.variant) == wanted).collect();
    let all = distinct(&rows).len();
    let level_0 = wanted.5.is_some();
    let fared = |row: &Row| {
        let same = |r: &&&Row| r.variant.addresses() == row.variant.addresses();
        let alike = || rows.iter().filter(same);
        match level_0 {
            true => (alike().map(|r| r.verdict).max(), alike().filter_map(|r| r.weights).min()),
            false => (Some(row.verdict), None),
        }
    };
    let fates: Vec<_> = rows.iter().map(|r| fared(r)).collect();
    let mut kinds = fates.clone();
    kinds.sort();
    kinds.dedup();
    let line = |kind| {
        let of_kind = rows.iter().zip(&fates).filter(|(_, fate)| **fate == kind);
        let members: Vec<&Row> = of_kind.map(|(row, _)| *row).collect();
        let worst = |of: fn(&Row) -> f64| members.iter().map(|r| of(r)).fold(0.0, f64::max);
        let (reader, dimension, scale, mip, filter, class) = wanted;
        Line {
            reader,
            dimension,
            scale,
            filter,
            mip,
            class,
            address: address(&distinct(&members), all),
            variants: members.len(),
            look_ups: members.iter().map(|r| r.look_ups).sum(),
            wrong: members.iter().map(|r| r.wrong).sum(),
            error: worst(|r| r.worst_error),
            beyond: worst(|r| r.worst_beyond),
            weights: kind.1.or(members.iter().filter_map(|r| r.level_weights).min()),
            verdict: kind.0.unwrap_or(Verdict::Within),
        }
    };
    kinds.into_iter().map(line).collect()
}

fn distinct(rows: &[&Row]) -> Vec<Vec<Address>> {
    let mut all: Vec<Vec<Address>> = rows.iter().map(|r| r.variant.addresses()).collect();
    all.sort();
    all.dedup();
    all
}

/// Returns `all 25 pairs`, `repeat × clamp-to-edge` (both modes on either axis), `21 pairs`,
/// `repeat/repeat`.
fn address(list: &[Vec<Address>], of: usize) -> String {
    let mut modes: Vec<Address> = list.iter().flatten().copied().collect();
    modes.sort();
    modes.dedup();
    let names =
        |modes: &[Address], between: &str| modes.iter().map(|m| m.name()).collect::<Vec<_>>().join(between);
    let axes = list.first().map_or(0, Vec::len);
    let what = match axes {
        0 => return "-".into(),
        1 => "modes",
        2 => "pairs",
        _ => "triples",
    };
    match list {
        _ if list.len() == of && of > 1 => format!("all {of} {what}"),
        [one] => names(one, "/"),
        _ if axes == 2 && list.len() == modes.len().pow(2) && modes.len() < 3 => names(&modes, " × "),
        _ => format!("{} {what}", list.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Address::{ClampToEdge, Repeat};

    #[test]
    fn pairs_of_address_modes_in_words() {
        assert_eq!(address(&[vec![Repeat, Repeat]], 25), "repeat/repeat");
        assert_eq!(address(&[vec![Repeat, ClampToEdge]], 1), "repeat/clamp-to-edge");
        assert_eq!(address(&[vec![]], 1), "-");
        assert_eq!(address(&[vec![Repeat], vec![ClampToEdge]], 2), "all 2 modes");
        assert_eq!(address(&[vec![Repeat; 3], vec![ClampToEdge; 3]], 25), "2 triples");
        let both =
            [[Repeat, Repeat], [Repeat, ClampToEdge], [ClampToEdge, Repeat], [ClampToEdge, ClampToEdge]]
                .map(|pair| pair.to_vec());
        assert_eq!(address(&both, 25), "repeat × clamp-to-edge");
        assert_eq!(address(&both[..3], 25), "3 pairs");
        assert_eq!(address(&both, 4), "all 4 pairs");
    }
}
