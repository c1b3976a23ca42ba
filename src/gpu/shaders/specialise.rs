//! A shader and the values of its specialization constants in; the shader without the code that these
//! leave out, out. Drivers would do the same, but only after they have translated and inlined all of it,
//! which for a small scene takes longer than everything else together. Constants become plain,
//! branches on them are decided, and blocks and functions that nothing reaches are dropped (SPIR-V 1.5,
//! "Structured Control Flow"). The workgroup's size stays a specialization constant.

use std::collections::{HashMap, HashSet};

use super::spirv::{Instruction, assemble, evaluate, op, parse};

/// Decoration number of a specialization constant's id.
const SPEC_ID: u32 = 1;
/// Ids 0 and 1 are the workgroup's width and height.
const GROUP_IDS: u32 = 2;

/// `constants` are (specialization id, value) pairs; the module must be valid.
pub fn specialise(words: &[u32], constants: &[(u32, u32)]) -> Vec<u32> {
    let (header, instructions) = parse(words);
    let first = instructions.iter().position(|i| i.op == op::FUNCTION).unwrap_or(instructions.len());
    let mut globals = instructions[..first].to_vec();
    let known = Constants::decide(&mut globals, constants);
    let mut functions: Vec<Function> = Vec::new();
    for body in instructions[first..].split_inclusive(|i| i.op == op::FUNCTION_END) {
        functions.push(Function::new(body, &known));
    }

    let entries = globals.iter().filter(|i| i.op == op::ENTRY_POINT).map(|i| i.words[1]);
    let called = reached(&functions, entries.collect());
    functions.retain(|f| called.contains(&f.id));
    let bodies: Vec<Instruction> = functions.iter().flat_map(Function::emit).collect();

    drop_unused_constants(&mut globals, &bodies);
    // Names and decorations of what is gone go too.
    let defined: HashSet<u32> = globals.iter().chain(&bodies).filter_map(Instruction::result).collect();
    globals.retain(|i| {
        let annotates = matches!(i.op, op::NAME | op::MEMBER_NAME | op::DECORATE | op::MEMBER_DECORATE);
        !annotates || defined.contains(&i.words[0])
    });
    assemble(&header, globals.iter().chain(&bodies))
}

/// Constants that only code had that is gone. Words that are no ids may keep one that nothing uses.
fn drop_unused_constants(globals: &mut Vec<Instruction>, bodies: &[Instruction]) {
    let lines = |i: &&Instruction| !matches!(i.op, op::LINE | op::NO_LINE);
    let mut used: HashSet<u32> = bodies.iter().filter(lines).flat_map(|i| &i.words).copied().collect();
    let is_kept: Vec<bool> = globals
        .iter()
        .rev()
        .map(|i| {
            let annotates = matches!(i.op, op::NAME | op::MEMBER_NAME | op::LINE | op::STRING | op::SOURCE);
            let constant = op::PLAIN_CONSTANTS.contains(&i.op);
            let kept = !constant || used.contains(&i.words[1]);
            if kept && !annotates {
                used.extend(&i.words);
            }
            kept
        })
        .collect();
    let mut kept = is_kept.into_iter().rev();
    globals.retain(|_| kept.next().unwrap_or(true));
}

/// Functions that are called from `entries`, directly or not.
fn reached(functions: &[Function], entries: Vec<u32>) -> HashSet<u32> {
    let mut called = HashSet::new();
    let mut open = entries;
    while let Some(id) = open.pop() {
        if called.insert(id) {
            open.extend(functions.iter().filter(|f| f.id == id).flat_map(Function::calls));
        }
    }
    called
}

/// Values of scalar constants: integers, and booleans as 0 or 1.
struct Constants(HashMap<u32, u32>);

