//! The smallest family there can be: text lines, one motor that takes speeds and no duty, one setting, one channel, one indicator. The
//! window's tests show it too.

use brushwork_link::Message;
use brushwork_link::device::controller::{
    ArmCheck, Controller, Described, DiscoverError, Line, PollItem, PollList, Search,
};
use brushwork_link::device::{
    Addresses, Capabilities, Channel, DeviceOptions, Drive, DriveCommand, Facts, Identity, Indicator,
    PlaceState, Sample, StatusPlace, StatusReport, StopBytes, UnitFacts, UnitStop,
};
use brushwork_link::exchange::{ExchangeError, Judgement, Outgoing, Reply, Span};
use brushwork_link::family::{Family, FamilyRef, Model};
use brushwork_link::settings::{
    Access, Argument, Bound, Carrier, Coding, FamilySettings, Group, Kind, Place, PlanContext, Planned,
    Range, ReadReport, Row, SaveReport, SettingValue, Sink, Source, Stage, Step, Subject, WriteOptions,
};
use brushwork_link::unit::{FirmwareGeneration, UnitAddress};
use brushwork_link::{Driver, Failure, Stream, Wire};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::{WorldAction, WorldView};
use brushwork_values::{Field, Kind as ValueKind, Severity, Unit, Value, Values};
use std::sync::LazyLock;
use std::time::Duration;

pub const ECHO: FamilyRef = FamilyRef::new(&Echo);
/// A part of the settings that no other family has.
pub const LOOP: Group = Group::new(200, "loop", "Loop");
const GAIN: &str = "gain";
const READ_GAIN: u8 = 1;
const WRITE_GAIN: u8 = 2;
static GAIN_FIELDS: [Field; 1] = [Field::new(GAIN, ValueKind::U16, "the gain")];
pub static HOT: [Indicator; 1] =
    [Indicator { key: "hot", short: "HOT", title: "Too hot", severity: Severity::Error, mask: 1 }];
pub const CHANNELS: &[Channel] = &[Channel::M1_POSITION];
pub static MODELS: LazyLock<[Model; 1]> = LazyLock::new(|| {
    [Model {
        key: "echo-1",
        name: "Echo 1",
        rating: "1x1A",
        family: ECHO,
        pins: Vec::new(),
        streams: 0,
        douts: 0,
    }]
});

/// Lines in, lines out: "P" tells position and status, "V n" sets the speed, "G" tells the gain, "G n" sets it.
#[derive(Default)]
pub struct EchoMachine {
    now: Duration,
    position_counts: f64,
    pub speed_counts_per_s: f64,
    pub gain: i64,
    pub is_hot: bool,
    /// Of a line whose end has not come yet.
    input: Vec<u8>,
    output: Option<Vec<u8>>,
}

impl Machine for EchoMachine {
    fn now(&self) -> Duration {
        self.now
    }

    fn receive(&mut self, _stream: StreamIndex, bytes: &[u8]) {
        self.input.extend(bytes);
        while let Some(end) = self.input.iter().position(|byte| *byte == b'\n') {
            let line: Vec<u8> = self.input.drain(..=end).collect();
            let line = String::from_utf8_lossy(&line[..end]);
            let (word, number) = line.split_once(' ').unwrap_or((&line, ""));
            let given: Option<f64> = number.parse().ok();
            let reply = match (word, given) {
                ("P", _) => format!("{:.0} {}", self.position_counts, u8::from(self.is_hot)),
                ("V", Some(speed)) => {
                    self.speed_counts_per_s = speed;
                    "ok".to_owned()
                }
                ("G", Some(gain)) => {
                    self.gain = gain as i64;
                    "ok".to_owned()
                }
                ("G", None) => self.gain.to_string(),
                _ => "?".to_owned(),
            };
            self.output.get_or_insert_default().extend(format!("{reply}\n").bytes());
        }
    }

