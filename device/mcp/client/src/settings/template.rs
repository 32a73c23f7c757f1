//! How one line of the table becomes the rows of one controller.
//!
//! A [`Template`] stands for one setting of every motor, pin, stream or output at once and for all four
//! firmware generations; [`Template::expand`] fills in a subject's numbers, names and ratings.

use brushwork_mcp_wire::codes;
use brushwork_mcp_wire::models::{Family, Model, Pin};
use brushwork_mcp_wire::packet_serial::{Generation, Part, has_number};
use brushwork_mcp_wire::roboclaw::ControlPin;
use brushwork_values::Unit as Measure;
use brushwork_values::{Code, Motor};

use crate::{layout_of, model_of};
use brushwork_link::settings::SettingValue;
use brushwork_link::settings::Subject;
use brushwork_link::settings::{
    Access, Bits, Bound, Carrier, Group, Instance, Place, Range, Row, Sink, Source,
};
use brushwork_link::settings::{Coding, Kind};

/// One line of the table.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Template {
    /// Key with "{n}" where the number or name of the instance goes.
    pub(crate) key: &'static str,
    pub(crate) label: &'static str,
    pub(crate) group: Group,
    pub(crate) repeat: Repeat,
    pub(crate) kind: Kind,
    pub(crate) unit: Measure,
    pub(crate) coding: Coding,
    pub(crate) range: Limits,
    pub(crate) default: Default,
    /// Product lines that have the setting; `None` for all.
    pub(crate) family: Option<Family>,
    /// The wire form by generation; a generation that stands in none does not have the setting.
    pub(crate) forms: &'static [Form],
    pub(crate) help: &'static str,
}

/// A table of settings: for each what its [`Template`] says, the forms of its commands in brackets, and its help.
macro_rules! settings {
    ($($row:ident($($own:expr),*) $(.$part:ident($($given:expr),*))*; [$($form:expr),*] $help:expr;)*) => {
        &[$($row($($own),*)$(.$part($($given),*))*.forms(&[$($form),*]).help($help)),*]
    };
}
pub(crate) use settings;

/// A setting of the unit.
pub(crate) const fn setting(key: &'static str, label: &'static str, group: Group) -> Template {
    Template::new(key, label, group)
}

/// A setting that an MCP alone has.
pub(crate) const fn mcp(key: &'static str, label: &'static str, group: Group) -> Template {
    Template::new(key, label, group).only_on(Family::Mcp)
}

/// A setting of each motor.
pub(crate) const fn motor(key: &'static str, label: &'static str, group: Group) -> Template {
    Template::new(key, label, group).per(Repeat::Motors)
}

impl Template {
    /// A yes-or-no line that every model has, once; the builders below say otherwise.
    pub(crate) const fn new(key: &'static str, label: &'static str, group: Group) -> Self {
        Self {
            key,
            label,
            group,
            repeat: Repeat::Once,
            kind: Kind::Bool,
            unit: Measure::None,
            coding: Coding::Plain,
            range: Limits::None,
            default: Default { value: DefaultValue::Bool(false), assumed: false },
            family: None,
            forms: &[],
            help: "",
        }
    }

    pub(crate) const fn per(mut self, repeat: Repeat) -> Self {
        self.repeat = repeat;
        self
    }

    pub(crate) const fn only_on(mut self, family: Family) -> Self {
        self.family = Some(family);
        self
    }

    pub(crate) const fn int(mut self, unit: Measure, range: Limits) -> Self {
        self.kind = Kind::Int;
        self.unit = unit;
        self.range = range;
        self
    }

    pub(crate) const fn fixed(
        mut self,
        unit: Measure,
        coding: Coding,
        decimals: usize,
        range: Limits,
    ) -> Self {
        self.kind = Kind::Fixed { decimals };
        self.unit = unit;
        self.coding = coding;
        self.range = range;
        self
    }

    pub(crate) const fn choice(mut self, codes: &'static [Code]) -> Self {
        self.kind = Kind::Choice(codes);
        self
    }

    /// A choice that takes other numbers too, since not all of its values have a public name.
    pub(crate) const fn open_choice(mut self, codes: &'static [Code], numbers: Limits) -> Self {
        self.range = numbers;
        self.choice(codes)
    }

    /// A default that the manual states.
    pub(crate) const fn default(mut self, value: DefaultValue) -> Self {
        self.default = Default { value, assumed: false };
        self
    }

    /// A default that the manual does not state.
    pub(crate) const fn assumed_default(mut self, value: DefaultValue) -> Self {
        self.default = Default { value, assumed: true };
        self
    }

