//! What a program finds on the board: display, beeper, motors, steppers, servos, inputs, timers and the serial line.

use super::assumed::byte_time;
use super::happening::{Happening, What};
use super::stepper::Stepper;
use brushwork_motorvator_wire::{BITS_PER_SECOND, FRAME_BYTES, Frame, line_of_board};
use brushwork_script::board::Board;
use brushwork_script::mcl::ast::Motion;
use brushwork_script::mcl::registers::RegisterId;
use brushwork_script::mecc::{TICKS_PER_SECOND, events};
use brushwork_script::vm::{Host, after_ticks, ticks};
use std::time::Duration;

/// Ticks of GetClock in a second (manual, GetClock(), Wait).
const CLOCK_PER_SECOND: u32 = 1024;

/// A motor output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MotorOutput {
    /// 'F' or 'B'.
    pub direction: char,
    /// 0 to 100.
    pub percent: u32,
}

/// A servo output: 'F' or 'B', and degrees from the middle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ServoOutput {
    /// 'F' or 'B'.
    pub direction: char,
    /// Degrees from the middle.
    pub angle: u32,
}

/// The board without its processor.
#[derive(Clone, Debug)]
pub struct Hardware {
    pub(crate) now: Duration,
    /// Of its serial line.
    pub(crate) bits_per_second: u32,
    /// When the program began, for the trace.
    pub(crate) begun: Duration,
    pub(crate) display: [u8; 2],
    pub(crate) beep: Option<(u32, u32)>,
    pub(crate) motors: [MotorOutput; 4],
    pub(crate) servos: [ServoOutput; 2],
    pub(crate) steppers: [Stepper; 2],
    pub(crate) analog: [u8; 6],
    pub(crate) on_off: [bool; 4],
    pub(crate) program_number: u8,
    timers: [Option<Duration>; events::TIMERS as usize],
    /// The line that is under way and when it is out.
    sending: Option<(Duration, Vec<u8>)>,
    pub(crate) received: Frame,
    /// Whether anybody keeps a trace.
    pub(crate) is_traced: bool,
    trace: Vec<Happening>,
}

impl Default for Hardware {
    fn default() -> Self {
        Self {
            now: Duration::ZERO,
            bits_per_second: BITS_PER_SECOND,
            begun: Duration::ZERO,
            display: *b"  ",
            beep: None,
            motors: [MotorOutput { direction: 'F', percent: 0 }; 4],
            servos: [ServoOutput { direction: 'F', angle: 0 }; 2],
            steppers: [Stepper::default(), Stepper::default()],
            analog: [0; 6],
            on_off: [false; 4],
            program_number: super::assumed::PROGRAM_NUMBER,
            timers: [None; events::TIMERS as usize],
            sending: None,
            received: [0; FRAME_BYTES],
            is_traced: false,
            trace: Vec::new(),
        }
    }
}

fn direction(value: u32) -> Option<char> {
    let letter = u8::try_from(value).ok()?.to_ascii_uppercase();
    matches!(letter, b'F' | b'B').then(|| char::from(letter))
}

impl Hardware {
    pub(crate) fn note(&mut self, what: What) {
        self.note_at(self.now, what);
    }

    fn note_at(&mut self, when: Duration, what: What) {
        if self.is_traced {
            self.trace.push(Happening::new(when.saturating_sub(self.begun), what));
        }
    }

    pub(crate) fn take_trace(&mut self) -> Vec<Happening> {
        std::mem::take(&mut self.trace)
    }

    /// Timers and what else a program set up are gone; outputs stay as they are.
    pub(crate) fn program_begins(&mut self) {
        self.timers = Default::default();
        self.begun = self.now;
    }

    /// When the next thing happens by itself.
    pub(crate) fn next_due(&self) -> Option<Duration> {
        let timers = self.timers.iter().flatten().copied();
        let steppers = self.steppers.iter().filter_map(|stepper| stepper.next_step);
        timers.chain(steppers).chain(self.sending.as_ref().map(|(done, _)| *done)).min()
    }

    /// When the line that is under way is out.
    pub(crate) fn sending_until(&self) -> Option<Duration> {
        self.sending.as_ref().map(|(done, _)| *done)
    }

    /// Does what is due by now: raised events, lowest first, and the line that is out.
    pub(crate) fn fall_due(&mut self, raise: &mut dyn FnMut(u32)) -> Option<Vec<u8>> {
        let now = self.now;
        for timer in 0..self.timers.len() {
            if let Some(due) = self.timers[timer].filter(|due| *due <= now) {
                self.timers[timer] = None;
                let number = u32::try_from(timer).unwrap_or(0);
                self.note_at(due, What::Timer { timer: number + 1 });
                raise(events::TIMER + number);
            }
        }
        for index in 0..self.steppers.len() {
            while let Some(due) = self.steppers[index].next_step.filter(|due| *due <= now) {
                if self.steppers[index].step() {
                    let number = u32::try_from(index).unwrap_or(0);
                    let what = self.stepper_state(index, "done");
                    self.note_at(due, what);
                    raise(events::STEPPER + number);
                }
            }
        }
        let is_out = self.sending_until().is_some_and(|done| done <= now);
        let (_, line) = self.sending.take_if(|_| is_out)?;
        raise(events::TRANSMIT);
        Some(line)
    }

