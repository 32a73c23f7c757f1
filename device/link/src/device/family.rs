//! Whichever protocol family is on a link: as the user says, or found out.

use super::controller::{Controller, DiscoverError, Family, Line};
use super::family_choice::FamilyChoice;
use super::identity::Identity;
use super::mcp::PacketSerial;
use super::motion_mind::MotionMinds;
use super::options::{Addresses, DeviceOptions};
use super::stop::StopBytes;
use crate::failure::Failure;
use brushwork_mcp_wire::packet_serial::Address;

/// Whichever family the link turns out to have.
#[derive(Debug, Default)]
pub struct AnyFamily {
    found: Option<Found>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Found {
    Packets,
    MotionMinds,
}

impl Family for AnyFamily {
    fn discover(
        &mut self,
        line: &mut Line<'_>,
        options: &DeviceOptions,
    ) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
        let packets = match (options.family, options.addresses) {
            (FamilyChoice::PacketSerial, _) => true,
            (FamilyChoice::MotionMind, _) => false,
            // No number is an address of both families.
            (FamilyChoice::Auto, Addresses::Only(number)) => is_packet_address(number),
            (FamilyChoice::Auto, Addresses::These(set)) => set.iter().all(is_packet_address),
            (FamilyChoice::Auto, Addresses::Scan | Addresses::Factory) => {
                return self.find_out(line, options);
            }
        };
        self.found = Some(if packets { Found::Packets } else { Found::MotionMinds });
        if packets {
            PacketSerial.discover(line, options)
        } else {
            MotionMinds::new().discover(line, options)
        }
    }

    fn stop_bytes(&self, addresses: Addresses) -> StopBytes {
        let packets = || PacketSerial.stop_bytes(addresses);
        let motion_minds = || MotionMinds::new().stop_bytes(addresses);
        match self.found {
            Some(Found::Packets) => packets(),
            Some(Found::MotionMinds) => motion_minds(),
            None => packets().with(motion_minds()),
        }
    }

    fn stop_all_bytes(&self, units: &[&Identity]) -> Option<StopBytes> {
        match self.found {
            Some(Found::MotionMinds) => MotionMinds::new().stop_all_bytes(units),
            _ => None,
        }
    }
}

impl AnyFamily {
    /// MCP and RoboClaw first; where nothing of packet serial comes back, a Motion Mind at its factory address in both protocols. All 98
    /// addresses are asked of a bus that is known to have one: of a silent port that would take seconds for nothing.
    fn find_out(
        &mut self,
        line: &mut Line<'_>,
        options: &DeviceOptions,
    ) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
        let nothing = match PacketSerial.discover(line, options) {
            Err(DiscoverError::NothingThere(nothing)) => nothing,
            other => {
                self.found = Some(Found::Packets);
                return other;
            }
        };
        let mut found = MotionMinds::new().at_the_factory_address(line, options);
        if found.is_ok() && options.addresses == Addresses::Scan {
            found = MotionMinds::new().discover(line, options);
        }
        match found {
            Ok(units) => {
                self.found = Some(Found::MotionMinds);
                Ok(units)
            }
            Err(DiscoverError::NothingThere(_)) => Err(DiscoverError::NothingThere(neither(nothing))),
            Err(error) => Err(error),
        }
    }
}

/// Whether a number that is asked for without a family is one of packet serial.
fn is_packet_address(number: u8) -> bool {
    Address::new(number).is_some() || number > 98
}

/// The failure of packet serial, with what else was tried.
fn neither(nothing: Failure) -> Failure {
    let mend = format!(
        "{}. For a Motion Mind at another address than 1 choose its family (family=motion-mind), so that all are asked",
        nothing.mend
    );
    Failure { mend, ..nothing }
}
