//! Whichever family is on a link: as the user says, or found out.

use super::controller::{Controller, DiscoverError, Line, Search};
use super::identity::Identity;
use super::options::{Addresses, DeviceOptions};
use super::stop::StopBytes;
use crate::failure::Failure;
use crate::family::{FamilyChoice, FamilyRef, families};
use crate::messages::{ActMessage, CauseMessage, RemedyMessage};
use brushwork_values::Message;

/// Whichever family the link turns out to have.
pub struct AnyFamily {
    searches: Vec<(FamilyRef, Box<dyn Search>)>,
    /// Which of them has found units, or was chosen.
    found: Option<usize>,
}

impl Search for AnyFamily {
    fn discover(
        &mut self,
        line: &mut Line<'_>,
        options: &DeviceOptions,
    ) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
        let candidates = self.candidates(options);
        self.found = match candidates[..] {
            [only] => Some(only),
            _ => None,
        };
        let mut nothing: Option<Failure> = None;
        for (turn, index) in candidates.iter().copied().enumerate() {
            let search = &mut self.searches[index].1;
            let found = match turn {
                0 => search.discover(line, options),
                _ => search.discover_gently(line, options),
            };
            match found {
                // The first says most of what came back.
                Err(DiscoverError::NothingThere(failure)) => {
                    nothing.get_or_insert(failure);
                }
                other => {
                    self.found = Some(index);
                    return other;
                }
            }
        }
        let nothing = nothing.unwrap_or_else(|| {
            let port = line.exchange().port();
            Failure::new(ActMessage::FindController, port, CauseMessage::NoFamily, Message::default())
        });
        Err(DiscoverError::NothingThere(self.with_the_others(nothing, &candidates)))
    }

    fn stop_bytes(&self, addresses: Addresses) -> StopBytes {
        let all = self.searches.iter().enumerate();
        let reported = all.filter(|(index, _)| self.found.is_none_or(|found| found == *index));
        reported
            .map(|(_, (_, search))| search.stop_bytes(addresses))
            .reduce(StopBytes::with)
            .unwrap_or_default()
    }

    fn stop_all_bytes(&self, units: &[&Identity]) -> Option<StopBytes> {
        self.searches.get(self.found?)?.1.stop_all_bytes(units)
    }
}

impl AnyFamily {
    /// The one that is chosen, whether the program lists it or not, or all that it has.
    pub fn new(choice: FamilyChoice) -> Self {
        let searches = match choice.family() {
            Some(chosen) => vec![(chosen, chosen.search())],
            None => families().iter().map(|family| (*family, family.search())).collect(),
        };
        Self { searches, found: None }
    }

    /// The families to look for, in turn: the one that is chosen, or those that have the addresses that are asked for. A number that no family has
    /// is left to the first to say so.
    fn candidates(&self, options: &DeviceOptions) -> Vec<usize> {
        let is_chosen = options.family.family().is_some();
        let fits = |family: FamilyRef| match options.addresses {
            _ if is_chosen => true,
            Addresses::Only(number) => family.has_address(number),
            Addresses::These(set) => set.iter().all(|number| family.has_address(number)),
            Addresses::Scan | Addresses::Factory => true,
        };
        let all = self.searches.iter().enumerate();
        let fitting: Vec<_> = all.filter(|(_, (family, _))| fits(*family)).map(|(index, _)| index).collect();
        if fitting.is_empty() && !self.searches.is_empty() { vec![0] } else { fitting }
    }

    /// The failure of the first family, with where the others may be found all the same.
    fn with_the_others(&self, nothing: Failure, candidates: &[usize]) -> Failure {
        let others = candidates.iter().skip(1).filter_map(|index| self.searches[*index].0.may_be_elsewhere());
        let remedy =
            others.fold(nothing.remedy, |remedy, other| RemedyMessage::OrElsewhere { remedy, other }.into());
        Failure { remedy, ..nothing }
    }
}
