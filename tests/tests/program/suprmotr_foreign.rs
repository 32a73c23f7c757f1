//! Clients that share no line of code with this project against simulated SuprMotrs: a driver for a sister controller over TCP, and one that
//! was written from the manual on a pseudo-terminal.
#![cfg(unix)]

use std::path::PathBuf;

use brushwork_child::ahead;
use brushwork_plant::server::{Endpoint, Server, ServerOptions, SimHandle};
use brushwork_suprmotr_sim::{SuprMotr, SuprMotrBus, SuprMotrConfig};
use brushwork_suprmotr_wire::{Address, ReportForm};
use brushwork_tests::foreign::{self, Simulated};
use serde_json::Value;

/// Boards as the driver wants them: the letter alone in front of reports, no echo.
fn config(number: u8) -> SuprMotrConfig {
    let mut config = SuprMotrConfig::new(Address::new(number).expect("there are 16"));
    config.eeprom.parameters.has_echo = false;
    config.reply_form = ReportForm::Id;
    config
}

struct Line(SimHandle<SuprMotrBus>);

impl Simulated for Line {
    fn truth(&mut self) -> Value {
        serde_json::to_value(&*self.0.views()).expect("views are data")
    }

    fn act(&mut self, action: &str) -> Result<(), String> {
        Err(format!("no action `{action}`"))
    }
}

#[test]
fn the_python_driver_of_a_sister_controller_drives_two_boards() {
    if foreign::is_left_out("python") {
        return;
    }
    let units = [0, 3].map(|number| SuprMotr::new(config(number)).unwrap());
    // It asks twelve addresses that no board has, and the silence that tells it so would be seconds on a pseudo-terminal, which may be late.
    let endpoint = Endpoint::Tcp("127.0.0.1:0".parse().unwrap());
    let server =
        ahead(|| Server::spawn(SuprMotrBus::new(units.into()), ServerOptions::default(), &endpoint)).unwrap();
    let port = PathBuf::from(format!("socket://{}", server.address().trim_start_matches("tcp:")));
    let findings = foreign::run("mercury_check.py", &port, &[], &mut Line(server));
    assert!(findings.failures().is_empty(), "{:#?}", findings.failures());
    assert_eq!(findings.findings.len(), 24, "every method was looked at");
}

#[test]
fn a_client_written_from_the_manual_alone_gets_what_the_manual_says() {
    if foreign::is_left_out("python") {
        return;
    }
    let forms = [("full", ReportForm::Full), ("address", ReportForm::Address), ("id", ReportForm::Id)];
    let check = |echo: &str, name: &str, form: ReportForm| {
        let folder = tempfile::tempdir().unwrap();
        let port = folder.path().join("line");
        let mut config = SuprMotrConfig::new(Address::FACTORY);
        config.eeprom.parameters.has_echo = echo == "on";
        config.reply_form = form;
        let board = SuprMotr::new(config).unwrap();
        let endpoint = Endpoint::Pty { link: port.clone() };
        let server =
            ahead(|| Server::spawn(SuprMotrBus::new(vec![board]), ServerOptions::default(), &endpoint))
                .unwrap();
        let findings = foreign::run("suprmotr_manual_check.py", &port, &[name, echo], &mut Line(server));
        assert!(findings.failures().is_empty(), "{name}, echo {echo}: {:#?}", findings.failures());
        assert_eq!(findings.findings.len(), 80, "{name}: everything was looked at");
    };
    // Most of it is waiting for what must not come and for moves, so that they do it at once.
    std::thread::scope(|scope| {
        for (echo, (name, form)) in ["on", "off", "off"].into_iter().zip(forms) {
            scope.spawn(move || check(echo, name, form));
        }
    });
}