    /// The forms by generation. Commands and fields that the command table does not have do not compile.
    pub(crate) const fn forms(mut self, forms: &'static [Form]) -> Self {
        let mut at = 0;
        while at < forms.len() {
            match forms[at].carrier {
                FormCarrier::Wire { read, write } => {
                    read.must_stand(if read.indexed { Part::Record } else { Part::Reply });
                    if let Some(write) = write {
                        write.must_stand(Part::Request);
                    }
                }
                FormCarrier::LinkAddress { write } => write.must_stand(Part::Request),
                FormCarrier::Hidden(_) => {}
            }
            at += 1;
        }
        self.forms = forms;
        self
    }

    pub(crate) const fn help(mut self, help: &'static str) -> Self {
        self.help = help;
        self
    }
}

/// How often a template stands in a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Repeat {
    Once,
    /// Motor 1 and motor 2.
    Motors,
    /// Priority levels 1 to 3.
    Levels,
    /// Every pin of command 144.
    Pins,
    /// Every stream of command 146.
    Streams,
    /// The TTL streams only.
    TtlStreams,
    /// Every output of command 138.
    Douts,
    /// Inputs S1 and S2 of a RoboClaw.
    RoboClawInputs,
    /// Functions of S3, S4, S5, D1 and D2 of a RoboClaw; the number of functions depends on the generation.
    RoboClawPins,
    /// CTRL1 and CTRL2 of a RoboClaw.
    Ctrls,
}

/// The bounds of a template.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Limits {
    /// None: yes or no, and choices.
    None,
    /// In the unit of the row.
    Between(f64, f64),
    /// In steps of the wire field.
    Steps(i64, i64),
    /// What the model's main battery terminals stand.
    MainVolts,
    /// What the model's logic battery terminals stand.
    LogicVolts,
    /// From 0 to the model's current.
    Amps,
    /// From the model's current, negative, to 0.
    NegativeAmps,
}

/// The default of a template.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Default {
    value: DefaultValue,
    /// Our assumption rather than a statement of the manual.
    assumed: bool,
}

/// Where the default of a template comes from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum DefaultValue {
    Bool(bool),
    Int(i64),
    Number(f64),
    /// The number, or the end of the model's range that it lies beyond.
    WithinRange(f64),
    /// Whatever the number on the wire stands for.
    Raw(i64),
    Key(&'static str),
    /// One key per instance.
    Keys(&'static [&'static str]),
    /// The lower end of the model's range.
    Lowest,
    /// The upper end of the model's range.
    Highest,
    /// "encoder" on pins that carry an encoder channel, else "none".
    PinType,
    /// The pin that carries phase A of the motor's own encoder.
    EncoderPin,
    /// "disabled" for a stream that shares its lines with an encoder, else "packet_serial".
    StreamType,
}

/// The wire form of a template in a range of generations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Form {
    pub(crate) first: Generation,
    pub(crate) last: Generation,
    pub(crate) carrier: FormCarrier,
    pub(crate) access: Access,
    /// Replaces the template's kind in these generations.
    pub(crate) kind: Option<Kind>,
    /// Replaces the template's coding in these generations.
    pub(crate) coding: Option<Coding>,
    /// Replaces the template's bounds in these generations.
    pub(crate) range: Option<Limits>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum FormCarrier {
    Wire { read: At, write: Option<At> },
    LinkAddress { write: At },
    Hidden(&'static str),
}

/// A place in a command that depends on the instance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct At {
    /// The command of each instance; the last one serves all further instances.
    pub(crate) commands: &'static [u8],
    /// The field of each instance; the last one serves all further instances.
    pub(crate) fields: &'static [&'static str],
    /// Whether the instance is the record of a counted reply, or the first field of a request.
    pub(crate) indexed: bool,
    pub(crate) bits: Option<Bits>,
}

impl At {
    pub(crate) const fn bits(mut self, shift: u8, width: u8) -> Self {
        self.bits = Some(Bits { shift, width });
        self
    }

    pub(crate) const fn indexed(mut self) -> Self {
        self.indexed = true;
        self
    }

    const fn must_stand(self, part: Part) {
        let mut instance = 0;
        while instance < self.commands.len() || instance < self.fields.len() {
            assert!(
                has_number(self.command(instance), part, self.field(instance)),
                "the command of a setting has no such field"
            );
            instance += 1;
        }
    }

