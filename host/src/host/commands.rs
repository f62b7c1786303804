//! `commands`: what robots are sent: the coach's orders, those of a strategy in another program, or those of
//! a drill.

use protocol::host::{Directive, HostCommand, RuleRole};
use protocol::{Duration, Instant, RobotId, Who};
use rules::Phase;

use super::{Host, InputVerdict};
use crate::external::{AnswerError, External, StrategyDrawing};
use crate::radio::RadioSituation;
use crate::strategy::view::ViewGame;
use crate::strategy::{Flip, Order, OrderReason};

impl Host {
    /// The newest view as a line for the strategy in another program, once; its answer is
    /// [`super::Input::Orders`].
    pub fn poll_view(&mut self) -> Option<String> {
        self.external.as_mut()?.poll()
    }

    /// Shapes and values of the strategy in another program, and the turn from its frame to the field's.
    pub fn strategy_drawing(&self) -> Option<(Flip, &StrategyDrawing)> {
        let drawing = self.external.as_ref()?.drawing();
        Some((Flip::defending(self.our_game().defending), drawing))
    }

    /// Number of answers of the strategy in another program that were followed.
    pub fn used_answers(&self) -> u64 {
        self.external.as_ref().map_or(0, External::used)
    }

    /// Number of refused answers of the strategy in another program, and the last one's error.
    pub fn refused_answers(&self) -> (u64, Option<&AnswerError>) {
        self.external.as_ref().map_or((0, None), |external| external.refused())
    }

    /// Time for which the strategy in another program has been asked without an answer, and whether it ever
    /// answered; `None` where nothing is asked.
    pub fn unanswered(&self, now: Instant) -> Option<(Duration, bool)> {
        let (asked, ever) = self.external.as_ref()?.unanswered()?;
        Some((now.since(asked), ever))
    }

    /// The orders, or the drill's in their place, as robots get them.
    pub(super) fn commands(&self, game: &ViewGame) -> heapless::Vec<HostCommand, { RobotId::COUNT }> {
        let flip = Flip::defending(game.defending);
        let command = |to: RobotId, rule_role: RuleRole, directive: Directive| HostCommand {
            to,
            defending: game.defending,
            phase: game.phase,
            rule_role,
            directive: self.practised(game, to, self.calibrated(to, directive)),
        };
        if let Some(drill) = &self.drill {
            return drill
                .iter()
                .map(|(to, role, directive)| command(*to, *role, directive.clone()))
                .collect();
        }
        let orders = self.orders.iter();
        orders
            .map(|order| command(order.robot, order.role.rule_role(), self.directive(order, flip)))
            .collect()
    }

    /// The directive on the part of the field that is practised on.
    fn practised(&self, game: &ViewGame, to: RobotId, directive: Directive) -> Directive {
        let bounded = self.settings.practice.bounded(directive);
        let robot = self.world().robot(Who { colour: self.settings.us, id: to });
        match robot.filter(|_| game.phase == Phase::Run) {
            Some(robot) => self.settings.practice.called_back(bounded, robot.pose),
            None => bounded,
        }
    }

    /// Where a part of the field is practised on no case is played: the robot at the ball gets it.
    fn directive(&self, order: &Order, flip: Flip) -> Directive {
        let directive = order.task.directive(flip);
        let plays = matches!(directive, Directive::Gameplay { .. })
            && matches!(order.why, OrderReason::SoonestAtBall { .. } | OrderReason::PlaysCase { .. });
        if plays && !self.settings.practice.is_all() { Directive::GetBall { face: None } } else { directive }
    }

    /// Orders of a strategy in another program are sent at once.
    pub(super) fn handle_orders(&mut self, now: Instant, line: &[u8]) -> InputVerdict {
        let Some(external) = &mut self.external else { return InputVerdict::Undecodable };
        match external.answered(now, line) {
            Err(error) => return InputVerdict::NoAnswer(error),
            Ok(None) => return InputVerdict::Orders,
            Ok(Some(orders)) => self.orders = orders,
        }
        let game = self.our_game();
        // The referee has stopped the game since the view was offered: the plan of that moment stands.
        if self.ordered == self.listener.game().phase {
            let commands = self.commands(&game);
            let situation =
                RadioSituation { us: self.settings.us, phase: game.phase, placement: game.placement };
            self.radio.offer(now, &self.world, situation, &commands);
        }
        InputVerdict::Orders
    }
}
