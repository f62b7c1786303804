//! `codes`: the table of finding codes and their meanings. One table, also the source of `cases check
//! --explain`.
//!
//! Errors are those that docs/case-format.md §1.2 lists; everything else doubtful is a warning and never
//! stops retrieval.

use foreign::Severity;

/// One kind of finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CodeEntry {
    /// Code as findings print it.
    pub code: &'static str,
    /// Severity: an error refuses the library.
    pub severity: Severity,
    /// Meaning and fix of the finding.
    pub meaning: &'static str,
}

macro_rules! codes {
    ($($name:ident $code:literal $severity:ident $meaning:literal)*) => {
        /// The codes of all findings.
        pub mod code {
            $(#[doc = concat!("`", $code, "`: see [`CODES`](super::CODES).")] pub const $name: &str = $code;)*
        }

        /// Every kind of finding: errors first.
        pub const CODES: &[CodeEntry] =
            &[$(CodeEntry { code: $code, severity: Severity::$severity, meaning: $meaning }),*];
    };
}

codes! {
    UNREADABLE "unreadable" Error "A file or directory cannot be read, or a file is not UTF-8. Make it a readable text file."
    SYNTAX "syntax" Error "The file is not TOML (a repeated key, too). Mend the syntax at the line."
    MISPLACED "misplaced" Error "A .toml file lies elsewhere than at <region>/<name>.toml, or its name has control characters. Move it into its region's directory, or rename it."
    NO_LEAGUE "no-league" Error "The directory has no league.toml. Add one, or name one league's directory."
    UNKNOWN_KEY "unknown-key" Error "An unknown key or action. Use one of those the finding lists."
    MISSING_KEY "missing-key" Error "A key that must be there is missing. Add it."
    WRONG_TYPE "wrong-type" Error "A value of another type than its key takes, such as 1.0 where whole mm are meant."
    BAD_VALUE "bad-value" Error "A value outside the range its key takes. Give one within it."
    BAD_SCOPE "bad-scope" Error "A scope radius that is not above 0. Give both radii in mm."
    BAD_DEFENDING "bad-defending" Error "defending is neither yellow (the goal at -x) nor cyan (the goal at +x)."
    NO_TEAMMATE "no-teammate" Error "The case has no robot. Add [[teammates]] with at and gameplay."
    TOO_MANY_TEAMMATES "too-many-teammates" Error "More than 4 robots. Leave out who only watches."
    TOO_MANY_OPPONENTS "too-many-opponents" Error "More than 4 opponents. Keep those that justify the gameplay."
    TOO_MANY_ACTIONS "too-many-actions" Error "More than 255 actions in one case. Shorten the gameplays."
    TOO_MANY_CASES "too-many-cases" Error "More cases than 16 bits can number in four copies. Split the league."
    ROBOT_NUMBER "robot-number" Error "A pass or a receive names a robot the case lacks, or the robot itself."
    ONE_GETTER "one-getter" Error "Not exactly one robot begins with get_ball. Let exactly one."
    NOT_HOLDING "not-holding" Error "A robot dribbles, passes or kicks when the walk of the plan has not given it the ball."
    PASS_UNANSWERED "pass-unanswered" Error "A pass that the other robot does not come to receive, or only after something that waits for the pass."
    RECEIVE_UNANSWERED "receive-unanswered" Error "A robot waits for a pass that no robot plays."
    UNKNOWN_KICK "unknown-kick" Error "A kind of kick that league.toml does not have. Add [kicks.KIND] or take a known one."
    BEYOND_REACH "beyond-reach" Error "A pass or a kick at the goal that ends farther away than league.toml says it rolls. Move the ball or the receiver nearer."
    OUTSIDE_FIELD "outside-field" Error "A position beyond the lines (on a line is inside). Move it inside the field."
    NO_PARTNER "no-partner" Error "A kind of kick to one side without its mirror image. Add the opposite kind, equal in length and radii."
    TOO_MANY_KICKS "too-many-kicks" Error "More kinds of kicks than a table holds. Take some out."
    EMPTY "empty" Warning "The library has no case: every retrieval finds nothing."
    TWIN "twin" Warning "Retrieval cannot tell the case, or its mirror image, from another. Take one of the two out."
    SCOPE_IN_PATH "scope-in-path" Warning "An opponent in the centre of its scope blocks the case's own ball path: the condition speaks against the case."
    SELF_BLOCKING "self-blocking" Warning "In more than a tenth of an opponent's scope the opponent blocks the case's own ball path."
    BIG_SCOPE "big-scope" Warning "A scope over 900 x 700 mm is more than a situation. Split the case."
    BEATEN "beaten" Warning "In the very situation the case describes another one is retrieved. Tell them apart."
    NEVER_RETRIEVED "never-retrieved" Warning "In none of the problems that were drawn was the case retrieved. Tell it apart from what is, or take it out."
    POINT_OUTSIDE "point-outside" Warning "An action's point lies beyond the lines. Move it inside the field."
    BYSTANDER "bystander" Warning "A robot that only waits. Leave it out, or give it something to do."
    LEAVES_BALL "leaves-ball" Warning "A robot walks off while it holds the ball. Write dribble_to to take the ball along."
    NEVER_REACHED "never-reached" Warning "A later get_ball to which no kick ever leaves the ball: it would wait for ever."
    UNKNOWN_PRIMITIVE "unknown-primitive" Warning "A kick asks the body for a primitive no body knows."
    NO_INTENT "no-intent" Warning "The intent is blank. Say in a sentence what the case is for."
    SAME_SPOT "same-spot" Warning "Two robots stand where only one has room. Move one of them."
    TEAMMATE_IN_PATH "mate-in-path" Warning "A teammate that does not take the ball stands on a leg of the ball's path. Move it aside."
    SHORT_PASS "short-pass" Warning "A pass shorter than its own radius r_min. Let the robot dribble, or stand farther off."
    KICK_LEAVES "kick-leaves" Warning "A kick leaves the field in the case's own situation. Take a shorter kind, or another heading."
    IDLE_BALL "idle-ball" Warning "A robot goes for the ball and does nothing with it. Say what is done with it."
    FILE_NAME "file-name" Warning "A region or name with characters other than letters, digits, - _ and . is hard to type and may not travel."
}

/// The entry of a code.
pub fn entry(code: &str) -> Option<&'static CodeEntry> {
    CODES.iter().find(|entry| entry.code == code)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_unique_and_errors_come_first() {
        let mut seen: Vec<_> = CODES.iter().map(|entry| entry.code).collect();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), CODES.len());
        assert!(CODES.is_sorted_by_key(|entry| entry.severity));
        assert_eq!(entry(code::TWIN).map(|entry| entry.severity), Some(Severity::Warning));
        assert_eq!(entry("no such code"), None);
    }
}
