//! What is left out of an OBJ file. Input: statements that are not read, with their lines. Output: one note for each keyword,
//! with how often it stands in the file and where first.

use crate::core::counted::counted;
use crate::mesh::text::quoted;

/// Statements that say nothing of how triangles look: groups, the smoothing that normals tell better, and the parts of curves
/// and surfaces, which are told by the statement that begins them.
const SILENT: [&[u8]; 27] = [
    b"",
    b"g",
    b"o",
    b"s",
    b"mg",
    b"vp",
    b"lod",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"shadow_obj",
    b"trace_obj",
    b"ctech",
    b"stech",
    b"cstype",
    b"deg",
    b"bmat",
    b"step",
    b"parm",
    b"trim",
    b"hole",
    b"scrv",
    b"sp",
    b"end",
    b"con",
    b"call",
    b"csh",
];
/// Other keywords that are told apart; a file that is none has many.
const MOST: usize = 8;

/// The statements that are left out.
#[derive(Default)]
pub(super) struct LeftOut(Vec<(Vec<u8>, usize, usize)>);

impl LeftOut {
    /// Adds a statement of this keyword in small letters.
    pub fn add(&mut self, keyword: &[u8], line: usize) {
        if SILENT.contains(&keyword) || keyword.starts_with(b"#") {
            return;
        }
        let is_full = self.0.len() == MOST;
        match self.0.iter_mut().find(|(known, ..)| known == keyword) {
            Some((_, count, _)) => *count += 1,
            None if is_full => {}
            None => self.0.push((keyword.to_owned(), 1, line)),
        }
    }

    /// Returns the notes.
    pub fn notes(self) -> impl Iterator<Item = String> {
        self.0.into_iter().map(|(keyword, count, line)| {
            let what = match keyword.as_slice() {
                b"l" => counted(count, "line"),
                b"p" => format!("{} of points", counted(count, "statement")),
                b"curv" | b"curv2" => counted(count, "curve"),
                b"surf" => counted(count, "free-form surface"),
                other => format!("{} {}", counted(count, "statement"), quoted(other)),
            };
            let first = if count > 1 { "the first " } else { "" };
            format!("left out: {what}, {first}in line {line}")
        })
    }
}