    fn advance(&mut self, to: Duration) {
        let passed = to.saturating_sub(self.now);
        self.position_counts += self.speed_counts_per_s * passed.as_secs_f64();
        self.now = self.now.max(to);
    }

    fn next_output_at(&self) -> Option<Duration> {
        self.output.as_ref().map(|_| self.now)
    }

    fn take_output(&mut self, _stream: StreamIndex) -> Option<Vec<u8>> {
        self.output.take()
    }

    fn bits_per_second(&self, _stream: StreamIndex) -> u32 {
        115_200
    }

    fn units(&self) -> usize {
        1
    }

    fn apply(&mut self, _unit: usize, _action: &WorldAction) {}

    fn views(&self) -> Vec<WorldView> {
        Vec::new()
    }

    fn plugged(&self) -> bool {
        true
    }
}

pub struct Echo;

impl Family for Echo {
    fn key(&self) -> &'static str {
        "echo"
    }

    fn label(&self) -> &'static str {
        "Echo"
    }

    fn default_baud(&self) -> u32 {
        115_200
    }

    fn models(&self) -> &'static [Model] {
        &*MODELS
    }

    fn model(&self, name: &str) -> Option<&'static Model> {
        MODELS.iter().find(|model| model.key == name)
    }

    fn identify(&self, version_text: &str) -> Option<&'static Model> {
        MODELS.iter().find(|model| version_text.starts_with(model.name))
    }

    fn has_address(&self, number: u8) -> bool {
        number == 1
    }

    fn addresses(&self) -> &'static str {
        "1 alone"
    }

    fn factory_address(&self) -> u8 {
        1
    }

    fn check_generation(&self, _number: i64) -> Result<u8, &'static str> {
        Ok(1)
    }

    fn generation_text(&self, number: u8) -> String {
        format!("edition {number}")
    }
}

impl Driver for Echo {
    fn family(&self) -> FamilyRef {
        ECHO
    }

    fn search(&self) -> Box<dyn Search> {
        Box::new(EchoSearch)
    }

    fn settings(&self) -> &'static dyn FamilySettings {
        &EchoSettings
    }
}

/// Sends a line and gives the one that comes back.
fn ask(line: &mut Line<'_>, text: &str) -> Result<(String, Span), ExchangeError> {
    let bytes = format!("{text}\n");
    let retries = line.retries();
    let outgoing =
        Outgoing { bytes: bytes.as_bytes(), reply_length: 2, patience: Duration::ZERO, retries, once: false };
    let mut answer = String::new();
    let (exchange, watch) = line.parts();
    let span = exchange.exchange(&outgoing, watch, &mut |bytes| match bytes
        .iter()
        .position(|byte| *byte == b'\n')
    {
        None => Judgement::More(1),
        Some(end) => {
            answer = String::from_utf8_lossy(&bytes[..end]).into_owned();
            Judgement::Good(end + 1)
        }
    })?;
    Ok((answer, span))
}

fn impossible<T>() -> Result<T, ExchangeError> {
    Err(ExchangeError::impossible(EchoMessage::NoSuchThing))
}

struct EchoSearch;

impl Search for EchoSearch {
    fn discover(
        &mut self,
        line: &mut Line<'_>,
        options: &DeviceOptions,
    ) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
        ask(line, "P")?;
        let identity = Identity {
            family: ECHO,
            address: 1,
            protocol: "echo",
            version_text: "Echo 1".to_owned(),
            model: Some("Echo 1"),
            firmware: "1".to_owned(),
            generation: FirmwareGeneration::new(ECHO, 1),
            facts: Facts::new(EchoFacts),
            also_answers: Vec::new(),
            simulated: options.simulated,
            port: line.exchange().port(),
            notes: Vec::new(),
        };
        Ok(vec![Box::new(EchoUnit { identity })])
    }

    fn stop_bytes(&self, _: Addresses) -> StopBytes {
        StopBytes::at_once(vec![b"V 0\n".to_vec()])
    }
}

