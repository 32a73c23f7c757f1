//! Examining a unit: which questions a family has, in which steps they are asked, and what was found, for the unit's owner and for whoever
//! makes this program.

mod question;
mod report;
mod text;

pub use question::{Assumed, Need, NotAskable, Question, Standing, Step, not_asked};
pub use report::{
    Answer, CommandFound, Examination, ExaminationError, Line, RawWrite, SCHEMA, State, Unit, VERSION,
};

use brushwork_link::device::JobContext;
use brushwork_link::exchange::ExchangeError;
use brushwork_link::settings::is_final;
use brushwork_link::{Failure, FamilyRef, Identity};
use brushwork_values::Motor;
use std::sync::{PoisonError, RwLock};

/// What examines the units of a family.
pub trait Examiner: Send + Sync {
    /// The family.
    fn family(&self) -> FamilyRef;

    /// What is asked, the reading first.
    fn steps(&self) -> &'static [Step];

    /// What is not.
    fn not_askable(&self) -> Vec<NotAskable>;

    /// Takes a step and enters what was found.
    ///
    /// # Errors
    /// The unit cannot be asked: the link is lost or something broke in. What a unit does not answer is no error.
    fn ask(
        &self,
        step: &Step,
        motor: Motor,
        context: &mut JobContext<'_>,
        found: &mut Examination,
    ) -> Result<(), Failure>;
}

static EXAMINERS: RwLock<Vec<&'static dyn Examiner>> = RwLock::new(Vec::new());

/// Names the families that can be examined.
pub fn install(examiners: &[&'static dyn Examiner]) {
    let mut known = EXAMINERS.write().unwrap_or_else(PoisonError::into_inner);
    for examiner in examiners {
        if !known.iter().any(|known| known.family() == examiner.family()) {
            known.push(*examiner);
        }
    }
}

/// What examines a unit; `None` where its family has no questions.
#[must_use]
pub fn examiner(family: FamilyRef) -> Option<&'static dyn Examiner> {
    let known = EXAMINERS.read().unwrap_or_else(PoisonError::into_inner);
    known.iter().find(|examiner| examiner.family() == family).copied()
}

/// An examination of a unit of which nothing was asked yet.
#[must_use]
pub fn begun(examiner: &dyn Examiner, identity: &Identity) -> Examination {
    let mut examination = Examination::of(identity);
    for step in examiner.steps() {
        let open = step.questions.iter().map(|question| Answer::open(step, question));
        examination.answers.extend(open);
    }
    let not_askable = examiner.not_askable().into_iter();
    examination.not_askable = not_askable
        .map(|row| report::Unasked { what: row.what.to_owned(), why: row.why.to_owned() })
        .collect();
    examination
}

/// What an exchange of an examination gave; nothing where the unit does not answer it.
///
/// # Errors
/// What ends the examination: the link is lost, or something more urgent came.
pub fn if_answered<T>(result: Result<T, ExchangeError>) -> Result<Option<T>, ExchangeError> {
    match result {
        Ok(value) => Ok(Some(value)),
        Err(error) if is_final(&error) => Err(error),
        Err(_) => Ok(None),
    }
}
