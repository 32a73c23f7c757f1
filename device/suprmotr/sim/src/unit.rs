//! One board: its clock, what it hears, and the line that it carries out.

use super::assumed::{BOOT_TIME, COMMANDS_PER_TICK, REPLY_DELAY, TICK, VERSION};
use super::axis::Axis;
use super::channels::Channels;
use super::config::SuprMotrConfig;
use super::outbox::Outbox;
use super::program::{Program, Step, Wait};
use super::store::{Eeprom, Parameters};
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::world::{Leds, UnitFault, World, WorldAction, WorldView};
use brushwork_plant::{AxisTruth, ParamsError};
use brushwork_suprmotr_wire::{
    Address, Command, ErrorCode, Parsed, Radix, Reader, Received, ReportLine, Reports, SELECT, Selection,
    Single, encode_report, parse_line,
};
use brushwork_values::Motor;
use std::time::Duration;

/// A simulated SuprMotr V9 with its motor.
#[derive(Clone, Debug)]
pub struct SuprMotr {
    pub(super) config: SuprMotrConfig,
    world: World,
    pub(super) eeprom: Eeprom,
    pub(super) eeprom_writes: u64,
    pub(super) now: Duration,
    next_tick: Duration,
    pub(super) running: Running,
    has_power: bool,
    is_traced: bool,
    trace: Vec<Step>,
}

/// What a start begins anew.
#[derive(Clone, Debug)]
pub(super) struct Running {
    ready_at: Duration,
    pub address: Address,
    pub is_selected: bool,
    /// Ctrl-A came, and its address did not yet.
    is_selecting: bool,
    reader: Reader,
    /// The line that a carriage return alone repeats.
    line: Vec<u8>,
    pub parameters: Parameters,
    pub radix: Radix,
    pub axis: Axis,
    pub channels: Channels,
    pub program: Program,
    commands_left: u32,
    pub error: Option<ErrorCode>,
    outbox: Outbox,
}

impl SuprMotr {
    /// A board that has just been switched on.
    ///
    /// # Errors
    /// A figure of the motor that is out of its range, by name.
    pub fn new(config: SuprMotrConfig) -> Result<Self, ParamsError> {
        let world = config.world()?;
        let eeprom = config.eeprom.clone();
        let running = Running::new(&eeprom, Duration::ZERO);
        let mut unit = Self {
            config,
            world,
            eeprom,
            eeprom_writes: 0,
            now: Duration::ZERO,
            next_tick: TICK,
            running,
            has_power: true,
            is_traced: false,
            trace: Vec::new(),
        };
        unit.start(Duration::ZERO);
        Ok(unit)
    }

    /// Its own time since its start.
    pub fn now(&self) -> Duration {
        self.now
    }

    /// Takes bytes that arrive now.
    pub fn receive(&mut self, bytes: &[u8]) {
        for byte in bytes {
            // RT in a line may make it deaf in the midst of them.
            if self.world.plugged() && self.is_awake() {
                self.hear(*byte);
            }
        }
    }

    /// When the next report leaves.
    pub fn next_output_at(&self) -> Option<Duration> {
        self.running.outbox.next_at()
    }

    /// Takes a report that has left by now, and when it left.
    pub fn take_output(&mut self) -> Option<(Duration, Vec<u8>)> {
        self.running.outbox.take(self.now)
    }

    /// Bits per second on the wire: BR.
    pub fn bits_per_second(&self) -> u32 {
        match self.running.parameters.rate {
            1 => 19_200,
            2 => 38_400,
            _ => 9_600,
        }
    }

    /// Does something to its world.
    pub fn apply(&mut self, action: &WorldAction) {
        self.world.apply(action);
        if self.world.powered() != self.has_power {
            self.has_power = self.world.powered();
            self.running = Running::new(&self.eeprom, self.now);
            if self.has_power {
                self.start(BOOT_TIME);
            }
        }
    }

    /// Its world as it is now.
    pub fn view(&self) -> WorldView {
        let leds = Leds { stat1: self.is_awake(), stat2: false, err: self.running.error.is_some() };
        WorldView { leds: self.has_power.then_some(leds), ..self.world.view(self.now) }
    }

    /// Its motor as it really is.
    pub fn truth(&self) -> AxisTruth {
        self.world.truth(Motor::M1)
    }

    /// Whether its cable is in.
    pub fn plugged(&self) -> bool {
        self.world.plugged()
    }

    /// Its address.
    pub fn address(&self) -> Address {
        self.running.address
    }

    /// Whether it is selected.
    pub fn is_selected(&self) -> bool {
        self.running.is_selected
    }

