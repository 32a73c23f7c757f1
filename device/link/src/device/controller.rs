//! What the device thread asks of a controller, whatever its family.
//!
//! The thread knows when and whether; a family knows which bytes.

pub use super::described::Described;

use super::channel::Sample;
use super::drive::Drive;
use super::identity::Identity;
use super::inquiry::{Heard, Inquiry};
use super::options::{Addresses, DeviceOptions};
use super::signals::Guard;
use super::status::StatusReport;
use super::stop::{StopBytes, UnitStop};
use crate::exchange::{Exchange, ExchangeError, Permit, RETRIES, Reply, Watch};
use crate::failure::Failure;
use crate::messages::CauseMessage;
use crate::settings::SettingsImage;
use crate::transport::Stream;
use brushwork_values::{Message, Motor, Value};
use std::cell::Cell;
use std::time::Duration;

/// One thing that can be read in a sweep; its number means something to its family only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PollItem {
    /// The family's own number.
    pub id: u16,
    /// What is read, for sentences: "main battery".
    pub name: &'static str,
}

/// What is read, and how often.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PollList {
    /// Read in every sweep.
    pub fast: Vec<PollItem>,
    /// One of them in each sweep, in turn.
    pub slow: Vec<PollItem>,
    /// Which of them brings the status word.
    pub status: Option<PollItem>,
    /// What reads the input pins; only in sweeps for which that was asked.
    pub signals: Option<PollItem>,
}

/// What was found when arming was asked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ArmCheck {
    /// Why it cannot be; empty if it can.
    pub reasons: Vec<Failure>,
    /// After how much silence the controller stops the motors by itself.
    pub controller_timeout: Option<Duration>,
    /// What does not speak against it but should be known, as sentences.
    pub warnings: Vec<Message>,
}

impl ArmCheck {
    /// What was found of two units that move together: the shorter time-out is the one that has to be fed.
    #[must_use]
    pub fn with(mut self, other: Self) -> Self {
        self.reasons.extend(other.reasons);
        self.warnings.extend(
            other.warnings.into_iter().filter(|warning| !self.warnings.contains(warning)).collect::<Vec<_>>(),
        );
        let timeouts = self.controller_timeout.into_iter().chain(other.controller_timeout);
        self.controller_timeout = timeouts.min();
        self
    }
}

/// One unit on a link.
pub trait Controller: Send {
    /// Who it is.
    fn identity(&self) -> &Identity;

    /// What can be read from it.
    fn poll_list(&self) -> PollList;

    /// Reads one item into `sample`; returns the status if the item brings it.
    fn poll(
        &mut self,
        line: &mut Line<'_>,
        item: PollItem,
        sample: &mut Sample,
    ) -> Result<Option<StatusReport>, ExchangeError>;

