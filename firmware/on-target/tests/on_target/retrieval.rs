//! `retrieval`: tests: the retrieved case is the one that a scan by docs/case-format.md §3 finds. mm.

#[embedded_test::tests]
mod tests {
    use casebase::{CaseBase, GoalEnd, PointMm, Problem, RetrievalSettings, retrieve, retrieve_best};
    use heapless::Vec;
    use protocol::RobotId;
    use workloads::retrieval::{Found, scan};

    /// Largest distance from the ball of a robot that may take part, mm.
    const NEAR: i32 = 1_200;

    /// The problem of docs/case-format.md §5.1: the ball at the centre, a teammate, an opponent on the path.
    #[test]
    fn the_example_of_the_design_finds_a_case_with_both_robots_and_the_opponent() {
        let problem = Problem {
            ball: PointMm { x: -600, y: 10 },
            defending: GoalEnd::Negative,
            teammates: robots(&[(1, -700, 0), (3, 200, 800)]),
            opponents: [PointMm { x: -150, y: 40 }].into_iter().collect(),
        };
        let found = retrieve_best(&case_library::four_legged(), &problem, &RetrievalSettings::default());
        let found = found.expect("pass-around fits, if nothing better does");
        assert_eq!((found.conditions, found.teammates), (1, 2));
    }

    #[test]
    fn two_hundred_problems_have_the_answers_of_a_plain_scan() {
        let (mut dice, settings) = (Dice(0x0102_0304_0506_0708), RetrievalSettings::default());
        let libraries =
            [(case_library::four_legged(), 2_700, 1_800), (case_library::division_b(), 4_500, 3_000)];
        let mut with_a_case = 0;
        for (base, length, width) in libraries {
            for _ in 0..100 {
                let problem = drawn(&mut dice, length, width);
                with_a_case += u32::from(agrees(&base, &problem, &settings));
            }
        }
        // With fewer the comparison would be weak.
        assert!(with_a_case > 100, "only {with_a_case} of 200 have a case");
    }

    /// Whether there is a case; both methods must find the same one.
    fn agrees(base: &CaseBase<'_>, problem: &Problem, settings: &RetrievalSettings) -> bool {
        let (best, all, plain) =
            (retrieve_best(base, problem, settings), retrieve(base, problem, settings), scan(base, problem));
        assert_eq!(Found::of(best.as_ref()), Found::of(plain.best.as_ref()), "{problem:?}");
        assert_eq!(Found::of(all.best.as_ref()), Found::of(plain.best.as_ref()), "{problem:?}");
        assert_eq!(all.candidates, plain.candidates, "{problem:?}");
        plain.best.is_some()
    }

    /// A ball anywhere, three robots within a stride of it, two opponents.
    fn drawn(dice: &mut Dice, length: i32, width: i32) -> Problem {
        let ball = PointMm { x: dice.within(length), y: dice.within(width) };
        let mut near = || PointMm { x: ball.x + dice.within(NEAR), y: ball.y + dice.within(NEAR) };
        let teammates = (1..=3).filter_map(|n| Some((RobotId::new(n)?, near()))).collect();
        let opponents = (0..2).map(|_| near()).collect();
        Problem { ball, defending: GoalEnd::Negative, teammates, opponents }
    }

    fn robots(list: &[(u8, i32, i32)]) -> Vec<(RobotId, PointMm), { casebase::PROBLEM_TEAMMATES_MAX }> {
        list.iter().filter_map(|&(n, x, y)| Some((RobotId::new(n)?, PointMm { x, y }))).collect()
    }

    /// Marsaglia's xorshift (2003), 64 bits.
    struct Dice(u64);
    impl Dice {
        /// A number from −`most` to `most`.
        fn within(&mut self, most: i32) -> i32 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            ((self.0 >> 32) as u32 % (2 * most.unsigned_abs() + 1)) as i32 - most
        }
    }
}