impl Constants {
    /// Turns specialization constants into plain ones, and what is computed from them.
    fn decide(globals: &mut Vec<Instruction>, constants: &[(u32, u32)]) -> Constants {
        let values: HashMap<u32, u32> = constants.iter().copied().filter(|c| c.0 >= GROUP_IDS).collect();
        let spec_id = |i: &Instruction| {
            (i.op == op::DECORATE && i.words[1] == SPEC_ID).then(|| (i.words[0], i.words[2]))
        };
        let ids: HashMap<u32, u32> = globals.iter().filter_map(spec_id).collect();
        globals.retain(|i| spec_id(i).is_none_or(|(_, id)| id < GROUP_IDS));
        let mut scalars: HashMap<u32, u32> = HashMap::new(); // type → its opcode
        let mut known: HashMap<u32, u32> = HashMap::new();
        for i in globals.iter_mut() {
            if matches!(i.op, op::TYPE_BOOL | op::TYPE_INT) {
                scalars.insert(i.words[0], i.op);
            }
            let Some(id) = i.result() else { continue };
            let spec = ids.get(&id).copied();
            let group = spec.is_some_and(|spec| spec < GROUP_IDS);
            let default = match i.op {
                op::CONSTANT_TRUE | op::SPEC_CONSTANT_TRUE => Some(1),
                op::CONSTANT_FALSE | op::SPEC_CONSTANT_FALSE => Some(0),
                op::CONSTANT | op::SPEC_CONSTANT => i.words.get(2).copied(),
                op::SPEC_CONSTANT_OP => {
                    let operands: Vec<Option<u32>> =
                        i.words[3..].iter().map(|w| known.get(w).copied()).collect();
                    evaluate(i.words[2], &operands)
                }
                _ => None,
            };
            let value = spec.and_then(|spec| values.get(&spec).copied()).or(default);
            let (Some(value), Some(&kind), false) = (value, scalars.get(&i.words[0]), group) else {
                continue;
            };
            known.insert(id, value);
            *i = match (kind, value) {
                (op::TYPE_BOOL, 0) => Instruction::new(op::CONSTANT_FALSE, &i.words[..2]),
                (op::TYPE_BOOL, _) => Instruction::new(op::CONSTANT_TRUE, &i.words[..2]),
                _ => Instruction::new(op::CONSTANT, &[i.words[0], id, value]),
            };
        }
        Constants(known)
    }
}

/// A block: its label, its instructions, the last of which ends it.
struct Block {
    label: u32,
    instructions: Vec<Instruction>,
    reachable: bool,
}

struct Function {
    id: u32,
    /// Up to the first block.
    head: Vec<Instruction>,
    blocks: Vec<Block>,
    /// (from, to) of every branch that may be taken.
    edges: HashSet<(u32, u32)>,
    /// Variables that have one value.
    constants: HashSet<u32>,
}

impl Function {
    fn new(body: &[Instruction], known: &Constants) -> Function {
        let starts = body.iter().position(|i| i.op == op::LABEL).unwrap_or(body.len());
        let mut blocks: Vec<Block> = Vec::new();
        for i in &body[starts..] {
            match i.op {
                op::LABEL => {
                    blocks.push(Block { label: i.words[0], instructions: Vec::new(), reachable: false });
                }
                op::FUNCTION_END => {}
                _ => blocks.last_mut().expect("a label comes first").instructions.push(i.clone()),
            }
        }
        let head = body[..starts].to_vec();
        let (id, edges, constants) = (head[0].words[1], HashSet::new(), written_once(body));
        let mut function = Function { id, head, blocks, edges, constants };
        function.follow(known);
        function
    }

    /// Decides branches, block by block in the order of the text, in which every block follows those that
    /// dominate it; again while a branch backwards reaches something new.
    fn follow(&mut self, known: &Constants) {
        let mut values = known.0.clone();
        let mut reached: HashSet<u32> = self.blocks.first().map(|b| b.label).into_iter().collect();
        loop {
            let before = reached.len();
            for block in &mut self.blocks {
                block.reachable = reached.contains(&block.label);
                if block.reachable {
                    decide(block, &self.edges, &self.constants, &mut values);
                    let targets = block.instructions.last().map(Instruction::targets).unwrap_or_default();
                    self.edges.extend(targets.iter().map(|&to| (block.label, to)));
                    reached.extend(targets);
                }
            }
            if reached.len() == before
                && self.blocks.iter().all(|b| b.reachable == reached.contains(&b.label))
            {
                return;
            }
        }
    }

    fn calls(&self) -> Vec<u32> {
        let all = self.blocks.iter().filter(|b| b.reachable).flat_map(|b| &b.instructions);
        all.filter(|i| i.op == op::FUNCTION_CALL).map(|i| i.words[2]).collect()
    }

    /// Returns the remaining instructions. A merge or continue block must exist even if nothing branches to
    /// it.
    fn emit(&self) -> Vec<Instruction> {
        let mut continues: HashMap<u32, u32> = HashMap::new(); // continue block → its loop's header
        let mut merges: HashSet<u32> = HashSet::new();
        for block in self.blocks.iter().filter(|b| b.reachable) {
            for i in &block.instructions {
                match i.op {
                    op::LOOP_MERGE if self.is_loop(block) => {
                        merges.insert(i.words[0]);
                        continues.insert(i.words[1], block.label);
                    }
                    op::SELECTION_MERGE => drop(merges.insert(i.words[0])),
                    _ => {}
                }
            }
        }
        let mut out = self.head.clone();
        for block in &self.blocks {
            let label = Instruction::new(op::LABEL, &[block.label]);
            if block.reachable {
                out.push(label);
                let kept =
                    block.instructions.iter().filter(|i| i.op != op::LOOP_MERGE || self.is_loop(block));
                out.extend(kept.map(|i| self.with_known_parents(i, block.label)));
            } else if let Some(header) = continues.get(&block.label) {
                out.extend([label, Instruction::new(op::BRANCH, &[*header])]);
            } else if merges.contains(&block.label) {
                out.extend([label, Instruction::new(op::UNREACHABLE, &[])]);
            }
        }
        out.push(Instruction::new(op::FUNCTION_END, &[]));
        out
    }

