//! The page of help on the Motion Mind 3: how to connect, drive and tune it, and its commands, registers and bits from the tables.

use std::sync::OnceLock;

use brushwork_motion_mind_wire::{BitEntry, CommandEntry, RegisterEntry, reference};
use egui::{Label, Ui};

use crate::help::list::{Entry, list_ui};
use crate::help::scrolled_ui;
use crate::model::help::Help;
use crate::motion_mind::messages::RegisterMessage;
use brushwork_core::words::capital;

/// What a person has to know beside the tables (Motion Mind manual, chapters 3 to 6).
const GUIDE: [(&str, &[&str]); 8] = [
    (
        "Connect",
        &[
            "Ports run at 9600 or 19,200 baud, 8 bits, no parity, one stop bit: switch 5 of SW1 says which. 38,400 and 115,200 are bits of \
             FUNCTION2, which count after they were stored and the power was off. Give another rate behind the port: /dev/ttyUSB0,baud=38400.",
            "Choose Motion Mind as the family at the left, or leave both. The addresses 1 to 98 are searched, in binary and in text, \
             whichever switch 6 has chosen; a unit whose address is known is found at once. Several units may share the line: each is \
             listed and selected by itself.",
            "Connecting reads registers and moves nothing.",
        ],
    ),
    (
        "Modes and switches",
        &[
            "Switches 2 to 4 of SW1 choose at power-up what moves the motor; a switch that is off counts 1.",
            "0 R/C pulses; 1 a voltage; 2 two buttons; 3 serial, open loop: the Duty screen; 4 serial PID with the encoder: the Velocity and \
             Position screens; 5 analog PID: the Position screen where ADSERIAL is set; 6 factory restore, with both limit inputs at \
             ground; 7 the maker's test.",
            "Screens that do nothing in a mode are not shown. Motion says what to set instead.",
        ],
    ),
    (
        "RAM and EEPROM",
        &[
            "Registers shows both side by side. Write sends edits to RAM, with a backup before and everything read back. Save to EEPROM \
             writes register by register those that differ; the motor stops for up to 40 ms each time. An EEPROM lasts about a million \
             writes.",
            "No command reads EEPROM. It is known after a save, or after Load from EEPROM, which restarts the unit and stops the motor.",
            "Restore brings the factory's values back, in RAM and in EEPROM, and the address 1 with them.",
        ],
    ),
    (
        "Stopping",
        &[
            "A Motion Mind has no serial time-out: a motor goes on with what it was told last when the cable or the computer dies. Have a \
             switch for its power at hand, or set VNLIMIT and VPLIMIT. During guided tuning they are kept just ahead of the motor.",
            "Stop All, Esc and, but where words are typed, Space send every unit a standstill and look whether the motor stands. A loop that does \
             not hold its motor still is switched off (DISABLEPID, in RAM) until the motor stands, then on again to hold it there. If it does not do that either, it \
             stays off, which is said, until a screen is armed again.",
            "The brake input at ground switches the bridge off, whatever is commanded.",
        ],
    ),
    (
        "Tuning",
        &[
            "Guided tuning works in mode 4 with an encoder, on the Velocity and Position screens. It checks the wiring, measures the motor \
             without a loop, designs PTERM, ITERM, DTERM, PIDSCALAR, VELOCITYFF and DEADBAND, and tries them.",
            "There is one set of registers: gains tuned for velocities serve positions too, and the other way round. Tune last what you use.",
            "VELOCITYFF ends at 255, which is little on most motors; the page says which share of the duty it gives. The loop does the rest.",
        ],
    ),
    (
        "Step response by hand",
        &[
            "The tab Step response on Position is the manual's recipe: clear VELOCITYFF, ITERM, DTERM, VELLIMIT and SATPROT; step by about one \
             turn of the encoder; find PTERM and PIDSCALAR, then ITERM, then DTERM; try other steps. It works in mode 5 too.",
            "One step of PIDSCALAR is a factor of two. Put all back undoes everything that the assistant has changed.",
        ],
    ),
    (
        "R/C calibration",
        &[
            "In mode 0, Inputs and R/C finds RCMAX, RCMIN and RCBAND: leave the stick in the middle and trim it to 1.500 ms, push it fully \
             forward, pull it fully back, and write what was found. In the position sub-mode (RCPOS) the ends lie a little inside, so that \
             the full scale is reached.",
        ],
    ),
    (
        "Terminal",
        &[
            "Commands as the manual prints them: R01 04 reads PTERM of unit 1, W01 04 6000 writes it to RAM, S01 04 6000 stores it, or the same \
             in hex. They go out in the protocol that the unit speaks. What is no command can be sent as typed.",
            "Z, the self-test, is never sent: a unit is dead after it until its power was off. What moves the motor needs an armed screen.",
        ],
    ),
];