brushwork_values::messages! {
    /// What the family says.
    pub enum EchoMessage {
        SpeedsAlone "it takes speeds alone",
        NoSuchThing "this controller has no such thing",
        Save "save",
        Reload "reload",
        Restore "restore the defaults",
        NoMemory "it has no memory",
    }
}

#[derive(Debug)]
pub struct EchoFacts;

impl UnitFacts for EchoFacts {
    fn capabilities(&self) -> Capabilities {
        Capabilities {
            motors: 1,
            duty: false,
            speed: true,
            position: false,
            ramps: false,
            queued_moves: false,
            scripts: false,
            estop: false,
            pins: false,
            batteries: false,
            serial_timeout: true,
            firmware_loader: false,
            reload: false,
            registers: false,
        }
    }

    fn channels(&self) -> &'static [Channel] {
        CHANNELS
    }

    fn status_row(&self, report: Option<&StatusReport>, _homed: Option<[bool; 2]>) -> Vec<StatusPlace> {
        let state = match report.map(|report| report.active().next()) {
            None => PlaceState::Unknown,
            Some(None) => PlaceState::Clear,
            Some(Some(indicator)) => PlaceState::Active(indicator.severity),
        };
        vec![StatusPlace { short: HOT[0].short, title: HOT[0].title, state }]
    }

    fn describe_sent(&self, bytes: &[u8]) -> Described {
        Described { text: String::from_utf8_lossy(bytes).into_owned(), sound: true }
    }

    fn objection(&self, drive: &Drive) -> Option<Message> {
        matches!(drive.m1, Some(DriveCommand::Duty { .. })).then(|| EchoMessage::SpeedsAlone.into())
    }

    fn preview(&self, _drive: &Drive, _address: u8) -> Vec<Vec<u8>> {
        Vec::new()
    }

    fn place(&self, address: u8) -> String {
        format!("echo {address}")
    }
}

struct EchoUnit {
    identity: Identity,
}

impl Controller for EchoUnit {
    fn identity(&self) -> &Identity {
        &self.identity
    }

    fn poll_list(&self) -> PollList {
        let item = PollItem { id: 0, name: "position and status" };
        PollList { fast: vec![item], slow: Vec::new(), status: Some(item), signals: None }
    }

    fn poll(
        &mut self,
        line: &mut Line<'_>,
        _item: PollItem,
        sample: &mut Sample,
    ) -> Result<Option<StatusReport>, ExchangeError> {
        let (answer, span) = ask(line, "P")?;
        let (position, word) = answer.split_once(' ').unwrap_or((&answer, "0"));
        let position = position.parse().unwrap_or(f64::NAN);
        sample.set(Channel::M1_POSITION, position, span.requested_at, span.replied_at);
        Ok(Some(StatusReport::new(1, span.replied_at, word.parse().unwrap_or(0), &HOT)))
    }

    fn drive(&mut self, line: &mut Line<'_>, drive: &Drive) -> Result<(), ExchangeError> {
        let Some(DriveCommand::Speed { speed_counts_per_s, .. }) = drive.m1 else { return impossible() };
        if !line.permit().motion {
            return Err(ExchangeError::NotArmed { command: "speed".to_owned() });
        }
        line.motion_begins();
        ask(line, &format!("V {speed_counts_per_s}")).map(drop)
    }

    fn stop_bytes(&self, _scripts: bool) -> StopBytes {
        StopBytes::at_once(vec![b"V 0\n".to_vec()])
    }

    fn confirm_stop(&mut self, line: &mut Line<'_>, _scripts: bool) -> Result<UnitStop, ExchangeError> {
        ask(line, "V 0")?;
        Ok(UnitStop { confirmed: true, ..UnitStop::new(1) })
    }

    fn other_drivers(&mut self, _line: &mut Line<'_>) -> Result<Vec<Message>, ExchangeError> {
        Ok(Vec::new())
    }

    fn check_arming(&mut self, _: &mut Line<'_>, _: Option<Stream>) -> Result<ArmCheck, ExchangeError> {
        let controller_timeout = Some(Duration::from_millis(300));
        Ok(ArmCheck { reasons: Vec::new(), controller_timeout, warnings: Vec::new() })
    }

