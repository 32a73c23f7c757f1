//! A link in virtual time: the loop, its handle, the bus behind it, and the events so far.

use crate::tests::testing::unit::{Bus, SharedBus, Taken};
use crate::tests::testing::{ScriptedTransport, Wiretap};
use brushwork_link::clock::{Clock, VirtualClock};
use brushwork_link::device::DeviceHandle;
use brushwork_link::device::DeviceOptions;
use brushwork_link::device::Request;
use brushwork_link::device::StopReport;
use brushwork_link::device::{ArmScope, Drive, DriveCommand};
use brushwork_link::device::{DeviceLoop, Step};
use brushwork_link::device::{DisarmReason, Event};
use brushwork_link::transport::Stream;
use std::sync::{Arc, MutexGuard};
use std::time::Duration;

pub struct Link {
    pub clock: VirtualClock,
    pub device_loop: DeviceLoop,
    pub handle: Arc<DeviceHandle>,
    pub bus: SharedBus,
    pub tap: Wiretap,
    pub events: Vec<(Duration, Event)>,
    pub ended: bool,
    /// Whether the window renews motion, as one does that is alive.
    pub window_alive: bool,
}

impl Link {
    /// A link to the bus's usual unit over what is known to be USB, not yet stepped.
    pub fn new() -> Self {
        Self::with(Bus::shared(), DeviceOptions { stream: Some(Stream::Usb), ..DeviceOptions::default() })
    }

    pub fn with(bus: SharedBus, options: DeviceOptions) -> Self {
        let clock = VirtualClock::new();
        let far_end = bus.clone();
        let (transport, tap) =
            ScriptedTransport::new(&clock, move |bytes, now| far_end.lock().unwrap().take(bytes, now));
        brushwork_link::install(&[&crate::McpDriver]);
        let (device_loop, handle) = DeviceLoop::new(transport, Arc::new(clock.clone()), options);
        Self { bus, ..Self::over(clock, device_loop, handle, tap) }
    }

    /// A link to whatever is at the far end of `tap`.
    pub fn over(clock: VirtualClock, device_loop: DeviceLoop, handle: DeviceHandle, tap: Wiretap) -> Self {
        let (handle, bus) = (Arc::new(handle), Bus::shared());
        Self { clock, device_loop, handle, bus, tap, events: Vec::new(), ended: false, window_alive: true }
    }

    /// A link that is connected and quiet: nothing is read until asked.
    pub fn connected() -> Self {
        let mut link = Self::new();
        link.run_for(Duration::from_millis(500));
        link.forget();
        link
    }

    /// A link that is armed for the PWM screen.
    pub fn armed() -> Self {
        let mut link = Self::connected();
        link.ask(Request::Arm(ArmScope::Pwm));
        link.settle();
        assert!(link.has(|event| matches!(event, Event::Armed { .. })), "{:?}", link.events);
        link
    }

    /// Turns the loop for a time; a living window renews and takes its events all the while.
    pub fn run_for(&mut self, time: Duration) {
        self.run_until(self.clock.now() + time);
    }

    pub fn run_until(&mut self, end: Duration) {
        while self.clock.now() < end && !self.ended {
            self.turn(end);
        }
    }

    /// Turns the loop until it idles.
    pub fn settle(&mut self) {
        for _ in 0..10_000 {
            if self.step() != Step::Again {
                return;
            }
        }
        panic!("the loop never idles");
    }

    /// Turns the loop until it ends.
    pub fn settle_to_end(&mut self) {
        for _ in 0..10_000 {
            if self.step() == Step::Ended {
                return;
            }
        }
        panic!("the loop does not end");
    }

    /// One step, and the way to the next moment if there is nothing to do.
    pub fn turn(&mut self, end: Duration) {
        if let Step::IdleUntil(until) = self.step() {
            let renewal = self.clock.now() + Duration::from_millis(16);
            let hook = self.tap.next_hook().unwrap_or(end);
            let until = until.min(end).min(renewal).min(hook.max(self.clock.now()));
            self.clock.advance_to(until);
            self.tap.run_hooks(self.clock.now());
        }
    }

    pub fn step(&mut self) -> Step {
        if self.window_alive {
            self.handle.renew();
        }
        let step = self.device_loop.step();
        self.ended = step == Step::Ended;
        let now = self.clock.now();
        self.events.extend(self.handle.events().try_iter().map(|event| (now, event)));
        step
    }

    pub fn ask(&self, request: Request) {
        self.handle.request(request).unwrap();
    }

    pub fn drive(&self, duty: f64) {
        self.ask(Request::Drive(Drive::both(DriveCommand::duty(duty))));
    }

    pub fn bus(&self) -> MutexGuard<'_, Bus> {
        self.bus.lock().unwrap()
    }

    /// What the units took so far of a command.
    pub fn taken(&self, command: u8) -> Vec<Taken> {
        self.bus().taken.iter().filter(|taken| taken.command == command).cloned().collect()
    }

    pub fn has(&self, test: impl Fn(&Event) -> bool) -> bool {
        self.events.iter().any(|(_, event)| test(event))
    }

    /// When something was first told.
    pub fn when(&self, test: impl Fn(&Event) -> bool) -> Option<Duration> {
        self.events.iter().find(|(_, event)| test(event)).map(|(time, _)| *time)
    }

    pub fn disarm_reasons(&self) -> Vec<DisarmReason> {
        let reasons = self.events.iter().filter_map(|(_, event)| match event {
            Event::Disarmed(reason) => Some(reason.clone()),
            _ => None,
        });
        reasons.collect()
    }

    pub fn stops(&self) -> Vec<StopReport> {
        let stops = self.events.iter().filter_map(|(_, event)| match event {
            Event::Stopped(report) => Some(report.clone()),
            _ => None,
        });
        stops.collect()
    }

    /// Every sentence told: failures, refusals, the reason of a loss.
    pub fn sentences(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        for (_, event) in &self.events {
            match event {
                Event::Failure(failure) | Event::Lost(failure) => sentences.push(failure.to_string()),
                Event::ArmRefused { reasons, .. } => {
                    sentences.extend(reasons.iter().map(ToString::to_string));
                }
                Event::Transacted { result: Err(failure), .. } => sentences.push(failure.to_string()),
                _ => {}
            }
        }
        sentences
    }

    /// Forgets events and what the bus took.
    pub fn forget(&mut self) {
        self.events.clear();
        self.bus().taken.clear();
    }
}

/// Duty 0 on both motors at the highest acceleration: what command 54 of a stop carries.
pub const DUTY_ZERO: [i64; 4] = [0, 655_359, 0, 655_359];
