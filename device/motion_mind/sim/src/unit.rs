//! One unit: its clock, its modes, what commands do to it, and its registers as they read now.

use super::assumed::{BLINK_TIME, BOOT_TIME, SAVE_POSITION_AFTER, STORE_TIME, VELOCITIES_IN_MEAN};
use super::config::{EncoderDecode, MotionMindConfig};
use super::drive::{Limits, OpenLoop, radio_position};
use super::inputs::Inputs;
use super::loops::{FULL_DUTY, Goal, Loop, Turn};
use super::store::Store;
use super::wire::{Order, Wire};
use brushwork_motion_mind_wire::register_number as number;
use brushwork_motion_mind_wire::{
    Address, Command, Part, REGISTERS, Reply, Returned, Returns, STATUS_BITS, function, function2, status,
};
use brushwork_motion_mind_wire::{Mode, Protocol};
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::world::{World, WorldAction, WorldView};
use brushwork_plant::{AxisTruth, ParamsError};
use brushwork_values::Motor;
use std::collections::VecDeque;
use std::time::Duration;

/// The short loop of FASTPID.
const FAST_LOOP: Duration = Duration::from_micros(500);
/// Short loops in the loop of 5 ms that everything else runs at.
const FAST_LOOPS: u32 = 10;
const FAST_LOOP_S: f64 = 0.000_5;
/// One step of AMPS.
const AMPS_STEP: f64 = 0.02;

/// A simulated Motion Mind 3 with its motor.
#[derive(Clone, Debug)]
pub struct MotionMind {
    config: MotionMindConfig,
    world: World,
    store: Store,
    wire: Wire,
    now: Duration,
    /// When the next short loop is due; all work follows this clock.
    next_loop: Duration,
    /// Short loops so far.
    fast_loops: u32,
    running: Running,
    has_power: bool,
    /// After a self-test only a power cycle helps.
    is_testing: bool,
}

/// What a power-up or a reset starts anew.
#[derive(Clone, Debug)]
struct Running {
    started_at: Duration,
    ready_at: Duration,
    baud: u32,
    uses_velocity_limit: bool,
    inputs: Inputs,
    open_loop: OpenLoop,
    closed_loop: Loop,
    limits: Limits,
    turn: Turn,
    duty: i64,
    output: BridgeOutput,
    /// Encoder count that reads as position 0.
    origin: i64,
    position: i64,
    position_before: i64,
    velocities: VecDeque<i64>,
    index_position: i64,
    was_index: bool,
    amps: i64,
    still_for: Duration,
    is_position_saved: bool,
    storing_until: Duration,
}

impl MotionMind {
    /// A unit that has just been switched on.
    ///
    /// # Errors
    /// A figure of the motor that is out of its range, by name.
    pub fn new(config: MotionMindConfig) -> Result<Self, ParamsError> {
        let world = config.world()?;
        let store = Store::new(config.address.get());
        let wire = Wire::new(config.protocol);
        let running = Running::new(Duration::ZERO);
        let mut unit = Self {
            config,
            world,
            store,
            wire,
            now: Duration::ZERO,
            next_loop: FAST_LOOP,
            fast_loops: 0,
            running,
            has_power: true,
            is_testing: false,
        };
        unit.start();
        Ok(unit)
    }

    /// Its own time since its start.
    pub fn now(&self) -> Duration {
        self.now
    }

    /// Takes bytes that arrive now.
    pub fn receive(&mut self, bytes: &[u8]) {
        if !self.world.plugged() || !self.is_awake() {
            return;
        }
        for byte in bytes {
            if let Some(order) = self.wire.receive(*byte, self.now) {
                self.obey(order);
            }
        }
    }

    /// When the next reply leaves.
    pub fn next_output_at(&self) -> Option<Duration> {
        self.wire.next_output_at()
    }

    /// Takes a reply that has left by now.
    pub fn take_output(&mut self) -> Option<Vec<u8>> {
        self.wire.take_output(self.now)
    }

    /// Bits per second on the wire, by the switch and by FUNCTION2 at power-up.
    pub fn bits_per_second(&self) -> u32 {
        self.running.baud
    }

    /// Which protocol it speaks.
    pub fn protocol(&self) -> Protocol {
        self.config.protocol
    }

    /// Does something to its world.
    pub fn apply(&mut self, action: &WorldAction) {
        self.world.apply(action);
        if self.world.powered() != self.has_power {
            self.has_power = self.world.powered();
            self.wire.forget();
            if self.has_power {
                self.is_testing = false;
                if let Some(switches) = self.world.board_switches() {
                    self.config.read_switches(switches);
                    self.wire = Wire::new(self.config.protocol);
                }
                self.start();
                self.running.ready_at += self.blinking();
            }
        }
    }

