//! The board: bytes and time in, bytes out.

use super::assumed::{HELP, INSTRUCTION_TIME, UNKNOWN_INSTRUCTION, byte_time};
use super::happening::{Happening, What};
use super::hardware::Hardware;
use brushwork_motorvator_wire::{LineReader, Order};
use brushwork_script::debug::Debugger;
use brushwork_script::mecc::events;
use brushwork_script::op::Op;
use brushwork_script::program::Program;
use brushwork_script::vm::{Fault, Machine, State};
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

/// A simulated MotorVator V3.
#[derive(Clone, Debug, Default)]
pub struct Motorvator {
    pub(super) hardware: Hardware,
    pub(super) program: Option<Arc<Program>>,
    pub(super) machine: Option<Machine>,
    pub(super) debugger: Debugger,
    lines: LineReader,
    /// What leaves by itself, with its time: the command line's words. Frames of a program leave when they are out.
    output: VecDeque<(Duration, Vec<u8>)>,
    /// Whether the end of the program has been told.
    is_over: bool,
}

impl Motorvator {
    /// A board that has just been switched on, with a program in its memory if there is one. It waits for `G`.
    #[must_use]
    pub fn new(program: Option<Program>) -> Self {
        Self { program: program.map(Arc::new), ..Self::default() }
    }

    /// The same with a line of another rate.
    #[must_use]
    pub fn at_rate(mut self, bits_per_second: u32) -> Self {
        self.hardware.bits_per_second = bits_per_second;
        self
    }

    /// Bits per second of its line.
    #[must_use]
    pub fn bits_per_second(&self) -> u32 {
        self.hardware.bits_per_second
    }

    /// Its own time since its start.
    #[must_use]
    pub fn now(&self) -> Duration {
        self.hardware.now
    }

    /// Keeps a trace from now on.
    pub fn trace(&mut self) {
        self.hardware.is_traced = true;
    }

    /// What was seen since the last call.
    pub fn take_trace(&mut self) -> Vec<Happening> {
        self.hardware.take_trace()
    }

    /// Puts another program into its memory; one that runs goes on.
    pub fn load(&mut self, program: Arc<Program>) {
        self.program = Some(program);
    }

    /// Begins the program from the start, as `G` does.
    pub fn start(&mut self) {
        let Some(program) = self.program.clone() else {
            return self.say("No program\r\n");
        };
        let machine = Machine::new(program);
        self.hardware.program_begins();
        self.debugger.started(&machine);
        self.machine = Some(machine);
        self.is_over = false;
    }

    /// Whether a program runs or waits.
    #[must_use]
    pub fn is_running(&self) -> bool {
        self.machine.as_ref().is_some_and(|machine| !is_over(machine.state()))
    }

    /// Why the program could not go on.
    #[must_use]
    pub fn fault(&self) -> Option<&Fault> {
        match self.machine.as_ref()?.state() {
            State::Faulted(fault) => Some(fault),
            State::Ready | State::Pausing { .. } | State::Listening { .. } | State::Ended => None,
        }
    }

    /// The machine that runs the program.
    #[must_use]
    pub fn machine(&self) -> Option<&Machine> {
        self.machine.as_ref()
    }

    /// The two characters of the display.
    #[must_use]
    pub fn display(&self) -> [u8; 2] {
        self.hardware.display
    }

    /// Direction and speed of the motors, in percent with a minus for backward.
    #[must_use]
    pub fn motors(&self) -> [i32; 4] {
        self.hardware.motors.map(|motor| {
            let percent = i32::try_from(motor.percent).unwrap_or(0);
            if motor.direction == 'B' { -percent } else { percent }
        })
    }

    /// Angles of the two servos, in degrees from the middle with a minus for backward.
    #[must_use]
    pub fn servos(&self) -> [i32; 2] {
        self.hardware.servos.map(|servo| {
            let angle = i32::try_from(servo.angle).unwrap_or(0);
            if servo.direction == 'B' { -angle } else { angle }
        })
    }

    /// Steps of the two steppers since power-up.
    #[must_use]
    pub fn steps(&self) -> [i64; 2] {
        [self.hardware.steppers[0].position, self.hardware.steppers[1].position]
    }

    /// What each stepper gets of full power: all of it while it moves, else what holds it.
    #[must_use]
    pub fn stepper_power(&self) -> [f64; 2] {
        self.hardware.steppers.each_ref().map(|stepper| match stepper.next_step {
            Some(_) => 1.0,
            None => f64::from(stepper.hold_percent) / 100.0,
        })
    }

    /// Sets an on/off input, counted from 1; a change raises its event.
    pub fn set_on_off(&mut self, input: usize, on: bool) {
        let Some(index) = input.checked_sub(1).filter(|index| *index < 4) else { return };
        if self.hardware.on_off[index] == on {
            return;
        }
        self.hardware.on_off[index] = on;
        let number = u32::try_from(index).unwrap_or(0);
        self.hardware.note(What::Input { input: number + 1, on });
        self.raise(events::ON_OFF + number);
    }

