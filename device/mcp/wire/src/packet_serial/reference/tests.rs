//! The page has every row, and says of each what the table says.

use super::super::number;
use super::super::table::lookup;
use super::words::scale_words;
use super::*;

#[test]
fn the_page_has_a_section_for_every_command() {
    let page = page();
    for command in COMMANDS {
        let head = format!("### {} {} ({})\n", command.number, command.title, command.key);
        assert_eq!(page.matches(&head).count(), 1, "{head}");
        assert!(page.contains(&section(command)));
    }
    for row in &CONDITIONS {
        assert!(page.contains(&format!("| {} |", row.title)));
    }
}

#[test]
fn a_section_says_widths_units_and_traps() {
    let section = section(lookup(number::SET_MAIN_VOLTAGES).expect("in the table"));
    let expected = "\
### 57 main voltage limits (set_main_voltages)

- generation 1 to 3, write: [min u16, max u16] -> 0xFF.
  - min: u16; 1 raw = 0.1 V; voltage in tenths of a volt
  - max: u16; 1 raw = 0.1 V; voltage in tenths of a volt
- generation 4, write: [min u16, max u16, auto_offset u8] -> 0xFF.
  - min: u16; 1 raw = 0.1 V; voltage in tenths of a volt
  - max: u16; 1 raw = 0.1 V; voltage in tenths of a volt
  - auto_offset: u8; 1 raw = 0.1 V; automatic offset in tenths of a volt

Source: MCP manual 2.3.1. The simulated controller only stores the automatic offset of generation 4.
";
    assert_eq!(section, expected);
}

#[test]
fn what_is_only_stored_and_what_is_never_sent_is_listed_with_its_reason() {
    let page = page();
    let (_, stored) = page.split_once("## Stored or without effect").expect("the heading");
    let (stored, never) = stored.split_once("## Never sent by this program").expect("the heading");
    let (never, guessed) = never.split_once("## Never sent to a controller").expect("the heading");
    for command in COMMANDS {
        let start = format!("\n- {} {}: ", command.number, command.title);
        assert_eq!(stored.contains(&start), command.simulated != Simulated::Acts, "{}", command.key);
        assert_eq!(never.contains(&start), matches!(command.client, ClientUse::Never(_)), "{}", command.key);
        assert_eq!(guessed.contains(&start), command.forms.iter().any(|form| form.assumed.is_some()));
    }
}

#[test]
fn the_rows_say_what_the_table_says() {
    let reference = reference();
    assert_eq!(reference.commands.len(), COMMANDS.len());
    assert_eq!(reference.status.len(), CONDITIONS.len());
    for (entry, command) in reference.commands.iter().zip(COMMANDS) {
        assert_eq!((entry.number, entry.key), (command.number, command.key));
        for (entry, form) in entry.forms.iter().zip(command.forms) {
            assert_eq!(entry.request.len(), form.request.len());
            assert_eq!(entry.reply_bytes, form.reply.width());
        }
    }
    let signals = &reference.commands[usize::from(number::READ_SIGNALS)].forms;
    let records: Vec<usize> = signals.iter().map(|form| form.reply[0].record.len()).collect();
    assert_eq!(records, [15, 16, 17]);
}

#[test]
fn scales_read_as_one_says_them() {
    let words = |number: u8, name: &str| {
        let form = lookup(number).and_then(|row| row.form(Generation::Gen3)).expect("in the table");
        let fields = form.request.iter().chain(form.reply.fields());
        fields.clone().find(|field| field.name == name).map(scale_words).expect("in the layout")
    };
    assert_eq!(words(number::SET_VELOCITY_PID_M1, "p"), "65536 raw = 1.0");
    assert_eq!(words(number::DUTY_M1, "duty"), "32767 raw = 100 %");
    assert_eq!(words(number::DUTY_ACCEL_M1, "accel"), "32768 raw = 100 %/s");
    assert_eq!(words(number::READ_CURRENTS, "current_m1"), "1 raw = 0.01 A");
    assert_eq!(words(number::SET_INDUCTANCE_RESISTANCE_M1, "inductance"), "16777216 raw = 1 H");
    assert_eq!(words(number::SET_HOMING_M1, "timeout"), "300 raw = 1 s");
    assert_eq!(words(number::READ_ENCODERS, "encoder_m1"), "in counts");
    assert_eq!(words(number::SET_PRIORITIES, "level_1"), "");
}
