//! System registers against what packet serial says of the same thing.

use super::super::support::Bench;
use super::{ms, run, running};
use brushwork_mcp_wire::packet_serial::{Generation, commands, name};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_values::Motor::{M1, M2};

/// What a script that says these values says, 20 ms after its start.
fn said(bench: &mut Bench, values: &str) -> String {
    run(bench, &format!("main\npause 20\nputs 0,[{values}]\nend\n"));
    bench.wait(ms(40));
    bench.said(StreamIndex::Usb)
}

#[test]
fn the_system_registers_say_what_the_commands_say() {
    let mut bench = Bench::new(Generation::Gen2);
    bench.apply(&WorldAction::SetBatteryVolts { volts: 15.5 });
    bench.apply(&WorldAction::SetLogicVolts { volts: 9.0 });
    bench.apply(&WorldAction::SetBoardCelsius { celsius: Some(39.3) });
    bench.ask(commands::SET_MAIN_VOLTAGES, &[100, 600]);
    bench.wait(ms(10));
    let said = said(
        &mut bench,
        "hex4 VERSION\\4,32,dec SYSMBAT,32,dec SYSLBAT,32,dec SYSTEMP,32,dec SYSMINMBAT,32,dec SYSMAXMBAT,32,\
         dec SYSTICK,32,dec SYSUSTICK/1000,32,dec SYSSTATUS",
    );
    let words: Vec<&str> = said.split(' ').collect();
    assert_eq!(words[..6], ["0100", "155", "90", "393", "100", "600"]);
    assert_eq!(words[6], words[7]);
    assert_eq!(words[8], "0");
}

#[test]
fn limits_that_a_script_sets_act_and_show_in_sysstatus() {
    let mut bench =
        running("SYSMAXMBAT = 200\nSYSMINMBAT = 120\npause 50\nputs 0,[hex4 SYSSTATUS\\4]\nend\n");
    bench.apply(&WorldAction::SetBatteryVolts { volts: 11.0 });
    bench.wait(ms(100));
    // Main battery low: 0x0040 on the register's page.
    assert_eq!(bench.said(StreamIndex::Usb), "0040");
    bench.apply(&WorldAction::SetRts { on: true });
    let limits = bench.ask(commands::READ_MAIN_VOLTAGES, &[]);
    assert_eq!((limits.int(name::MIN), limits.int(name::MAX)), (120, 200));
}

#[test]
fn motor_registers_are_the_gains_and_the_state_of_the_channels() {
    let mut bench = running(
        "MOTORVELKI(0) = TOINT(0.5*65536.0)\nMOTORVELQPPS(1) = 180000\nMOTORPOSMIN(0) = -10000\nMOTORDEFAULTACCEL(0) = 655360\n\
         MOTORMAXCURRENT(0) = 3000\nMOTORENCPOS(1) = -77\nspeed 0,2000,4000\npause 1000\n\
         puts 0,[sdec MOTORTARGETSPEED(0),32,dec MOTORACCEL(0),32,hex MOTORFLAGS(0),32,hex MOTORBUFFER(0),32,sdec MOTORENCPOS(1)]\nmain\ngoto main\n",
    );
    bench.wait(ms(1_100));
    // Active, velocity loop, nothing waits: 0x40 + 0x80 + 0x200.
    assert_eq!(bench.said(StreamIndex::Usb), "2000 4000 2c0 80 -77");
    bench.apply(&WorldAction::SetRts { on: true });
    assert_eq!(bench.ask(commands::READ_VELOCITY_PID_M1, &[]).int(name::I), 32_768);
    assert_eq!(bench.ask(commands::READ_VELOCITY_PID_M2, &[]).int(name::QPPS), 180_000);
    assert_eq!(bench.ask(commands::READ_POSITION_PID_M1, &[]).int(name::MIN), -10_000);
    assert_eq!(bench.ask(commands::READ_DEFAULT_ACCELS, &[]).int(name::ACCEL_M1), 655_360);
    let unit = bench.unit().unit().expect("power");
    assert_eq!(unit.channel(M2).encoder().position(), -77);
    assert!((1_800..2_200).contains(&unit.channel(M1).speeds().filtered));
}

