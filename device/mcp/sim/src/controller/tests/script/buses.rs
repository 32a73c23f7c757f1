//! I2C: the manual's example with the sensor it names, and all that can go wrong.

use super::super::support::Bench;
use super::{ms, run};
use brushwork_mcp_wire::packet_serial::{Generation, commands};
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::world::{I2cDevice, WorldAction};

/// MCP manual 3.4.1, I2COUT, with a pause so that the output stays short.
const WHO_AM_I: &str = "temp var long\nmain\npause 10\ni2cout error,10,[0xd0,0x75]\ni2coutns error,10,[0xd1]\n\
    i2cin error,10,[temp]\nputs 0,[dec temp,13]\ngoto main\nerror\nputs 0,[\"I2C Error:\",dec i2cerror,13]\ngoto main\n";

/// Starts a script with UART1 disabled, which makes its pins the I2C bus.
fn on_the_bus(text: &str) -> Bench {
    let mut bench = Bench::new(Generation::Gen2);
    bench.ask(commands::SET_STREAM, &[2, 2, 115_200, 1000]);
    run(&mut bench, text);
    bench
}

fn said_in(bench: &mut Bench, milliseconds: u64) -> String {
    bench.wait(ms(milliseconds));
    bench.said(StreamIndex::Usb)
}

#[test]
fn the_manuals_example_reads_who_the_sensor_is() {
    let mut bench = on_the_bus(WHO_AM_I);
    assert_eq!(said_in(&mut bench, 15), "I2C Error:2\r", "nobody is there");
    bench.apply(&WorldAction::AddI2cDevice { device: I2cDevice::mpu6050() });
    assert_eq!(said_in(&mut bench, 11), "104\r", "0x68");
    bench.apply(&WorldAction::SetI2cRegisters { address: 0x68, first: 0x75, values: vec![0x70] });
    assert!(said_in(&mut bench, 25).ends_with("112\r"));
    bench.apply(&WorldAction::RemoveI2cDevice { address: 0x68 });
    assert!(said_in(&mut bench, 25).ends_with("I2C Error:2\r"));
}

#[test]
fn the_bus_is_there_only_while_uart_1_is_disabled() {
    let mut bench = Bench::new(Generation::Gen2);
    bench.apply(&WorldAction::AddI2cDevice { device: I2cDevice::mpu6050() });
    run(&mut bench, WHO_AM_I);
    assert_eq!(said_in(&mut bench, 15), "I2C Error:1\r");
}

#[test]
fn several_bytes_are_written_and_read_in_order() {
    let mut bench = on_the_bus(
        "high var byte\nlow var byte\npause 5\ni2cout error,10,[0xa0,0x10,0x12,0x34]\ni2cout error,10,[0xa0,0x10]\n\
         i2coutns error,10,[0xa1]\ni2cin error,10,[high,low]\nputs 0,[hex high,hex low]\nend\nerror\nputs 0,[\"bad\"]\nend\n",
    );
    bench.apply(&WorldAction::AddI2cDevice { device: I2cDevice::new("memory", 0x50) });
    assert_eq!(said_in(&mut bench, 20), "1234");
}

#[test]
fn a_device_that_holds_the_clock_for_too_long_is_a_time_out() {
    let mut bench = on_the_bus(WHO_AM_I);
    bench.apply(&WorldAction::AddI2cDevice { device: I2cDevice::mpu6050().stretching(9_000) });
    // Two bytes, one and one at 9 ms each, and the pause before them.
    assert_eq!(said_in(&mut bench, 40), "");
    assert_eq!(said_in(&mut bench, 10), "104\r");
    bench.apply(&WorldAction::AddI2cDevice { device: I2cDevice::mpu6050().stretching(10_001) });
    assert!(said_in(&mut bench, 60).ends_with("I2C Error:5\r"));
}

#[test]
fn a_read_without_an_address_fails() {
    let mut bench =
        on_the_bus("temp var byte\ni2cin error,10,[temp]\nend\nerror\nputs 0,[dec i2cerror]\nend\n");
    assert_eq!(said_in(&mut bench, 10), "4");
}
