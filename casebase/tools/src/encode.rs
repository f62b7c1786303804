//! `encode`: encoder from authored cases to the flat table that robots carry. Mirrored four ways, simulated,
//! indexed, laid out.
//!
//! The code that will read the table computes its content: `casebase`'s symmetry, plan simulation and
//! records.

use std::collections::BTreeMap;

use casebase::plan_simulation::{PlanStep, Script, plan_simulation};
use casebase::table::{
    Group, HASHED_FROM, Header, MAGIC, MAGIC_WORDS, OpponentRecord, RawAction, RawKick, RawLeg, RecordHeader,
    WordSections, content_hash,
};
use casebase::{Action, CaseRobot, Demands, GoalEnd, PointMm, Scope, Symmetry, TurnTarget, cells_of};
use zerocopy::IntoBytes;

use crate::authored::{Authored, Mirrored, Teammate};
use crate::grid;
use crate::league::CaseLeague;

/// A table that starts at a multiple of 4, as required of a case base.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    words: Vec<u32>,
    length: usize,
}

impl Table {
    /// From bytes of any alignment.
    pub fn aligned(bytes: &[u8]) -> Self {
        let mut words = vec![0_u32; bytes.len().div_ceil(4)];
        words.as_mut_bytes()[..bytes.len()].copy_from_slice(bytes);
        Self { words, length: bytes.len() }
    }

    /// The table as robots carry it, without the padding of the last word.
    pub fn bytes(&self) -> &[u8] {
        &self.words.as_bytes()[..self.length]
    }
}

/// The table of cases that passed every check, in the order of their ids; without symmetry, mirrored copies
/// are stored but never found.
pub(crate) fn encode(league: &CaseLeague, cases: &[Authored], symmetry: bool) -> Table {
    let mut pools = Pools::default();
    for case in cases {
        pools.add(case, league);
    }
    if !symmetry {
        let images = pools.record_headers.iter_mut().enumerate().filter(|(id, _)| !id.is_multiple_of(4));
        images.for_each(|(_, record_header)| (record_header.ball, record_header.inverse_scope) = NOWHERE);
    }
    let kicks: Vec<_> = league.kicks.iter().map(|(_, kick)| RawKick::encode(*kick)).collect();
    let others = size_of::<Header>() + pools.bytes() + kicks.as_bytes().len();
    let index = grid::build(league.field, cases, others);
    let field = league.field;
    let count = |length: usize| length as u32;
    let (words, bitmaps) = (&index.words.list, &index.words.bitmaps);
    let sections = WordSections { words: count(words.len()), bitmaps: count(bitmaps.len()) };
    let (magic, sections) =
        if words.is_empty() { (MAGIC, &[][..]) } else { (MAGIC_WORDS, sections.as_bytes()) };
    let mut header = Header {
        magic,
        hash: 0,
        field: [
            field.length,
            field.width,
            field.margin,
            field.goal_width,
            field.penalty_depth,
            field.penalty_width,
        ],
        pass: [league.pass.r_min, league.pass.r_max],
        groups: count(pools.groups.len()),
        points: count(pools.points.len()),
        kicks: count(kicks.len()),
        places: count(pools.places.len()),
        cell_cases: count(index.cases.len()),
        actions: count(pools.actions.len()),
        grid: index.grid,
    };
    let body = [
        sections,
        words.as_bytes(),
        bitmaps.as_bytes(),
        index.masks.as_bytes(),
        pools.groups.as_bytes(),
        pools.record_headers.as_bytes(),
        pools.points.as_bytes(),
        kicks.as_bytes(),
        index.starts.as_bytes(),
        pools.places.as_bytes(),
        index.cases.as_bytes(),
        pools.actions.as_bytes(),
    ]
    .concat();
    header.hash = content_hash(&[&header.as_bytes()[HASHED_FROM..], &body].concat());
    Table::aligned(&[header.as_bytes(), &body].concat())
}

/// A scope of a millimetre, farther away than any ball: fields are at most 30 m long.
const NOWHERE: ([f32; 2], [f32; 2]) = ([32_767.0; 2], [1.0; 2]);

/// The growing sections of the table.
#[derive(Default)]
struct Pools {
    groups: Vec<Group>,
    record_headers: Vec<RecordHeader>,
    points: Vec<[i32; 2]>,
    places: Vec<u32>,
    actions: Vec<RawAction>,
}

impl Pools {
    /// Their length so far, bytes.
    fn bytes(&self) -> usize {
        let Self { groups, record_headers, points, places, actions } = self;
        [
            groups.as_bytes(),
            record_headers.as_bytes(),
            points.as_bytes(),
            places.as_bytes(),
            actions.as_bytes(),
        ]
        .map(<[u8]>::len)
        .iter()
        .sum()
    }

