//! The reference page as text, in plain Markdown.

use std::fmt::Write;

use super::super::command::{ClientUse, Command, Direction, Form, Reply, Simulated};
use super::super::identity::Generation;
use super::super::status::{CONDITIONS, StatusIndicator};
use super::super::table::COMMANDS;
use super::words::{field_words, generations, kind};
use brushwork_values::{Field, Kind};

const HEAD: &str = "\
# Packet serial

The binary protocol of the MCP and RoboClaw motor controllers, as the command table of this program has it.

A packet is an address (0x80 to 0x87), a command byte and arguments, all numbers big-endian. A **write** ends with a CRC
(CRC-16/XMODEM, high byte first) over everything before it and is answered with one byte 0xFF. A **read** has no CRC of
its own; one that is appended is ignored. Its reply is data and a CRC over address, command, arguments and data. A bad
CRC, an unknown command or a wrong length is not answered at all. A pause of more than 10 ms inside a packet discards it.

Firmware comes in four **generations** with different widths: 1 is the manual of 2014-2015, 2 the vendor's library of
2016-2017, 3 those of 2018-2020, 4 those of 2025. A reply tells neither its width nor the generation: the length of the
reply to command 90 does (4 bytes in 1 and 2, 6 bytes in 3 and 4).
";

/// The whole page.
pub fn page() -> String {
    let mut page = HEAD.to_owned();
    heading(&mut page, "Commands");
    for command in COMMANDS {
        page.push('\n');
        page.push_str(&section(command));
    }
    status_table(&mut page);
    exceptions(&mut page);
    page
}

/// The part of the page about one command.
pub fn section(command: &Command) -> String {
    let mut text = String::new();
    line(&mut text, &format!("### {} {} ({})", command.number, command.title, command.key));
    line(&mut text, "");
    if command.forms.is_empty() {
        line(&mut text, "No layout is public.");
    }
    for form in command.forms {
        form_lines(&mut text, form);
    }
    for fields in command.also_accepted {
        line(&mut text, &format!("- also taken: {}", layout(fields)));
    }
    let mut after = vec![format!("Source: {}.", command.source)];
    after.extend(Some(command.note.to_owned()).filter(|note| !note.is_empty()));
    after.extend(simulated(command.simulated));
    after.extend(client(command.client));
    line(&mut text, "");
    line(&mut text, &after.join(" "));
    text
}

fn form_lines(text: &mut String, form: &Form) {
    let direction = match form.direction {
        Direction::Read => "read",
        Direction::Write => "write",
    };
    let title = form.title.map(|title| format!(", \"{title}\"")).unwrap_or_default();
    let assumed = form.assumed.map(|why| format!(" Assumed: {why}.")).unwrap_or_default();
    line(
        text,
        &format!(
            "- generation {}{title}, {direction}: {} -> {}.{assumed}",
            generations(form),
            layout(form.request),
            reply(&form.reply)
        ),
    );
    let fields = form.request.iter().filter(|field| field.fixed.is_none()).chain(form.reply.fields());
    for field in fields {
        line(text, &format!("  - {}", field_words(field)));
        if let Kind::Counted(record) = field.kind {
            for field in record {
                line(text, &format!("    - {}", field_words(field)));
            }
        }
    }
}

/// `[d u32, p u32]`, or "nothing".
fn layout(fields: &[Field]) -> String {
    if fields.is_empty() {
        return "nothing".to_owned();
    }
    let parts: Vec<String> = fields
        .iter()
        .map(|field| match field.fixed {
            Some(fixed) => format!("{} {fixed:X}", field.name),
            None => format!("{} {}", field.name, kind(&field.kind)),
        })
        .collect();
    format!("[{}]", parts.join(", "))
}

fn reply(reply: &Reply) -> String {
    let fields = layout(reply.fields());
    match reply {
        Reply::Ack => "0xFF".to_owned(),
        Reply::Data(_) => format!("{fields} and CRC"),
        Reply::AckThenStatus(_) => format!("0xFF, then {fields} when the work is done"),
        Reply::AckThenData(_) => format!("0xFF, then {fields} and a CRC over these alone"),
    }
}

fn simulated(simulated: Simulated) -> Option<String> {
    match simulated {
        Simulated::Acts => None,
        Simulated::StoredOnly(why) => {
            Some(format!("The simulated controller stores and returns it only: {why}."))
        }
        Simulated::Inert(why) => Some(format!("In the simulated controller it has no effect: {why}.")),
        Simulated::Silent(why) => Some(format!("The simulated controller does not answer it: {why}.")),
    }
}

fn client(client: ClientUse) -> Option<String> {
    match client {
        ClientUse::Sends => None,
        ClientUse::Superseded(why) => Some(format!("This program has a better one: {why}.")),
        ClientUse::Never(why) => Some(format!("This program never sends it: {why}.")),
    }
}

fn status_table(page: &mut String) {
    heading(page, "Status bits (commands 90 and 73)");
    line(page, "");
    line(page, "| Condition | Severity | Indicator | Generation 1 | 2 | 3 | 4 |");
    line(page, "| --- | --- | --- | --- | --- | --- | --- |");
    for row in &CONDITIONS {
        let masks = Generation::ALL.map(|generation| match row.mask(generation) {
            0 => "-".to_owned(),
            mask => format!("0x{mask:X}"),
        });
        let indicator = row.indicator.map_or("-", StatusIndicator::abbreviation);
        let severity = format!("{:?}", row.severity).to_lowercase();
        line(page, &format!("| {} | {severity} | {indicator} | {} |", row.title, masks.join(" | ")));
    }
}

/// What is not as one might expect, gathered from all rows.
fn exceptions(page: &mut String) {
    heading(page, "Stored or without effect in the simulated controller");
    line(page, "");
    list(page, |command| match command.simulated {
        Simulated::Acts => None,
        Simulated::StoredOnly(why) => Some(format!("stored and returned only; {why}.")),
        Simulated::Inert(why) => Some(format!("no effect; {why}.")),
        Simulated::Silent(why) => Some(format!("not answered; {why}.")),
    });
    heading(page, "Never sent by this program");
    line(page, "");
    list(page, |command| match command.client {
        ClientUse::Never(why) => Some(format!("{why}.")),
        ClientUse::Sends | ClientUse::Superseded(_) => None,
    });
    heading(page, "Never sent to a controller that is not simulated");
    line(page, "");
    list(page, |command| {
        let guessed = command.forms.iter().find(|form| form.assumed.is_some())?;
        Some(format!("in generation {}: {}.", generations(guessed), guessed.assumed?))
    });
}

fn list(page: &mut String, words: impl Fn(&Command) -> Option<String>) {
    for command in COMMANDS {
        if let Some(words) = words(command) {
            line(page, &format!("- {} {}: {words}", command.number, command.title));
        }
    }
}

fn heading(page: &mut String, title: &str) {
    line(page, "");
    line(page, &format!("## {title}"));
}

fn line(text: &mut String, line: &str) {
    // Writing into a String cannot fail.
    let _ = writeln!(text, "{line}");
}
