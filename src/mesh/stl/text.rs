//! STL as text. Input: the bytes of a file. Output: the corners of its facets, three each. Its words may stand in one line
//! or in many; names of solids and the normals of facets are passed over.

use glam::DVec3;

use crate::mesh::{Fault, check};

/// Reads the corners of at most `most` facets.
pub(super) fn corners(bytes: &[u8], most: usize) -> Result<Vec<DVec3>, Fault> {
    let mut reader = Reader { most, ..Reader::default() };
    for (line, bytes) in (1..).zip(bytes.split(|&byte| byte == b'\n')) {
        let shown = String::from_utf8_lossy(bytes);
        let mut words = shown.split_ascii_whitespace().peekable();
        reader.passes = Passes::None;
        while let Some(word) = words.next() {
            let next = words.peek().copied().unwrap_or_default();
            reader.word(word, next, &mut words).map_err(|what| Fault::new(format!("line {line}"), what))?;
        }
    }
    match reader.positions.len() {
        0 => Err(Fault::new("", "it has no facets")),
        count if count % 3 != 0 => Err(Fault::new("", "it ends within a facet")),
        _ => Ok(reader.positions),
    }
}

/// Words that are passed over until the next one of STL, or the end of the line.
#[derive(Clone, Copy, Default, PartialEq)]
enum Passes {
    #[default]
    None,
    /// The name of a solid, which may have words of STL.
    Name,
    /// Numbers of a normal, or `loop`.
    Rest,
}

#[derive(Default)]
struct Reader {
    most: usize,
    positions: Vec<DVec3>,
    /// Corners before the facet that is being read.
    first: usize,
    passes: Passes,
}

impl Reader {
    /// Reads a word and what belongs to it.
    fn word<'a>(
        &mut self,
        word: &str,
        next: &str,
        words: &mut impl Iterator<Item = &'a str>,
    ) -> Result<(), String> {
        let lower = word.to_ascii_lowercase();
        let ends_name = lower == "facet" && next.eq_ignore_ascii_case("normal") || lower == "endsolid";
        if self.passes == Passes::Name && !ends_name {
            return Ok(());
        }
        self.passes = match lower.as_str() {
            "solid" | "endsolid" => Passes::Name,
            "outer" | "endloop" => Passes::Rest,
            "vertex" => {
                self.positions.push(corner(words)?);
                if self.positions.len() - self.first > 3 {
                    return Err("a facet has 3 vertices, not more".into());
                }
                Passes::None
            }
            "facet" => {
                self.first = self.positions.len();
                Passes::Rest
            }
            "endfacet" => {
                let count = self.positions.len() - self.first;
                if count != 3 {
                    return Err(format!("a facet has 3 vertices, not {count}"));
                }
                // A further corner begins the next facet, with or without its word.
                self.first = self.positions.len();
                check::count(self.positions.len() / 3, self.most).map_err(|fault| fault.what)?;
                Passes::None
            }
            _ if self.passes == Passes::Rest => Passes::Rest,
            _ => {
                return Err(format!(
                    "{word:?} is no word of STL; facet, outer loop, vertex, endloop, endfacet are"
                ));
            }
        };
        Ok(())
    }
}

fn corner<'a>(words: &mut impl Iterator<Item = &'a str>) -> Result<DVec3, String> {
    let mut number = || {
        let word = words.next().ok_or("a vertex has 3 coordinates")?;
        word.parse::<f64>().map_err(|_| format!("{word:?} is no number"))
    };
    Ok(DVec3::new(number()?, number()?, number()?))
}
