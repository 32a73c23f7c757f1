//! Clients that share no line of code with this project, against the simulated controller on a pseudo-terminal.
#![cfg(unix)]
#![expect(clippy::print_stdout, reason = "figures and refusals belong into the record of a test run")]

use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_tests::foreign::{self, Findings};
use brushwork_tests::simulated::OnPty;

/// Methods of `basicmicro.Basicmicro` 2.0.10 that speak to the controller.
const BASICMICRO_METHODS: usize = 159;

/// How many of them have to succeed.
const BASICMICRO_SUCCEED: usize = 140;

/// Methods that act on the library's own object and send nothing.
const LOCAL: [&str; 11] = [
    "Open",
    "reconnect",
    "close",
    "crc_clear",
    "crc_update",
    "SendRandomData",
    "decode_error_status",
    "decode_warning_status",
    "decode_full_status",
    "analyze_roboclaw_status",
    "print_status_analysis",
];

/// What cannot succeed with this version of the library, whatever the controller does: ten that speak to it, four that do not.
const DOOMED: [&str; 14] = [
    "BackwardM1",
    "BackwardM2",
    "ForwardBackwardM1",
    "ForwardBackwardM2",
    "ForwardM1",
    "ForwardM2",
    "SetMaxVoltageLogicBattery",
    "SetMaxVoltageMainBattery",
    "SetMinVoltageLogicBattery",
    "SetMinVoltageMainBattery",
    "analyze_roboclaw_status",
    "decode_error_status",
    "decode_full_status",
    "decode_warning_status",
];

fn print(findings: &Findings) {
    for figure in &findings.figures {
        println!("{}: {:.2} {}", figure.name, figure.value, figure.unit);
    }
}

#[test]
fn the_vendors_python_library_finds_a_generation_4_controller() {
    if foreign::is_left_out("python") {
        return;
    }
    let mut controller = OnPty::start(Generation::Gen4);
    let port = controller.port();
    let findings = foreign::run("basicmicro_check.py", &port, &[], &mut controller);

    let (local, wire): (Vec<_>, Vec<_>) =
        findings.findings.iter().partition(|finding| LOCAL.contains(&finding.name.as_str()));
    assert_eq!((local.len(), wire.len()), (LOCAL.len(), BASICMICRO_METHODS), "every method is called");
    let succeeded = wire.iter().filter(|finding| finding.passed).count();
    println!("{succeeded} of {BASICMICRO_METHODS} methods succeed; the others:");
    for failure in findings.failures() {
        println!("  {failure}");
    }
    let mut failed: Vec<&str> = findings
        .findings
        .iter()
        .filter(|finding| !finding.passed)
        .map(|finding| finding.name.as_str())
        .collect();
    failed.sort_unstable();
    assert_eq!(failed, DOOMED, "{:#?}", findings.failures());
    assert!(succeeded >= BASICMICRO_SUCCEED);
}

#[test]
fn clients_in_three_styles_find_a_generation_1_controller() {
    if foreign::is_left_out("python") {
        return;
    }
    let mut controller = OnPty::start(Generation::Gen1);
    let port = controller.port();
    let findings = foreign::run("generation1_check.py", &port, &[], &mut controller);
    print(&findings);
    println!("{} findings", findings.findings.len());
    assert!(findings.failures().is_empty(), "{:#?}", findings.failures());
    assert!(findings.findings.len() > 300, "the script checked only {} things", findings.findings.len());
}

#[test]
fn the_python_package_canopen_reads_drives_and_loses_the_node() {
    if foreign::is_left_out("python") {
        return;
    }
    let node = NodeId::new(3).unwrap();
    let mut controller = OnPty::on_can(node, Form::Ascii);
    let port = controller.port();
    let folder = tempfile::tempdir().unwrap();
    let sheet = folder.path().join("mcp266.eds");
    let model = brushwork_mcp_wire::models::lookup("mcp266").unwrap();
    std::fs::write(&sheet, brushwork_mcp_wire::canopen::data_sheet(model, Generation::Gen1).unwrap())
        .unwrap();
    let sheet = sheet.display().to_string();
    let findings = foreign::run("canopen_check.py", &port, &["3", &sheet], &mut controller);
    print(&findings);
    println!("{} findings", findings.findings.len());
    assert!(findings.failures().is_empty(), "{:#?}", findings.failures());
    assert!(findings.findings.len() >= 31, "the script checked only {} things", findings.findings.len());
}

#[test]
fn every_generation_has_the_widths_that_public_clients_expect() {
    if foreign::is_left_out("python") {
        return;
    }
    for generation in Generation::ALL {
        let mut controller = OnPty::start(generation);
        let port = controller.port();
        let number = generation.number().to_string();
        let findings = foreign::run("generations_check.py", &port, &[&number], &mut controller);
        println!("{generation}: {} findings", findings.findings.len());
        assert!(findings.failures().is_empty(), "{generation}: {:#?}", findings.failures());
        assert!(findings.findings.len() >= 25, "{generation}: only {}", findings.findings.len());
    }
}

#[test]
fn five_controllers_on_one_line_do_each_what_a_foreign_client_tells_it() {
    if foreign::is_left_out("python") {
        return;
    }
    for generation in Generation::ALL {
        let mut line = OnPty::line_of(generation, &[0x80, 0x81, 0x82, 0x83, 0x84]);
        let port = line.port();
        let findings = foreign::run("rover_check.py", &port, &["0x80", "5"], &mut line);
        assert!(findings.failures().is_empty(), "{generation}: {:#?}", findings.failures());
        assert_eq!(findings.findings.len(), 7, "{generation}");
    }
}
