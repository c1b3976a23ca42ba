//! Defines the macros of `src/schema/tables.rs` a second time: here the same tables become lists of names, from which
//! `generate.rs` writes GLSL.

pub struct Enum {
    pub prefix: &'static str,
    pub name: &'static str,
    /// The variants as files and messages name them.
    pub variants: &'static [&'static str],
}

pub enum Number {
    Uint(u32),
    Float(f64),
}

pub struct SpecializationConstant {
    pub name: &'static str,
    pub kind: &'static str,
    /// The text in parentheses after the kind.
    pub of: &'static str,
}

pub struct Block {
    pub name: &'static str,
    pub fields: &'static [&'static str],
}

pub struct Record {
    pub name: &'static str,
    /// Empty for one that is in no list.
    pub list: &'static str,
    /// Name and type of each field.
    pub fields: &'static [(&'static str, &'static str)],
}

macro_rules! enums {
    ($($(#[$meta:meta])* $prefix:ident: $enum:ident { $($(#[$vmeta:meta])* $variant:ident = $name:literal,)+ })+) => {
        pub const ENUMS: &[crate::tables::Enum] = &[$(crate::tables::Enum {
            prefix: stringify!($prefix),
            name: stringify!($enum),
            variants: &[$($name,)+],
        },)+];
    };
}

macro_rules! models {
    ($($(#[$meta:meta])* $variant:ident = $name:literal, [$($property:ident)*], [$($key:ident)*];)+) => {
        enums! { MODEL: Model { $($variant = $name,)+ } }
    };
}

macro_rules! constants {
    ($($(#[$meta:meta])* $name:ident: $type:ident = $value:expr;)+) => {
        pub const CONSTANTS: &[(&str, crate::tables::Number)] =
            &[$((stringify!($name), number!($type, $value)),)+];
    };
}

macro_rules! number {
    (u32, $value:expr) => {
        crate::tables::Number::Uint($value)
    };
    (f64, $value:expr) => {
        crate::tables::Number::Float($value)
    };
}

macro_rules! bindings {
    ($($(#[$meta:meta])* $name:ident = $number:literal;)+) => {
        pub const BINDINGS: &[(&str, u32)] = &[$((stringify!($name), $number),)+];
    };
}

macro_rules! blocks {
    ($($(#[$meta:meta])* $block:ident { $($(#[$fmeta:meta])* $field:ident,)+ })+) => {
        pub const BLOCKS: &[crate::tables::Block] = &[$(crate::tables::Block {
            name: stringify!($block),
            fields: &[$(stringify!($field),)+],
        },)+];
    };
}

macro_rules! specialization {
    ($($(#[$meta:meta])* $variant:ident = $name:literal, $kind:ident $(($($of:tt)+))?, $what:literal;)+) => {
        pub const SPECIALIZATION: &[crate::tables::SpecializationConstant] =
            &[$(crate::tables::SpecializationConstant {
                name: $name,
                kind: stringify!($kind),
                of: concat!($($(stringify!($of)),+)?),
            },)+];
    };
}

macro_rules! header {
    ($(#[$meta:meta])* $record:ident { $($(#[$fmeta:meta])* $field:ident: $type:ident,)+ }) => {
        pub const HEADER: crate::tables::Record = crate::tables::Record {
            name: stringify!($record),
            list: "",
            fields: &[$((stringify!($field), stringify!($type)),)+],
        };
    };
}

macro_rules! records {
    ($($(#[$meta:meta])* $record:ident in $list:ident as $what:literal { $($(#[$fmeta:meta])* $field:ident: $type:ident,)+ })+) => {
        pub const RECORDS: &[crate::tables::Record] = &[$(crate::tables::Record {
            name: stringify!($record),
            list: stringify!($list),
            fields: &[$((stringify!($field), stringify!($type)),)+],
        },)+];

        /// The lengths of all lists.
        pub const LENGTHS: crate::tables::Record = crate::tables::Record {
            name: "Lengths",
            list: "",
            fields: &[$((stringify!($list), "u32"),)+],
        };

        /// Where all lists begin.
        pub const PLACES: crate::tables::Record =
            crate::tables::Record { name: "Places", list: LENGTHS.list, fields: LENGTHS.fields };
    };
}

/// A kind of shapes.
pub struct ShapeKind {
    pub record: &'static str,
    pub module: &'static str,
    pub list: &'static str,
    pub properties: &'static [&'static str],
}

macro_rules! shape_kinds {
    ($($record:ident $module:ident $list:ident [$($property:ident)*];)+) => {
        pub const SHAPE_KINDS: &[crate::tables::ShapeKind] = &[$(crate::tables::ShapeKind {
            record: stringify!($record),
            module: stringify!($module),
            list: stringify!($list),
            properties: &[$(stringify!($property)),*],
        },)+];
    };
}
