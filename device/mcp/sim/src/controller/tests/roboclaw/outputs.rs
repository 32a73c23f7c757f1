//! Voltage clamp, brakes and outputs set by a command.

use super::*;
use brushwork_mcp_wire::packet_serial::Generation::{Gen1, Gen2, Gen3, Gen4};
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::{BrakeResistorParams, presets};

fn outputs(bench: &Bench) -> Vec<bool> {
    bench.unit().unit().expect("it has power").outputs().to_vec()
}

#[test]
fn a_voltage_clamp_is_on_while_the_main_battery_is_above_its_maximum() {
    for (generation, function) in [(Gen1, 3), (Gen2, 3), (Gen3, 0x14), (Gen4, 0x14)] {
        let mut bench = claw(generation);
        set_pins(&mut bench, [function, 0, 0]);
        bench.ask(
            commands::SET_MAIN_VOLTAGES,
            if generation == Gen4 { &[60, 260, 0][..] } else { &[60, 260] },
        );
        bench.wait(A_MOMENT);
        assert_eq!(outputs(&bench), [false; 5], "{generation}");
        bench.apply(&WorldAction::SetBatteryVolts { volts: 28.0 });
        bench.wait(A_MOMENT);
        assert_eq!(outputs(&bench), [true, false, false, false, false], "{generation}");
        // The pin is an output now: what pulls it is no emergency stop.
        pull(&mut bench, S3, true);
        bench.wait(A_MOMENT);
        assert!(!has(&mut bench, Condition::EStop), "{generation}");
    }
}

#[test]
fn a_resistor_on_the_clamp_takes_the_current_so_that_protection_need_not_brake() {
    let braking = |function: i64| {
        let mut config = config(Gen1);
        let flywheel = presets::lookup("flywheel").expect("it is built in");
        config.world = presets::world_of(flywheel, flywheel, config.model.wired_pins());
        config.world.supply.can_sink = false;
        config.world.supply.brake_resistor = Some(BrakeResistorParams { ohms: 2.0, dout: 0 });
        let max_tenths = (config.world.supply.open_circuit_volts * 10.0) as i64 + 30;
        let mut bench = Bench::of(config);
        bench.ask(commands::SET_MAIN_VOLTAGES, &[60, max_tenths]);
        set_pins(&mut bench, [function, 0, 0]);
        bench.ask(commands::DUTY_ACCEL_M1, &[32_767, 655_359]);
        bench.wait_talking(Duration::from_secs(30));
        bench.ask(commands::DUTY_ACCEL_M1, &[16_000, 6_553]);
        let mut braking = 0;
        for _ in 0..300 {
            bench.wait_talking(Duration::from_millis(10));
            braking += usize::from(bench.unit().view().axes[0].output == BridgeOutput::Brake);
        }
        braking
    };
    let (clamped, free) = (braking(3), braking(0));
    assert!(free > 30 && clamped * 5 < free, "{clamped} looks with the clamp, {free} without");
}

#[test]
fn a_brake_is_on_while_its_motor_stands() {
    let mut bench = claw(Gen4);
    set_pins(&mut bench, [0, 0x04, 0x04]);
    bench.wait(A_MOMENT);
    assert_eq!(outputs(&bench), [false, true, true, false, false]);
    bench.ask(commands::DUTY_M2, &[10_000]);
    bench.wait(A_MOMENT);
    assert_eq!(outputs(&bench), [false, true, false, false, false]);
}

#[test]
fn ctrl_outputs_follow_their_modes() {
    for generation in [Gen2, Gen3] {
        let mut bench = claw(generation);
        let mut seen = |modes: [i64; 2], duties: [i64; 2]| {
            bench.ask(commands::READ_VOLTS, &modes);
            bench.ask(commands::SET_AUX_DUTIES, &duties[..1]);
            bench.ask(commands::READ_ENCODER_STATUS, &duties[1..]);
            bench.wait(A_MOMENT);
            outputs(&bench)[3..].to_vec()
        };
        assert_eq!(seen([0, 0], [4096, 4096]), [false, false], "disabled, {generation}");
        assert_eq!(seen([1, 1], [0, 4096]), [false, true], "set by a command, {generation}");
        assert_eq!(seen([3, 2], [0, 0]), [true, false], "a brake, and a clamp at a sound voltage");
    }
}

#[test]
fn d1_and_d2_have_functions_of_their_own_in_generation_4() {
    let mut bench = claw(Gen4);
    bench.ask(commands::SET_PIN_FUNCTIONS, &[0, 0, 0, 0x04, 0x84]);
    bench.wait(A_MOMENT);
    assert_eq!(outputs(&bench)[3..], [true, false]);
    bench.ask(commands::SET_AUX_DUTIES, &[0, 0, 0, 0, 20_000]);
    bench.ask(commands::DUTY_M1, &[10_000]);
    bench.wait(A_MOMENT);
    assert_eq!(outputs(&bench)[3..], [false, true]);
}