    fn stepper_state(&self, index: usize, state: &'static str) -> What {
        let stepper = &self.steppers[index];
        What::Stepper {
            stepper: u32::try_from(index).unwrap_or(0) + 1,
            state,
            direction: if stepper.sense > 0 { 'F' } else { 'B' },
            steps: stepper.steps,
            position: stepper.position,
        }
    }

    fn show(&mut self, characters: [u8; 2]) {
        self.display = characters;
        let letter = |byte: u8| if byte.is_ascii_control() { ' ' } else { char::from(byte) };
        self.note(What::Display { text: characters.into_iter().map(letter).collect() });
    }

    /// A number from 1 on as an index, where there are so many.
    fn index(number: u32, count: usize) -> Option<usize> {
        (number as usize).checked_sub(1).filter(|index| *index < count)
    }

    fn set_motor(&mut self, number: u32, output: MotorOutput) {
        let Some(index) = Self::index(number, self.motors.len()) else { return };
        self.motors[index] = output;
        let MotorOutput { direction, percent } = output;
        self.note(What::Motor { motor: number, direction, speed: percent });
    }

    fn stop_motor(&mut self, number: u32) {
        let Some(index) = Self::index(number, self.motors.len()) else { return };
        let direction = self.motors[index].direction;
        self.set_motor(number, MotorOutput { direction, percent: 0 });
    }
}

impl Host for Hardware {
    fn now(&self) -> Duration {
        self.now
    }

    /// What the board does not have, as a motor 5 or a direction "X", is passed by. Assumed.
    fn board(&mut self, command: Board, arguments: &[u32]) -> u32 {
        let argument = |at: usize| arguments.get(at).copied().unwrap_or(0);
        let (first, second, third) = (argument(0), argument(1), argument(2));
        match command {
            Board::Beep => {
                self.beep = Some((first, second));
                self.note(What::Beep { pitch: first, length: second });
            }
            Board::DisplayChars => self.show([first as u8, second as u8]),
            Board::DisplayHex => {
                let digits = format!("{:02X}", first as u8);
                self.show([digits.as_bytes()[0], digits.as_bytes()[1]]);
            }
            Board::SetTimer => {
                if let Some(index) = Self::index(first, self.timers.len()) {
                    self.timers[index] = Some(after_ticks(self.now, second, TICKS_PER_SECOND));
                }
            }
            Board::GetClock => return (ticks(self.now, CLOCK_PER_SECOND) & 0xFFFF) as u32,
            Board::SetMotor => {
                if let Some(direction) = direction(second) {
                    self.set_motor(first, MotorOutput { direction, percent: third.min(100) });
                }
            }
            Board::StopMotor => self.stop_motor(first),
            Board::StopMotors => (1..=4).for_each(|motor| self.stop_motor(motor)),
            Board::ConfigStepper => {
                if let Some(index) = Self::index(first, self.steppers.len()) {
                    self.steppers[index].configure(second, third, argument(3));
                }
            }
            Board::SetStepper => {
                if let (Some(index), Some(direction)) =
                    (Self::index(first, self.steppers.len()), direction(second))
                {
                    let sense = if direction == 'F' { 1 } else { -1 };
                    self.steppers[index].start(self.now, sense, third);
                    let what = self.stepper_state(index, "moving");
                    self.note(what);
                }
            }
            Board::SetServo => {
                if let (Some(index), Some(direction)) =
                    (Self::index(first, self.servos.len()), direction(second))
                {
                    self.servos[index] = ServoOutput { direction, angle: third };
                    self.note(What::Servo { servo: first, direction, angle: third });
                }
            }
            Board::ReadAnalogue => {
                return Self::index(first, self.analog.len()).map_or(0, |index| self.analog[index].into());
            }
            Board::GetProgramNumber => return self.program_number.into(),
            Board::Debug => self.note(What::Debug),
        }
        0
    }

    /// A frame; one that comes while another is under way is lost. Assumed: "you must not try".
    fn send(&mut self, bytes: &[u8]) {
        let mut frame = [0; FRAME_BYTES];
        let count = bytes.len().min(FRAME_BYTES);
        frame[..count].copy_from_slice(&bytes[..count]);
        let lost = self.sending.is_some();
        self.note(What::Transmit { bytes: frame, lost });
        if !lost {
            let line = line_of_board(&frame);
            let length = u32::try_from(line.len()).unwrap_or(0);
            self.sending = Some((self.now + byte_time(self.bits_per_second) * length, line));
        }
    }

    fn receive(&mut self) -> Vec<u8> {
        self.received.to_vec()
    }

    fn register(&mut self, _: RegisterId, _: u8) -> u32 {
        0
    }

    fn set_register(&mut self, _: RegisterId, _: u8, _: u32) {}

    fn put(&mut self, _: u32, _: u8) {}

    fn get(&mut self, _: u32) -> Option<u8> {
        None
    }

    fn motion(&mut self, _: Motion, _: &[i32]) {}

    fn read_eeprom(&mut self, _: u32) -> u8 {
        0xFF
    }

    fn write_eeprom(&mut self, _: u32, _: u8) {}

    fn i2c_write(&mut self, _: &[u8], _: bool, _: Option<Duration>) -> bool {
        false
    }

    fn i2c_read(&mut self, _: usize, _: Option<Duration>) -> Option<Vec<u8>> {
        None
    }
}
