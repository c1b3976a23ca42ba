//! Adds `NoContraction` to all float arithmetic of a SPIR-V module, as if every variable of the source were
//! `precise`. Otherwise a driver may fuse a product with a sum in one pipeline and not in another, and lean
//! pictures would differ from full ones by an ulp. `fma` still fuses where it is written.

const DECORATE: u32 = 71;
const NO_CONTRACTION: u32 = 42;
const FUNCTION: u32 = 54;
const TYPES: std::ops::RangeInclusive<u32> = 19..=39;
/// FAdd, FSub, FMul, FDiv; products of vectors and matrices; Dot.
const FLOAT_ARITHMETIC: [u32; 11] = [129, 131, 133, 136, 142, 143, 144, 145, 146, 147, 148];

pub fn uncontracted(words: &[u32]) -> Vec<u32> {
    let (mut decorations, mut annotations_end) = (Vec::new(), None);
    let (mut at, mut in_functions) = (5, false);
    while at < words.len() {
        let (op, len) = (words[at] & 0xFFFF, (words[at] >> 16) as usize);
        // Decorations end where types begin (SPIR-V 1.5, section 2.4).
        if TYPES.contains(&op) && annotations_end.is_none() {
            annotations_end = Some(at);
        }
        in_functions |= op == FUNCTION;
        if in_functions && FLOAT_ARITHMETIC.contains(&op) {
            decorations.extend([3 << 16 | DECORATE, words[at + 2], NO_CONTRACTION]);
        }
        at += len;
    }
    let (head, tail) = words.split_at(annotations_end.unwrap_or(words.len()));
    [head, &decorations, tail].concat()
}
