//! How scripts start, stop, end, fail and come back after a power cycle.

use super::super::support::Bench;
use super::{ms, running, start_bytes};
use brushwork_mcp_wire::packet_serial::{Generation, Request, commands, name, number};
use brushwork_mcp_wire::script_image;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::{Content, ScriptRun};
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_script::debug::Wanted;
use brushwork_values::Value;
use std::time::Duration;

/// DIN4, which shares its line with no port.
const PIN: usize = 3;

const COUNTER: &str = "count var word\nmain\ncount = count+1\nputs 0,[dec count,13]\npause 10\ngoto main\n";

#[test]
fn start_and_stop_are_commands_248_and_249_and_a_start_begins_anew() {
    let mut bench = running(COUNTER);
    bench.wait(ms(25));
    assert_eq!(bench.said(StreamIndex::Usb), "1\r2\r3\r");
    bench.apply(&WorldAction::SetRts { on: true });
    bench.ask(commands::STOP_SCRIPT, &[]);
    assert!(matches!(bench.script(), ScriptRun::Stopped { line: 3..=6 }));
    bench.apply(&WorldAction::SetRts { on: false });
    bench.wait(ms(50));
    assert_eq!(bench.said(StreamIndex::Usb), "");
    bench.apply(&WorldAction::SetRts { on: true });
    bench.ask(commands::START_SCRIPT, &[]);
    bench.ask(commands::START_SCRIPT, &[]);
    bench.apply(&WorldAction::SetRts { on: false });
    bench.wait(ms(15));
    let said = bench.said(StreamIndex::Usb);
    assert!(said.ends_with("2\r"), "it began again: {said:?}");
}

#[test]
fn a_script_that_pauses_is_told_on_the_line_of_its_pause() {
    let mut bench = running("main\nputs 0,[dec 1,13]\npause 1000\ngoto main\n");
    bench.wait(ms(100));
    assert_eq!(bench.script(), ScriptRun::Running { line: 3 });
    bench.apply(&WorldAction::SetRts { on: true });
    bench.ask(commands::STOP_SCRIPT, &[]);
    assert_eq!(bench.script(), ScriptRun::Stopped { line: 3 });
}

#[test]
fn what_a_script_does_does_not_depend_on_how_time_is_cut() {
    let program = "main\nputs 0,[dec SYSUSTICK,32]\npause 3\nif SYSTICK < 200 then main\nend\n";
    let said = |step: Duration| {
        let mut bench = running(program);
        let end = bench.bus.now() + ms(250);
        while bench.bus.now() < end {
            bench.wait(step);
        }
        bench.said(StreamIndex::Usb)
    };
    let whole = said(ms(250));
    assert!(whole.len() > 100);
    for step in [ms(1), Duration::from_micros(3_333), Duration::from_micros(70)] {
        assert_eq!(said(step), whole, "{step:?}");
    }
}

#[test]
fn a_pause_takes_as_long_as_it_says_and_instructions_take_time() {
    let mut bench = running("start var long\nstart = SYSTICK\npause 100\nputs 0,[dec SYSTICK-start]\nend\n");
    bench.wait(ms(200));
    assert_eq!(bench.said(StreamIndex::Usb), "100");
    // A loop of a few instructions at 8 us each.
    let mut bench = running("count var long\nmain\ncount = count+1\ngoto main\n");
    bench.wait(ms(1_000));
    let executed = bench.unit().unit().expect("power").script().expect("a script").executed();
    assert!((120_000..130_000).contains(&executed), "{executed}");
}

#[test]
fn a_fault_names_its_line_and_the_script_stands() {
    let mut bench = running("zero var long\nmain\nzero = 1/zero\ngoto main\n");
    bench.wait(ms(10));
    let ScriptRun::Faulted { line, what } = bench.script() else { panic!("{:?}", bench.script()) };
    assert_eq!((line, what.contains("zero")), (3, true), "{what}");
    let mut bench = running("main\ngosub deeper\nend\ndeeper\ngosub deeper\nreturn\n");
    bench.wait(ms(500));
    assert!(matches!(bench.script(), ScriptRun::Faulted { line: 5, .. }), "{:?}", bench.script());
}

#[test]
fn autorun_starts_a_script_after_its_delay_and_never_below_100_ms() {
    for (delay_ms, runs) in [(99, false), (0, false), (100, true), (400, true)] {
        let mut bench = Bench::new(Generation::Gen2);
        bench.install(COUNTER);
        bench.ask(commands::SET_SCRIPT_AUTORUN, &[delay_ms]);
        bench.ask(commands::SAVE_SETTINGS, &[]);
        bench.wait(ms(1_000));
        assert_eq!(bench.script(), ScriptRun::Idle, "only a power-up counts");
        bench.apply(&WorldAction::Power { on: false });
        bench.apply(&WorldAction::Power { on: true });
        bench.wait(ms((delay_ms - 10).max(0).unsigned_abs()));
        assert!(!bench.script().is_running());
        bench.wait(ms(100));
        assert_eq!(bench.script().is_running(), runs, "{delay_ms} ms");
    }
}

#[test]
fn a_script_stopped_after_an_autorun_stays_stopped() {
    let mut bench = Bench::new(Generation::Gen2);
    bench.install(COUNTER);
    bench.ask(commands::SET_SCRIPT_AUTORUN, &[200]);
    bench.ask(commands::SAVE_SETTINGS, &[]);
    bench.wait(ms(500));
    bench.apply(&WorldAction::Power { on: false });
    assert_eq!(bench.unit().view().script, None);
    bench.apply(&WorldAction::Power { on: true });
    // A Stop that comes before the delay is over keeps it from starting too.
    bench.wait(ms(100));
    bench.ask(commands::STOP_SCRIPT, &[]);
    bench.wait(ms(1_000));
    assert_eq!(bench.script(), ScriptRun::Idle);
}