/// One entry: how it is found, and what it says, paragraph by paragraph.
struct Page {
    entry: Entry,
    lines: Vec<String>,
}

pub fn motion_mind_ui(ui: &mut Ui, help: &mut Help) {
    static PAGES: OnceLock<Vec<Page>> = OnceLock::new();
    static ENTRIES: OnceLock<Vec<Entry>> = OnceLock::new();
    let pages = PAGES.get_or_init(pages);
    let copy = |page: &Page| Entry {
        key: page.entry.key.clone(),
        title: page.entry.title.clone(),
        words: page.entry.words.clone(),
    };
    let entries = ENTRIES.get_or_init(|| pages.iter().map(copy).collect());
    list_ui(ui, entries, help);
    let chosen = pages.iter().find(|page| Some(page.entry.key.as_str()) == help.entry.as_deref());
    scrolled_ui(ui, |ui| match chosen {
        Some(page) => page_ui(ui, page),
        None => {
            ui.weak("Choose a subject, a command or a register at the left.");
            for (title, lines) in &GUIDE[..2] {
                guide_ui(ui, title, lines.iter().copied());
            }
        }
    });
}

fn guide_ui<'a>(ui: &mut Ui, title: &str, lines: impl Iterator<Item = &'a str>) {
    ui.add_space(6.0);
    ui.strong(title);
    for line in lines {
        ui.add(Label::new(line).wrap());
        ui.add_space(3.0);
    }
}

fn page_ui(ui: &mut Ui, page: &Page) {
    ui.heading(&page.entry.title);
    for line in &page.lines {
        ui.add_space(3.0);
        ui.add(Label::new(line).wrap());
    }
}

fn page(key: String, title: String, lines: Vec<String>) -> Page {
    let words = format!("{title} {}", lines.join(" ")).to_lowercase();
    Page { entry: Entry { key, title, words }, lines }
}

fn pages() -> Vec<Page> {
    let reference = reference();
    let guide = GUIDE.iter().map(|(title, lines)| {
        page(
            format!("guide:{title}"),
            (*title).to_owned(),
            lines.iter().map(|line| (*line).to_owned()).collect(),
        )
    });
    let commands = reference.commands.iter().map(command_page);
    let registers = reference.registers.iter().map(|register| {
        register_page(register, reference.bits.iter().filter(|bit| bit.register == register.name))
    });
    guide.chain(commands).chain(registers).collect()
}

fn command_page(command: &CommandEntry) -> Page {
    let mut lines = vec![
        format!("{}.", capital(command.help.trim_end_matches('.'))),
        RegisterMessage::Binary { frame: command.frame.to_string() }.to_string(),
    ];
    match command.line.is_empty() {
        true => lines.push("It has no form in text.".to_owned()),
        false => lines.push(RegisterMessage::Text { line: command.line.to_string() }.to_string()),
    }
    page(format!("command:{}", command.number), command.name.to_owned(), lines)
}

fn register_page<'a>(register: &RegisterEntry, bits: impl Iterator<Item = &'a BitEntry>) -> Page {
    let access =
        if register.writable { "Written by WRITE and WRITE_STORE." } else { "The unit alone changes it." };
    let bytes = super::registers::width_text(register.bytes);
    let range = RegisterMessage::Range { min: register.min, max: register.max }.to_string();
    let unit = match register.unit {
        "" => String::new(),
        unit => RegisterMessage::Step { scale: register.scale, unit }.to_string(),
    };
    let default =
        register.default.map_or_else(String::new, |value| RegisterMessage::Factory { value }.to_string());
    let facts = [access.to_owned(), bytes, range, unit, default];
    let facts: Vec<String> = facts.into_iter().filter(|fact| !fact.is_empty()).collect();
    let mut lines = vec![format!("{}.", capital(register.help.trim_end_matches('.'))), facts.join(" ")];
    lines.extend(
        bits.map(|bit| {
            RegisterMessage::Bit { bit: bit.bit, name: bit.name, means: bit.set_means }.to_string()
        }),
    );
    page(format!("register:{}", register.number), format!("{} {}", register.number, register.name), lines)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_register_command_and_subject_has_a_page_that_can_be_found_by_what_it_says() {
        let pages = pages();
        assert!(pages.len() > 32 + 9 + GUIDE.len(), "{}", pages.len());
        let found = |words: &str| {
            let hit = pages.iter().filter(|page| page.entry.words.contains(words));
            hit.map(|page| page.entry.title.clone()).collect::<Vec<_>>()
        };
        assert!(found("satprot").contains(&"3 FUNCTION".to_owned()));
        assert!(found("time-out").contains(&"Stopping".to_owned()));
        let mut keys: Vec<&str> = pages.iter().map(|page| page.entry.key.as_str()).collect();
        keys.sort_unstable();
        assert!(keys.windows(2).all(|pair| pair[0] != pair[1]), "two entries of one name");
    }
}