    /// The position that it tells, in counts.
    pub fn position(&self) -> i64 {
        self.running.axis.position()
    }

    /// How far the position lags behind the trajectory, in counts.
    pub fn following_error(&self) -> i64 {
        self.running.axis.following_error()
    }

    /// What the loop gives, in steps of the bridge.
    pub fn drive(&self) -> i64 {
        self.running.axis.drive()
    }

    /// Whether no move is in process.
    pub fn is_motion_complete(&self) -> bool {
        self.running.axis.is_complete()
    }

    /// Whether the loop is on; the brake output is released then. Assumed: the manual has a pin and no word for it.
    pub fn is_motor_on(&self) -> bool {
        self.has_power && self.running.axis.is_on()
    }

    /// Whether a macro runs.
    pub fn is_in_macro(&self) -> bool {
        self.running.program.is_in_macro()
    }

    /// What the digital outputs give, channel 1 in bit 0.
    pub fn outputs(&self) -> u16 {
        self.running.channels.outputs()
    }

    /// The analog output, in steps of 19.5 mV.
    pub fn analog_output(&self) -> u8 {
        self.running.channels.analog_output()
    }

    /// Whether a line, or a macro that it called, is still being carried out.
    pub fn is_busy(&self) -> bool {
        self.running.program.is_running()
    }

    /// What the last command was refused for, if it was.
    pub fn error(&self) -> Option<ErrorCode> {
        self.running.error
    }

    /// Whether the motor was let go since its position lagged too far behind.
    pub fn has_excessive_error(&self) -> bool {
        self.running.axis.flags().excessive_error
    }

    /// Begins to note the commands that lines and macros begin; [`SuprMotr::take_trace`] has to be called now and then from here on.
    pub fn start_trace(&mut self) {
        self.is_traced = true;
    }

    /// Takes what was noted since the last time.
    pub fn take_trace(&mut self) -> Vec<Step> {
        std::mem::take(&mut self.trace)
    }

    /// What it works with now.
    pub fn parameters(&self) -> &Parameters {
        &self.running.parameters
    }

    /// What outlives its power.
    pub fn eeprom(&self) -> &Eeprom {
        &self.eeprom
    }

    /// Writes to EEPROM so far.
    pub fn eeprom_writes(&self) -> u64 {
        self.eeprom_writes
    }

    /// Moves time on.
    pub fn advance(&mut self, to: Duration) {
        while self.next_tick <= to {
            self.now = self.next_tick;
            self.next_tick += TICK;
            self.tick();
        }
        self.now = self.now.max(to);
    }

    fn is_awake(&self) -> bool {
        self.has_power && self.now >= self.running.ready_at
    }

    /// Whether something outside the firmware holds the bridge off.
    fn is_bridge_dead(&self) -> bool {
        let faults = self.world.unit_faults();
        faults.has(UnitFault::M1Driver) || faults.has(UnitFault::M1Current) || self.world.estop_pressed()
    }

    fn tick(&mut self) {
        let is_driving = self.is_awake() && !self.is_bridge_dead();
        let axis = &mut self.running.axis;
        self.world.advance_with(TICK.as_secs_f64(), |motor, sense| match motor {
            Motor::M1 if is_driving => axis.output(sense),
            Motor::M1 | Motor::M2 => BridgeOutput::Coast,
        });
        if !self.is_awake() {
            return;
        }
        let running = &mut self.running;
        running.channels.read(&mut self.world);
        let counts = self.world.encoder(Motor::M1).counts;
        running.axis.sense(counts, running.parameters.is_phase_reversed);
        running.axis.tick(&running.parameters, &running.channels);
        running.commands_left = COMMANDS_PER_TICK;
        self.go_on();
    }

    /// What a power-up does, or RT.
    pub(super) fn start(&mut self, boot_time: Duration) {
        let mut running = Running::new(&self.eeprom, self.now + boot_time);
        running.channels.read(&mut self.world);
        if self.config.has_address_pins {
            running.address = Address::new(running.channels.address_pins()).unwrap_or(self.eeprom.address);
        }
        running.is_selected = self.config.is_addressed;
        running.program.start_macro(0, self.eeprom.macro_of(0).to_vec());
        self.running = running;
        if self.config.is_addressed {
            self.say(self.running.ready_at, &[ReportLine::Text(VERSION.to_owned())]);
        }
    }

