//! A device thread's loop on a simulated machine in virtual time, with a window that lives or is frozen.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use brushwork_canopen::adapter::Form;
use brushwork_canopen::bus::Monitor;
use brushwork_core::session::line::SimulatedLine;
use brushwork_family::Started;
use brushwork_link::device::{
    ArmScope, DeviceHandle, DeviceLoop, DeviceOptions, Drive, DriveCommand, Event, Job, JobEnding, JobTicket,
    Request, Step, StopReport,
};
use brushwork_link::{Clock, Transport, TransportError};
use brushwork_mcp_client::can::{BusTransport, CanOpen};
use brushwork_mcp_sim::controller::{Bus, UnitView};
use brushwork_plant::faults::{Fault, Faulty};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::pacing::{Paced, byte_time};
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;

use crate::virtual_line::VirtualLine;

type Line<M> = VirtualLine<Paced<Faulty<M>>>;
type Hook = Box<dyn FnOnce(&DeviceHandle) + Send>;
type Hooks = Arc<Mutex<Vec<(Duration, Hook)>>>;

/// How often a living window renews motion and takes its events.
const FRAME: Duration = Duration::from_millis(16);

/// The loop, its handle, the machine behind it, and the events so far.
pub struct VirtualLink<M: Machine = Bus> {
    /// The machine and the clock.
    pub line: Line<M>,
    /// The window's end.
    pub handle: Arc<DeviceHandle>,
    /// What was told, and when the window took it.
    pub events: Vec<(Duration, Event)>,
    /// Whether the window renews motion and takes its events.
    window_alive: Arc<AtomicBool>,
    /// Whether the loop has ended.
    pub ended: bool,
    device_loop: DeviceLoop,
    hooks: Hooks,
    frame_at: Duration,
    written: Written,
    timer: Arc<Mutex<Duration>>,
    byte_time: Option<Duration>,
}

/// What the loop has written, each write by itself.
type Written = Arc<Mutex<Vec<Vec<u8>>>>;

/// The line as the device thread gets it: reading stops at the window's frames and at hooks.
struct Watched<M: Machine> {
    line: Line<M>,
    hooks: Hooks,
    handle: Arc<Mutex<Option<Arc<DeviceHandle>>>>,
    window_alive: Arc<AtomicBool>,
    byte_time: Option<Duration>,
    written: Written,
    timer: Arc<Mutex<Duration>>,
}

impl VirtualLink {
    /// A loop on a stream of a bus; nothing has been sent. Bytes take no time on USB, and that of the stream's rate elsewhere.
    pub fn new(bus: Bus, stream: StreamIndex, options: DeviceOptions, faults: Vec<Fault>, seed: u64) -> Self {
        Self::made(bus, stream, faults, seed, |line, clock| DeviceLoop::new(line, clock, options))
    }

    /// A loop on the adapter of a CAN bus, whose frames it writes in `form`.
    pub fn on_can(bus: Bus, form: Form, options: DeviceOptions, faults: Vec<Fault>, seed: u64) -> Self {
        Self::made(bus, StreamIndex::Usb, faults, seed, |line, clock| {
            let monitor = Monitor::default();
            let line = BusTransport::new(line, Arc::clone(&clock), form, monitor.clone());
            DeviceLoop::for_family(Box::new(line), clock, options, Box::new(CanOpen::new(form, monitor)))
        })
    }

    /// Looks at the truth of a unit of the bus, which must have power.
    pub fn unit<T>(&self, index: usize, look: impl FnOnce(UnitView<'_>) -> T) -> T {
        self.bus(|bus| look(bus.controllers()[index].unit().expect("the unit has power")))
    }

    /// Moves waiting in a unit's buffers, as command 47 tells them.
    pub fn buffers(&self, index: usize) -> [u8; 2] {
        self.unit(index, |unit| Motor::BOTH.map(|motor| unit.channel(motor).buffer_length()))
    }
}

impl VirtualLink<SimulatedLine> {
    /// A loop on the simulated units of a family, at the stream that they are reached by.
    pub fn to_simulated(started: Started, options: DeviceOptions) -> Self {
        Self::over_stream(started, options, Vec::new())
    }

