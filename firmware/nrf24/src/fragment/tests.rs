//! `tests`: of fragments: every length comes back, and no order, loss or copy makes another frame.

use rand_core::{RngCore, SeedableRng};
use rand_xoshiro::Xoshiro128PlusPlus;

use super::*;

const TEAM: TeamId = TeamId(1);
const ASSEMBLY_TIME_MAX: Duration = Duration::millis(8);

fn frame(len: usize, fill: u32) -> Packet {
    let mut frame = Packet::from_slice(&[VERSION, TEAM.0]).unwrap();
    frame.extend((2..len).map(|at| (fill as usize * 31 + at * 7) as u8));
    frame
}

#[test]
fn a_frame_of_every_length_comes_back_as_it_was_in_the_fewest_fragments() {
    let (mut cutter, mut assembler) = (Cutter::new(TEAM), Assembler::new(TEAM, ASSEMBLY_TIME_MAX));
    for len in 3..=FRAME_LEN_MAX {
        let frame = frame(len, 0);
        let fragments = cutter.cut(&frame).unwrap();
        assert_eq!(fragments.len(), (len - 2).div_ceil(31));
        let now = Instant(len as u64 * 1_000);
        let (last, others) = fragments.split_last().unwrap();
        assert!(others.iter().all(|fragment| assembler.push(now, fragment).is_none()));
        assert_eq!(assembler.push(now, last), Some(frame));
    }
    assert_eq!(assembler.joined(), Joined { frames: 118, broken: 0, stray: 0 });
}

#[test]
fn other_teams_frames_and_other_bytes_are_refused() {
    let mut cutter = Cutter::new(TEAM);
    assert_eq!(cutter.cut(&[VERSION]), Err(NotSent::Length(1)));
    assert_eq!(cutter.cut(&[VERSION, 1]), Err(NotSent::Length(2)));
    assert_eq!(cutter.cut(&[0; FRAME_LEN_MAX + 1]), Err(NotSent::Length(121)));
    assert_eq!(cutter.cut(&[VERSION, 2, 3]), Err(NotSent::Foreign));
    assert_eq!(cutter.cut(&[VERSION + 1, 1, 3]), Err(NotSent::Foreign));
}

#[test]
fn a_question_and_any_bytes_disturb_nothing() {
    let (mut cutter, mut assembler) = (Cutter::new(TEAM), Assembler::new(TEAM, ASSEMBLY_TIME_MAX));
    let (frame, now) = (frame(60, 1), Instant(5));
    let fragments = cutter.cut(&frame).unwrap();
    assert_eq!(assembler.push(now, &fragments[0]), None);
    for other in [&question(9)[..], &[], &[0xff; 7], &[0xff; 33], &fragments[0]] {
        assert_eq!(assembler.push(now, other), None);
    }
    assert_eq!(assembler.push(now, &fragments[1]), Some(frame));
}

#[test]
fn a_fragment_that_comes_too_late_completes_nothing() {
    let (mut cutter, mut assembler) = (Cutter::new(TEAM), Assembler::new(TEAM, ASSEMBLY_TIME_MAX));
    let fragments = cutter.cut(&frame(60, 1)).unwrap();
    assert_eq!(assembler.push(Instant(0), &fragments[0]), None);
    assert_eq!(assembler.push(Instant(8_001), &fragments[1]), None);
    assert_eq!(assembler.joined(), Joined { frames: 0, broken: 1, stray: 1 });
}

#[test]
fn with_loss_copies_and_exchanged_neighbours_every_frame_comes_once_and_as_it_was() {
    let mut dice = Xoshiro128PlusPlus::seed_from_u64(3);
    for loss in [0, 5, 10, 20, 30] {
        let (mut cutter, mut assembler) = (Cutter::new(TEAM), Assembler::new(TEAM, ASSEMBLY_TIME_MAX));
        let mut line: std::vec::Vec<(u32, Payload)> = std::vec::Vec::new();
        for fill in 0..2_000 {
            let len = 3 + dice.next_u32() as usize % (FRAME_LEN_MAX - 2);
            line.extend(cutter.cut(&frame(len, fill)).unwrap().into_iter().map(|payload| (fill, payload)));
        }
        let first = line.clone();
        for at in 1..line.len() {
            // A neighbour or a copy no further away than patience allows.
            match dice.next_u32() % 20 {
                0 => line.swap(at - 1, at),
                1 => line[at] = first[at - 1].clone(),
                2 => line[at] = first[at.saturating_sub(9)].clone(),
                _ => {}
            }
        }
        let mut seen = std::collections::BTreeSet::new();
        for (at, (fill, payload)) in line.iter().enumerate() {
            if dice.next_u32() % 100 < loss {
                continue;
            }
            if let Some(came) = assembler.push(Instant(at as u64 * 460), payload) {
                assert_eq!(came, frame(came.len(), *fill), "altered, at {loss} %");
                assert!(seen.insert(*fill), "frame {fill} came twice at {loss} %");
            }
        }
        assert!(seen.len() > 200, "{} of 2000 at {loss} %", seen.len());
    }
}
