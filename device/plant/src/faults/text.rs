//! The text form of a fault, as `--fault` takes it.

use super::fault::{Direction, Fault, FaultEffect};
use crate::world::{PinSignal, SwitchKind, UnitFault, WorldAction};
use brushwork_values::Motor;
use std::str::FromStr;
use std::time::Duration;

/// The text form of faults, for help pages.
pub const FAULT_SYNTAX: &str = "\
NAME[=VALUE][@FROM[..TO]][,KEY=VALUE]

On the wire (dir=in or dir=out for one direction only; in is towards the controller):
  drop=SHARE        bytes are lost: drop=0.01, drop=1%@5s..10s
  corrupt=SHARE     one bit of a byte is turned over
  duplicate=SHARE   bytes arrive twice
  delay=TIME        bytes are late: delay=5ms, delay=20ms@3s,share=0.1
  mute              all bytes are lost: mute@2s..2.5s, mute,dir=out
  unplug            the cable is out: unplug@3s, unplug@3s..5s

In the machine (motor=1 or motor=2, else motor 1; unit=N for the Nth unit of a bus, else the first):
  plant:locked-shaft        plant:open-lead           plant:reversed-leads
  plant:reversed-encoder    plant:lost-encoder        plant:noisy-encoder=COUNTS
  plant:swapped-encoders    plant:load-torque=NM      plant:battery=VOLTS
  plant:battery-ohms=OHMS   plant:battery-off         plant:power-supply
  plant:logic=VOLTS         plant:hot-board=CELSIUS   plant:e-stop
  plant:power-loss          plant:pin-volts=VOLTS,pin=N     plant:driver-fault
  plant:short-circuit       plant:boot-fault          plant:can-fault
  plant:detect-battery      (the buttons on the board; cells are counted from the next start on)
  plant:pin-pulse=MICROSECONDS,pin=N                  (as a radio receiver sends them; 0 is none)
  plant:limit-switch=forward|backward|home,pin=N      (wires the switch to that pin)

Without FROM a fault is there from the start, without TO it stays. Times: 2s, 2.5s, 500ms, 100us, 1min.";

/// A fault that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("fault \"{text}\", column {column}: {problem}")]
#[non_exhaustive]
pub struct FaultTextError {
    /// The text as given.
    pub text: String,
    /// Where it goes wrong, counted from 1 in characters.
    pub column: usize,
    /// What is wrong there.
    pub problem: FaultProblem,
}

