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

/// Declares game events by [`messages!`]: `team NAME` opens with the team, `robot NAME` with team and robot.
macro_rules! events {
    ($($(#[$about:meta])* $of:ident $name:ident { $($field:tt)* })+) => {
        $(events! { @$of $(#[$about])* $name { $($field)* } })+
    };
    (@robot $(#[$about:meta])* $name:ident { $($field:tt)* }) => {
        events! { @team $(#[$about])* $name {
            /// Shell number of the robot that did it, or touched the ball last.
            by_bot: Option<u32> [uint32, optional] = 2;
            $($field)*
        } }
    };
    (@team $(#[$about:meta])* $name:ident { $($field:tt)* }) => {
        messages! {
            $(#[$about])*
            #[derive(Clone, Copy, PartialEq, prost::Message)]
            pub struct $name {
                /// Team that the event concerns, [`Team`].
                by_team: i32 [enumeration = "Team", required] = 1;
                $($field)*
            }
        }
    };
}

/// Declares a choice of values (`oneof`), a line a variant: `NAME(TYPE) [KIND] = TAG;`.
macro_rules! one_of {
    ($(#[$about:meta])* pub enum $name:ident {
        $($(#[$doc:meta])* $variant:ident($value:ty) [$($kind:tt)+] = $tag:tt;)+
    }) => {
        $(#[$about])*
        pub enum $name {
            $($(#[$doc])* #[prost($($kind)+, tag = $tag)] $variant($value),)+
        }
    };
}