    fn transact(
        &mut self,
        line: &mut Line<'_>,
        command: u8,
        values: Vec<Value>,
    ) -> Result<Reply, ExchangeError> {
        match (command, values.first().and_then(Value::as_int)) {
            (READ_GAIN, _) => {
                let (answer, span) = ask(line, "G")?;
                let gain = answer.parse().unwrap_or(0);
                Ok(Reply { values: Values::new(&GAIN_FIELDS, vec![Value::Int(gain)]), span })
            }
            (WRITE_GAIN, Some(gain)) => {
                let (_, span) = ask(line, &format!("G {gain}"))?;
                Ok(Reply { values: Values::default(), span })
            }
            _ => impossible(),
        }
    }

    fn can_move(&self, _: u8) -> bool {
        false
    }

    fn undermines_arming(&self, _: u8) -> bool {
        false
    }

    fn describe_traffic(&self, request: &[u8], _: Option<&[u8]>) -> Described {
        EchoFacts.describe_sent(request)
    }
}

struct EchoSettings;

impl FamilySettings for EchoSettings {
    fn rows(&self, _subject: &Subject) -> Vec<Row> {
        let place = Place { field: GAIN, bits: None };
        vec![Row {
            key: "loop.gain".to_owned(),
            pattern: "loop.gain",
            label: "Gain",
            group: LOOP,
            instance: None,
            kind: Kind::Int,
            unit: Unit::None,
            coding: Coding::Plain,
            range: Range { min: 0.0, max: 100.0, bound: Bound::Field },
            default: SettingValue::Int(0),
            default_assumed: false,
            carrier: Carrier::Wire {
                read: Source::Reply { command: READ_GAIN, place, record: None },
                write: Some(Sink { command: WRITE_GAIN, place, index: None }),
            },
            access: Access::ReadWrite,
            help: "The one setting there is.",
            model: "Echo 1",
            register: None,
        }]
    }

    fn is_there(&self, wire: &mut dyn Wire) -> Result<Values, ExchangeError> {
        wire.transact(READ_GAIN, &[])
    }

    fn read_title(&self, _command: u8) -> &'static str {
        "read the gain"
    }

    fn arguments(&self, _planned: &Planned<'_>) -> Result<Vec<Argument>, Message> {
        Ok(vec![Argument::Field(GAIN)])
    }

    fn stage(&self, _planned: &Planned<'_>) -> Stage {
        Stage::Motors
    }

    fn warnings(&self, _context: &PlanContext<'_>, _steps: &[Step]) -> Vec<Message> {
        Vec::new()
    }

    fn step_bytes(&self, step: &Step, _: UnitAddress, _: FirmwareGeneration) -> Result<Vec<u8>, Message> {
        Ok(format!("G {}\n", step.values()[0]).into_bytes())
    }

    fn step_words(&self, _: &Step, _: UnitAddress, _: FirmwareGeneration) -> String {
        "set the gain".to_owned()
    }

    fn step_title(&self, _: &Step) -> String {
        "write the gain".to_owned()
    }

    fn new_address(&self, _: &Step) -> Option<u8> {
        None
    }

    fn save(&self, wire: &mut dyn Wire, _: &ReadReport, _: WriteOptions) -> Result<SaveReport, Failure> {
        Err(Failure::new(EchoMessage::Save, wire.describe(), EchoMessage::NoMemory, Message::default()))
    }

    fn reload(&self, wire: &mut dyn Wire) -> Result<(), Failure> {
        Err(Failure::new(EchoMessage::Reload, wire.describe(), EchoMessage::NoMemory, Message::default()))
    }

    fn restore(&self, wire: &mut dyn Wire) -> Result<(), Failure> {
        Err(Failure::new(EchoMessage::Restore, wire.describe(), EchoMessage::NoMemory, Message::default()))
    }
}