    /// A loop that is left after its first turn, and in one place only, is none: its blocks follow each
    /// other as any do.
    fn is_loop(&self, header: &Block) -> bool {
        let Some(merge) = header.instructions.iter().find(|i| i.op == op::LOOP_MERGE) else { return false };
        let place = |label: u32| self.blocks.iter().position(|b| b.label == label);
        let comes_back =
            self.edges.iter().any(|&(from, to)| to == header.label && place(from) >= place(header.label));
        comes_back || self.edges.iter().filter(|(_, to)| *to == merge.words[0]).count() != 1
    }

    /// A phi without the values of branches that are not taken; anything else as it is.
    fn with_known_parents(&self, i: &Instruction, label: u32) -> Instruction {
        if i.op != op::PHI {
            return i.clone();
        }
        let taken = i.words[2..].chunks(2).filter(|pair| self.edges.contains(&(pair[1], label)));
        let words: Vec<u32> = i.words[..2].iter().chain(taken.flatten()).copied().collect();
        Instruction::new(op::PHI, &words)
    }
}

/// Local variables that are written once, and otherwise only read: all reads have that value.
fn written_once(body: &[Instruction]) -> HashSet<u32> {
    let locals = body.iter().filter(|i| i.op == op::VARIABLE && i.words.len() == 3).map(|i| i.words[1]);
    let mut writes: HashMap<u32, u32> = locals.map(|id| (id, 0)).collect();
    for i in body {
        let used = match i.op {
            op::VARIABLE | op::LOAD => continue,
            op::STORE => {
                writes.entry(i.words[0]).and_modify(|count| *count += 1);
                &i.words[1..]
            }
            _ => i.words.as_slice(),
        };
        for word in used {
            writes.remove(word); // others may write through its address
        }
    }
    writes.into_iter().filter(|w| w.1 == 1).map(|w| w.0).collect()
}

/// Values that a reachable block computes from known ones, and its branch if that is known. `constants`
/// are variables that are written once.
fn decide(
    block: &mut Block,
    edges: &HashSet<(u32, u32)>,
    constants: &HashSet<u32>,
    values: &mut HashMap<u32, u32>,
) {
    // Branches backwards are not seen before the loop has been gone through.
    let is_loop = block.instructions.iter().any(|i| i.op == op::LOOP_MERGE);
    for i in &block.instructions {
        if let (op::STORE, [pointer, value, ..]) = (i.op, i.words.as_slice())
            && constants.contains(pointer)
            && let Some(&value) = values.get(value)
        {
            values.insert(*pointer, value);
        }
        let Some(id) = i.result().filter(|_| i.op != op::VARIABLE) else { continue };
        let value = if i.op == op::PHI && !is_loop {
            let taken = i.words[2..].chunks(2).filter(|pair| edges.contains(&(pair[1], block.label)));
            let mut incoming = taken.map(|pair| values.get(&pair[0]).copied());
            let first = incoming.next().flatten();
            first.filter(|_| incoming.all(|value| value == first))
        } else if i.op == op::LOAD {
            values.get(&i.words[2]).copied()
        } else {
            let operands = i.words.get(2..).unwrap_or_default();
            let operands: Vec<Option<u32>> = operands.iter().map(|w| values.get(w).copied()).collect();
            evaluate(i.op, &operands)
        };
        match value {
            Some(value) => drop(values.insert(id, value)),
            None => drop(values.remove(&id)),
        }
    }
    let Some(last) = block.instructions.last() else { return };
    if last.op != op::BRANCH_CONDITIONAL {
        return;
    }
    if let Some(&condition) = values.get(&last.words[0]) {
        let taken = if condition != 0 { last.words[1] } else { last.words[2] };
        block.instructions.pop();
        if block.instructions.last().is_some_and(|i| i.op == op::SELECTION_MERGE) {
            block.instructions.pop();
        }
        block.instructions.push(Instruction::new(op::BRANCH, &[taken]));
    }
}
