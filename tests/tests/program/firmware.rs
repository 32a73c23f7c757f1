//! Firmware updates against the simulated controller in virtual time: done whole, and broken at every page by a lost byte, a pulled
//! cable and a power failure.

use std::time::Duration;

use brushwork_link::device::RiskAccepted;
use brushwork_link::device::{DeviceOptions, Event, Request};
use brushwork_link::{Clock as _, Stream, Transport, TransportError};
use brushwork_mcp_client::firmware::{Left, Progress, SendError, Sent, send};
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig, ERASE_TIME, Flash};
use brushwork_mcp_wire::loader::{Image, PAGE_BYTES, SimulatedImage};
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::{Address, Generation, number};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::WorldAction;
use brushwork_tests::virtual_line::VirtualLine;
use brushwork_tests::virtual_link::VirtualLink;

type Line = VirtualLine<Bus>;

/// Pages of the smallest published image, which a RoboClaw takes.
const PAGES: usize = 128;
/// Command 255 with its marks and CRC, to 0x80.
const ENTER: [u8; 9] = [0x80, 0xFF, 0xFF, 0xA5, 0xA5, 0x12, 0x34, 0xB6, 0x70];

fn bus(model: &str) -> Bus {
    let model = models::lookup(model).expect("the model is listed");
    Bus::single(Controller::new(ControllerConfig::of(model)).expect("the preset is valid"), StreamIndex::Usb)
}

fn image(model: &str) -> Image {
    let model = models::lookup(model).expect("the model is listed");
    let made = SimulatedImage { model, version: "9.8.7".to_owned(), generation: Generation::Gen3 };
    Image::new(made.bytes().expect("a version"), model.family).expect("an image")
}

/// A RoboClaw that has just been sent into its loader.
fn in_loader() -> Line {
    let line = VirtualLine::new(bus("roboclaw-2x7a"), StreamIndex::Usb);
    let mut client = line.clone();
    client.write(&ENTER).expect("it is plugged in");
    let mut ack = [0; 8];
    assert_eq!(client.read(&mut ack, Duration::from_millis(50)).expect("it is plugged in"), 1);
    assert_eq!(ack[0], 0xFF);
    line
}

fn transfer(line: &Line, image: &Image, mut on: impl FnMut(Progress)) -> Result<Sent, SendError> {
    let clock = line.clock().clone();
    send(&mut line.clone(), &clock, image, &mut |progress| {
        on(progress);
        true
    })
}

fn set_power(line: &Line, on: bool) {
    line.with(|bus| bus.controllers_mut()[0].apply(&WorldAction::Power { on }).expect("no setting is named"));
}

fn cycle_power(line: &Line) {
    set_power(line, false);
    line.pass(Duration::from_millis(100));
    set_power(line, true);
    line.pass(Duration::from_millis(600));
}

fn version(line: &Line) -> Option<String> {
    line.with(|bus| Some(bus.controllers()[0].unit()?.version_text()))
}

fn is_in_loader(line: &Line) -> bool {
    line.with(|bus| bus.controllers()[0].unit().is_some_and(|unit| unit.is_in_loader()))
}

fn holds(line: &Line, image: &Image) -> bool {
    line.with(|bus| *bus.controllers()[0].flash() == Flash::Image(image.bytes().to_vec()))
}

/// The update begun anew goes through, byte for byte, and the new firmware answers.
fn resumes(line: &Line, image: &Image, what: &str) {
    assert!(is_in_loader(line), "{what}: it waits in its loader");
    transfer(line, image, |_| ()).unwrap_or_else(|error| panic!("{what}: {error}"));
    assert!(holds(line, image), "{what}: the image is not what was sent");
    line.pass(Duration::from_millis(600));
    assert!(version(line).expect("it runs").ends_with("v9.8.7"), "{what}");
}