    const fn command(self, instance: usize) -> u8 {
        self.commands[if instance < self.commands.len() { instance } else { self.commands.len() - 1 }]
    }

    const fn field(self, instance: usize) -> &'static str {
        self.fields[if instance < self.fields.len() { instance } else { self.fields.len() - 1 }]
    }

    fn place(self, instance: usize) -> Place {
        Place { field: self.field(instance), bits: self.bits }
    }

    fn source(self, instance: usize) -> Source {
        let record = self.indexed.then_some(instance);
        Source::Reply { command: self.command(instance), place: self.place(instance), record }
    }

    fn sink(self, instance: usize) -> Sink {
        let index = self.indexed.then(|| u8::try_from(instance).unwrap_or(u8::MAX));
        Sink { command: self.command(instance), place: self.place(instance), index }
    }
}

/// The place named `fields` in `commands`, by instance.
pub(crate) const fn at(commands: &'static [u8], fields: &'static [&'static str]) -> At {
    At { commands, fields, indexed: false, bits: None }
}

impl Form {
    /// Whether one command writes a field of each instance.
    fn writes_for_all(&self) -> bool {
        match self.carrier {
            FormCarrier::Wire { write: Some(write), .. } => {
                write.commands.len() == 1 && write.fields.len() > 1 && !write.indexed
            }
            FormCarrier::Wire { write: None, .. }
            | FormCarrier::LinkAddress { .. }
            | FormCarrier::Hidden(_) => false,
        }
    }

    /// A form of all generations; narrow it with [`Form::only`].
    pub(crate) const fn wire(read: At, write: At) -> Self {
        Self::new(FormCarrier::Wire { read, write: Some(write) })
    }

    /// A form whose fields have the same names in the reply that reads them and in the request that writes
    /// them.
    pub(crate) const fn field(
        reads: &'static [u8],
        writes: &'static [u8],
        fields: &'static [&'static str],
    ) -> Self {
        Self::wire(at(reads, fields), at(writes, fields))
    }

    /// One pin, stream or output of several: a record of the reply, an index in the request.
    pub(crate) const fn record(
        reads: &'static [u8],
        writes: &'static [u8],
        fields: &'static [&'static str],
    ) -> Self {
        Self::wire(at(reads, fields).indexed(), at(writes, fields).indexed())
    }

    /// Some bits of a field that has the same name in both directions.
    pub(crate) const fn bits(
        reads: &'static [u8],
        writes: &'static [u8],
        fields: &'static [&'static str],
        (shift, width): (u8, u8),
    ) -> Self {
        Self::wire(at(reads, fields).bits(shift, width), at(writes, fields).bits(shift, width))
    }

    /// Names the fields of the request where they differ from those of the reply.
    pub(crate) const fn writing(mut self, fields: &'static [&'static str]) -> Self {
        if let FormCarrier::Wire { read, write: Some(mut write) } = self.carrier {
            write.fields = fields;
            self.carrier = FormCarrier::Wire { read, write: Some(write) };
        }
        self
    }

    /// A form that can be read and not written.
    pub(crate) const fn read_only(read: At, reason: &'static str) -> Self {
        let mut form = Self::new(FormCarrier::Wire { read, write: None });
        form.access = Access::ReadOnly { reason };
        form
    }

    /// A setting with no public wire form.
    pub(crate) const fn hidden(reason: &'static str) -> Self {
        let mut form = Self::new(FormCarrier::Hidden(reason));
        form.access = Access::SimulatedOnly { reason };
        form
    }

    /// Read as the address of the link, written with a command.
    pub(crate) const fn link_address(write: At) -> Self {
        Self::new(FormCarrier::LinkAddress { write })
    }

    pub(crate) const fn only(mut self, first: Generation, last: Generation) -> Self {
        self.first = first;
        self.last = last;
        self
    }

    pub(crate) const fn simulated_only(mut self, reason: &'static str) -> Self {
        self.access = Access::SimulatedOnly { reason };
        self
    }

    pub(crate) const fn with_kind(mut self, kind: Kind) -> Self {
        self.kind = Some(kind);
        self
    }

    pub(crate) const fn with_range(mut self, range: Limits) -> Self {
        self.range = Some(range);
        self
    }

    pub(crate) const fn with_coding(mut self, coding: Coding) -> Self {
        self.coding = Some(coding);
        self
    }

    const fn new(carrier: FormCarrier) -> Self {
        Self {
            first: Generation::Gen1,
            last: Generation::Gen4,
            carrier,
            access: Access::ReadWrite,
            kind: None,
            coding: None,
            range: None,
        }
    }

    pub(crate) fn serves(&self, generation: Generation) -> bool {
        (self.first..=self.last).contains(&generation)
    }
}

