//! A run of walking robots without a host: the trials' simulator with the swarm's computers in it.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

use hil_sim::{
    Configuration, Fault, Noise, Parameters, Scenario, ScheduledFault, Simulation, SimulationConfig,
};
use protocol::RobotId;
use protocol::robot_io::ActuatorFrame;

use super::adversary::earlier_match;
use super::computer::{FaultyBackend, Shared};
use super::guard::Danger;
use super::honest::Honest;
use super::plan::Plan;
use super::team::TeamWatch;
use super::{Broken, Counters, Found};

pub(super) fn run(plan: Plan) -> Result<Counters, Found> {
    let plan = Rc::new(plan);
    let shared = Rc::new(RefCell::new(Shared::default()));
    for packet in earlier_match(&plan) {
        shared.borrow_mut().sent_packets.add(&packet);
    }
    let mut simulation = simulation(&plan, &shared);
    let mut watch = TeamWatch::new(&plan);
    let mut lives: BTreeMap<RobotId, Honest> = BTreeMap::new();
    let mut epochs: BTreeMap<RobotId, u32> = BTreeMap::new();
    for brain in &plan.brains {
        lives.insert(brain.robot, Honest::new(brain.robot, brain.epoch));
        epochs.insert(brain.robot, brain.epoch);
    }
    for number in 0..plan.end / TICK_MS {
        let ms = number * TICK_MS;
        let tick = simulation.step().expect("native computers do not fail");
        for fault in &tick.faults {
            match fault {
                Fault::Crash(id) => watch.crashed(ms, *id),
                Fault::Return(id) => {
                    let epoch = epochs.entry(*id).or_default();
                    *epoch += 1;
                    lives.insert(*id, Honest::new(*id, *epoch));
                    watch.booted(ms, *id);
                }
                Fault::Air(_) | Fault::FlipOrderBit { .. } => {}
            }
        }
        let mut shared = shared.borrow_mut();
        let handed = std::mem::take(&mut shared.handed);
        shared.sensed.clear();
        for (to, packet) in handed {
            let believed = lives.get_mut(&to).and_then(|boot| boot.receive(&packet, &shared.sent_packets));
            watch.received(ms, to, believed.as_ref());
        }
        for sent in &tick.sent {
            watch.note_sent(ms, &plan, &sent.packet);
        }
        for (id, order) in &tick.orders {
            if !is_sane(order) {
                watch.find(ms, Broken::Body(*id, Danger::Absurd(*order)));
            }
        }
        watch.end_of_step(ms)?;
    }
    Ok(watch.counters())
}

fn simulation(plan: &Rc<Plan>, shared: &Rc<RefCell<Shared>>) -> Simulation<'static> {
    let parameters = Parameters::four_legged();
    let configuration =
        if plan.seed.is_multiple_of(4) { Configuration::DefenderGoalie } else { Configuration::TwoDefenders };
    let scenario = Scenario::PAPER[(plan.seed / 4 % 4) as usize];
    let at = |ms: u32, fault| ScheduledFault { tick: ms.div_ceil(TICK_MS), fault };
    let mut faults: Vec<ScheduledFault> =
        plan.air_changes().into_iter().map(|ms| at(ms, Fault::Air(plan.air_at(ms)))).collect();
    for (robot, span) in &plan.reboots {
        faults.push(at(span.from, Fault::Crash(*robot)));
        // A computer is off for a tick at least.
        let back = span.to.max((span.from.div_ceil(TICK_MS) + 1) * TICK_MS);
        faults.push(at(back, Fault::Return(*robot)));
    }
    let config = SimulationConfig {
        seed: plan.seed,
        layout: scenario.layout(configuration, parameters, plan.seed),
        configuration,
        brains: plan.brains.clone(),
        air: plan.air_at(0),
        noise: if plan.seed.is_multiple_of(3) { parameters.noise } else { Noise::NONE },
        parameters: parameters.clone(),
        faults,
    };
    let backend = Box::new(FaultyBackend::new(plan.clone(), case_library::four_legged(), shared.clone()));
    Simulation::new(config, backend).expect("the simulation starts")
}

/// Finite numbers within the limits of walking orders.
fn is_sane(order: &ActuatorFrame) -> bool {
    let ActuatorFrame::Legged { walk, .. } = order else { return false };
    walk.linear.is_finite()
        && walk.angular.is_finite()
        && walk.linear.norm() < WALK_MAX
        && walk.angular.abs() < TURN_MAX
}

/// Period of a brain's tick, ms.
const TICK_MS: u32 = super::plan::Squad::Legged.tick_ms();
/// m/s: twice the walking speed of an AIBO.
const WALK_MAX: f32 = 0.8;
/// rad/s: twice its turning rate.
const TURN_MAX: f32 = 5.0;