    /// Moves motors.
    fn drive(&mut self, line: &mut Line<'_>, drive: &Drive) -> Result<(), ExchangeError>;

    /// The bytes that stop this unit, to be written without waiting for anything. With `scripts`, a script is stopped first.
    fn stop_bytes(&self, scripts: bool) -> StopBytes;

    /// Stops the unit once more, this time asking for its confirmation, and empties its buffers.
    fn confirm_stop(&mut self, line: &mut Line<'_>, scripts: bool) -> Result<UnitStop, ExchangeError>;

    /// What can drive a motor without this program: input pins and scripts, each as a sentence.
    fn other_drivers(&mut self, line: &mut Line<'_>) -> Result<Vec<Message>, ExchangeError>;

    /// Whether motion may be allowed over this port.
    fn check_arming(
        &mut self,
        line: &mut Line<'_>,
        stream: Option<Stream>,
    ) -> Result<ArmCheck, ExchangeError>;

    /// Whether its kind of controller can stop its motors by itself when nobody speaks to it any more. Whether this one is set to do so is found
    /// out by [`Controller::check_arming`].
    fn has_timeout(&self) -> bool {
        true
    }

    /// The settings that a stop may change for a while, as the unit holds them when nothing of that is under way; known after
    /// [`Controller::check_arming`].
    fn lends(&self) -> SettingsImage {
        SettingsImage::default()
    }

    /// Those that a stop has changed and not given back yet, as they were before.
    fn lent(&self) -> SettingsImage {
        SettingsImage::default()
    }

    /// Sets an encoder's count.
    fn set_encoder(
        &mut self,
        _line: &mut Line<'_>,
        _motor: Motor,
        _counts: i32,
    ) -> Result<(), ExchangeError> {
        Err(ExchangeError::impossible(CauseMessage::NoEncoder))
    }

    /// Sets all encoders' counts to zero; those of a unit with one motor by setting that one's.
    fn zero_encoders(&mut self, line: &mut Line<'_>) -> Result<(), ExchangeError> {
        self.set_encoder(line, Motor::M1, 0)
    }

    /// Resets an E-stop.
    fn reset_estop(&mut self, _line: &mut Line<'_>) -> Result<(), ExchangeError> {
        Err(ExchangeError::impossible(CauseMessage::NoEStop))
    }

    /// Starts the stored script.
    fn start_script(&mut self, _line: &mut Line<'_>) -> Result<(), ExchangeError> {
        Err(ExchangeError::impossible(CauseMessage::NoScripts))
    }

    /// Stops the running script.
    fn stop_script(&mut self, _line: &mut Line<'_>) -> Result<(), ExchangeError> {
        Err(ExchangeError::impossible(CauseMessage::NoScripts))
    }

    /// Starts the program in the unit's memory. The user has accepted that nothing here may be able to stop it.
    fn start_program(&mut self, _line: &mut Line<'_>) -> Result<(), ExchangeError> {
        Err(ExchangeError::impossible(CauseMessage::NoProgram))
    }

    /// Sends the unit into its firmware loader, after which it understands nothing of this family any more. The user has accepted
    /// the risk.
    fn enter_loader(&mut self, _line: &mut Line<'_>) -> Result<(), ExchangeError> {
        Err(ExchangeError::impossible(CauseMessage::NoWayIntoLoader))
    }

    /// Sends one command of the family's protocol.
    fn transact(
        &mut self,
        line: &mut Line<'_>,
        command: u8,
        values: Vec<Value>,
    ) -> Result<Reply, ExchangeError>;

    /// Sends bytes as a person typed them, one command at a time, and gives what came back, whatever it was.
    fn raw(&mut self, _line: &mut Line<'_>, _bytes: &[u8]) -> Result<Vec<u8>, ExchangeError> {
        Err(ExchangeError::impossible(CauseMessage::BytesNotTaken))
    }

    /// Asks the firmware something in bytes, for an examination. Refused where the bytes could do more than was agreed to.
    fn inquire(&mut self, _line: &mut Line<'_>, _inquiry: &Inquiry<'_>) -> Result<Heard, ExchangeError> {
        Err(ExchangeError::impossible(CauseMessage::NotExamined))
    }

    /// Finds out anew what can be read from it, after what was known of its firmware was forgotten, or a program has begun on it.
    fn look_again(&mut self, _line: &mut Line<'_>) -> Result<(), ExchangeError> {
        Ok(())
    }

    /// Whether typed bytes can undo what [`Controller::check_arming`] found.
    fn raw_undermines_arming(&self, _bytes: &[u8]) -> bool {
        false
    }

    /// Speaks to another address from now on, since the unit has just been given it. `false` if the family has no such
    /// address.
    fn set_address(&mut self, _address: u8) -> bool {
        false
    }

    /// Whether a command can set a motor in motion.
    fn can_move(&self, command: u8) -> bool;

    /// Whether a command starts a script.
    fn starts_script(&self, _command: u8) -> bool {
        false
    }

    /// Whether a command can undo what [`Controller::check_arming`] found, so that it disarms.
    fn undermines_arming(&self, command: u8) -> bool;

    /// What bytes on the wire mean: a request alone, or what came after it.
    fn describe_traffic(&self, request: &[u8], reply: Option<&[u8]>) -> Described;
}

/// How the units of a family are found on a line, and stopped before they are.
pub trait Search: Send {
    /// Finds the units of a link. None found is a failure that says what came back.
    fn discover(
        &mut self,
        line: &mut Line<'_>,
        options: &DeviceOptions,
    ) -> Result<Vec<Box<dyn Controller>>, DiscoverError>;

    /// The same on a line that is rather another family's, which has answered nothing: by few and harmless questions.
    fn discover_gently(
        &mut self,
        line: &mut Line<'_>,
        options: &DeviceOptions,
    ) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
        self.discover(line, options)
    }

    /// The bytes that stop every unit that may be there, for a Stop before any was found; with [`Addresses::These`] those alone.
    fn stop_bytes(&self, addresses: Addresses) -> StopBytes;

    /// The bytes that stop all these units at once, where the family can address them all; else each is stopped by its own.
    fn stop_all_bytes(&self, _units: &[&Identity]) -> Option<StopBytes> {
        None
    }
}

/// Why no unit was found.
#[derive(Debug)]
pub enum DiscoverError {
    /// Nothing answered that could be understood.
    NothingThere(Failure),
    /// The search was broken into or the link was lost.
    Exchange(ExchangeError),
}

impl From<ExchangeError> for DiscoverError {
    fn from(error: ExchangeError) -> Self {
        Self::Exchange(error)
    }
}

/// The wire as a controller gets it for one act: what may go out, and what breaks in.
pub struct Line<'a> {
    exchange: &'a mut Exchange,
    guard: &'a Guard,
    permit: Permit,
    asked_at: Duration,
    retries: u32,
    stopping: bool,
    moved: Cell<bool>,
    progress: Option<&'a mut Progress<'a>>,
}

/// Takes how far a search is: done, of how many, what is looked for.
pub type Progress<'a> = dyn FnMut(usize, usize, &str) + 'a;

impl<'a> Line<'a> {
    /// A line for an act that was asked for at `asked_at`.
    pub fn new(exchange: &'a mut Exchange, guard: &'a Guard, permit: Permit, asked_at: Duration) -> Self {
        Self {
            exchange,
            guard,
            permit,
            asked_at,
            retries: RETRIES,
            stopping: false,
            moved: Cell::new(false),
            progress: None,
        }
    }

