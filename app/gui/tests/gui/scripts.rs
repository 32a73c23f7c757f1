//! Scripts as the window shows them: what a real controller is refused and offered, that a script is told of on every screen, and what
//! the panel of the simulated world does to the buses of scripts.

use crate::support::bench::Bench;
use brushwork_gui::model::screen::Screen;
use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_plant::world::Content;
use brushwork_plant::world::{CanPeer, WorldAction};
use brushwork_script::image;
use brushwork_script::mcl::compile;
use egui::{Event, Key, Modifiers};
use egui_kittest::kittest::Queryable as _;

const FOREVER: &str = "main\npause 10\ngoto main\n";

fn compiled(text: &str) -> Vec<u8> {
    image::encode(&compile(text).program.expect("it compiles"))
}

fn holds(bench: &Bench) -> Content {
    bench.truth().script.expect("the unit has power").holds
}

/// A unit that runs this script after 100 ms by itself.
fn autorunning(text: &str) -> Controller {
    let config = ControllerConfig::default();
    let mut settings = Controller::new(config.clone()).expect("the default is sound").stored_settings();
    settings.unit.script_autorun_ms = 100;
    let config = ControllerConfig { settings: Some(settings), ..config };
    let mut unit = Controller::new(config).expect("a delay is sound");
    unit.install_script(&compiled(text));
    // Autorun is for a unit that is switched on with a script in it.
    for on in [false, true] {
        unit.apply(&WorldAction::Power { on }).expect("there is a switch");
    }
    unit
}

#[test]
fn a_real_controller_is_refused_what_is_compiled_here_and_offered_what_can_be_done() {
    let mut bench = Bench::new();
    bench.pass_for_real();
    bench.connect();
    bench.press("MCL Editor");
    bench.pass_ms(200);
    bench.model().mcl.open_named("forever.mcl", FOREVER);
    bench.pass_ms(200);
    bench.key(Key::F5);
    bench.pass_ms(500);
    for part in ["byte code of real controllers is not public", "started, stopped and set to autorun"] {
        assert!(bench.sees_part(part), "{part}");
    }
    assert!(bench.sees("Download the maker's image file"), "the way that is left is open");
    assert_eq!(holds(&bench), Content::Nothing, "nothing was sent");
    // The file of the maker's compiler: a header of 0x100 bytes, then what only the maker knows.
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("maker.bin");
    std::fs::write(&path, [0x1A; 0x140]).expect("a folder of ours");
    bench.harness.get_by_role_and_label(egui::accesskit::Role::TextInput, "Path").focus();
    bench.pass_ms(100);
    bench.harness.event(Event::Text(path.display().to_string()));
    bench.pass_ms(100);
    bench.key(Key::Enter);
    bench.until("the download is done", |bench| {
        bench.pass_ms(100);
        !bench.model().front.script.job.is_running() && holds(bench) == Content::Foreign
    });
    // An image of ours in a file is not sent either.
    std::fs::write(&path, compiled(FOREVER)).expect("a folder of ours");
    bench.key(Key::F5);
    bench.pass_ms(500);
    bench.harness.get_by_role_and_label(egui::accesskit::Role::TextInput, "Path").focus();
    bench.pass_ms(100);
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.harness.event(Event::Text(path.display().to_string()));
    bench.pass_ms(100);
    bench.key(Key::Enter);
    bench.pass_ms(2_000);
    assert!(bench.sees_part("Compile the script with the maker's Ion Studio"));
    assert_eq!(holds(&bench), Content::Foreign);
    bench.press("Arm");
    bench.pass_ms(500);
    assert!(bench.sees("Toolbar Start Script") && bench.sees("Toolbar Stop Script"));
}

#[test]
fn a_script_that_started_by_itself_is_told_on_every_screen_until_stop_all_ends_it() {
    let mut bench = Bench::of(autorunning(FOREVER));
    bench.pass_ms(500);
    bench.connect();
    bench.pass_ms(1_000);
    for screen in Screen::ALL {
        bench.model().screen = screen;
        bench.pass_ms(200);
        assert!(bench.sees_part("Script running"), "{}", screen.title());
    }
    bench.press("Stop All");
    bench.pass_ms(1_000);
    assert!(!bench.sees_part("Script running"));
    assert!(!bench.truth().script.expect("the unit has power").run.is_running());
}

#[test]
fn a_script_that_only_may_run_is_told_too() {
    let mut bench = Bench::of(autorunning(FOREVER));
    bench.pass_for_real();
    bench.connect();
    bench.until("the settings were read", |bench| {
        bench.pass_ms(200);
        bench.sees_part("Script may run (autorun)")
    });
}

#[test]
fn the_world_panel_holds_rts_and_moves_sensor_and_peer() {
    // High enough for the whole panel.
    let mut bench = Bench::sized([1280.0, 1800.0], egui::Theme::Dark);
    bench.connect();
    bench.press("Simulated world");
    bench.pass_ms(300);
    let rts = bench.truth().rts;
    bench.press("Hold RTS of the USB port");
    bench.pass_ms(300);
    assert_eq!(bench.truth().rts, !rts);
    bench.press("Hold RTS of the USB port");
    bench.press("Motion sensor MPU-6050 on I2C");
    bench.pass_ms(300);
    assert_eq!((bench.truth().rts, bench.truth().i2c.len()), (rts, 1));
    bench.press("Lay y up");
    bench.pass_ms(300);
    // Acceleration y stands in registers 0x3D and 0x3E; 16384 is 1 g.
    assert_eq!(bench.truth().i2c[0].registers[0x3D..0x3F], [0x40, 0]);
    bench.choose("CAN peer", "sends back what it hears");
    bench.pass_ms(300);
    assert_eq!(bench.truth().can_peer, CanPeer::Echoing);
    assert!(bench.sees_part("It heard last:"));
    bench.press("Motion sensor MPU-6050 on I2C");
    bench.pass_ms(300);
    assert!(bench.truth().i2c.is_empty());
}
