//! `messages`: the macro that declares the league's messages, a line a field, close to the league's own
//! files.

/// Declares `prost` messages. A field is `NAME: TYPE [KIND, LABEL] = TAG;` with its docs above it; what
/// stands in brackets is `prost`'s.
macro_rules! messages {
    ($(
        $(#[$about:meta])*
        pub struct $name:ident {
            $($(#[$doc:meta])* $field:ident: $ty:ty [$($kind:tt)+] = $tag:tt;)*
        }
    )+) => { $(
        $(#[$about])*
        pub struct $name {
            $($(#[$doc])* #[prost($($kind)+, tag = $tag)] pub $field: $ty,)*
        }
    )+ };
}
