//! Whether motion may be allowed: what holds a move within bounds, and a motor that is off.
//!
//! MN drives a motor that is off to the target that it had: arming sets the target to where the motor stands first (AB), and switches it
//! on only where the unit says that it took that.

use crate::controller::unit::SuprMotr;
use crate::messages::{
    SuprMotrActMessage, SuprMotrCauseMessage, SuprMotrDriverMessage, SuprMotrRemedyMessage,
};
use brushwork_link::Message;
use brushwork_link::device::controller::{ArmCheck, Line};
use brushwork_link::exchange::ExchangeError;
use brushwork_link::failure::Failure;
use brushwork_suprmotr_wire::{
    Command, Line as Commands, Mnemonic, Single, inputs, limits, motion, operation,
};

/// A target this near to the motor is where it stands: the motor may be turned a little in between.
const HERE_COUNTS: i32 = 20;
/// A lag that is told when the motor stands.
const LAG_COUNTS: i32 = 500;

/// Reads what matters, and lists what speaks against it. Nothing is changed unless nothing does.
pub fn check(unit: &mut SuprMotr, line: &mut Line<'_>) -> Result<ArmCheck, ExchangeError> {
    let on = unit.name(line);
    let (status, _) = unit.speaker.status(line)?;
    let mut objections = Vec::new();
    if status.operation & (operation::MACRO | operation::WAIT) != 0 {
        let name = "arming";
        objections.push((SuprMotrCauseMessage::MacroRuns { name }, SuprMotrRemedyMessage::StopFirst));
    }
    let mut warnings: Vec<Message> = Vec::new();
    if objections.is_empty() && !status.is_motor_on() {
        match switch_on(unit, line)? {
            SwitchedOn::Here => warnings.push(SuprMotrDriverMessage::MotorSwitchedOn.into()),
            SwitchedOn::WouldJump(counts) => objections
                .push((SuprMotrCauseMessage::JumpsToTarget { counts }, SuprMotrRemedyMessage::SetTarget)),
        }
    }
    if objections.is_empty() {
        let (after, _) = unit.speaker.status(line)?;
        if after.motion & motion::EXCESSIVE_ERROR != 0 {
            objections.push((SuprMotrCauseMessage::Lagged, SuprMotrRemedyMessage::FreeTheAxis));
        }
        let (report, _) = unit.speaker.ask_single(line, Single::FollowingError)?;
        let lag = report.number(Mnemonic::TF).unwrap_or_default();
        if lag.unsigned_abs() > LAG_COUNTS.unsigned_abs() {
            warnings.push(SuprMotrDriverMessage::Lags { counts: lag }.into());
        }
    }
    warnings.push(SuprMotrDriverMessage::NoTimeout.into());
    if status.limits & limits::ENABLED == 0 {
        warnings.push(SuprMotrDriverMessage::NoLimits.into());
    } else {
        warnings.push(SuprMotrDriverMessage::Fence.into());
        if status.inputs & inputs::NEGATIVE != 0 {
            warnings.push(SuprMotrDriverMessage::AtNegativeLimit.into());
        }
        if status.inputs & inputs::POSITIVE != 0 {
            warnings.push(SuprMotrDriverMessage::AtPositiveLimit.into());
        }
    }
    let reasons = objections
        .into_iter()
        .map(|(came_back, remedy)| Failure::new(SuprMotrActMessage::Arm, on.as_str(), came_back, remedy))
        .collect::<Vec<_>>();
    if !reasons.is_empty() {
        warnings.clear();
    }
    Ok(ArmCheck { reasons, controller_timeout: None, warnings })
}

enum SwitchedOn {
    Here,
    WouldJump(i32),
}

/// Sets the target of a motor that is off to where it stands, and switches it on.
fn switch_on(unit: &mut SuprMotr, line: &mut Line<'_>) -> Result<SwitchedOn, ExchangeError> {
    unit.speaker.order(line, &Commands::of(Command::with(Mnemonic::AB, 0)))?;
    let mut counts = |mnemonic| -> Result<i32, ExchangeError> {
        let (report, _) = unit.speaker.ask(line, &Command::plain(mnemonic))?;
        Ok(report.number(mnemonic).unwrap_or_default())
    };
    let away = counts(Mnemonic::TT)?.saturating_sub(counts(Mnemonic::TP)?);
    if away.saturating_abs() > HERE_COUNTS {
        return Ok(SwitchedOn::WouldJump(away));
    }
    unit.speaker.order(line, &Commands::of(Command::plain(Mnemonic::MN)))?;
    unit.switched_off = false;
    Ok(SwitchedOn::Here)
}
