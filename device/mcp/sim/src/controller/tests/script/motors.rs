//! The manual's programs that move motors, and who else commands them.

use super::super::support::Bench;
use super::{ms, running};
use brushwork_mcp_wire::packet_serial::{Generation, commands};
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_values::Motor;
use brushwork_values::Motor::{M1, M2};

fn duty(bench: &Bench, motor: Motor) -> i32 {
    bench.unit().unit().expect("power").channel(motor).duty_raw().into()
}

fn counts(bench: &Bench, motor: Motor) -> i32 {
    bench.unit().unit().expect("power").channel(motor).encoder().position()
}

fn speed(bench: &Bench, motor: Motor) -> i32 {
    bench.unit().unit().expect("power").channel(motor).speeds().average
}

#[test]
fn power_ramps_to_full_duty_in_a_second_and_back() {
    // MCP manual 3.4.1, POWER: "should take 1 second to accel to specific power (100% duty)".
    let mut bench =
        running("main\npower 0,32767,32767\npause 1000\npower 0,0,32767\npause 1000\ngoto main\n");
    bench.wait(ms(500));
    assert!((15_500..17_300).contains(&duty(&bench, M1)), "{}", duty(&bench, M1));
    bench.wait(ms(495));
    assert!(duty(&bench, M1) > 32_300, "{}", duty(&bench, M1));
    bench.wait(ms(505));
    assert!((15_500..17_300).contains(&duty(&bench, M1)), "{}", duty(&bench, M1));
    assert_eq!(duty(&bench, M2), 0);
}

#[test]
fn power2_moves_both() {
    let mut bench = running("main\npower2 32767,32767,-16384,65536\npause 2000\nend\n");
    bench.wait(ms(500));
    assert!(duty(&bench, M1) > 15_000);
    assert_eq!(duty(&bench, M2), -16_384);
    bench.wait(ms(2_000));
    assert_eq!(duty(&bench, M1), 32_767, "END leaves the motors as they were told");
}

#[test]
fn speed_and_dist_close_the_velocity_loop() {
    let mut bench = running("main\nspeed 0,3000,12000\npause 5000\nend\n");
    bench.wait(ms(3_000));
    assert!((2_850..3_150).contains(&speed(&bench, M1)), "{}", speed(&bench, M1));
    // The manual's DIST example, with the argument that it lacks and parentheses where `<>` binds tighter than `&`: one move forward,
    // one back, again and again.
    let mut bench = running(
        "main\ndist 0,6000,12000,6000,0\ndist 0,-6000,12000,6000,0\nwhile (MOTORBUFFER(0) & 0x7F) <> 0\nwend\ngoto main\n",
    );
    let mut farthest = 0;
    let mut lowest = i32::MAX;
    for _ in 0..800 {
        bench.wait(ms(10));
        farthest = farthest.max(counts(&bench, M1));
        if bench.bus.controllers()[0].now() > ms(4_000) {
            lowest = lowest.min(counts(&bench, M1));
        }
    }
    // A move that another follows goes through its end at full speed; turning from 6000/s at 12000/s^2 takes 1500 counts.
    assert!((7_300..7_800).contains(&farthest), "{farthest}");
    assert!((-1_800..-1_200).contains(&lowest), "{lowest}");
    assert!(bench.script().is_running());
}

#[test]
fn move_takes_one_second_for_a_thousand_counts_and_stands_for_another() {
    // MCP manual 3.4.1, MOVE, on a motor whose loops are tuned for it: position P 10 (x1024 in this generation).
    let mut bench = Bench::new(Generation::Gen2);
    bench.ask(commands::SET_POSITION_PID_M1, &[0, 10 * 1024, 0, 0, 0, -20_000, 20_000]);
    bench.start("main\nmove 0,1000,0,0,1000,0\npause 2000\nmove 0,1000,0,0,-1000,0\npause 2000\ngoto main\n");
    bench.wait(ms(500));
    assert!((350..650).contains(&counts(&bench, M1)), "{}", counts(&bench, M1));
    bench.wait(ms(1_000));
    assert!((950..1_050).contains(&counts(&bench, M1)), "{}", counts(&bench, M1));
    // Two thousand counts back take two seconds, at whose end the next move begins.
    bench.wait(ms(2_400));
    assert!((-960..-800).contains(&counts(&bench, M1)), "{}", counts(&bench, M1));
}

#[test]
fn a_serial_port_that_goes_silent_does_not_stop_what_the_script_drives() {
    let mut bench = Bench::new(Generation::Gen2);
    bench.start("main\npower 0,10000,655359\nmain2\npause 10\ngoto main2\n");
    bench.ask(commands::DUTY_M2, &[8_000]);
    bench.wait(ms(500));
    assert_eq!((duty(&bench, M1), duty(&bench, M2)), (10_000, 8_000));
    bench.wait(ms(1_500));
    assert_eq!((duty(&bench, M1), duty(&bench, M2)), (10_000, 0), "motor 2 was the serial port's");
}

#[test]
fn stop_all_stands_the_motors_of_a_running_script() {
    let mut bench = Bench::new(Generation::Gen2);
    bench.start("main\npower2 10000,655359,10000,655359\npause 1\ngoto main\n");
    bench.wait(ms(300));
    assert_eq!(duty(&bench, M1), 10_000);
    // Duty 0 alone does not last: the script drives on.
    bench.ask(commands::DUTY_ACCEL_BOTH, &[0, 655_359, 0, 655_359]);
    bench.wait(ms(300));
    assert_eq!(duty(&bench, M1), 10_000);
    bench.ask(commands::STOP_SCRIPT, &[]);
    bench.ask(commands::DUTY_ACCEL_BOTH, &[0, 655_359, 0, 655_359]);
    bench.wait(ms(300));
    assert_eq!((duty(&bench, M1), duty(&bench, M2)), (0, 0));
}

#[test]
fn a_script_that_was_stopped_leaves_its_motors_to_the_time_out() {
    let mut bench = Bench::new(Generation::Gen2);
    bench.start("main\npower 0,10000,655359\nmain2\ngoto main2\n");
    bench.wait(ms(300));
    bench.ask(commands::STOP_SCRIPT, &[]);
    bench.wait(ms(500));
    assert_eq!(duty(&bench, M1), 10_000, "stopping a script stops no motor");
    bench.wait(ms(1_000));
    assert_eq!(duty(&bench, M1), 0, "the serial port timed out");
}

#[test]
fn an_emergency_stop_holds_the_motors_against_a_script() {
    let mut bench = Bench::new(Generation::Gen2);
    bench.start("main\npower 0,10000,655359\npause 1\ngoto main\n");
    bench.wait(ms(300));
    bench.apply(&WorldAction::EStop { pressed: true });
    bench.wait(ms(300));
    assert_eq!(duty(&bench, M1), 0);
    assert!(bench.script().is_running(), "the script itself goes on");
}

#[test]
fn a_limit_switch_holds_the_motor_against_a_script() {
    let mut bench = running(
        "SIGNALTYPE(3) = 1\nSIGNALMAXACTION(3) = 0x0008\nmain\npower 0,10000,655359\npause 1\ngoto main\n",
    );
    bench.wait(ms(300));
    assert_eq!(duty(&bench, M1), 10_000);
    bench.apply(&WorldAction::SetPin { pin: 3, signal: PinSignal::Volts { volts: 5.1 } });
    bench.wait(ms(300));
    assert_eq!(duty(&bench, M1), 0);
    assert_eq!(bench.said(StreamIndex::Usb), "");
}
