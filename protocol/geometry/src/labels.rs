//! `labels`: the macro that declares an enum whose variants have labels, for options, reports and files.

/// Declares an enum with `ALL`, `label` and `from_label`; a variant is `NAME = "label"`.
///
/// ```
/// geometry::labels! {
///     /// A kind of restart.
///     #[derive(Clone, Copy, Debug, PartialEq)]
///     pub enum Restart {
///         /// From the centre.
///         Kickoff = "kick-off",
///         /// From where the ball left the field.
///         FreeKick = "free-kick",
///     }
/// }
/// assert_eq!(Restart::from_label("free-kick"), Some(Restart::FreeKick));
/// assert_eq!(Restart::ALL.map(Restart::label), ["kick-off", "free-kick"]);
/// ```
#[macro_export]
macro_rules! labels {
    ($(#[$about:meta])* $vis:vis enum $name:ident { $($(#[$doc:meta])* $variant:ident = $label:literal,)+ }) => {
        $(#[$about])*
        $vis enum $name { $($(#[$doc])* $variant,)+ }

        impl $name {
            /// Every variant, in the order of declaration.
            $vis const ALL: [Self; [$(Self::$variant),+].len()] = [$(Self::$variant),+];

            /// Label in options, reports and files.
            $vis const fn label(self) -> &'static str {
                match self { $(Self::$variant => $label),+ }
            }

            /// The variant with this label.
            $vis fn from_label(label: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|variant| variant.label() == label)
            }
        }
    };
}