#[test]
fn dout_overrides_its_action_until_the_action_is_set() {
    let mut bench = running(
        "DOUTACTION(0) = 3\nDOUT(1) = 1\npause 20\nDOUT(0) = 1\npause 20\npower 0,10000,655359\nDOUT(0) = 0\npause 100\n\
         puts 0,[dec DOUT(0),dec DOUT(1)]\nDOUTACTION(0) = 1\nmain\ngoto main\n",
    );
    let on = |bench: &Bench| bench.unit().unit().expect("power").outputs().to_vec();
    bench.wait(ms(10));
    assert_eq!(on(&bench)[..2], [false, true]);
    bench.wait(ms(20));
    assert_eq!(on(&bench)[..2], [true, true], "no motor runs, and yet it is on");
    bench.wait(ms(60));
    assert_eq!(on(&bench)[..2], [false, true], "a motor runs, and yet it is off");
    bench.wait(ms(100));
    assert_eq!(bench.said(StreamIndex::Usb), "01");
    assert_eq!(on(&bench)[..2], [true, true], "the action is back");
    bench.apply(&WorldAction::SetRts { on: true });
    bench.ask(commands::STOP_SCRIPT, &[]);
    bench.ask(commands::DUTY_BOTH, &[0, 0]);
    bench.ask(commands::SET_DOUT_ACTION, &[1, 0]);
    bench.wait(ms(300));
    assert_eq!(on(&bench)[..2], [false, false], "command 137 gives an output back to its action");
}

#[test]
fn signals_are_read_and_set() {
    let mut bench = running(
        "SIGNALTYPE(3) = 1\nSIGNALMIN(3) = 0\nSIGNALMAX(3) = 4000\nSIGNALCENTER(3) = 2000\nSIGNALTARGET(3) = 1\nSIGNALTIMEOUT(3) = 250\n\
         pause 500\nputs 0,[sdec SIGNALPOSITION(3),32,sdec SIGNALPERCENT(3),32,dec SIGNALTARGET(3),32,dec SIGNALTARGET(1),32,\
         dec SIGNALTICK(3),32,dec SIGNALACTIVE(3),32,dec SIGNALITER(3)]\nend\n",
    );
    // 5.1 V read 4095.
    let volts = 5.1 * 1000.0 / 4095.0;
    bench.apply(&WorldAction::SetPin { pin: 3, signal: PinSignal::Volts { volts } });
    bench.wait(ms(600));
    let said = bench.said(StreamIndex::Usb);
    let words: Vec<i64> = said.split(' ').map(|word| word.parse().unwrap()).collect();
    assert_eq!(words[..4], [-1000, -16_383, 1, 255], "{said}");
    // It changed within the first ticks and timed out since; it was read in each of some 150 ticks.
    assert!(words[4] < 20 && words[5] == 0 && (140..=155).contains(&words[6]), "{said}");
    bench.apply(&WorldAction::SetRts { on: true });
    let signals = bench.ask(commands::READ_SIGNALS, &[]);
    assert_eq!(signals.records().nth(3).map(|record| record.int(name::TARGET)), Some(2));
}

#[test]
fn stream_registers_are_those_of_command_146() {
    let mut bench = running(
        "STREAMRATE(3) = 57600\nSTREAMTIMEOUT(0) = 50\npause 10\nputs 0,[dec STREAMTYPE(0),dec STREAMTYPE(3),dec STREAMISBUSY(0)]\n\
         pause 100\nputs 0,[dec STREAMISBUSY(0),32,dec SYSTICK-STREAMTICK(0)]\nend\n",
    );
    bench.bus.receive(StreamIndex::Usb, b"x");
    bench.wait(ms(200));
    let said = bench.said(StreamIndex::Usb);
    assert!(said.starts_with("0110 11"), "{said}");
    bench.apply(&WorldAction::SetRts { on: true });
    let streams = bench.ask(commands::READ_STREAMS, &[]);
    let rates: Vec<i64> = streams.records().map(|record| record.int(name::RATE)).collect();
    assert_eq!(rates[1], 57_600, "RS-232 is stream 3 of scripts and 1 of command 145");
}

#[test]
fn the_priority_registers_follow_the_inputs() {
    let mut bench = running("main\nputs 0,[dec PRIORITYLEVEL,dec PRIORITYACTIVE,32]\npause 500\ngoto main\n");
    bench.apply(&WorldAction::SetRts { on: true });
    bench.ask(commands::SET_PRIORITIES, &[1, 2, 3]);
    bench.apply(&WorldAction::SetRts { on: false });
    bench.wait(ms(2_600));
    let said = bench.said(StreamIndex::Usb);
    // Level 0 with serial; nothing could raise it. After the time-out none is active: the last level, and all three could raise it.
    assert!(said.starts_with("00 ") && said.ends_with("27 "), "{said}");
}