    fn hear(&mut self, byte: u8) {
        let was_selected = self.running.is_selected;
        let ends_selection = std::mem::take(&mut self.running.is_selecting);
        self.running.is_selecting = byte == SELECT && !ends_selection;
        let received = self.running.reader.feed(byte, was_selected);
        if was_selected && !ends_selection && !self.running.is_selecting {
            self.echo(&[byte]);
        }
        match received {
            Some(Received::Selection(selection)) => self.select(selection, byte),
            Some(Received::Single(single)) => self.obey_single(single),
            Some(Received::Line(line)) => {
                self.running.line = line;
                self.carry_out();
            }
            Some(Received::Repeat) => self.carry_out(),
            None => {}
        }
    }

    /// Assumed: the two characters of a selection come back from the board that they select.
    fn select(&mut self, selection: Selection, character: u8) {
        self.running.is_selected = selection.selects(self.running.address);
        if self.running.is_selected {
            self.echo(&[SELECT, character]);
        }
    }

    fn obey_single(&mut self, single: Single) {
        match single {
            Single::Abort => self.running.axis.stop(),
            Single::EndMacro => self.running.program.end(),
            Single::Position
            | Single::FollowingError
            | Single::Iteration
            | Single::Status
            | Single::Channels => {
                if let Some(mnemonic) = single.mnemonic() {
                    self.report(Command::plain(mnemonic));
                }
            }
        }
    }

    /// Carries the last line out, whatever ran before.
    ///
    /// Assumed: the commands before the first that is refused are done, but nothing of a line that is too long.
    fn carry_out(&mut self) {
        self.running.program.end();
        let Parsed { line, error } = parse_line(&self.running.line, self.running.radix);
        if let Some(error) = error {
            self.running.error = Some(error.code);
            if line.defines.is_some() || error.code == ErrorCode::LineOverflow {
                return;
            }
        }
        if let Some(number) = line.defines {
            if self.eeprom.define(number, line.commands) {
                self.eeprom_writes += 1;
            } else {
                self.running.error = Some(ErrorCode::MacroOverflow);
            }
            return;
        }
        self.running.program.start(line.commands);
        self.go_on();
    }

    /// Goes on with the line, as far as it may in this tick.
    fn go_on(&mut self) {
        while self.running.commands_left > 0 && self.is_awake() && self.may_go_on() {
            let Some(command) = self.running.program.peek() else { return };
            if command.row().reports != Reports::Nothing && self.running.is_selected {
                // One report after another waits until the wire is free: a loop must not say more than goes through.
                if self.running.program.has_reported && self.running.outbox.is_busy(self.now) {
                    return;
                }
                self.running.program.has_reported = true;
            }
            self.running.commands_left -= 1;
            let step = self.running.program.take(self.now);
            self.trace.extend(step.filter(|_| self.is_traced));
            let refused = self.execute(command);
            if let Err(code) = refused {
                self.running.error = Some(code);
                self.running.program.end();
            }
        }
    }

    /// Whether the line waits no more.
    fn may_go_on(&mut self) -> bool {
        let running = &mut self.running;
        if let Some(Wait::Stop(then)) = running.program.wait
            && running.axis.is_complete()
        {
            running.program.wait = Some(Wait::Until(self.now + then));
        }
        let is_over = match running.program.wait {
            None => return true,
            Some(Wait::Stop(_)) => false,
            Some(Wait::Until(at)) => self.now >= at,
            Some(Wait::Channel { channel, is_on }) => running.channels.is_on(channel) == is_on,
        };
        if is_over {
            running.program.wait = None;
        }
        is_over
    }

    /// Reports what a command asks for, if the board is selected.
    pub(super) fn report(&mut self, command: Command) {
        if self.running.is_selected {
            let lines = self.lines_of(command);
            self.say(self.now + REPLY_DELAY, &lines);
        }
    }

    fn say(&mut self, at: Duration, lines: &[ReportLine]) {
        let running = &self.running;
        let bytes = encode_report(self.config.reply_form, running.radix, running.address, lines);
        let bits_per_second = self.bits_per_second();
        self.running.outbox.put(at, &bytes, bits_per_second);
    }

    fn echo(&mut self, bytes: &[u8]) {
        if self.running.parameters.has_echo {
            let bits_per_second = self.bits_per_second();
            self.running.outbox.put(self.now, bytes, bits_per_second);
        }
    }
}

impl Running {
    fn new(eeprom: &Eeprom, ready_at: Duration) -> Self {
        Self {
            ready_at,
            address: eeprom.address,
            is_selected: false,
            is_selecting: false,
            reader: Reader::new(),
            line: Vec::new(),
            parameters: eeprom.parameters.clone(),
            radix: Radix::default(),
            axis: Axis::default(),
            channels: Channels::default(),
            program: Program::default(),
            commands_left: COMMANDS_PER_TICK,
            error: None,
            outbox: Outbox::default(),
        }
    }
}
