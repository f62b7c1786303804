//! `labels`: the macro that declares enums whose variants have labels, for options, reports and files.

/// Declares enums with `ALL`, `label` and `from_label`; a variant is `NAME = "label"`. An enum whose variants
/// have fields gets `LABELS` and `label`.
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
///
/// geometry::labels! {
///     /// An action.
///     pub enum Action {
///         /// Stays.
///         Wait = "wait",
///         /// Turns by an angle, degrees.
///         Turn(f32) = "turn",
///     }
/// }
/// assert_eq!((Action::Turn(90.0).label(), Action::LABELS), ("turn", ["wait", "turn"]));
/// ```
#[macro_export]
macro_rules! labels {
    ($($(#[$about:meta])* $vis:vis enum $name:ident { $($(#[$doc:meta])* $variant:ident = $label:literal,)+ })+) => { $(
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
    )+ };
    ($(#[$about:meta])* $vis:vis enum $name:ident { $($(#[$doc:meta])* $variant:ident
        $(($of:ty))? $({ $($(#[$field_doc:meta])* $field:ident: $type:ty,)+ })? = $label:literal,)+ }) => {
        $(#[$about])*
        $vis enum $name { $($(#[$doc])* $variant $(($of))? $({ $($(#[$field_doc])* $field: $type,)+ })?,)+ }

        impl $name {
            /// Label of every variant, in the order of declaration.
            $vis const LABELS: [&'static str; [$($label),+].len()] = [$($label),+];

            /// Label in options, reports and files.
            $vis const fn label(&self) -> &'static str {
                match self { $(Self::$variant { .. } => $label),+ }
            }
        }
    };
}
