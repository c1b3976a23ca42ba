//! SPIR-V modules as lists of instructions (SPIR-V 1.5, section 2.3): words in, instructions out, and
//! back. Only what specialising needs to know about them.

/// Opcodes by their names in the specification.
pub mod op {
    use std::ops::RangeInclusive;

    pub const SOURCE_CONTINUED: u32 = 2;
    pub const SOURCE: u32 = 3;
    pub const NAME: u32 = 5;
    pub const MEMBER_NAME: u32 = 6;
    pub const STRING: u32 = 7;
    pub const LINE: u32 = 8;
    pub const EXT_INST_IMPORT: u32 = 11;
    pub const ENTRY_POINT: u32 = 15;
    /// Up to here, and decorations: instructions about the module and its ids.
    pub const CAPABILITY: u32 = 17;
    pub const TYPE_BOOL: u32 = 20;
    pub const TYPE_INT: u32 = 21;
    pub const TYPES: RangeInclusive<u32> = 19..=39;
    pub const CONSTANT_TRUE: u32 = 41;
    pub const CONSTANT_FALSE: u32 = 42;
    pub const CONSTANT: u32 = 43;
    pub const PLAIN_CONSTANTS: RangeInclusive<u32> = 41..=44;
    pub const SPEC_CONSTANT_TRUE: u32 = 48;
    pub const SPEC_CONSTANT_FALSE: u32 = 49;
    pub const SPEC_CONSTANT: u32 = 50;
    pub const SPEC_CONSTANT_OP: u32 = 52;
    pub const FUNCTION: u32 = 54;
    pub const FUNCTION_END: u32 = 56;
    pub const FUNCTION_CALL: u32 = 57;
    pub const VARIABLE: u32 = 59;
    pub const LOAD: u32 = 61;
    pub const STORE: u32 = 62;
    pub const DECORATE: u32 = 71;
    pub const MEMBER_DECORATE: u32 = 72;
    pub const I_ADD: u32 = 128;
    pub const I_SUB: u32 = 130;
    pub const I_MUL: u32 = 132;
    pub const LOGICAL_EQUAL: u32 = 164;
    pub const LOGICAL_NOT_EQUAL: u32 = 165;
    pub const LOGICAL_OR: u32 = 166;
    pub const LOGICAL_AND: u32 = 167;
    pub const LOGICAL_NOT: u32 = 168;
    pub const SELECT: u32 = 169;
    pub const I_EQUAL: u32 = 170;
    pub const I_NOT_EQUAL: u32 = 171;
    pub const U_GREATER_THAN: u32 = 172;
    pub const U_GREATER_THAN_EQUAL: u32 = 174;
    pub const U_LESS_THAN: u32 = 176;
    pub const U_LESS_THAN_EQUAL: u32 = 178;
    pub const SHIFT_RIGHT_LOGICAL: u32 = 194;
    pub const SHIFT_LEFT_LOGICAL: u32 = 196;
    pub const BITWISE_OR: u32 = 197;
    pub const BITWISE_AND: u32 = 199;
    pub const PHI: u32 = 245;
    pub const LOOP_MERGE: u32 = 246;
    pub const SELECTION_MERGE: u32 = 247;
    pub const LABEL: u32 = 248;
    pub const BRANCH: u32 = 249;
    pub const BRANCH_CONDITIONAL: u32 = 250;
    pub const SWITCH: u32 = 251;
    pub const TERMINATORS: RangeInclusive<u32> = 249..=255;
    pub const UNREACHABLE: u32 = 255;
    pub const NO_LINE: u32 = 317;
}

/// One instruction without its first word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Instruction {
    pub op: u32,
    pub words: Vec<u32>,
}

impl Instruction {
    pub fn new(op: u32, words: &[u32]) -> Instruction {
        Instruction { op, words: words.to_vec() }
    }

