//! `goal`: the two goals: at which end of the field they are, the paper's names for them, and which team
//! attacks where (docs/architecture.md §2.1).

use serde::{Deserialize, Serialize};

crate::labels! {
    /// A goal, by the end of the field it stands at. Cases, problems and robots name the goal they defend.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    pub enum GoalEnd {
        /// At −x, the paper's "yellow": its defenders attack towards +x.
        Negative = "yellow",
        /// At +x, the paper's "cyan": its defenders attack towards −x.
        Positive = "cyan",
    }
}

impl GoalEnd {
    /// The sign of its x: −1 or +1.
    pub const fn sign(self) -> i32 {
        match self {
            Self::Negative => -1,
            Self::Positive => 1,
        }
    }

    /// +1 where its defenders attack towards +x, else −1.
    pub const fn attack_sign(self) -> i32 {
        -self.sign()
    }

    /// The goal at the other end.
    pub const fn opposite(self) -> Self {
        match self {
            Self::Negative => Self::Positive,
            Self::Positive => Self::Negative,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defenders_of_yellow_attack_cyan_towards_plus_x() {
        let ours = GoalEnd::from_label("yellow").unwrap();
        assert_eq!((ours.sign(), ours.attack_sign()), (-1, 1));
        assert_eq!(ours.opposite().label(), "cyan");
        assert_eq!(ours.opposite().sign(), ours.attack_sign());
    }
}
