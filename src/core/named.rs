//! One table per vocabulary: an enum whose variants carry the names that scene files, the command
//! line, messages and tests use. Each name is written once, at the enum.

/// Declares an enum with `ALL`, `name()`, `NAMES` and `from_name()`.
macro_rules! named_enum {
    ($(#[$meta:meta])* pub enum $enum:ident { $($(#[$vmeta:meta])* $variant:ident = $name:literal,)+ }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[repr(u32)]
        pub enum $enum {
            $($(#[$vmeta])* #[doc = concat!("Written `", $name, "`.")] $variant,)+
        }

        impl $enum {
            /// Every value, in the order of the vocabulary.
            pub const ALL: &'static [$enum] = &[$($enum::$variant,)+];
            /// The names of all, in the same order.
            pub const NAMES: &'static [&'static str] = &[$($name,)+];

            /// Returns the name that scene files, options and messages use.
            pub const fn name(self) -> &'static str {
                Self::NAMES[self as usize]
            }

            /// Returns the value of this name.
            pub fn from_name(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|v| v.name() == name)
            }
        }

        impl std::fmt::Display for $enum {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }
    };
}

pub(crate) use named_enum;
