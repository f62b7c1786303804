//! `theme`: the colour palettes. Okabe and Ito's colours, distinguishable by colour-blind readers, on three
//! backgrounds.

/// Purpose of the figure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// A screen with a light page: a green field surface.
    #[default]
    Light,
    /// A screen with a dark page.
    Dark,
    /// Paper: no field surface, black lines.
    Print,
}

/// The colours of a theme, as SVG writes them.
#[derive(Debug)]
pub struct Colors {
    /// Background of the whole figure.
    pub paper: &'static str,
    /// Surface of the field.
    pub surface: &'static str,
    /// The lines on it.
    pub line: &'static str,
    /// Main text, such as titles.
    pub ink: &'static str,
    /// Secondary text, such as captions and axis labels.
    pub faint: &'static str,
    /// The ball and its scope.
    pub ball: &'static str,
    /// The attackers, whose case is drawn.
    pub team: &'static str,
    /// The opponents and their scopes.
    pub opponent: &'static str,
    /// The ball's path: legs of passes and kicks.
    pub path: &'static str,
    /// Faults, such as blocked legs.
    pub warning: &'static str,
    /// The goal at −x, as the paper names it.
    pub yellow: &'static str,
    /// The goal at +x.
    pub cyan: &'static str,
    /// Cells of a heat map without a value.
    pub unknown: &'static str,
}

impl Theme {
    /// The palette that belongs to this theme.
    pub const fn colors(self) -> &'static Colors {
        match self {
            Self::Light => &LIGHT,
            Self::Dark => &DARK,
            Self::Print => &PRINT,
        }
    }
}

const LIGHT: Colors = Colors {
    paper: "#ffffff",
    surface: "#e3eedd",
    line: "#ffffff",
    ink: "#1b1b1b",
    faint: "#5c5c5c",
    ball: "#e69f00",
    team: "#0072b2",
    opponent: "#555555",
    path: "#009e73",
    warning: "#d55e00",
    yellow: "#f0e442",
    cyan: "#56b4e9",
    unknown: "#d0d0d0",
};
const DARK: Colors = Colors {
    paper: "#14181b",
    surface: "#1f2d26",
    line: "#5d6f65",
    ink: "#f2f2f2",
    faint: "#b0b6b3",
    ball: "#e69f00",
    team: "#56b4e9",
    opponent: "#b8b8b8",
    path: "#2ccf9f",
    warning: "#ff7a33",
    yellow: "#c9be2b",
    cyan: "#2f83b0",
    unknown: "#3a3f42",
};
const PRINT: Colors = Colors {
    paper: "#ffffff",
    surface: "#ffffff",
    line: "#8a8a8a",
    ink: "#000000",
    faint: "#444444",
    ball: "#e69f00",
    team: "#0072b2",
    opponent: "#333333",
    path: "#007a59",
    warning: "#d55e00",
    yellow: "#f0e442",
    cyan: "#56b4e9",
    unknown: "#e4e4e4",
};