    /// Its world as it is now.
    pub fn view(&self) -> WorldView {
        self.world.view(self.now)
    }

    /// Its motor as it really is.
    pub fn truth(&self) -> AxisTruth {
        self.world.truth(Motor::M1)
    }

    /// The duty that it gives, -1 to 1.
    pub fn duty(&self) -> f64 {
        self.running.duty as f64 / FULL_DUTY as f64
    }

    /// Whether its cable is in.
    pub fn plugged(&self) -> bool {
        self.world.plugged()
    }

    /// The value of a register in EEPROM.
    pub fn stored(&self, register: u8) -> i64 {
        self.store.stored(register)
    }

    /// Writes to EEPROM so far.
    pub fn eeprom_writes(&self) -> u64 {
        self.store.eeprom_writes()
    }

    /// Moves time on.
    pub fn advance(&mut self, to: Duration) {
        while self.next_loop <= to {
            self.now = self.next_loop;
            self.next_loop += FAST_LOOP;
            self.fast_loops = self.fast_loops.wrapping_add(1);
            self.fast_loop();
        }
        self.now = self.now.max(to);
    }

    fn fast_loop(&mut self) {
        let output = if self.has_power { self.running.output } else { BridgeOutput::Coast };
        self.world.advance([output, BridgeOutput::Coast], FAST_LOOP_S);
        if !self.is_awake() {
            self.running.output = BridgeOutput::Coast;
            return;
        }
        let is_whole_loop = self.fast_loops.is_multiple_of(FAST_LOOPS);
        if is_whole_loop {
            self.sense();
        }
        let is_fast = self.store.has2(function2::FASTPID) && self.is_closed_loop();
        if is_fast && !is_whole_loop {
            self.running.inputs.read_feedback(&mut self.world);
            self.running.position = self.measured_position();
        }
        if is_whole_loop || is_fast {
            self.drive(is_whole_loop);
        }
    }

    fn is_awake(&self) -> bool {
        self.has_power && !self.is_testing && self.now >= self.running.ready_at
    }

    /// What a power-up does, or a reset.
    fn start(&mut self) {
        self.store.load();
        if self.config.mode == Mode::FactoryRestore && Inputs::limits_at_ground(&mut self.world) {
            self.store.restore();
        }
        let mut running = Running::new(self.now);
        running.ready_at = if self.now.is_zero() { Duration::ZERO } else { self.now + BOOT_TIME };
        running.baud = self.baud();
        running.uses_velocity_limit = self.store.has(function::ADSTEP);
        let start = if self.store.has(function::POSPWRUP) { self.store.stored(number::POSITION) } else { 0 };
        running.origin = self.encoder_counts() - start;
        running.position = start;
        running.position_before = start;
        self.running = running;
        if !self.has_absolute_feedback() {
            self.aim(Goal::Position(start));
        }
    }

