//! The tables of this folder → Rust. Each table is one macro call in a file of its own; `build/tables.rs` gives
//! the same macros another body, by which the same files become GLSL.

/// Enums that the shader knows as `const uint PREFIX_VARIANT`, in the same order.
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

/// Numbers that host and device share.
macro_rules! constants {
    ($($(#[$meta:meta])* $name:ident: $type:ty = $value:expr;)+) => {
        $($(#[$meta])* pub const $name: $type = $value;)+
    };
}

/// Descriptors of set 0; the shader says `BINDING_NAME`.
macro_rules! bindings {
    ($($(#[$meta:meta])* $name:ident = $number:literal;)+) => {
        $($(#[$meta])* pub const $name: u32 = $number;)+
    };
}

/// Blocks of words: push constants and list entries, as std430 and `repr(C)` lay them out alike.
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

        /// What the value of a specialization constant means.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Kind {
            /// A bit mask of modes, which have these names.
            Modes(&'static [&'static str]),
            /// A number, or `DYNAMIC`.
            Count,
            /// Code that is there or not.
            Switch,
            /// Set where a pipeline is built, whatever the scene uses.
            Parameter,
        }

        impl Constant {
            const WHAT: &'static [&'static str] = &[$($what,)+];
            const KINDS: &'static [Kind] = &[$(kind!($kind $(($($of)+))?),)+];

            /// Returns the number by which SPIR-V knows it.
            pub const fn id(self) -> u32 {
                self as u32
            }

            pub const fn kind(self) -> Kind {
                Constant::KINDS[self as usize]
            }

            /// Returns what a person calls the code behind it.
            pub const fn what(self) -> &'static str {
                Constant::WHAT[self as usize]
            }
        }
    };
}

/// What the value of a specialization constant means.
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

/// Records of the scene buffer, and the word for the code that goes through a list of them.
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
