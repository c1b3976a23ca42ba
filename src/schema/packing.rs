//! The layout of a record's fields in device memory: consecutive units of 16 bytes, four words or four reals each. A
//! field begins a new unit if the current one lacks room or holds the other kind. A unit of f64 reals takes two units
//! of 16 bytes. Both the host and the generated GLSL use this layout.

/// The kind of values in a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Geometry: f32, or f64 if the device stores or computes it in f64.
    Reals,
    /// 32-bit words: f32, u32, enums.
    Words,
}

/// The kind and the number of lanes of a type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    pub kind: Kind,
    pub lanes: u32,
}

/// The position of a field: the numbers of preceding units of either kind, and the first lane in its own unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    pub reals: u32,
    pub words: u32,
    pub lane: u32,
}

/// The types of fields as the tables name them. Any other name is that of an enum.
const SHAPES: [(&str, Shape); 13] = [
    ("f32", words(1)),
    ("Vec2", words(2)),
    ("Vec3", words(3)),
    ("Vec4", words(4)),
    ("u32", words(1)),
    ("UVec2", words(2)),
    ("UVec3", words(3)),
    ("bool", words(1)),
    ("RealBits", words(2)),
    ("f64", reals(1)),
    ("DVec2", reals(2)),
    ("DVec3", reals(3)),
    ("DVec4", reals(4)),
];

const fn words(lanes: u32) -> Shape {
    Shape { kind: Kind::Words, lanes }
}

const fn reals(lanes: u32) -> Shape {
    Shape { kind: Kind::Reals, lanes }
}

/// Returns the shape of a type.
pub const fn shape(name: &str) -> Shape {
    let mut i = 0;
    while i < SHAPES.len() {
        if same(SHAPES[i].0.as_bytes(), name.as_bytes()) {
            return SHAPES[i].1;
        }
        i += 1;
    }
    words(1)
}

const fn same(a: &[u8], b: &[u8]) -> bool {
    if a.len() != b.len() {
        return false;
    }
    let mut i = 0;
    while i < a.len() {
        if a[i] != b[i] {
            return false;
        }
        i += 1;
    }
    true
}

/// Computes the position of each field in turn.
#[derive(Clone, Copy, Debug, Default)]
pub struct Packer {
    /// Units begun so far.
    pub reals: u32,
    pub words: u32,
    last: Option<Kind>,
    filled: u32,
}

impl Packer {
    pub const fn new() -> Packer {
        Packer { reals: 0, words: 0, last: None, filled: 0 }
    }

    /// Returns the position of the next field, and the packer behind it.
    pub const fn place(mut self, next: Shape) -> (Place, Packer) {
        let goes_on = matches!(
            (self.last, next.kind),
            (Some(Kind::Reals), Kind::Reals) | (Some(Kind::Words), Kind::Words)
        );
        if !goes_on || self.filled + next.lanes > 4 {
            self.filled = 0;
            match next.kind {
                Kind::Reals => self.reals += 1,
                Kind::Words => self.words += 1,
            }
        }
        let (reals, words) = match next.kind {
            Kind::Reals => (self.reals - 1, self.words),
            Kind::Words => (self.reals, self.words - 1),
        };
        let place = Place { reals, words, lane: self.filled };
        self.filled += next.lanes;
        self.last = Some(next.kind);
        (place, self)
    }

    /// Returns the numbers of units of reals and of words in a record with such fields.
    pub const fn units(fields: &[Shape]) -> (u32, u32) {
        let mut packer = Packer::new();
        let mut i = 0;
        while i < fields.len() {
            packer = packer.place(fields[i]).1;
            i += 1;
        }
        (packer.reals, packer.words)
    }
}