    /// Sets an analog input, counted from 1, to 0 to 255.
    pub fn set_analog(&mut self, input: usize, value: u8) {
        if let Some(place) = input.checked_sub(1).and_then(|index| self.hardware.analog.get_mut(index)) {
            *place = value;
        }
    }

    fn raise(&mut self, event: u32) {
        if let Some(machine) = &mut self.machine {
            machine.raise(event);
        }
    }

    /// The power comes: everything is as at the start but the program in memory and the time.
    pub fn power_up(&mut self) {
        let Hardware { now, is_traced, bits_per_second, .. } = self.hardware;
        let program = self.program.take();
        let debugger = std::mem::take(&mut self.debugger);
        *self = Self { program, debugger, ..Self::default() };
        self.hardware.now = now;
        self.hardware.is_traced = is_traced;
        self.hardware.bits_per_second = bits_per_second;
    }

    /// Lets time pass without power.
    pub fn rest(&mut self, to: Duration) {
        self.hardware.now = self.now().max(to);
    }

    /// Takes bytes that arrive now.
    pub fn receive(&mut self, bytes: &[u8]) {
        for byte in bytes {
            let order = self.lines.take(*byte).and_then(|line| Order::of_line(&line));
            match order {
                Some(Order::Data(frame)) => {
                    self.hardware.received = frame;
                    self.hardware.note(What::Receive { bytes: frame });
                    self.raise(events::RECEIVE);
                }
                Some(Order::Go) => self.start(),
                Some(Order::Help) => self.say(HELP),
                Some(Order::Unknown) => self.say("?\r\n"),
                Some(Order::Ignored) | None => {}
            }
        }
    }

    /// Words of the command line leave one after the other.
    fn say(&mut self, text: &str) {
        let from = self.output.back().map_or(self.now(), |(at, _)| *at).max(self.now());
        let length = u32::try_from(text.len()).unwrap_or(0);
        let byte_time = byte_time(self.hardware.bits_per_second);
        self.output.push_back((from + byte_time * length, text.as_bytes().to_vec()));
    }

    /// When the next output that is already decided leaves.
    #[must_use]
    pub fn next_output_at(&self) -> Option<Duration> {
        let words = self.output.front().map(|(at, _)| *at);
        words.into_iter().chain(self.hardware.sending_until()).min()
    }

    /// Takes a line that has left by now.
    pub fn take_output(&mut self) -> Option<Vec<u8>> {
        let now = self.now();
        self.output.pop_front_if(|(at, _)| *at <= now).map(|(_, line)| line)
    }

    /// Moves time on to `to`; does nothing when that is past. The program runs as far as it comes in that time.
    pub fn advance(&mut self, to: Duration) {
        while self.now() < to {
            self.fall_due();
            let next = self.hardware.next_due().map_or(to, |due| due.min(to)).max(self.now());
            self.run_until(next);
        }
        self.fall_due();
    }

    fn fall_due(&mut self) {
        let Self { hardware, machine, output, .. } = self;
        let mut raise = |event| {
            if let Some(machine) = machine {
                machine.raise(event);
            }
        };
        if let Some(line) = hardware.fall_due(&mut raise) {
            output.push_back((hardware.now, line));
        }
    }

    /// Lets the program run until something is due. What it does may be due earlier: then it is stopped there.
    fn run_until(&mut self, to: Duration) {
        while let Some(machine) = &mut self.machine {
            let is_due = self.hardware.next_due().is_some_and(|due| due <= self.hardware.now);
            if self.hardware.now >= to || is_due {
                return;
            }
            let before = machine.executed();
            let state = self.debugger.run(machine, &mut self.hardware, 1).clone();
            if machine.executed() > before {
                self.hardware.now += INSTRUCTION_TIME;
            }
            match state {
                State::Ready if !self.debugger.is_paused() && !spins(machine) => {}
                State::Pausing { until } if !self.debugger.is_paused() => {
                    let next = self.hardware.next_due().map_or(to, |due| due.min(to));
                    self.hardware.now = until.min(next).max(self.hardware.now);
                }
                State::Ended | State::Faulted(_) => {
                    self.tell_end(&state);
                    break;
                }
                State::Ready | State::Pausing { .. } | State::Listening { .. } => break,
            }
        }
        let next = self.hardware.next_due().map_or(to, |due| due.min(to));
        self.hardware.now = next.max(self.hardware.now);
    }

    fn tell_end(&mut self, state: &State) {
        if std::mem::replace(&mut self.is_over, true) {
            return;
        }
        let line = self.machine.as_ref().map_or(0, Machine::line);
        if let State::Faulted(fault) = state {
            let message = format!("{UNKNOWN_INSTRUCTION}: {}", fault.kind);
            self.say(&format!("{UNKNOWN_INSTRUCTION}\r\n"));
            self.hardware.note(What::Fault { line, message });
        } else {
            self.hardware.note(What::End { line });
        }
    }
}

fn is_over(state: &State) -> bool {
    matches!(state, State::Ended | State::Faulted(_))
}

/// Whether the program stands in a loop that does nothing: only an event leads out of it.
fn spins(machine: &Machine) -> bool {
    let at = machine.at();
    matches!(machine.program().ops.get(at as usize), Some(Op::Jump(to)) if *to == at) && !machine.has_event()
}