    /// The same behind a line with faults.
    pub fn over_stream(started: Started, options: DeviceOptions, faults: Vec<Fault>) -> Self {
        let bus = SimulatedLine::new(started.machine);
        Self::made(bus, started.index, faults, started.seed, |line, clock| {
            DeviceLoop::new(line, clock, options)
        })
    }
}

impl<M: Machine + 'static> VirtualLink<M> {
    /// A loop on any machine, whose bytes take the time of its rate.
    pub fn over(machine: M, options: DeviceOptions, faults: Vec<Fault>, seed: u64) -> Self {
        Self::made(machine, StreamIndex::Uart0, faults, seed, |line, clock| {
            DeviceLoop::new(line, clock, options)
        })
    }

    fn made(
        bus: M,
        stream: StreamIndex,
        faults: Vec<Fault>,
        seed: u64,
        open: impl FnOnce(Box<dyn Transport>, Arc<dyn Clock>) -> (DeviceLoop, DeviceHandle),
    ) -> Self {
        brushwork::install();
        let paced = stream != StreamIndex::Usb;
        let byte_time = paced.then(|| byte_time(bus.bits_per_second(stream)));
        let line = VirtualLine::new(Paced::new(Faulty::new(bus, faults, seed), paced), stream);
        Self::on(line, byte_time, open)
    }

    /// The program is gone in the midst of whatever it did, and another one opens the same line.
    #[must_use]
    pub fn killed_and_opened_again(self, options: DeviceOptions) -> Self {
        let (line, byte_time) = (self.line.clone(), self.byte_time);
        drop(self);
        line.pass(Duration::from_millis(500));
        Self::on(line, byte_time, |line, clock| DeviceLoop::new(line, clock, options))
    }

    fn on(
        line: Line<M>,
        byte_time: Option<Duration>,
        open: impl FnOnce(Box<dyn Transport>, Arc<dyn Clock>) -> (DeviceLoop, DeviceHandle),
    ) -> Self {
        let hooks = Hooks::default();
        let handle_for_hooks = Arc::new(Mutex::new(None));
        let window_alive = Arc::new(AtomicBool::new(true));
        let watched = Watched {
            line: line.clone(),
            hooks: Arc::clone(&hooks),
            handle: Arc::clone(&handle_for_hooks),
            window_alive: Arc::clone(&window_alive),
            byte_time,
            written: Written::default(),
            timer: Arc::default(),
        };
        let written = Arc::clone(&watched.written);
        let timer = Arc::clone(&watched.timer);
        let (device_loop, handle) = open(Box::new(watched), Arc::new(line.clock().clone()));
        let handle = Arc::new(handle);
        *lock(&handle_for_hooks) = Some(Arc::clone(&handle));
        let frame_at = line.clock().now();
        Self {
            line,
            handle,
            events: Vec::new(),
            window_alive,
            ended: false,
            device_loop,
            hooks,
            frame_at,
            written,
            timer,
            byte_time,
        }
    }

    /// Bytes are handed over at each turn of such a timer alone, as the adapters of serial ports do; at once where it is zero.
    pub fn set_timer(&self, timer: Duration) {
        *lock(&self.timer) = timer;
    }

    /// The window hangs: it renews nothing and takes nothing.
    pub fn freeze_window(&self) {
        self.window_alive.store(false, Ordering::SeqCst);
    }

    /// The window goes on.
    pub fn thaw_window(&self) {
        self.window_alive.store(true, Ordering::SeqCst);
        self.handle.renew();
    }

    /// Time now.
    pub fn now(&self) -> Duration {
        self.line.clock().now()
    }