    /// The four copies of a case.
    fn add(&mut self, case: &Authored, league: &CaseLeague) {
        let (points_at, actions_at) = (self.points.len(), self.actions.len());
        for symmetry in Symmetry::ALL {
            self.add_copy(&case.mirrored(symmetry, league), league);
        }
        let mut list_ends = [0; 4];
        let mut end = 0;
        for (list_end, teammate) in list_ends.iter_mut().zip(&case.teammates) {
            end += teammate.gameplay.len();
            *list_end = end as u8;
        }
        self.groups.push(Group {
            points_at: points_at as u32,
            actions_at: actions_at as u32,
            points: ((self.points.len() - points_at) / 4) as u8,
            list_ends,
            defending: u8::from(case.defending == GoalEnd::Positive),
            getter: case.teammates.iter().position(Teammate::is_getter).unwrap_or(0) as u8,
            reserved: 0,
        });
    }

    fn add_copy(&mut self, copy: &Mirrored<'_>, league: &CaseLeague) {
        let ball = copy.ball();
        let robots = CaseRobot::first(copy.teammates());
        let positions: Vec<_> =
            robots.clone().map(|robot| narrow(copy.position(robot).minus(ball))).collect();
        let opponents: Vec<_> = copy
            .case
            .opponents
            .iter()
            .map(|opponent| {
                let at = copy.symmetry.point(opponent.at).minus(ball);
                let cells = cells_of(at, opponent.scope);
                OpponentRecord { cells, at: narrow(at), inverse_scope: inverse(opponent.scope) }
            })
            .collect();
        let first_point = self.points.len();
        // The point of each action that has one, by robot and index in its list.
        let mut point_of = BTreeMap::new();
        for robot in robots {
            for index in 0.. {
                let Some(action) = copy.action(robot, index) else { break };
                let argument = (self.points.len() - first_point) as u8;
                let raw = self.add_action(action, argument);
                point_of.insert((robot, index), raw.argument);
            }
        }
        let mut legs = Vec::new();
        let walked = plan_simulation(copy, league, |step| {
            if let PlanStep::Leg { robot, action, to, radii, carried_by, .. } = step {
                legs.push(RawLeg {
                    to: to.at,
                    radii: radii.map(|radius| radius as f32),
                    robot: robot.index() as u8,
                    action: action as u8,
                    carried_to: carried_by
                        .and_then(|by| point_of.get(&by))
                        .copied()
                        .unwrap_or(RawLeg::NOT_CARRIED),
                    flags: if to.on_field { RawLeg::TO_FIELD } else { 0 },
                });
            }
        });
        debug_assert!(walked.is_ok(), "only cases that can be walked are encoded: {walked:?}");
        self.record_headers.push(RecordHeader {
            ball: narrow(ball).map(f32::from),
            inverse_scope: inverse(copy.case.ball_scope),
            places_at: self.places.len() as u32,
            teammates: positions.len() as u8,
            opponents: opponents.len() as u8,
            legs: legs.len() as u8,
            demands: Demands::of(copy.case.opponents.iter().map(|opponent| opponent.presence)).bits(),
        });
        // The order in which `RecordHeader` reads them.
        for records in [opponents.as_bytes(), legs.as_bytes(), positions.as_bytes()] {
            let (words, _) = records.as_chunks();
            self.places.extend(words.iter().map(|word| u32::from_ne_bytes(*word)));
        }
    }

    /// An action; `next_point` is the number of its point, where it has one.
    fn add_action(&mut self, action: Action, next_point: u8) -> RawAction {
        let (kind, argument, point) = match action {
            Action::Wait => (RawAction::WAIT, 0, None),
            Action::GetBall => (RawAction::GET_BALL, 0, None),
            Action::GoToPoint(at) => (RawAction::GO_TO_POINT, next_point, Some([at.x, at.y])),
            Action::DribbleTo(at) => (RawAction::DRIBBLE_TO, next_point, Some([at.x, at.y])),
            Action::Turn(TurnTarget::Face(at)) => (RawAction::TURN_FACE, next_point, Some([at.x, at.y])),
            Action::Turn(TurnTarget::HeadingDeg(degrees)) => {
                (RawAction::TURN_HEADING, next_point, Some([degrees, 0]))
            }
            Action::PassBall(robot) => (RawAction::PASS_BALL, robot.index() as u8, None),
            Action::ReceiveBall(robot) => (RawAction::RECEIVE_BALL, robot.index() as u8, None),
            Action::Kick(id) => (RawAction::KICK, id.0, None),
        };
        let raw = RawAction { kind, argument };
        self.points.extend(point);
        self.actions.push(raw);
        raw
    }
}

/// A position within a field of at most 30 m, which the checks have ensured.
fn narrow(point: PointMm) -> [i16; 2] {
    [point.x as i16, point.y as i16]
}

fn inverse(scope: Scope) -> [f32; 2] {
    [1.0 / scope.x as f32, 1.0 / scope.y as f32]
}