    /// A line for stopping: driving commands pass and do not count as motion. For duty zero alone.
    pub fn for_stopping(exchange: &'a mut Exchange, guard: &'a Guard, simulated: bool) -> Self {
        let permit = Permit { motion: true, guesses: simulated, ..Permit::default() };
        Self {
            exchange,
            guard,
            permit,
            asked_at: Duration::ZERO,
            retries: STOP_RETRIES,
            stopping: true,
            moved: Cell::new(false),
            progress: None,
        }
    }

    /// Tells `progress` how far a search is.
    #[must_use]
    pub fn with_progress(mut self, progress: &'a mut Progress<'a>) -> Self {
        self.progress = Some(progress);
        self
    }

    /// Tells whoever waits how far a search is.
    pub fn report_progress(&mut self, done: usize, of: usize, what: &str) {
        if let Some(progress) = &mut self.progress {
            progress(done, of, what);
        }
    }

    /// The exchange underneath.
    pub fn exchange(&mut self) -> &mut Exchange {
        self.exchange
    }

    /// Exchange and watch together, for requests that are not packets of a table.
    pub fn parts(&mut self) -> (&mut Exchange, &dyn Watch) {
        (self.exchange, self.guard)
    }

    /// What may go out.
    #[must_use]
    pub fn permit(&self) -> Permit {
        self.permit
    }

    /// How often a request is sent again.
    #[must_use]
    pub fn retries(&self) -> u32 {
        self.retries
    }

    /// Changes how often a request is sent again.
    pub fn set_retries(&mut self, retries: u32) {
        self.retries = retries;
    }

    /// Takes note that what is about to be written can set a motor in motion.
    pub fn motion_begins(&self) {
        if !self.stopping {
            self.guard.motion_begins(self.asked_at);
            self.moved.set(true);
        }
    }

    /// Whether this is a stop, which has no time for anything else.
    #[must_use]
    pub fn is_stopping(&self) -> bool {
        self.stopping
    }

    /// Whether anything that can set a motor in motion was about to be written over this line.
    #[must_use]
    pub fn has_moved(&self) -> bool {
        self.moved.get()
    }
}

/// A stop is worth more tries than other requests.
const STOP_RETRIES: u32 = 4;
