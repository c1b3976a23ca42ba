//! Expands the tables of this folder to Rust. Each table is one macro call in a file of its own; `build/tables.rs`
//! defines the same macros differently, so that the same files become GLSL.

/// Enums that the shader declares as `const uint PREFIX_VARIANT`, in the same order.
macro_rules! enums {
    ($($(#[$meta:meta])* $prefix:ident: $enum:ident { $($(#[$vmeta:meta])* $variant:ident = $name:literal,)+ })+) => {
        use crate::core::named::named_enum;
        $(
            named_enum! {
                $(#[$meta])*
                pub enum $enum { $($(#[$vmeta])* $variant = $name,)+ }
            }

            impl super::record::Field for $enum {
                fn write(self, double: bool, bytes: &mut Vec<u8>) {
                    (self as u32).write(double, bytes);
                }
            }
        )+
    };
}

/// The reflection models as an enum.
macro_rules! models {
    ($($(#[$meta:meta])* $variant:ident = $name:literal, [$($property:ident)*], [$($key:ident)*];)+) => {
        enums! {
            /// The reflection model of a material.
            #[derive(Default)]
            MODEL: Model { $($(#[$meta])* $variant = $name,)+ }
        }

        impl Model {
            const PROPERTIES: &'static [&'static [&'static str]] = &[$(&[$(stringify!($property)),*]),+];
            const KEYS: &'static [&'static [&'static str]] = &[$(&[$(stringify!($key)),*]),+];

            /// Returns true if it has a property of the table.
            pub(crate) fn is(self, property: &str) -> bool {
                Model::PROPERTIES[self as usize].contains(&property)
            }

            /// Returns true if a material of this model has a key that only some have.
            pub(crate) fn has_key(self, key: &str) -> bool {
                Model::KEYS[self as usize].contains(&key)
            }
        }
    };
}

/// Constants that host and device share.
macro_rules! constants {
    ($($(#[$meta:meta])* $name:ident: $type:ty = $value:expr;)+) => {
        $($(#[$meta])* pub const $name: $type = $value;)+
    };
}

/// Descriptors of set 0; the shader's name is `BINDING_NAME`.
macro_rules! bindings {
    ($($(#[$meta:meta])* $name:ident = $number:literal;)+) => {
        $($(#[$meta])* pub const $name: u32 = $number;)+
    };
}

/// Blocks of words: push constants and list entries, for which std430 and `repr(C)` are the same.
macro_rules! blocks {
    ($($(#[$meta:meta])* $block:ident { $($(#[$fmeta:meta])* $field:ident,)+ })+) => {
        $(
            $(#[$meta])*
            #[repr(C)]
            #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
            pub struct $block { $($(#[$fmeta])* pub $field: u32,)+ }
        )+
    };
}

/// Specialization constants, in the order of their ids; two for each list of records follow.
macro_rules! specialization {
    ($($(#[$meta:meta])* $variant:ident = $name:literal, $kind:ident $(($($of:tt)+))?, $what:literal;)+) => {
        use super::enums::*;
        use super::models::Model;
        use super::records::List;

        /// A specialization constant of the shaders.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Constant {
            $($(#[$meta])* #[doc = concat!("Written `", $name, "`.")] $variant,)+
            /// The length of a list of records.
            Length(List),
            /// The offset of a list in the scene buffer, in units of 16 bytes.
            At(List),
        }

        /// The meaning of a specialization constant's value.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Kind {
            /// A bit mask of modes with these names.
            Modes(&'static [&'static str]),
            /// A number, or `DYNAMIC`.
            Count,
            /// Code that may be removed.
            Switch,
            /// Set when a pipeline is built, whatever the scene uses.
            Parameter,
        }

        /// The rows of the table: constant, meaning of its value, and user-visible name of the code that it controls.
        const ROWS: &[(Constant, Kind, &str)] =
            &[$((Constant::$variant, kind!($kind $(($($of)+))?), $what),)+];

        impl Constant {
            /// Returns all constants, in the order of their ids.
            pub fn all() -> impl Iterator<Item = Constant> {
                let rows = ROWS.iter().map(|row| row.0);
                rows.chain(List::ALL.iter().flat_map(|&list| [Constant::Length(list), Constant::At(list)]))
            }

            /// Returns the constant id in SPIR-V.
            pub fn id(self) -> u32 {
                Constant::all().take_while(|&constant| constant != self).count() as u32
            }

            /// Returns the name that the shaders use.
            pub fn name(self) -> String {
                match self {
                    $(Constant::$variant => $name.to_owned(),)+
                    Constant::Length(list) => list.name().to_uppercase(),
                    Constant::At(list) => list.name().to_uppercase() + "_AT",
                }
            }

            pub fn kind(self) -> Kind {
                match self {
                    Constant::Length(_) => Kind::Count,
                    Constant::At(_) => Kind::Parameter,
                    _ => ROWS[self.id() as usize].1,
                }
            }

            /// Returns the user-visible name of the code that it controls.
            pub fn what(self) -> &'static str {
                match self {
                    Constant::Length(list) | Constant::At(list) => list.what(),
                    _ => ROWS[self.id() as usize].2,
                }
            }
        }
    };
}

/// The meaning of a specialization constant's value.
macro_rules! kind {
    (modes($enum:ident)) => {
        Kind::Modes($enum::NAMES)
    };
    (count) => {
        Kind::Count
    };
    (switch) => {
        Kind::Switch
    };
    (parameter($default:literal)) => {
        Kind::Parameter
    };
    (flag) => {
        Kind::Parameter
    };
    (id) => {
        Kind::Parameter
    };
}

/// The record at the front of the scene buffer.
macro_rules! header {
    ($(#[$meta:meta])* $record:ident { $($(#[$fmeta:meta])* $field:ident: $type:ident,)+ }) => {
        use super::enums::*;
        use super::packing::{Packer, shape};
        use super::record::{Field as _, Record, Writer};
        use glam::{DVec3, UVec2, Vec3};
        record! { $(#[$meta])* $record { $($(#[$fmeta])* $field: $type,)+ } }
    };
}

/// Records of lists in the scene buffer, and the name of the code that loops over each.
macro_rules! records {
    ($($(#[$meta:meta])* $record:ident in $list:ident as $what:literal { $($(#[$fmeta:meta])* $field:ident: $type:ident,)+ })+) => {
        use super::enums::*;
        use super::models::Model;
        use super::packing::{Packer, shape};
        use super::record::{Field as _, RealBits, Record, Writer, bytes_of};
        use glam::{DVec2, DVec3, DVec4, UVec3, Vec3, Vec4};
        $(record! { $(#[$meta])* $record { $($(#[$fmeta])* $field: $type,)+ } })+

        record! {
            /// The length of each list of records.
            Lengths { $($list: u32,)+ }
        }

        record! {
            /// The offset of each list of records in the scene buffer, in units of 16 bytes.
            Places { $($list: u32,)+ }
        }

        impl Places {
            /// Returns the offset of a list.
            pub fn of(&mut self, list: List) -> &mut u32 {
                match list {
                    $(List::$record => &mut self.$list,)+
                }
            }
        }

        /// A list of records in the scene buffer.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum List {
            $(#[doc = concat!("`", stringify!($list), "`.")] $record,)+
        }

        impl List {
            /// All lists, in the order of the table.
            pub const ALL: &'static [List] = &[$(List::$record,)+];
            const NAMES: &'static [&'static str] = &[$(stringify!($list),)+];
            const WHAT: &'static [&'static str] = &[$($what,)+];

            pub const fn name(self) -> &'static str {
                List::NAMES[self as usize]
            }

            /// Returns the user-visible name of the code that loops over it.
            pub const fn what(self) -> &'static str {
                List::WHAT[self as usize]
            }
        }

        /// The lists of records after the header of the scene buffer.
        #[derive(Clone, Debug, Default)]
        pub struct Records {
            $(pub $list: Vec<$record>,)+
        }

        impl Records {
            pub fn lengths(&self) -> Lengths {
                Lengths { $($list: self.$list.len() as u32,)+ }
            }

            pub fn len(&self, list: List) -> usize {
                match list {
                    $(List::$record => self.$list.len(),)+
                }
            }

            /// Returns the bytes of a list.
            pub fn bytes(&self, list: List, double: bool) -> Vec<u8> {
                match list {
                    $(List::$record => bytes_of(&self.$list, double),)+
                }
            }

            /// Rounds all records to the f32 values that the shader reads unless it reads f64.
            pub fn quantize_f32(&mut self) {
                $(self.$list.iter_mut().for_each(|record| *record = record.quantize_f32());)+
            }
        }
    };
}

/// Implements a record: writing its fields, and rounding them to the values of an f32 shader.
macro_rules! record {
    ($(#[$meta:meta])* $record:ident { $($(#[$fmeta:meta])* $field:ident: $type:ident,)+ }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct $record { $($(#[$fmeta])* pub $field: $type,)+ }

        impl Record for $record {
            const UNITS: (u32, u32) = Packer::units(&[$(shape(stringify!($type)),)+]);

            fn write(&self, double: bool, bytes: &mut Vec<u8>) {
                let mut writer = Writer::new(double, bytes);
                $(writer.field(shape(stringify!($type)), self.$field);)+
                writer.end();
            }

            fn quantize_f32(&self) -> Self {
                $record { $($field: self.$field.quantize_f32(),)+ }
            }
        }
    };
}
