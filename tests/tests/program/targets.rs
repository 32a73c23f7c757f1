//! What a user types to say where a controller is, with the families that the program has.

use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use brushwork_link::transport::target::LineOptions;
use brushwork_link::transport::{ConnectTarget, Stream};

/// What a text means.
fn parse(text: &str) -> Result<ConnectTarget, String> {
    brushwork::install();
    text.parse().map_err(|error: brushwork_link::transport::target::TargetError| error.to_string())
}

fn serial(path: &str, baud: u32, stream: Option<Stream>) -> ConnectTarget {
    ConnectTarget::Serial {
        path: path.to_owned(),
        baud,
        line: LineOptions { stream, ..LineOptions::default() },
    }
}

fn can(adapter: ConnectTarget, node: Option<NodeId>, form: Form) -> ConnectTarget {
    ConnectTarget::Can { adapter: Box::new(adapter), node, form }
}

#[test]
fn every_form_of_target_is_understood() {
    let cases = [
        ("/dev/ttyACM0", serial("/dev/ttyACM0", 38_400, None)),
        ("COM3", serial("COM3", 38_400, None)),
        (r"\\.\COM12,baud=9600", serial(r"\\.\COM12", 9_600, None)),
        ("/dev/ttyUSB0,baud=115200,stream=ttl1", serial("/dev/ttyUSB0", 115_200, Some(Stream::Ttl1))),
        ("my,odd,link", serial("my,odd,link", 38_400, None)),
        (
            "tcp:127.0.0.1:5000",
            ConnectTarget::Tcp { address: "127.0.0.1:5000".into(), line: LineOptions::default() },
        ),
        (
            "TCP:[::1]:5000,stream=rs232",
            ConnectTarget::Tcp {
                address: "[::1]:5000".into(),
                line: LineOptions { stream: Some(Stream::Rs232), ..LineOptions::default() },
            },
        ),
        ("sim:mcp266,generation=4", ConnectTarget::Sim("mcp266,generation=4".into())),
        ("can:COM7", can(serial("COM7", 115_200, None), None, Form::Ascii)),
        (
            "can:/dev/ttyUSB0,baud=230400,node=3,form=binary",
            can(serial("/dev/ttyUSB0", 230_400, None), NodeId::new(3), Form::Binary),
        ),
        (
            "CAN:tcp:localhost:4000,node=127",
            can(
                ConnectTarget::Tcp { address: "localhost:4000".into(), line: LineOptions::default() },
                NodeId::new(127),
                Form::Ascii,
            ),
        ),
    ];
    for (text, target) in cases {
        assert_eq!(parse(text).unwrap(), target, "{text}");
    }
}

#[test]
fn a_motion_mind_has_a_baud_rate_of_its_own_unless_one_is_named() {
    let baud = |text: &str| match parse(text).unwrap() {
        ConnectTarget::Serial { baud, .. } => baud,
        other => panic!("{other}"),
    };
    assert_eq!(baud("COM3,family=motion-mind"), 19_200);
    assert_eq!(baud("COM3,baud=38400,family=motion-mind"), 38_400);
}

#[test]
fn a_target_prints_as_it_is_typed() {
    for text in [
        "can:/dev/ttyUSB0,baud=9600,node=3,form=binary",
        "can:tcp:[::1]:5000",
        "/dev/ttyACM0",
        "/dev/ttyUSB0,family=motion-mind",
        "tcp:[::1]:5000,family=mcp",
        "COM3,baud=9600,stream=usb",
        "tcp:[::1]:5000,stream=ttl3",
        "/dev/ttyUSB0,baud=115200,stream=ttl1,latency=800",
        "tcp:[::1]:5000,latency=10000,family=mcp",
        "can:/dev/ttyUSB0,node=3,latency=800",
        "can:tcp:[::1]:5000,node=3,latency=800",
        "sim:mcp266",
    ] {
        assert_eq!(parse(text).unwrap().to_string(), text);
    }
}

#[test]
fn a_bad_target_says_what_would_be_good() {
    let sentence = |text: &str| parse(text).unwrap_err();
    assert!(sentence("  ").contains("/dev/ttyACM0"));
    assert!(sentence(",baud=9600").contains("no port was named"));
    assert!(sentence("tcp:host").contains("tcp:host:port"));
    assert!(sentence("tcp::80").contains("tcp:host:port"));
    assert!(sentence("COM3,baud=12").contains("300 to 1000000"));
    for latency in ["0", "10001", "soon", "-1"] {
        assert!(sentence(&format!("COM3,latency={latency}")).contains("1 to 10000 ms"), "{latency}");
        assert!(sentence(&format!("can:COM3,latency={latency}")).contains("1 to 10000 ms"), "{latency}");
    }
    assert!(sentence("COM3,family=can").contains("motion-mind"));
    assert!(sentence("COM3,stream=can").contains("rs232"));
    assert!(sentence("can:COM3,node=0").contains("1 to 127"));
    assert!(sentence("can:COM3,form=slcan").contains("ascii or binary"));
    assert!(sentence("can:").contains("no port was named"));
}
