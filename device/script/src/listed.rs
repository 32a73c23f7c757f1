//! Enums that know all their members, and a text of each.

/// Defines an enum with the list of its members as `ALL`, in the order of their definition, and where each member has a text behind
/// it, with the function that tells that text.
macro_rules! listed {
    ($(#[$of:meta])* pub enum $name:ident { $($(#[$what:meta])* $member:ident,)* }) => {
        $(#[$of])*
        pub enum $name {
            $($(#[$what])* $member,)*
        }

        impl $name {
            /// All of them.
            pub const ALL: [Self; [$(Self::$member),*].len()] = [$(Self::$member),*];
        }
    };
    ($(#[$of:meta])* pub enum $name:ident { $($(#[$what:meta])* $member:ident $text:literal,)* }
     $(#[$told:meta])* fn $tell:ident;) => {
        $crate::listed::listed! { $(#[$of])* pub enum $name { $($(#[$what])* $member,)* } }

        impl $name {
            $(#[$told])*
            pub const fn $tell(self) -> &'static str {
                match self {
                    $(Self::$member => $text,)*
                }
            }
        }
    };
}

/// Codes of errors and warnings: a constant each, and all with their meaning.
macro_rules! coded {
    ($($name:ident = $code:literal, $meaning:literal;)*) => {
        $(#[doc = $meaning] pub const $name: &str = $code;)*
        /// Every code with its meaning, in order.
        pub const ALL: &[(&str, &str)] = &[$(($code, $meaning)),*];
    };
}

pub(crate) use {coded, listed};
