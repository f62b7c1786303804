//! `field`: check of the number of robots and of the field's dimensions against the league.

use std::fmt;

use protocol::{Duration, Instant};
use rules::{Colour, FieldSpec, League, limits};

use super::Lasting;
use crate::Host;

/// A robot not seen for this time is not counted: ten frames of 60 Hz, and fewer than its track lasts (1 s).
const COUNTED_FOR: Duration = Duration::millis(170);
/// Tolerance of a field's dimensions as a share of its size (an estimate; the rules allow 10 %, and the
/// leagues' differ by a third).
const DIMENSION_TOLERANCE: f32 = 0.1;

/// More robots of a team than its league allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooManyRobots {
    /// Colour of the team.
    pub team: Colour,
    /// Whether the team is ours.
    pub ours: bool,
    /// Number of robots inside the lines.
    pub on_field: usize,
    /// Number of robots allowed.
    pub allowed: usize,
    /// The league whose rules apply.
    pub league: League,
}

impl fmt::Display for TooManyRobots {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { team, on_field, allowed, league, .. } = self;
        let (whose, remedy) = if self.ours {
            ("ours", "take the others off the field, or the referee counts a foul")
        } else {
            ("theirs", "tell the referee, none is led by this host")
        };
        write!(
            f,
            "{on_field} {} robots ({whose}) are on the field, {} allows {allowed}: {remedy} (or another --league)",
            team.label(),
            league.name()
        )
    }
}

/// Counts robots inside the lines.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RobotCount {
    teams: [Lasting; 2],
}

impl RobotCount {
    pub(super) fn look(
        &mut self,
        now: Instant,
        host: &Host,
        sees: bool,
    ) -> impl Iterator<Item = TooManyRobots> {
        let (league, us, field) = (host.settings().league, host.settings().us, host.field());
        let allowed = league.limits().map_or(usize::MAX, |limits| limits.robots as usize);
        let inside = |robot: &&crate::world::Robot| {
            let at = robot.pose.position;
            field.clamp(at, -limits::ROBOT_RADIUS) == at && host.world().time.since(robot.seen) < COUNTED_FOR
        };
        let found = [Colour::Yellow, Colour::Blue].map(|team| {
            let on_field = host.world().team(team).filter(inside).count();
            let many = self.teams[team as usize].see(now, sees && on_field > allowed);
            many.then_some(TooManyRobots { team, ours: team == us, on_field, allowed, league })
        });
        found.into_iter().flatten()
    }
}

/// A field from vision that is not the league's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OtherField {
    /// The league that was chosen.
    pub league: League,
    /// Length and width by vision, m.
    pub announced: [f32; 2],
    /// The league whose field it is, if it fits one.
    pub fits: Option<League>,
}

impl fmt::Display for OtherField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([length, width], own) = (self.announced, self.league.field());
        write!(
            f,
            "vision announces a field of {length:.1} × {width:.1} m, {} has {:.1} × {:.1} m: ",
            self.league.name(),
            own.length,
            own.width
        )?;
        match self.fits {
            Some(league) => {
                write!(f, "start with --league {}, or receive the vision of this field (--vision)", league.name())
            }
            None => f.write_str(
                "vision's is played on; is its geometry calibrated for this field, and is this the right vision (--vision)?",
            ),
        }
    }
}

/// Compares the field that vision sent with that league's.
pub fn other_field(league: League, announced: &FieldSpec) -> Option<OtherField> {
    if fits(announced, league) {
        return None;
    }
    let mut leagues = [League::DivisionB, League::DivisionA, League::Ssl2013].into_iter();
    Some(OtherField {
        league,
        announced: [announced.length, announced.width],
        fits: leagues.find(|other| fits(announced, *other)),
    })
}

/// Whether a field has that league's length and width.
fn fits(announced: &FieldSpec, league: League) -> bool {
    let field = league.field();
    let near = |announced: f32, own: f32| (announced - own).abs() <= own * DIMENSION_TOLERANCE;
    near(announced.length, field.length) && near(announced.width, field.width)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_league_has_its_own_field_and_the_right_one_is_named_for_another() {
        let leagues = [League::DivisionA, League::DivisionB, League::Ssl2013];
        for league in leagues {
            for announced in leagues {
                let found = other_field(league, &announced.field());
                assert_eq!(found.map(|found| found.fits), (league != announced).then_some(Some(announced)));
            }
        }
        let found = other_field(League::DivisionB, &League::DivisionA.field()).unwrap();
        let description = found.to_string();
        assert!(
            description.contains("12.0 × 9.0 m") && description.contains("--league division-a"),
            "{description}"
        );
    }

    #[test]
    fn a_slightly_wrong_field_is_the_leagues_and_an_unknown_one_is_of_no_league() {
        let own = League::DivisionB.field();
        assert_eq!(other_field(League::DivisionB, &FieldSpec { length: 9.3, width: 5.8, ..own }), None);
        let found = other_field(League::DivisionB, &FieldSpec { length: 4.5, width: 3.0, ..own }).unwrap();
        assert!(found.fits.is_none() && found.to_string().contains("calibrated"), "{found}");
    }
}
