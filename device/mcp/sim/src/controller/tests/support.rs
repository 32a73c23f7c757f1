//! A client in virtual time: asks, waits for the reply, and takes it apart with the client's side of the codec.

use crate::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_wire::packet_serial::name::Name;
use brushwork_mcp_wire::packet_serial::{
    Address, Generation, Read, ReplyProgress, Request, Typed, commands, lookup, parse_reply,
};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::ScriptRun;
use brushwork_plant::world::WorldAction;
use brushwork_script::mcl;
use brushwork_script::program::Program;
use brushwork_values::Values;
use std::time::Duration;

/// A controller on a wire and whoever talks to it.
pub struct Bench {
    pub bus: Bus,
    pub generation: Generation,
    pub address: Address,
}

/// How long a client waits for a reply.
const TIMEOUT: Duration = Duration::from_millis(100);

impl Bench {
    /// The default controller in that generation, on USB.
    pub fn new(generation: Generation) -> Self {
        Self::of(ControllerConfig { generation, ..ControllerConfig::default() })
    }

    /// A controller on USB.
    pub fn of(config: ControllerConfig) -> Self {
        Self::on(config, StreamIndex::Usb)
    }

    /// A controller on some stream.
    pub fn on(config: ControllerConfig, stream: StreamIndex) -> Self {
        let (generation, address) = (config.generation, config.address);
        let unit = Controller::new(config).expect("the preset is valid");
        Self { bus: Bus::single(unit, stream), generation, address }
    }

    /// The controller.
    pub fn unit(&self) -> &Controller {
        &self.bus.controllers()[0]
    }

    /// Sends raw bytes and gives back the first reply.
    pub fn raw(&mut self, bytes: &[u8]) -> Vec<u8> {
        self.bus.exchange(bytes, TIMEOUT)
    }

    /// Sends a request with numbers and gives back the values of its reply, `None` where there was silence.
    pub fn try_ask(&mut self, command: u8, args: &[i64]) -> Option<Values> {
        self.try_send(&Request::new(self.address, command, args))
    }

    /// The same with any values.
    pub fn try_send(&mut self, request: &Request) -> Option<Values> {
        let bytes = request.encode(self.generation).expect("a request of this generation");
        let reply = self.raw(&bytes);
        if reply.is_empty() {
            return None;
        }
        match parse_reply(request, self.generation, &reply) {
            ReplyProgress::Done { values, used } => {
                assert_eq!(used, reply.len(), "one write is one reply");
                Some(values)
            }
            other => {
                panic!("{} answered {reply:02x?}: {other:?}", lookup(request.command).expect("known").key)
            }
        }
    }

    /// Sends a request that is answered.
    pub fn ask<const L: u8>(&mut self, command: Typed<L>, args: &[i64]) -> Read<L> {
        command.reply(self.ask_row(command.number(), args)).expect("it is its reply")
    }

    /// The same with whatever command.
    pub fn ask_row(&mut self, command: u8, args: &[i64]) -> Values {
        let answer = self.try_ask(command, args);
        answer.unwrap_or_else(|| panic!("command {command} was not answered"))
    }

    /// The first number of this name in the reply to a read without arguments.
    pub fn read<const L: u8>(&mut self, command: Typed<L>, name: impl Name) -> i64 {
        self.ask(command, &[]).try_int(name).expect("this generation returns it")
    }

    /// Lets time pass.
    pub fn wait(&mut self, time: Duration) {
        self.bus.advance(self.bus.now() + time);
    }

    /// Lets time pass, a status request every 100 ms keeping the port active.
    pub fn wait_talking(&mut self, time: Duration) {
        let end = self.bus.now() + time;
        while self.bus.now() < end {
            self.ask(commands::READ_STATUS, &[]);
            self.bus.advance((self.bus.now() + Duration::from_millis(100)).min(end));
        }
    }

    /// Stores a script, as if it had been downloaded.
    pub fn install(&mut self, text: &str) {
        let image = brushwork_script::image::encode(&compiled(text));
        self.bus.controllers_mut()[0].install_script(&image);
    }

    /// Stores a script and starts it with command 248.
    pub fn start(&mut self, text: &str) {
        self.install(text);
        self.ask(commands::START_SCRIPT, &[]);
    }

    /// What the script has said on a stream since it was asked last.
    pub fn said(&mut self, stream: StreamIndex) -> String {
        let writes = std::iter::from_fn(|| self.bus.take_output(stream));
        writes.flatten().map(char::from).collect()
    }

    /// How far the script is.
    pub fn script(&self) -> ScriptRun {
        self.unit().unit().expect("it has power").script_view().run
    }

    /// Does something to the machine.
    pub fn apply(&mut self, action: &WorldAction) {
        self.bus.controllers_mut()[0].apply(action).expect("a known key");
    }
}

/// A program that has to compile.
pub fn compiled(text: &str) -> Program {
    let compiled = mcl::compile(text);
    let problems: Vec<String> = compiled.diagnostics.iter().map(|problem| problem.message.clone()).collect();
    compiled.program.unwrap_or_else(|| panic!("{problems:?} in\n{text}"))
}