impl Template {
    /// The generations that have the setting, ascending.
    pub(crate) fn generations(&self) -> Vec<Generation> {
        Generation::ALL.into_iter().filter(|generation| self.form(*generation).is_some()).collect()
    }

    pub(crate) fn form(&self, generation: Generation) -> Option<&'static Form> {
        self.forms.iter().find(|form| form.serves(generation))
    }

    /// The rows of `subject`, one per instance; none when the subject does not have the setting.
    pub(crate) fn expand(&self, subject: &Subject) -> Vec<Row> {
        let Some(model) = model_of(subject) else { return Vec::new() };
        let subject = &Unit { subject, model };
        let ours = self.family.is_none_or(|family| family == model.family);
        match self.form(layout_of(subject.generation)) {
            Some(form) if ours => self
                .instances(form, subject)
                .into_iter()
                .map(|instance| self.row(form, subject, instance))
                .collect(),
            _ => Vec::new(),
        }
    }

    /// For each instance: its place in the commands from 0, what fills "{n}", and what it is called.
    fn instances(&self, form: &Form, subject: &Unit<'_>) -> Vec<(usize, String, Option<Instance>)> {
        let numbered = |count: usize, name: &dyn Fn(usize) -> String| {
            let one = |index: usize| {
                let number = index + 1;
                (index, number.to_string(), Some(Instance { number, name: name(index) }))
            };
            (0..count).map(one).collect()
        };
        let named = |list: &[(usize, &str, &str)]| {
            let instance =
                |index: usize, name: &str| Some(Instance { number: index + 1, name: name.to_owned() });
            list.iter()
                .map(|(index, key, name)| (*index, (*key).to_owned(), instance(*index, name)))
                .collect()
        };
        match self.repeat {
            Repeat::Once => vec![(0, String::new(), None)],
            Repeat::Motors => {
                // A command for both motors is sent with what was read of the one that the board lacks.
                let count = if form.writes_for_all() { Motor::BOTH.len() } else { subject.model.motors };
                numbered(count, &|index| {
                    on_board(format!("Motor {}", index + 1), index < subject.model.motors)
                })
            }
            Repeat::Levels => numbered(3, &|index| format!("Priority level {}", index + 1)),
            Repeat::Pins => numbered(subject.pins, &|index| subject.pin_name(index)),
            Repeat::Douts => numbered(subject.douts, &|index| format!("DOUT{}", index + 1)),
            Repeat::Ctrls => numbered(subject.model.control_outputs, &|index| format!("CTRL{}", index + 1)),
            Repeat::Streams => named(&streams(0, subject.streams)),
            Repeat::TtlStreams => named(&streams(2, subject.streams)),
            Repeat::RoboClawInputs => named(&[(0, "s1", "S1"), (1, "s2", "S2")]),
            Repeat::RoboClawPins => {
                let is_there = |name: &str| match name {
                    "D1" | "D2" => subject.model.control_outputs > 0,
                    input => subject.model.control_pins.contains(&input),
                };
                let inputs = 3;
                let carried = if layout_of(subject.generation) == Generation::Gen4 {
                    ROBOCLAW_PINS.len()
                } else {
                    inputs
                };
                let pin = |(index, key, name): &(usize, &str, &str)| {
                    let name = on_board((*name).to_owned(), is_there(name));
                    (*index, (*key).to_owned(), Some(Instance { number: index + 1, name }))
                };
                ROBOCLAW_PINS[..carried].iter().map(pin).collect()
            }
        }
    }

    fn row(
        &self,
        form: &'static Form,
        subject: &Unit<'_>,
        (index, number, instance): (usize, String, Option<Instance>),
    ) -> Row {
        let coding = form.coding.unwrap_or(self.coding);
        // What the numbers stand for differs by pin and by generation.
        let kind = if self.repeat == Repeat::RoboClawPins {
            Kind::Choice(ControlPin::ALL[index].functions(layout_of(subject.generation)))
        } else {
            form.kind.unwrap_or(self.kind)
        };
        let range = form.range.unwrap_or(self.range).at(coding, subject);
        Row {
            key: self.key.replace("{n}", &number),
            pattern: self.key,
            label: self.label,
            group: self.group,
            instance,
            kind,
            unit: self.unit,
            coding,
            range,
            default: self.default_value(kind, coding, range, index, subject),
            default_assumed: self.default.assumed,
            carrier: form.carrier.at(index),
            access: form.access,
            help: self.help,
            model: subject.model.name,
            register: None,
        }
    }

    fn default_value(
        &self,
        kind: Kind,
        coding: Coding,
        range: Range,
        index: usize,
        subject: &Unit<'_>,
    ) -> SettingValue {
        let exact = |number: f64| coding.decode(kind, coding.to_raw(number));
        match self.default.value {
            DefaultValue::Bool(on) => SettingValue::Bool(on),
            DefaultValue::Int(number) => SettingValue::Int(number),
            DefaultValue::Number(number) => exact(number),
            DefaultValue::WithinRange(number) => exact(number.clamp(range.min, range.max)),
            DefaultValue::Raw(raw) => coding.decode(kind, raw),
            DefaultValue::Key(key) => SettingValue::Choice(key),
            DefaultValue::Keys(keys) => SettingValue::Choice(keys[index.min(keys.len() - 1)]),
            DefaultValue::Lowest => exact(range.min),
            DefaultValue::Highest => exact(range.max),
            DefaultValue::PinType => SettingValue::Choice(match subject.model.pins.get(index) {
                Some(pin) if pin.encoder_channel().is_some() => "encoder",
                _ => "none",
            }),
            DefaultValue::StreamType if subject.model.stream_shares_encoder(index) => {
                SettingValue::Choice("disabled")
            }
            DefaultValue::StreamType => SettingValue::Choice("packet_serial"),
            DefaultValue::EncoderPin => SettingValue::Int(encoder_pin(subject.model, index)),
        }
    }
}

