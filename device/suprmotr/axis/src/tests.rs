//! Which commands a run sends, in which order, and how it ends.

use super::*;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::law::Law;

/// A board of numbers.
#[derive(Debug, Default)]
struct Board {
    numbers: Vec<(Mnemonic, i32)>,
    status: Status,
    sent: Vec<String>,
    now: Duration,
}

impl SuprMotrCarrier for Board {
    fn transact(&mut self, command: Command) -> Result<(Exchange, Answer), AxisError> {
        self.sent.push(command.text(brushwork_suprmotr_wire::Radix::Decimal));
        self.now += Duration::from_millis(25);
        let at = Exchange { sent: self.now, received: self.now };
        let [p, i, d, l, v, a] = [P, I, D, INTEGRAL_LIMIT, VELOCITY, ACCELERATION];
        if let Some((write, _)) = [p, i, d, l, v, a].into_iter().find(|held| held.1 == command.mnemonic) {
            let held = self.numbers.iter().find(|(known, _)| *known == write);
            return Ok((at, Answer::Number(held.map_or(0, |(_, number)| *number))));
        }
        if command.mnemonic == Mnemonic::TP {
            return Ok((at, Answer::Number(0)));
        }
        if let Some(number) = command.number {
            self.numbers.retain(|(known, _)| *known != command.mnemonic);
            self.numbers.push((command.mnemonic, number));
        }
        Ok((at, Answer::Status(self.status)))
    }

    fn now(&mut self) -> Duration {
        self.now
    }

    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError> {
        self.now = self.now.max(time);
        Ok(())
    }
}

fn axis() -> SuprMotrAxis<Board> {
    let numbers = [(Mnemonic::DP, 75), (Mnemonic::DL, 100), (Mnemonic::DV, 20_000), (Mnemonic::DA, 200_000)];
    SuprMotrAxis::new(Board { numbers: numbers.to_vec(), ..Board::default() })
}

#[test]
fn a_run_begins_with_reading_moves_at_the_highest_pace_and_ends_with_what_was_before() {
    let mut axis = axis();
    let setup = axis.read_setup().expect("six numbers");
    let held = setup.held.suprmotr.expect("a SuprMotr");
    assert_eq!((held.registers.p, held.registers.integral_limit, held.pace.velocity), (75, 100, 20_000));
    axis.carrier.sent.clear();
    axis.write(SuprMotrWrite::Loop(SuprMotrRegisters { p: 10, d: 200, ..held.registers })).expect("taken");
    axis.command_position(500, 2_000_000).expect("taken");
    axis.drive_duty(0).expect("taken");
    assert_eq!(axis.carrier.sent, ["AB", "DP10", "DD200", "DV1000000", "DA10000000", "MA500", "AB"]);
    axis.carrier.sent.clear();
    for write in SuprMotrLaw::ending(
        &setup.held,
        brushwork_tuning::law::Ending { kept: None, is_touched: false, stays_off: false },
    ) {
        axis.write(write).expect("taken");
    }
    assert_eq!(axis.carrier.sent, ["AB", "DD0", "DP75", "DV20000", "DA200000"]);
    assert_eq!(axis.held(), Ok(held));
}

#[test]
fn a_motor_that_must_not_be_held_is_let_go_before_its_gains_come_back() {
    let mut axis = axis();
    let setup = axis.read_setup().expect("six numbers").held.suprmotr.expect("a SuprMotr");
    axis.carrier.sent.clear();
    axis.write(SuprMotrWrite::End(setup, true)).expect("taken");
    assert_eq!(axis.carrier.sent, ["AB", "MF"]);
}

#[test]
fn what_was_put_back_is_read_and_one_that_differs_is_an_error() {
    let mut axis = axis();
    let setup = axis.read_setup().expect("six numbers").held.suprmotr.expect("a SuprMotr");
    axis.write(SuprMotrWrite::Loop(SuprMotrRegisters { p: 1, ..setup.registers })).expect("taken");
    axis.put_back(setup, false).expect("it is as before");
    assert!(axis.carrier.numbers.contains(&(Mnemonic::DP, 75)));
}

#[test]
fn only_a_nought_is_a_duty() {
    let mut axis = axis();
    assert!(matches!(axis.drive_duty(1), Err(AxisError::Refused(_))));
    assert!(matches!(axis.command_speed(1), Err(AxisError::Refused(_))));
    assert!(axis.carrier.sent.is_empty());
}

#[test]
fn a_motor_that_is_off_is_a_fault_once_it_was_driven() {
    let mut axis = axis();
    axis.carrier.status.motion = motion::MOTOR_OFF | motion::EXCESSIVE_ERROR;
    for _ in 0..STATUS_EVERY {
        assert!(!axis.sample(Want::default()).expect("a position").status.fault);
    }
    axis.command_position(100, 1_000).expect("taken");
    let polls = (0..STATUS_EVERY).map(|_| axis.sample(Want::default()).expect("a position").status);
    let last = polls.last().expect("some");
    assert!(last.fault);
    assert_eq!(SuprMotrLaw::fault(&SuprMotrHeld::default(), last.raw), Cause::FollowingError);
}