    /// What the loop has written since this was asked last, each write by itself.
    pub fn take_written(&self) -> Vec<Vec<u8>> {
        std::mem::take(&mut *lock(&self.written))
    }

    /// Lets the loop and the machine run for a time.
    pub fn run_for(&mut self, time: Duration) {
        let end = self.now() + time;
        while self.now() < end && !self.ended {
            self.frame();
            match self.device_loop.step() {
                Step::Again => {}
                Step::IdleUntil(until) => self.pass(until.min(end).min(self.frame_at)),
                Step::Ended => self.ended = true,
            }
        }
        self.line.clock().advance_to(end);
        self.take_events();
    }

    /// The window is gone and nobody turns the loop any more: only the machine lives on.
    pub fn machine_alone_for(&mut self, time: Duration) {
        self.line.pass(time);
    }

    /// Does something at a time, even in the middle of an exchange.
    pub fn at(&self, time: Duration, act: impl FnOnce(&DeviceHandle) + Send + 'static) {
        lock(&self.hooks).push((time, Box::new(act)));
    }

    /// Asks something of the loop.
    pub fn ask(&self, request: Request) {
        self.handle.request(request).expect("the queue has room in these tests");
    }

    /// Asks for a job.
    pub fn start<T: Send + 'static>(&self, job: Job<T>) -> JobTicket<T> {
        self.handle.start(job).expect("the queue has room in these tests")
    }

    /// Runs a job to its end, with no other events left than those since its beginning; none when it does not end in this time.
    pub fn finish<T: Send + 'static>(&mut self, job: Job<T>, longest: Duration) -> Option<JobEnding<T>> {
        self.events.clear();
        let ticket = self.start(job);
        self.finish_begun(&ticket, longest)
    }

    /// Runs until a job has ended that was begun.
    pub fn finish_begun<T>(&mut self, ticket: &JobTicket<T>, longest: Duration) -> Option<JobEnding<T>> {
        let end = self.now() + longest;
        while self.now() < end && !self.ended {
            self.run_for(Duration::from_millis(10));
            let is_end = |event: &Event| matches!(event, Event::JobEnded(report) if report.id == ticket.id());
            let found = self.events.iter().position(|(_, event)| is_end(event));
            if let Some((_, Event::JobEnded(report))) = found.map(|at| self.events.remove(at)) {
                return Some(ticket.ending(report.ending));
            }
        }
        None
    }

    /// Arms and says whether it was allowed.
    pub fn arm(&mut self, scope: ArmScope) -> bool {
        self.events.clear();
        self.ask(Request::Arm(scope));
        self.run_for(Duration::from_millis(300));
        self.events.iter().any(|(_, event)| matches!(event, Event::Armed { .. }))
    }

    /// Drives both motors open loop.
    pub fn drive(&self, duty: f64) {
        self.ask(Request::Drive(Drive::both(DriveCommand::duty(duty))));
    }

    /// The reports of all stops so far.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn stops(&self) -> Vec<&StopReport> {
        let stops = self.events.iter().filter_map(|(_, event)| match event {
            Event::Stopped(report) => Some(report),
            _ => None,
        });
        stops.collect()
    }

    /// Does something with the simulated bus.
    pub fn bus<T>(&self, act: impl FnOnce(&mut M) -> T) -> T {
        self.line.with(|machine| act(machine.inner_mut().inner_mut()))
    }

    /// Does something to the world of a unit.
    pub fn apply(&self, index: usize, action: &WorldAction) {
        self.bus(|bus| Machine::apply(bus, index, action));
    }

    /// The bridge duties of a unit as they are.
    pub fn duties(&self, index: usize) -> [f64; 2] {
        self.bus(|bus| bus.views().swap_remove(index).axes.map(|axis| axis.output.duty()))
    }

    /// The bridge duties of a unit as they will be at a time, even if the loop is then in the middle of an exchange.
    pub fn duties_at(&self, time: Duration, index: usize) -> Arc<Mutex<Option<[f64; 2]>>> {
        let seen = Arc::new(Mutex::new(None));
        let (line, into) = (self.line.clone(), Arc::clone(&seen));
        self.at(time, move |_| {
            let look = |machine: &mut Paced<Faulty<M>>| machine.views().swap_remove(index);
            *lock(&into) = Some(line.with(look).axes.map(|axis| axis.output.duty()));
        });
        seen
    }

    /// The speeds of a unit's motor shafts, rad/s.
    pub fn speeds(&self, index: usize) -> [f64; 2] {
        self.bus(|bus| bus.views().swap_remove(index).axes.map(|axis| axis.truth.motor_radians_per_second))
    }

    /// Passes time while the loop idles; a hook on the way wakes it.
    fn pass(&self, until: Duration) {
        let hook = next_hook(&self.hooks).filter(|at| *at <= until);
        self.line.clock().advance_to(hook.unwrap_or(until));
        run_hooks(&self.hooks, &self.handle, self.now());
    }

    /// What a living window does with each frame.
    fn frame(&mut self) {
        let now = self.now();
        if now < self.frame_at {
            return;
        }
        self.frame_at = now + FRAME;
        if self.window_alive.load(Ordering::SeqCst) {
            self.handle.renew();
            self.take_events();
        }
    }

    fn take_events(&mut self) {
        let now = self.now();
        self.events.extend(self.handle.events().try_iter().map(|event| (now, event)));
    }
}