/// The controller that rows are made for, with its ratings and pins.
struct Unit<'s> {
    subject: &'s Subject,
    model: &'static Model,
}

impl std::ops::Deref for Unit<'_> {
    type Target = Subject;

    fn deref(&self) -> &Subject {
        self.subject
    }
}

/// The signal number of phase A of a motor's own encoder; on a RoboClaw, encoder mode 0.
fn encoder_pin(model: &Model, motor: usize) -> i64 {
    let own = |pin: &Pin| {
        pin.encoder_channel().is_some_and(|(number, phase)| usize::from(number) == motor + 1 && phase == 'A')
    };
    match model.family {
        Family::RoboClaw => 0,
        Family::Mcp => {
            let index = model.pins.iter().position(own).and_then(|index| i64::try_from(index).ok());
            index.unwrap_or(codes::ENCODER_PIN_NONE)
        }
    }
}

impl Limits {
    /// The bounds for one controller.
    fn at(self, coding: Coding, subject: &Unit<'_>) -> Range {
        let model = subject.model;
        let rated = |(min, max): (f64, f64)| Range { min, max, bound: Bound::Model };
        let field = |min: f64, max: f64| Range { min, max, bound: Bound::Field };
        match self {
            Self::None => Range::UNBOUNDED,
            Self::Between(min, max) => field(min, max),
            Self::Steps(min, max) => field(coding.to_physical(min), coding.to_physical(max)),
            Self::MainVolts => rated(model.main_volts),
            Self::LogicVolts => rated(model.logic_volts),
            Self::Amps => rated((0.0, model.max_amps)),
            Self::NegativeAmps => rated((-model.max_amps, 0.0)),
        }
    }
}

impl FormCarrier {
    fn at(self, instance: usize) -> Carrier {
        match self {
            Self::Wire { read, write } => {
                Carrier::Wire { read: read.source(instance), write: write.map(|write| write.sink(instance)) }
            }
            Self::LinkAddress { write } => {
                Carrier::Wire { read: Source::LinkAddress, write: Some(write.sink(instance)) }
            }
            Self::Hidden(reason) => Carrier::NoWireForm { reason },
        }
    }
}

/// The name of a part; one that the board lacks has its place in a command all the same.
fn on_board(name: String, is_there: bool) -> String {
    if is_there { name } else { format!("{name} (not on this board)") }
}

const ROBOCLAW_PINS: &[(usize, &str, &str)] =
    &[(0, "s3", "S3"), (1, "s4", "S4"), (2, "s5", "S5"), (3, "d1", "D1"), (4, "d2", "D2")];

/// Index, key and name of streams `first` up to `count`.
fn streams(first: usize, count: usize) -> Vec<(usize, &'static str, &'static str)> {
    let listed = |(index, code): (usize, &'static Code)| (index, code.key, code.label);
    codes::STREAMS.iter().enumerate().map(listed).take(count).skip(first).collect()
}