    /// The id that it defines.
    pub fn result(&self) -> Option<u32> {
        match self.op {
            op::LABEL | op::EXT_INST_IMPORT => self.words.first().copied(),
            0..=op::CAPABILITY | op::DECORATE | op::MEMBER_DECORATE => None,
            o if op::TYPES.contains(&o) => self.words.first().copied(),
            op::STORE | op::LOOP_MERGE | op::SELECTION_MERGE | op::FUNCTION_END => None,
            o if op::TERMINATORS.contains(&o) => None,
            _ => self.words.get(1).copied(),
        }
    }

    /// Labels that a terminator leads to.
    pub fn targets(&self) -> Vec<u32> {
        match self.op {
            op::BRANCH => vec![self.words[0]],
            op::BRANCH_CONDITIONAL => vec![self.words[1], self.words[2]],
            op::SWITCH => {
                std::iter::once(self.words[1]).chain(self.words[3..].iter().step_by(2).copied()).collect()
            }
            _ => Vec::new(),
        }
    }
}

/// Words of a module's header.
const HEADER: usize = 5;

/// The header and the instructions of a valid module, without the source text and the places in it.
pub fn parse(words: &[u32]) -> (Vec<u32>, Vec<Instruction>) {
    let mut instructions = Vec::new();
    let mut at = HEADER;
    while at < words.len() {
        let (op, length) = (words[at] & 0xFFFF, (words[at] >> 16) as usize);
        if !matches!(op, op::SOURCE | op::SOURCE_CONTINUED | op::STRING | op::LINE | op::NO_LINE) {
            instructions.push(Instruction::new(op, &words[at + 1..at + length]));
        }
        at += length;
    }
    (words[..HEADER].to_vec(), instructions)
}

pub fn assemble<'a>(header: &[u32], instructions: impl Iterator<Item = &'a Instruction>) -> Vec<u32> {
    let mut words = header.to_vec();
    for instruction in instructions {
        words.push(((instruction.words.len() as u32 + 1) << 16) | instruction.op);
        words.extend_from_slice(&instruction.words);
    }
    words
}

/// Integer and boolean arithmetic; `None` where the known operands do not decide the result, or for what
/// is not among it.
pub fn evaluate(op: u32, operands: &[Option<u32>]) -> Option<u32> {
    match (op, operands) {
        (op::SELECT, [condition, a, b]) => return if (*condition)? != 0 { *a } else { *b },
        (op::LOGICAL_AND, [Some(0), _] | [_, Some(0)]) => return Some(0),
        (op::LOGICAL_OR, [Some(1), _] | [_, Some(1)]) => return Some(1),
        _ => {}
    }
    let known: Vec<u32> = operands.iter().copied().collect::<Option<_>>()?;
    Some(match (op, known.as_slice()) {
        (op::LOGICAL_NOT, [a]) => u32::from(*a == 0),
        (op::LOGICAL_AND | op::BITWISE_AND, [a, b]) => a & b,
        (op::LOGICAL_OR | op::BITWISE_OR, [a, b]) => a | b,
        (op::LOGICAL_EQUAL | op::I_EQUAL, [a, b]) => u32::from(a == b),
        (op::LOGICAL_NOT_EQUAL | op::I_NOT_EQUAL, [a, b]) => u32::from(a != b),
        (op::U_GREATER_THAN, [a, b]) => u32::from(a > b),
        (op::U_GREATER_THAN_EQUAL, [a, b]) => u32::from(a >= b),
        (op::U_LESS_THAN, [a, b]) => u32::from(a < b),
        (op::U_LESS_THAN_EQUAL, [a, b]) => u32::from(a <= b),
        (op::SHIFT_RIGHT_LOGICAL, [a, b]) => a.checked_shr(*b)?,
        (op::SHIFT_LEFT_LOGICAL, [a, b]) => a.checked_shl(*b)?,
        (op::I_ADD, [a, b]) => a.wrapping_add(*b),
        (op::I_SUB, [a, b]) => a.wrapping_sub(*b),
        (op::I_MUL, [a, b]) => a.wrapping_mul(*b),
        _ => return None,
    })
}