/// What is wrong in the text of a fault.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FaultProblem {
    /// No fault of this name.
    #[error("there is no fault \"{0}\"; \"brushwork sim --help\" lists them")]
    UnknownName(String),
    /// A value is missing.
    #[error("{0} needs a value, as in {1}")]
    MissingValue(String, &'static str),
    /// A key is missing.
    #[error("{0} needs {1} too")]
    MissingKey(String, &'static str),
    /// A value where none belongs.
    #[error("{0} takes no value")]
    NeedlessValue(String),
    /// A share out of range.
    #[error("\"{0}\" is no share: write 0 to 1, or 0% to 100%")]
    Share(String),
    /// A number that is none.
    #[error("\"{0}\" is no number")]
    Number(String),
    /// A time that is none.
    #[error("\"{0}\" is no time: write a number and us, ms, s or min, as in 2.5s")]
    Time(String),
    /// An end that is not after the beginning.
    #[error("the end must come after the beginning")]
    Backwards,
    /// A key that this fault does not have.
    #[error("{0} has no \"{1}\"; it may have {2}")]
    UnknownKey(String, String, &'static str),
    /// A value that a key does not take.
    #[error("\"{0}\" will not do: write {1}")]
    Choice(String, &'static str),
}

/// A piece of the text and where it stands.
#[derive(Clone, Copy)]
struct Piece<'a> {
    text: &'a str,
    /// In bytes from the start of the whole.
    at: usize,
}

type Parsed<T> = Result<T, (usize, FaultProblem)>;

/// A fault's parts before they are understood.
struct Parts<'a> {
    name: Piece<'a>,
    value: Option<Piece<'a>>,
    from: Duration,
    until: Option<Duration>,
    direction: Option<Direction>,
    motor: Motor,
    unit: usize,
    share: Option<f64>,
    pin: Option<usize>,
}

impl FromStr for Fault {
    type Err = FaultTextError;

    fn from_str(text: &str) -> Result<Self, FaultTextError> {
        let whole = Piece { text, at: 0 };
        Parts::read(whole).and_then(|parts| parts.fault()).map_err(|(at, problem)| FaultTextError {
            text: text.to_owned(),
            column: text[..at].chars().count() + 1,
            problem,
        })
    }
}

impl<'a> Parts<'a> {
    fn read(whole: Piece<'a>) -> Parsed<Self> {
        let (head, keys) = whole.split_once(",");
        let (what, when) = head.split_once("@");
        let (name, value) = what.split_once("=");
        let (from, until) = when.map_or(Ok((Duration::ZERO, None)), Piece::range)?;
        let mut parts = Self {
            name,
            value,
            from,
            until,
            direction: None,
            motor: Motor::M1,
            unit: 0,
            share: None,
            pin: None,
        };
        let mut left = keys;
        while let Some(keys) = left {
            let (key, rest) = keys.split_once(",");
            parts.take_key(key)?;
            left = rest;
        }
        Ok(parts)
    }

    fn take_key(&mut self, piece: Piece<'a>) -> Parsed<()> {
        let (key, value) = piece.split_once("=");
        let name = self.name.text;
        let may_have = match name {
            "delay" => "dir and share",
            "unplug" => "unit",
            "plant:pin-volts" | "plant:pin-pulse" => "pin and unit",
            "plant:limit-switch" => "motor and pin and unit",
            _ if name.starts_with("plant:") => "motor and unit",
            _ => "dir",
        };
        if !may_have.split(" and ").any(|known| known == key.text) {
            let problem = FaultProblem::UnknownKey(name.to_owned(), key.text.to_owned(), may_have);
            return Err((key.at, problem));
        }
        let example = "motor=1, unit=1, dir=in or share=0.5";
        let Some(value) = value else {
            return Err((key.at, FaultProblem::MissingValue(key.text.to_owned(), example)));
        };
        match key.text {
            "dir" => self.direction = Some(value.direction()?),
            "share" => self.share = Some(value.share()?),
            "motor" => self.motor = value.motor()?,
            "pin" => self.pin = Some(value.counted_from_one()?),
            _ => self.unit = value.counted_from_one()?,
        }
        Ok(())
    }

    fn fault(&self) -> Parsed<Fault> {
        let effect = match self.name.text {
            "drop" => FaultEffect::Drop { share: self.need("drop=0.01")?.share()? },
            "corrupt" => FaultEffect::Corrupt { share: self.need("corrupt=0.001")?.share()? },
            "duplicate" => FaultEffect::Duplicate { share: self.need("duplicate=0.01")?.share()? },
            "delay" => {
                FaultEffect::Delay { by: self.need("delay=5ms")?.time()?, share: self.share.unwrap_or(1.0) }
            }
            "mute" => self.bare(FaultEffect::Mute)?,
            "unplug" => self.bare(FaultEffect::World(vec![WorldAction::Unplug { unplugged: true }]))?,
            "plant:limit-switch" => FaultEffect::World(self.limit_switch()?),
            _ => FaultEffect::World(vec![self.plant_action()?]),
        };
        Ok(Fault {
            effect,
            direction: self.direction.unwrap_or_default(),
            unit: self.unit,
            from: self.from,
            until: self.until,
        })
    }

    fn plant_action(&self) -> Parsed<WorldAction> {
        let motor = self.motor;
        let on = true;
        let number = |example| self.need(example).and_then(Piece::number);
        let Some(name) = self.name.text.strip_prefix("plant:") else { return Err(self.unknown()) };
        match name {
            "locked-shaft" => self.bare(WorldAction::LockShaft { motor, on }),
            "open-lead" => self.bare(WorldAction::OpenLead { motor, on }),
            "reversed-leads" => self.bare(WorldAction::ReverseLeads { motor, on }),
            "reversed-encoder" => self.bare(WorldAction::ReverseEncoder { motor, on }),
            "lost-encoder" => self.bare(WorldAction::LoseEncoder { motor, on }),
            "swapped-encoders" => self.bare(WorldAction::SwapEncoders { on }),
            "battery-off" => self.bare(WorldAction::ConnectBattery { connected: false }),
            "power-supply" => self.bare(WorldAction::SetBatterySinks { can_sink: false }),
            "e-stop" => self.bare(WorldAction::EStop { pressed: true }),
            "driver-fault" => {
                let fault = [UnitFault::M1Driver, UnitFault::M2Driver][motor.index()];
                self.bare(WorldAction::SetUnitFault { fault, on })
            }
            "short-circuit" => {
                let fault = [UnitFault::M1Current, UnitFault::M2Current][motor.index()];
                self.bare(WorldAction::SetUnitFault { fault, on })
            }
            "boot-fault" => self.bare(WorldAction::SetUnitFault { fault: UnitFault::Boot, on }),
            "can-fault" => self.bare(WorldAction::SetUnitFault { fault: UnitFault::Can, on }),
            "detect-battery" => self.bare(WorldAction::SetBatteryDetection { on }),
            "power-loss" => self.bare(WorldAction::Power { on: false }),
            "noisy-encoder" => {
                Ok(WorldAction::SetEncoderNoise { motor, counts: number("plant:noisy-encoder=5")? })
            }
            "load-torque" => {
                Ok(WorldAction::SetLoadTorque { motor, newton_metres: number("plant:load-torque=0.2")? })
            }
            "battery" => Ok(WorldAction::SetBatteryVolts { volts: number("plant:battery=11.5")? }),
            "battery-ohms" => Ok(WorldAction::SetBatteryOhms { ohms: number("plant:battery-ohms=0.5")? }),
            "logic" => Ok(WorldAction::SetLogicVolts { volts: number("plant:logic=7")? }),
            "hot-board" => Ok(WorldAction::SetBoardCelsius { celsius: Some(number("plant:hot-board=90")?) }),
            "pin-volts" => {
                let volts = number("plant:pin-volts=2.5,pin=1")?;
                let pin = self.need_pin("pin=1")?;
                Ok(WorldAction::SetPin { pin, signal: PinSignal::Volts { volts } })
            }
            "pin-pulse" => {
                let microseconds = number("plant:pin-pulse=1500,pin=1")?;
                let pin = self.need_pin("pin=1")?;
                Ok(WorldAction::SetPin { pin, signal: PinSignal::Pulse { microseconds } })
            }
            _ => Err(self.unknown()),
        }
    }

    /// A switch means nothing to the controller before it is wired to a pin.
    fn limit_switch(&self) -> Parsed<Vec<WorldAction>> {
        let (motor, switch) = (self.motor, self.need("plant:limit-switch=forward,pin=1")?.switch()?);
        let pin = Some(self.need_pin("pin=1")?);
        Ok(vec![
            WorldAction::WireSwitch { motor, switch, pin, trips_at_radians: None },
            WorldAction::HoldSwitch { motor, switch, closed: true },
        ])
    }

    fn need_pin(&self, example: &'static str) -> Parsed<usize> {
        self.pin.ok_or_else(|| {
            let end = self.value.map_or(self.name.end(), Piece::end);
            (end, FaultProblem::MissingKey(self.name.text.to_owned(), example))
        })
    }

    fn need(&self, example: &'static str) -> Parsed<Piece<'a>> {
        self.value.ok_or_else(|| self.missing(example))
    }

    fn missing(&self, example: &'static str) -> (usize, FaultProblem) {
        (self.name.end(), FaultProblem::MissingValue(self.name.text.to_owned(), example))
    }

    fn bare<T>(&self, effect: T) -> Parsed<T> {
        match self.value {
            None => Ok(effect),
            Some(value) => Err((value.at, FaultProblem::NeedlessValue(self.name.text.to_owned()))),
        }
    }

    fn unknown(&self) -> (usize, FaultProblem) {
        (self.name.at, FaultProblem::UnknownName(self.name.text.to_owned()))
    }
}

impl<'a> Piece<'a> {
    /// Splits at the first `mark` and takes the blanks away on both sides of it.
    fn split_once(self, mark: &str) -> (Self, Option<Self>) {
        match self.text.split_once(mark) {
            None => (self.trimmed(), None),
            Some((before, after)) => {
                let rest = Self { text: after, at: self.at + before.len() + mark.len() };
                (Self { text: before, at: self.at }.trimmed(), Some(rest.trimmed()))
            }
        }
    }

    fn trimmed(self) -> Self {
        let text = self.text.trim_start();
        Self { text: text.trim_end(), at: self.at + self.text.len() - text.len() }
    }

    fn end(self) -> usize {
        self.at + self.text.len()
    }

    fn wrong<T>(self, problem: impl FnOnce(String) -> FaultProblem) -> Parsed<T> {
        Err((self.at, problem(self.text.to_owned())))
    }

    fn choice<T>(self, known: &'static str) -> Parsed<T> {
        self.wrong(|text| FaultProblem::Choice(text, known))
    }

    fn range(self) -> Parsed<(Duration, Option<Duration>)> {
        let (from, to) = self.split_once("..");
        let begin = from.time()?;
        let Some(to) = to.filter(|to| !to.text.is_empty()) else { return Ok((begin, None)) };
        let end = to.time()?;
        if end > begin { Ok((begin, Some(end))) } else { Err((to.at, FaultProblem::Backwards)) }
    }

    fn time(self) -> Parsed<Duration> {
        let digits = self.text.trim_end_matches(|letter: char| letter.is_ascii_alphabetic());
        let scale = match &self.text[digits.len()..] {
            "us" => 1e-6,
            "ms" => 1e-3,
            "s" => 1.0,
            "min" => 60.0,
            _ => return self.wrong(FaultProblem::Time),
        };
        let seconds = digits.trim_end().parse::<f64>().map_or(f64::NAN, |number| number * scale);
        match Duration::try_from_secs_f64(seconds) {
            Ok(time) => Ok(time),
            Err(_) => self.wrong(FaultProblem::Time),
        }
    }

    fn share(self) -> Parsed<f64> {
        let (digits, scale) = self.text.strip_suffix('%').map_or((self.text, 1.0), |text| (text, 0.01));
        match digits.trim_end().parse::<f64>().map(|number| number * scale) {
            Ok(share) if (0.0..=1.0).contains(&share) => Ok(share),
            _ => self.wrong(FaultProblem::Share),
        }
    }

    fn number(self) -> Parsed<f64> {
        match self.text.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => self.wrong(FaultProblem::Number),
        }
    }

    fn counted_from_one(self) -> Parsed<usize> {
        match self.text.parse::<usize>() {
            Ok(number) if number > 0 => Ok(number - 1),
            _ => self.choice("a number from 1"),
        }
    }

    fn motor(self) -> Parsed<Motor> {
        match self.text {
            "1" => Ok(Motor::M1),
            "2" => Ok(Motor::M2),
            _ => self.choice("1 or 2"),
        }
    }

    fn direction(self) -> Parsed<Direction> {
        match self.text {
            "in" => Ok(Direction::ToController),
            "out" => Ok(Direction::ToHost),
            "both" => Ok(Direction::Both),
            _ => self.choice("in, out or both"),
        }
    }

    fn switch(self) -> Parsed<SwitchKind> {
        match self.text {
            "forward" => Ok(SwitchKind::Forward),
            "backward" => Ok(SwitchKind::Backward),
            "home" => Ok(SwitchKind::Home),
            _ => self.choice("forward, backward or home"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(text: &str) -> Fault {
        text.parse().unwrap_or_else(|error: FaultTextError| panic!("{error}"))
    }

    fn refusal(text: &str) -> String {
        text.parse::<Fault>().expect_err("it makes no sense").to_string()
    }

    fn wire(effect: FaultEffect) -> Fault {
        Fault { effect, direction: Direction::Both, unit: 0, from: Duration::ZERO, until: None }
    }

    #[test]
    fn faults_on_the_wire_are_read_with_their_times_and_keys() {
        assert_eq!(fault("drop=0.01"), wire(FaultEffect::Drop { share: 0.01 }));
        assert_eq!(fault("drop = 1%"), wire(FaultEffect::Drop { share: 0.01 }));
        let corrupt = fault("corrupt=0.001@5s..10s");
        assert_eq!(corrupt.effect, FaultEffect::Corrupt { share: 0.001 });
        assert_eq!((corrupt.from, corrupt.until), (Duration::from_secs(5), Some(Duration::from_secs(10))));
        let mute = fault("mute@2s..2.5s,dir=out");
        assert_eq!((mute.effect, mute.direction), (FaultEffect::Mute, Direction::ToHost));
        assert_eq!(mute.until, Some(Duration::from_millis(2500)));
        let delay = fault("delay=5ms@1min..,share=0.1");
        assert_eq!(delay.effect, FaultEffect::Delay { by: Duration::from_millis(5), share: 0.1 });
        assert_eq!((delay.from, delay.until), (Duration::from_secs(60), None));
        let unplug = fault("unplug@300ms,unit=2");
        assert_eq!(unplug.effect, FaultEffect::World(vec![WorldAction::Unplug { unplugged: true }]));
        assert_eq!((unplug.unit, unplug.from), (1, Duration::from_millis(300)));
    }

    #[test]
    fn faults_in_the_machine_are_read_with_their_motor() {
        let locked = fault("plant:locked-shaft@4s,motor=2");
        let action = WorldAction::LockShaft { motor: Motor::M2, on: true };
        assert_eq!(locked.effect, FaultEffect::World(vec![action]));
        let hot = fault("plant:hot-board=90");
        assert_eq!(
            hot.effect,
            FaultEffect::World(vec![WorldAction::SetBoardCelsius { celsius: Some(90.0) }])
        );
        let pin = fault("plant:pin-volts=2.5,pin=3");
        let action = WorldAction::SetPin { pin: 2, signal: PinSignal::Volts { volts: 2.5 } };
        assert_eq!(pin.effect, FaultEffect::World(vec![action]));
    }

    #[test]
    fn every_fault_of_the_help_page_is_read_and_every_example_too() {
        let names = FAULT_SYNTAX.split_whitespace().filter(|word| word.starts_with("plant:"));
        let mut count = 0;
        for name in names {
            let text = name
                .replace("forward|backward|home", "home")
                .replace("=COUNTS", "=4")
                .replace("=NM", "=-0.5")
                .replace("=VOLTS", "=9")
                .replace("=MICROSECONDS", "=1500")
                .replace("=OHMS", "=1")
                .replace("=CELSIUS", "=101")
                .replace("pin=N", "pin=1");
            fault(&text);
            count += 1;
        }
        assert_eq!(count, 24);
        for line in FAULT_SYNTAX.lines().filter(|line| line.starts_with("  ") && line.contains(": ")) {
            let (_, examples) = line.split_once(": ").expect("it was just found");
            for example in examples.split(", ") {
                fault(example);
            }
        }
    }

    #[test]
    fn mistakes_are_told_with_their_place() {
        assert_eq!(
            refusal("drip=0.1"),
            "fault \"drip=0.1\", column 1: there is no fault \"drip\"; \"brushwork sim --help\" lists them"
        );
        assert_eq!(
            refusal("drop=2"),
            "fault \"drop=2\", column 6: \"2\" is no share: write 0 to 1, or 0% to 100%"
        );
        assert_eq!(refusal("drop"), "fault \"drop\", column 5: drop needs a value, as in drop=0.01");
        assert_eq!(refusal("mute=3"), "fault \"mute=3\", column 6: mute takes no value");
        assert_eq!(
            refusal("mute@5s..2s"),
            "fault \"mute@5s..2s\", column 10: the end must come after the beginning"
        );
        assert_eq!(
            refusal("mute@5"),
            "fault \"mute@5\", column 6: \"5\" is no time: write a number and us, ms, s or min, as in 2.5s"
        );
        assert_eq!(
            refusal("plant:open-lead,motor=3"),
            "fault \"plant:open-lead,motor=3\", column 23: \"3\" will not do: write 1 or 2"
        );
        assert_eq!(
            refusal("drop=0.1,motor=1"),
            "fault \"drop=0.1,motor=1\", column 10: drop has no \"motor\"; it may have dir"
        );
        assert_eq!(refusal("plant:battery=x"), "fault \"plant:battery=x\", column 15: \"x\" is no number");
        assert_eq!(
            refusal("plant:limit-switch=home@1s"),
            "fault \"plant:limit-switch=home@1s\", column 24: plant:limit-switch needs pin=1 too"
        );
        assert!(refusal("").contains("there is no fault \"\""));
        assert!(refusal("delay=é@1s").contains("column 7"), "{}", refusal("delay=é@1s"));
    }
}