impl<M: Machine + 'static> Watched<M> {
    /// Reads what is there at the next turn of the adapter's timer, if that comes in time.
    fn read_at_turns(
        &mut self,
        buffer: &mut [u8],
        timer: Duration,
        until: Duration,
    ) -> Result<usize, TransportError> {
        let now = self.line.clock().now();
        let turns = now.as_nanos().div_ceil(timer.as_nanos());
        let mut turn = timer * u32::try_from(turns).unwrap_or(u32::MAX);
        while turn <= until {
            self.line.clock().advance_to(turn);
            let count = self.line.read_all(buffer)?;
            if count > 0 {
                return Ok(count);
            }
            turn += timer;
        }
        self.line.clock().advance_to(until);
        Ok(0)
    }
}

impl<M: Machine + 'static> Transport for Watched<M> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        lock(&self.written).push(bytes.to_vec());
        self.line.write(bytes)
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        let until = self.line.clock().now() + timeout;
        let stop_at = next_hook(&self.hooks).map_or(until, |at| at.min(until));
        let timer = *lock(&self.timer);
        let count = match timer {
            Duration::ZERO => self.line.read(buffer, stop_at.saturating_sub(self.line.clock().now()))?,
            timer => self.read_at_turns(buffer, timer, stop_at)?,
        };
        if let Some(handle) = lock(&self.handle).as_ref() {
            run_hooks(&self.hooks, handle, self.line.clock().now());
            // Frames go on while the loop waits for bytes, in a job for instance.
            if self.window_alive.load(Ordering::SeqCst) {
                handle.renew();
            }
        }
        Ok(count)
    }

    fn discard_input(&mut self) -> Result<usize, TransportError> {
        self.line.discard_input()
    }

    fn describe(&self) -> String {
        self.line.describe()
    }

    fn byte_time(&self) -> Option<Duration> {
        self.byte_time
    }
}

fn next_hook(hooks: &Hooks) -> Option<Duration> {
    lock(hooks).iter().map(|(at, _)| *at).min()
}

/// Runs what is due. The lock is free while a hook runs.
fn run_hooks(hooks: &Hooks, handle: &DeviceHandle, now: Duration) {
    loop {
        let mut waiting = lock(hooks);
        let Some(index) = waiting.iter().position(|(at, _)| *at <= now) else { return };
        let (_, hook) = waiting.remove(index);
        drop(waiting);
        hook(handle);
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