#[test]
fn an_update_stops_the_motors_enters_the_loader_and_brings_the_new_firmware() {
    let options = DeviceOptions { stream: Some(Stream::Usb), simulated: true, ..DeviceOptions::default() };
    let mut link = VirtualLink::new(bus("mcp266"), StreamIndex::Usb, options, Vec::new(), 1);
    link.run_for(Duration::from_secs(2));
    assert!(link.arm(brushwork_link::device::ArmScope::Pwm));
    link.drive(0.5);
    link.run_for(Duration::from_millis(500));
    assert!(link.duties(0)[0].abs() > 0.4, "it drives before the update");
    link.ask(Request::EnterLoader(RiskAccepted::by_the_user()));
    link.run_for(Duration::from_millis(300));
    let position =
        |wanted: fn(&Event) -> bool| link.events.iter().position(|(_, event)| wanted(event)).unwrap();
    let stopped = position(|event| matches!(event, Event::Stopped(report) if report.confirmed()));
    let entered = position(|event| matches!(event, Event::LoaderEntered));
    assert!(stopped < entered, "motors are stopped, with confirmation, before the loader is entered");
    assert!(link.ended && matches!(link.events.last(), Some((_, Event::Closed))));
    assert_eq!(link.duties(0), [0.0, 0.0]);

    let image = image("mcp266");
    let clock = link.line.clock().clone();
    let mut seen = Vec::new();
    let sent = send(&mut link.line.clone(), &clock, &image, &mut |progress| {
        seen.push(progress);
        true
    });
    assert_eq!(sent.unwrap().pages, 3840);
    assert_eq!(seen.first(), Some(&Progress::Greeting));
    assert_eq!(seen.last(), Some(&Progress::Writing { pages: 3840, of: 3840 }));
    assert!(seen.contains(&Progress::Erasing) && seen.contains(&Progress::Writing { pages: 1919, of: 3840 }));
    clock.advance(Duration::from_secs(1));
    assert_eq!(link.unit(0, |unit| unit.version_text()), "MCP266 2x60A v9.8.7");
    assert!(link.bus(|bus| *bus.controllers()[0].flash() == Flash::Image(image.bytes().to_vec())));
    // The generation is the image's, so that status is 32 bits wide from now on: addr, 90, four bytes, CRC.
    let mut wire = link.line.wire(Address::DEFAULT, Generation::Gen3, true);
    use brushwork_link::Wire as _;
    assert!(wire.transact(number::READ_STATUS, &[]).is_ok());
}

#[test]
fn no_other_request_enters_the_loader() {
    let options = DeviceOptions { stream: Some(Stream::Usb), simulated: true, ..DeviceOptions::default() };
    let mut link = VirtualLink::new(bus("mcp266"), StreamIndex::Usb, options, Vec::new(), 1);
    link.run_for(Duration::from_secs(2));
    link.ask(Request::Transact { id: 7, command: number::ENTER_LOADER, values: Vec::new() });
    link.run_for(Duration::from_millis(300));
    let refused = link.events.iter().any(|(_, event)| match event {
        Event::Transacted { id: 7, result: Err(failure) } => {
            failure.came_back.to_string().contains("risk was accepted")
        }
        _ => false,
    });
    assert!(refused, "{:?}", link.events.last());
    assert!(!link.unit(0, |unit| unit.is_in_loader()));
}

#[test]
fn cancelled_before_the_greeting_nothing_is_erased_and_a_restart_brings_the_old_firmware_back() {
    let line = in_loader();
    let clock = line.clock().clone();
    let error = send(&mut line.clone(), &clock, &image("roboclaw-2x7a"), &mut |_| false).unwrap_err();
    assert!(matches!(error, SendError::Cancelled), "{error}");
    assert_eq!(error.left(), Left::Untouched);
    cycle_power(&line);
    assert!(!is_in_loader(&line));
    assert!(version(&line).unwrap().contains("v4.2.8"));
}

#[test]
fn power_lost_at_any_page_leaves_the_unit_in_its_loader_where_the_update_resumes() {
    let image = image("roboclaw-2x7a");
    for page in 0..PAGES {
        let line = in_loader();
        let error = transfer(&line, &image, |progress| {
            if progress == (Progress::Writing { pages: page, of: PAGES }) {
                set_power(&line, false);
            }
        });
        let error = error.unwrap_err();
        // The page whose bytes went out before the power failed may have been written; its answer never came.
        assert!(matches!(error, SendError::PageLost { page: lost, .. } if lost == page), "{page}: {error}");
        assert_eq!(error.left(), Left::WithoutFirmware);
        cycle_power(&line);
        if page + 1 < PAGES {
            resumes(&line, &image, &format!("power lost at page {page}"));
        } else {
            assert!(holds(&line, &image) || is_in_loader(&line), "after the last page either is right");
        }
    }
}

#[test]
fn power_lost_in_the_erase_kills_the_unit_as_the_risk_text_says() {
    let image = image("roboclaw-2x7a");
    for share in 0..10 {
        let line = in_loader();
        // The greeting alone, then the power fails at some moment of the erase.
        line.clone().write(&[0x01]).unwrap();
        line.pass(ERASE_TIME * share / 10);
        cycle_power(&line);
        let again = transfer(&line, &image, |_| ());
        assert!(matches!(again, Err(SendError::NoGreeting { .. })), "{share}: {again:?}");
        assert_eq!(line.with(|bus| bus.controllers()[0].flash().clone()), Flash::Dead);
        assert_eq!(version(&line), None, "nothing runs, with power or without");
    }
    let reported = brushwork_mcp_client::firmware::risks(false).join(" ");
    assert!(reported.contains("dead for good") && reported.contains("no recovery"), "{reported}");
}

