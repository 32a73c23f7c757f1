//! MeccCode: what is said of wrong programs, damaged programs, and bounds. What right ones do is tested on the simulated board.

mod bounds;
mod messages;
mod mutations;
mod watch;

use brushwork_script::board::Board;
use brushwork_script::mcl::ast::Motion;
use brushwork_script::mcl::registers::RegisterId;
use brushwork_script::vm::Host;
use std::time::Duration;

/// A board on which nothing is connected, where time passes when it is asked for.
#[derive(Debug, Default)]
struct Bare {
    now: Duration,
}

impl Host for Bare {
    fn now(&self) -> Duration {
        self.now
    }
    fn board(&mut self, _: Board, _: &[u32]) -> u32 {
        7
    }
    fn receive(&mut self) -> Vec<u8> {
        vec![1, 2, 3]
    }
    fn register(&mut self, _: RegisterId, _: u8) -> u32 {
        0
    }
    fn set_register(&mut self, _: RegisterId, _: u8, _: u32) {}
    fn put(&mut self, _: u32, _: u8) {}
    fn get(&mut self, _: u32) -> Option<u8> {
        None
    }
    fn motion(&mut self, _: Motion, _: &[i32]) {}
    fn read_eeprom(&mut self, _: u32) -> u8 {
        0
    }
    fn write_eeprom(&mut self, _: u32, _: u8) {}
    fn i2c_write(&mut self, _: &[u8], _: bool, _: Option<Duration>) -> bool {
        true
    }
    fn i2c_read(&mut self, _: usize, _: Option<Duration>) -> Option<Vec<u8>> {
        None
    }
}

/// The programs of the manual, as they are shipped.
const EXAMPLES: [&str; 5] = [
    include_str!("../../../../../assets/mecc/flash.mecc"),
    include_str!("../../../../../assets/mecc/limit_switch.mecc"),
    include_str!("../../../../../assets/mecc/motors.mecc"),
    include_str!("../../../../../assets/mecc/send_receive.mecc"),
    include_str!("../../../../../assets/mecc/wait_clock.mecc"),
];

/// A program for each code of an error or warning.
const WRONG: &str = include_str!("programs.txt");

/// Each with its code.
fn wrong() -> Vec<(&'static str, String)> {
    let sections =
        WRONG.split("== ").skip(1).map(|section| section.split_once('\n').unwrap_or((section, "")));
    sections
        .map(|(code, text)| {
            let text = text
                .replace("LONGNAME", &"n".repeat(1025))
                .replace("DEEP", &("(".repeat(101) + "1" + &")".repeat(101)))
                .replace("MANY\n", &"a = 1\n".repeat(103))
                .replace("WARNINGS\n", &"Loop\nEnd Loop\n".repeat(103));
            (code.trim(), text)
        })
        .collect()
}
