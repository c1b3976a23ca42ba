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

/// Specialization constants, in the order of their ids.
macro_rules! specialization {
    ($($(#[$meta:meta])* $variant:ident = $name:literal, $kind:ident $(($($of:tt)+))?, $what:literal;)+) => {
        use super::enums::*;
        use crate::core::named::named_enum;

        named_enum! {
            /// A specialization constant of the shaders.
            pub enum Constant { $($(#[$meta])* $variant = $name,)+ }
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

        impl Constant {
            const WHAT: &'static [&'static str] = &[$($what,)+];
            const KINDS: &'static [Kind] = &[$(kind!($kind $(($($of)+))?),)+];

            /// Returns the constant id in SPIR-V.
            pub const fn id(self) -> u32 {
                self as u32
            }

            pub const fn kind(self) -> Kind {
                Constant::KINDS[self as usize]
            }

            /// Returns the user-visible name of the code that it controls.
            pub const fn what(self) -> &'static str {
                Constant::WHAT[self as usize]
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

/// Records of the scene buffer, and the name of the code that loops over a list of them.
macro_rules! records {
    ($($(#[$meta:meta])* $record:ident $(in $list:ident as $what:literal)? { $($(#[$fmeta:meta])* $field:ident: $type:ident,)+ })+) => {
        use super::enums::*;
        use super::packing::{Packer, shape};
        use super::record::{Field as _, RealBits, Record, Writer};
        use glam::{DVec2, DVec3, DVec4, UVec2, UVec3, Vec3, Vec4};
        $(
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
        )+
    };
}