#[test]
fn the_cable_pulled_at_any_page_leaves_the_unit_in_its_loader_where_the_update_resumes() {
    let image = image("roboclaw-2x7a");
    for page in 0..PAGES {
        let line = in_loader();
        let unplug = |unplugged| {
            line.with(|bus| bus.controllers_mut()[0].apply(&WorldAction::Unplug { unplugged }).unwrap());
        };
        let error = transfer(&line, &image, |progress| {
            if progress == (Progress::Writing { pages: page, of: PAGES }) {
                unplug(true);
            }
        });
        let error = error.unwrap_err();
        assert!(matches!(error, SendError::Line { left: Left::WithoutFirmware, .. }), "{page}: {error}");
        unplug(false);
        cycle_power(&line);
        if page + 1 < PAGES {
            resumes(&line, &image, &format!("unplugged at page {page}"));
        }
    }
}

/// A line that loses one byte on its way to the controller, or one answer.
struct Lossy {
    line: Line,
    /// Which write loses its byte, counted from 0 with the greeting.
    write: usize,
    /// Which byte of it; behind its end the answer is lost instead.
    byte: usize,
    writes: usize,
}

impl Transport for Lossy {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let loses = self.writes == self.write;
        self.writes += 1;
        let mut bytes = bytes.to_vec();
        if loses && self.byte < bytes.len() {
            bytes.remove(self.byte);
        }
        self.line.write(&bytes)
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        let count = self.line.read(buffer, timeout)?;
        let loses = self.writes == self.write + 1 && self.byte >= PAGE_BYTES;
        Ok(if loses { 0 } else { count })
    }

    fn discard_input(&mut self) -> Result<usize, TransportError> {
        self.line.discard_input()
    }

    fn describe(&self) -> String {
        self.line.describe()
    }

    fn byte_time(&self) -> Option<Duration> {
        None
    }
}

#[test]
fn a_byte_or_an_answer_lost_at_any_page_breaks_the_transfer_and_nothing_is_sent_twice() {
    let image = image("roboclaw-2x7a");
    for page in 0..PAGES {
        // A byte of the page, another one each time, or the answer to it.
        for byte in [(page * 37) % PAGE_BYTES, PAGE_BYTES] {
            let line = in_loader();
            let mut lossy = Lossy { line: line.clone(), write: page + 1, byte, writes: 0 };
            let clock = line.clock().clone();
            let error = send(&mut lossy, &clock, &image, &mut |_| true).unwrap_err();
            assert!(
                matches!(error, SendError::PageLost { page: lost, .. } if lost == page),
                "{page}: {error}"
            );
            assert_eq!(lossy.writes, page + 2, "the greeting and each page once, and no more after the loss");
            cycle_power(&line);
            if page + 1 < PAGES || byte < PAGE_BYTES {
                resumes(&line, &image, &format!("byte {byte} lost at page {page}"));
            } else {
                assert!(holds(&line, &image), "the last page was there; only its answer was lost");
            }
        }
    }
}

#[test]
fn a_greeting_that_is_lost_is_not_sent_again() {
    let line = in_loader();
    let mut lossy = Lossy { line: line.clone(), write: 0, byte: 0, writes: 0 };
    let clock = line.clock().clone();
    let begun_at = clock.now();
    let error = send(&mut lossy, &clock, &image("roboclaw-2x7a"), &mut |_| true).unwrap_err();
    assert!(matches!(error, SendError::NoGreeting { .. }), "{error}");
    assert_eq!(lossy.writes, 1);
    assert!(clock.now() - begun_at < Duration::from_secs(11));
    let sentence = error.failure("the simulated controller").to_string();
    assert!(sentence.contains("leave its power on for a minute"), "{sentence}");
}

#[test]
fn without_power_or_firmware_the_loader_keeps_the_motors_still_and_the_leds_turning() {
    let line = in_loader();
    line.clone().write(&[0x01]).unwrap();
    line.pass(ERASE_TIME + Duration::from_secs(1));
    cycle_power(&line);
    let leds = |line: &Line| line.with(|bus| bus.controllers()[0].unit().unwrap().leds());
    let first = leds(&line);
    line.pass(Duration::from_millis(250));
    let second = leds(&line);
    assert!(first.stat1 != first.stat2 && second.stat1 == first.stat2, "{first:?} {second:?}");
    // Packets move nothing: 0x80, command 32, duty 0x4000, CRC.
    let duty = brushwork_mcp_wire::packet_serial::Request::new(Address::DEFAULT, number::DUTY_M1, &[0x4000]);
    line.clone().write(&duty.encode(Generation::Gen1).unwrap()).unwrap();
    line.pass(Duration::from_millis(200));
    let view = line.with(|bus| bus.views().remove(0));
    assert_eq!(view.axes[0].output.duty(), 0.0);
}