    /// Whether the feedback tells where the motor is from the first moment on.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn has_absolute_feedback(&self) -> bool {
        match self.config.mode {
            Mode::RadioControl => true,
            Mode::AnalogPid => !self.store.has(function::RCPOS),
            _ => self.store.has2(function2::PULSEFB),
        }
    }

    /// How long the light blinks at power-up.
    fn blinking(&self) -> Duration {
        let blinks =
            if self.store.has(function::DISABLEBLINK) { 0 } else { u32::from(self.config.mode.number()) + 1 };
        BLINK_TIME * blinks
    }

    fn baud(&self) -> u32 {
        match self.config.is_fast {
            _ if self.store.has2(function2::BAUD115200) => 115_200,
            _ if self.store.has2(function2::BAUD38400) => 38_400,
            true => 19_200,
            false => 9_600,
        }
    }

    fn encoder_counts(&mut self) -> i64 {
        let counts = self.world.encoder(Motor::M1).counts;
        match self.config.decode {
            EncoderDecode::Times4 => counts,
            EncoderDecode::Times1 => counts.div_euclid(4),
        }
    }

    /// Whether the mode closes a loop, with its sub-mode.
    fn is_closed_loop(&self) -> bool {
        match self.config.mode {
            Mode::SerialPid | Mode::AnalogPid => true,
            Mode::RadioControl => self.store.has(function::RCPOS),
            Mode::Analog | Mode::Buttons | Mode::Serial | Mode::FactoryRestore | Mode::FactoryTest => false,
        }
    }

    fn sense(&mut self) {
        self.running.inputs.read(&mut self.world, &self.store, self.config.mode);
        self.running.amps =
            (self.world.measured_amps(Motor::M1).abs() / AMPS_STEP).round().clamp(0.0, 1023.0) as i64;
        let celsius = self.world.board_celsius()[0];
        let is_heat_ignored = self.store.has2(function2::OVERTEMP);
        self.running.limits.look(&self.store, self.running.amps, celsius, is_heat_ignored);
        self.running.position = self.measured_position();
        if self.running.closed_loop.goal() == Goal::Idle {
            // Assumed: the loop holds what it finds at power-up.
            self.aim(Goal::Position(self.running.position));
            self.running.position_before = self.running.position;
        }
        let velocity = self.running.position - self.running.position_before;
        self.running.position_before = self.running.position;
        self.running.velocities.truncate(VELOCITIES_IN_MEAN - 1);
        self.running.velocities.push_front(velocity);
        if self.running.inputs.index && !self.running.was_index {
            self.running.index_position = self.running.position;
        }
        self.running.was_index = self.running.inputs.index;
        self.save_position(velocity);
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn measured_position(&mut self) -> i64 {
        let is_encoder_in_mode_5 = self.store.has(function::RCPOS);
        match self.config.mode {
            Mode::RadioControl if self.store.has(function::RCPOS) => self.running.inputs.feedback,
            Mode::AnalogPid if !is_encoder_in_mode_5 => self.running.inputs.feedback,
            Mode::SerialPid if self.store.has2(function2::PULSEFB) => {
                self.running.inputs.pulse_steps.unwrap_or(self.running.position)
            }
            _ => self.encoder_counts() - self.running.origin,
        }
    }

    fn save_position(&mut self, velocity: i64) {
        if velocity != 0 {
            self.running.still_for = Duration::ZERO;
            self.running.is_position_saved = false;
            return;
        }
        self.running.still_for += FAST_LOOP * FAST_LOOPS;
        let is_due = self.running.still_for >= SAVE_POSITION_AFTER && !self.running.is_position_saved;
        if is_due && self.config.mode == Mode::SerialPid && self.store.has(function::SAVEPOS) {
            self.running.is_position_saved = true;
            self.store.store(number::POSITION, self.running.position);
        }
    }

    fn drive(&mut self, is_whole_loop: bool) {
        if self.now < self.running.storing_until {
            self.running.duty = 0;
            self.running.output = self.running.limits.bridge(&self.store, &self.running.inputs, 0);
            return;
        }
        let is_closed = self.is_closed_loop();
        let wanted = if is_closed {
            self.follow_input();
            let velocity = self.running.velocities.front().copied().unwrap_or_default();
            self.running.turn = self.running.closed_loop.turn(&self.store, self.running.position, velocity);
            self.running.turn.duty
        } else if is_whole_loop {
            self.running.turn = Turn::default();
            let uses_register = self.running.uses_velocity_limit;
            self.running.open_loop.turn(
                self.config.mode,
                &self.store,
                &self.running.inputs,
                uses_register,
                self.config.is_fast,
            )
        } else {
            self.running.open_loop.duty
        };
        let running = &mut self.running;
        let position = is_closed.then_some(running.position);
        let duty = running.limits.apply(&self.store, &running.inputs, wanted, is_closed, position);
        running.closed_loop.note_limit(duty, running.limits.pwm_limit);
        running.duty = duty;
        running.output = running.limits.bridge(&self.store, &running.inputs, duty);
    }

    /// Lets the setpoint of modes 0 and 5 follow its input.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn follow_input(&mut self) {
        let inputs = &self.running.inputs;
        let target = match self.config.mode {
            Mode::RadioControl => radio_position(&self.store, inputs),
            Mode::AnalogPid if self.store.has(function::ADSERIAL) => return,
            Mode::AnalogPid if self.store.has(function::RCPOS) => inputs.control * self.analog_factor(),
            Mode::AnalogPid => inputs.control,
            _ => return,
        };
        if self.running.closed_loop.goal() != Goal::Position(target) {
            let position = self.running.position;
            self.running.closed_loop.follow(target, position);
        }
    }

    /// The highest of the bits ADX2 to ADX64.
    fn analog_factor(&self) -> i64 {
        (1..=6).rev().find(|power| self.store.has2(1 << (power + 1))).map_or(1, |power| 1 << power)
    }

    fn aim(&mut self, goal: Goal) {
        let position = self.running.position;
        self.running.closed_loop.aim(goal, position);
    }

    fn obey(&mut self, order: Order) {
        match order {
            Order::NotUnderstood(address) => {
                if address.is_none_or(|address| address == self.address()) {
                    self.wire.say(None, &Reply::NotUnderstood, self.address(), self.now);
                }
            }
            Order::SelfTest(address) if self.listens_to(address) => self.is_testing = true,
            Order::Command(_, command) if self.lacks(&command) => {}
            Order::Command(address, command) if self.listens_to(address) => {
                let own = self.address();
                let reply = self.execute(&command);
                if !address.is_broadcast() {
                    let at = self.now.max(self.running.storing_until);
                    self.wire.say(Some(&command), &reply, own, at);
                }
                if command == Command::Reset {
                    self.start();
                }
            }
            Order::SelfTest(_) | Order::Command(..) => {}
        }
    }

    /// Whether a read asks for a register that its firmware does not have.
    fn lacks(&self, command: &Command) -> bool {
        command.named_registers() & self.config.lacks != 0
    }

    fn address(&self) -> Address {
        Address::from_wire(u8::try_from(self.store.get(number::ADDRESS)).unwrap_or_default())
    }

    /// A unit whose own address is a broadcast hears and never answers.
    fn listens_to(&self, address: Address) -> bool {
        address.is_broadcast() || address == self.address()
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn execute(&mut self, command: &Command) -> Reply {
        match *command {
            Command::ChangeSpeed(duty) if self.config.mode == Mode::Serial => {
                self.running.open_loop.asked = i64::from(duty).clamp(-1023, 1023);
            }
            Command::MoveToAbsolute(position) if self.takes_moves() => {
                self.aim(Goal::Position(self.reachable(i64::from(position))));
            }
            Command::MoveToRelative(distance) if self.takes_moves() => {
                let target = self.reachable(self.running.position + i64::from(distance));
                self.aim(Goal::Position(target));
            }
            Command::MoveAtVelocity(velocity) if self.config.mode == Mode::SerialPid => {
                self.aim(Goal::Velocity(i64::from(velocity)));
            }
            Command::Write { register, value } => self.write(register, value, false),
            Command::WriteStore { register, value } => {
                self.write(register, value, true);
                self.stop_to_store();
            }
            Command::Restore => {
                self.store.restore();
                self.stop_to_store();
            }
            Command::Read(mask) => return self.read((0..32).filter(|number| mask >> number & 1 == 1)),
            Command::ReadRegister(register) | Command::ReadText(Part::Register(register)) => {
                return self.read(std::iter::once(register));
            }
            Command::ReadText(Part::All) => return self.read(0..32),
            Command::ReadText(Part::StatusBits) => return bits(self.status(), STATUS_LINES),
            Command::ReadText(Part::FunctionBits) => return bits(self.store.bits(number::FUNCTION), 16),
            // Assumed: what the mode has no use for is taken and does nothing.
            _ => {}
        }
        self.acknowledge(command)
    }

    fn acknowledge(&self, command: &Command) -> Reply {
        let returns = Returns::of_function(self.store.bits(number::FUNCTION));
        if !command.takes_returns() || returns.is_none() {
            return Reply::Acknowledged;
        }
        let position = i32::try_from(self.read_one(number::POSITION)).unwrap_or_default();
        let velocity = i16::try_from(self.read_one(number::VELOCITY)).unwrap_or_default();
        let time = u32::try_from(self.read_one(number::TIME)).unwrap_or_default();
        Reply::Returned(Returned::of(returns, position, velocity, time))
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn takes_moves(&self) -> bool {
        match self.config.mode {
            Mode::SerialPid => true,
            Mode::AnalogPid => self.store.has(function::ADSERIAL),
            _ => false,
        }
    }

    /// Mode 5 has the positions of its converter, unless the encoder is its feedback.
    fn reachable(&self, position: i64) -> i64 {
        let is_analog = self.config.mode == Mode::AnalogPid && !self.store.has(function::RCPOS);
        if is_analog { position.clamp(0, 1023) } else { position }
    }

    fn write(&mut self, register: u8, value: i64, is_stored: bool) {
        // Assumed: a write to a register that cannot be written is taken and does nothing.
        if !Store::is_writable(register) {
            return;
        }
        let was_absolute = self.has_absolute_feedback();
        if is_stored {
            self.store.store(register, value);
        } else {
            self.store.set(register, value);
        }
        if self.has_absolute_feedback() != was_absolute {
            // Assumed: another feedback is another scale, so the loop holds what it finds on it.
            self.aim(Goal::Idle);
        }
        if register == number::POSITION {
            self.running.origin = self.encoder_counts() - value;
            self.running.position = value;
            self.running.position_before = value;
            self.aim(Goal::Position(value));
        }
    }

    fn stop_to_store(&mut self) {
        self.running.storing_until = self.now + STORE_TIME;
        self.running.open_loop.stop();
        let position = self.running.position;
        self.running.duty = 0;
        self.running.output = self.running.limits.bridge(&self.store, &self.running.inputs, 0);
        if self.running.closed_loop.goal() != Goal::Idle {
            self.aim(Goal::Position(position));
        }
        self.wire.deaf_until(self.running.storing_until);
    }

    fn read(&self, numbers: impl Iterator<Item = u8>) -> Reply {
        Reply::Registers(numbers.map(|number| (number, self.read_one(number))).collect())
    }

    /// A register as it reads now.
    pub fn read_one(&self, register: u8) -> i64 {
        let running = &self.running;
        let is_velocity =
            self.store.has2(function2::NEWVELMODE) && matches!(running.closed_loop.goal(), Goal::Velocity(_));
        let value = match register {
            number::POSITION if is_velocity => self.velocity(),
            number::POSITION => running.position,
            number::RCCOUNT => running.inputs.rc,
            number::VELOCITY => self.velocity(),
            number::TIME => {
                (self.now - running.started_at).as_millis() as i64 / 5 % (i64::from(u32::MAX) + 1)
            }
            number::STATUS => i64::from(self.status()),
            number::REVISION => i64::from(self.config.revision),
            number::MODE => i64::from(self.config.mode.number()),
            number::ANALOGCON => running.inputs.control,
            number::ANALOGFBCK => running.inputs.feedback,
            number::PWMOUT => running.duty,
            number::INDEXPOS => running.index_position,
            number::DESIREDPOSITION => running.closed_loop.desired(&self.store),
            number::AMPS => running.amps,
            number::THERMISTOR => thermistor(self.world.board_celsius()[0]),
            stored => self.store.get(stored),
        };
        let fits = REGISTERS.get(usize::from(register)).map(|row| row.kind.range());
        fits.map_or(value, |fits| value.clamp(*fits.start(), *fits.end()))
    }

    fn velocity(&self) -> i64 {
        let velocities = &self.running.velocities;
        if self.config.mode == Mode::AnalogPid {
            return velocities.front().copied().unwrap_or_default();
        }
        velocities.iter().sum::<i64>() / (velocities.len() as i64).max(1)
    }

    fn status(&self) -> u16 {
        let running = &self.running;
        let conditions = [
            (status::NEGLIMIT, running.inputs.negative.is_low),
            (status::POSLIMIT, running.inputs.positive.is_low),
            (status::BRAKE, running.inputs.brake),
            (status::INDEX, running.inputs.index),
            (status::BADRC, running.inputs.is_rc_bad),
            (status::VNLIMIT, running.limits.virtual_limits[0]),
            (status::VPLIMIT, running.limits.virtual_limits[1]),
            (status::CURRENTLIMIT, running.limits.is_over_current),
            (status::PWMLIMIT, running.limits.is_at_pwm_limit),
            (status::INPOSITION, running.turn.in_position),
            (status::TEMPFAULT, running.limits.is_too_hot),
        ];
        conditions.into_iter().filter(|(_, is_set)| *is_set).fold(0, |word, (bit, _)| word | bit)
    }
}

/// The manual's sample lists ten bits of STATUS, though the register has eleven.
const STATUS_LINES: usize = STATUS_BITS.len() - 1;

fn bits(word: u16, count: usize) -> Reply {
    Reply::Bits((0..count).map(|bit| word >> bit & 1 == 1).collect())
}

/// The converter's value of a temperature.
fn thermistor(celsius: f64) -> i64 {
    ((celsius / -0.165 + 1104.0).round() as i64).clamp(0, 1023)
}

impl Running {
    fn new(now: Duration) -> Self {
        Self {
            started_at: now,
            ready_at: now,
            baud: 9_600,
            uses_velocity_limit: false,
            inputs: Inputs::default(),
            open_loop: OpenLoop::default(),
            closed_loop: Loop::default(),
            limits: Limits::default(),
            turn: Turn::default(),
            duty: 0,
            output: BridgeOutput::Coast,
            origin: 0,
            position: 0,
            position_before: 0,
            velocities: VecDeque::new(),
            index_position: 0,
            was_index: false,
            amps: 0,
            still_for: Duration::ZERO,
            is_position_saved: false,
            storing_until: Duration::ZERO,
        }
    }
}