#[test]
fn pins_run_stop_and_reset_the_script() {
    let mut bench = running(COUNTER);
    let drive = |bench: &mut Bench, volts| {
        bench.apply(&WorldAction::SetPin { pin: PIN, signal: PinSignal::Volts { volts } });
        bench.wait(ms(10));
    };
    bench.apply(&WorldAction::SetRts { on: true });
    // An analog pin that stops the script at its lowest value and resets it at its highest: 0x4000 and 0x0080.
    let set = |bench: &mut Bench, min_action: i64, max_action: i64| {
        let ends = [min_action, max_action];
        let before = [PIN as i64, 1, 0, 0];
        let after = [0, 0, 0, 0, 4095, 2048, 0, 0, 0, 0, 0];
        bench.ask(commands::SET_SIGNAL, &[&before[..], &ends, &after].concat());
    };
    drive(&mut bench, 2.5);
    set(&mut bench, 0x4000, 0x0080);
    bench.wait(ms(100));
    let count = |bench: &Bench| {
        let machine = bench.unit().unit().unwrap();
        let machine = machine.script().unwrap();
        let place = machine.program().variables[0].memory.first;
        machine.memory().load(place)
    };
    let before = count(&bench);
    assert!(before > 8, "{before}");
    drive(&mut bench, 5.1);
    assert!(count(&bench) < before && bench.script().is_running(), "reset keeps it running");
    drive(&mut bench, 0.0);
    assert!(matches!(bench.script(), ScriptRun::Stopped { .. }));
    let why = bench.bus.controllers_mut()[0].debug(Vec::new(), &Wanted::default()).sentence();
    assert!(why.contains("the action of input pin 4 did it"), "DIN4 is the fourth: {why}");
    drive(&mut bench, 2.5);
    drive(&mut bench, 5.1);
    assert!(matches!(bench.script(), ScriptRun::Stopped { .. }), "reset starts nothing");
    set(&mut bench, 0, 0x0040);
    drive(&mut bench, 2.5);
    drive(&mut bench, 5.1);
    assert!(bench.script().is_running());
}

#[test]
fn a_downloaded_image_runs_and_a_foreign_one_is_refused() {
    let mut bench = Bench::new(Generation::Gen2);
    let image = brushwork_script::image::encode(&super::super::support::compiled(COUNTER));
    assert_eq!(brushwork_script::image::MAGIC, script_image::OWN_MAGIC);
    download(&mut bench, &image);
    assert_eq!(bench.unit().view().script.map(|script| script.holds), Some(Content::Own));
    bench.ask(commands::START_SCRIPT, &[]);
    bench.wait(ms(50));
    assert!(bench.script().is_running());
    let mut foreign = image.clone();
    foreign[0] ^= 0xFF;
    download(&mut bench, &foreign);
    assert!(!bench.script().is_running(), "an erase ends the script");
    assert_eq!(bench.raw(&start_bytes()), [0]);
    assert_eq!(bench.unit().view().script.map(|script| script.holds), Some(Content::Foreign));
    // One byte is wrong somewhere in the middle: the checksum finds it.
    let mut damaged = image;
    let middle = damaged.len() / 2;
    damaged[middle] ^= 1;
    download(&mut bench, &damaged);
    assert_eq!(bench.raw(&start_bytes()), [0]);
}

/// Erases and writes as a client does: 250 with its key, then 251 for each sixteen bytes.
fn download(bench: &mut Bench, image: &[u8]) {
    let mut send = |request: &Request, wait: Duration| {
        let bytes = request.encode(Generation::Gen2).unwrap();
        assert_eq!(bench.raw(&bytes), [0xFF]);
        bench.wait(wait);
        assert_eq!(bench.bus.take_output(StreamIndex::Usb), Some(vec![0xFF]));
    };
    let address = brushwork_mcp_wire::packet_serial::Address::DEFAULT;
    send(&Request::new(address, number::ERASE_SCRIPT, &[0x55AA]), ms(1_600));
    for block in script_image::blocks(image) {
        let values = vec![Value::Int(block.address.into()), Value::Bytes(block.wire_bytes().to_vec())];
        send(&Request { address, command: number::WRITE_SCRIPT, values }, ms(3));
    }
}

#[test]
fn user_eeprom_of_scripts_and_of_commands_252_and_253_is_one_memory() {
    // The manual's example of READ and WRITE.
    let mut bench = running(
        "index var byte\nchar var byte\nwrite 0,\"H\"\nwrite 1,\"e\"\nwrite 2,\"l\"\nwrite 3,\"l\"\nwrite 4,\"o\"\n\
         for index = 0 to 10\nread index,char\nputs 0,[char]\nnext\nend\n",
    );
    bench.wait(ms(100));
    assert_eq!(bench.said(StreamIndex::Usb), "Hello\0\0\0\0\0\0");
    bench.apply(&WorldAction::SetRts { on: true });
    // Word 0 is bytes 0 and 1, the low one first: "H" is 0x48, "e" 0x65.
    assert_eq!(bench.ask(commands::READ_USER_MEMORY, &[0]).int(name::VALUE), 0x6548);
    assert_eq!(bench.ask(commands::READ_USER_MEMORY, &[2]).int(name::VALUE), 0x006F);
    bench.apply(&WorldAction::Power { on: false });
    bench.apply(&WorldAction::Power { on: true });
    bench.wait(ms(10));
    assert_eq!(bench.ask(commands::READ_USER_MEMORY, &[1]).int(name::VALUE), 0x6C6C, "it survives");
}
