//! What help pages say of families: their examples, targets and names. No page names a family itself.

use brushwork_link::family::addresses_text;

use super::family::families;

/// The end of a command's page: its examples, in which `{sim}` is a simulated controller, those of families after the others, and what
/// else is to be known.
pub fn after(command: &str, shared: &[&str], note: &str) -> String {
    let own = families().iter().flat_map(|family| family.examples().lines);
    let of_command = own.filter(|line| line.split(' ').next() == Some(command));
    let lines = shared.iter().chain(of_command).map(|line| {
        let piped = line.rsplit_once("| ").map(|(pipe, line)| (format!("{pipe}| "), line));
        let (pipe, line) = piped.unwrap_or((String::new(), line));
        format!("\n  {pipe}brushwork {}", line.replace("{sim}", target()))
    });
    let note = if note.is_empty() { String::new() } else { format!("\n\n{note}") };
    format!("Examples:{}{note}", lines.collect::<String>())
}

/// The end of the page of `brushwork terminal`.
pub fn terminal_help() -> String {
    let typed = families().iter().map(|family| family.examples().typed).filter(|typed| !typed.is_empty());
    let typed = typed.map(|typed| format!("\n{typed}")).collect::<String>();
    let note = "Without commands each line of standard input is one. Commands that move the motor are refused; use `brushwork drive`.";
    after("terminal", &[], &format!("{note}{typed}"))
}

/// The model that is simulated where none is named.
pub fn model() -> &'static str {
    families().first().map_or("", |family| family.examples().model)
}

/// It as a target.
pub fn target() -> &'static str {
    kept(format!("sim:{}", model()))
}

/// Two of it on a simulated CAN bus.
pub fn bus() -> &'static str {
    kept(format!("{},can", target()))
}

/// What `--family` takes.
pub fn names(first: &[&str]) -> &'static str {
    let keys = families().iter().map(|family| family.family().key());
    kept(first.iter().copied().chain(keys).collect::<Vec<_>>().join("|"))
}

/// What the program is for, in a sentence.
pub fn about() -> String {
    let labels = families().iter().map(|family| family.family().label());
    format!(
        "Configures, drives and tunes brushed-DC motor controllers ({}).\nWithout a command the window opens.",
        labels.collect::<Vec<_>>().join(", ")
    )
}

/// What `--connect` takes.
pub fn connect_help() -> String {
    let options = families().first().map_or("", |family| family.examples().options);
    let others = families().iter().skip(1).map(|family| {
        let (examples, known) = (family.examples(), family.family());
        format!(
            "; a {} as sim:{}{} or with ,family={} behind its port",
            known.label(),
            examples.model,
            examples.options,
            known.key()
        )
    });
    format!(
        "{}{options}, /dev/ttyACM0, /dev/ttyUSB0,baud=115200,stream=ttl1, COM3 or tcp:HOST:PORT; a CANopen bus as \
         can:PORT[,node=3,form=binary]{}. ,latency=800 lets replies take 800 ms; up to 500 ms are found out",
        target(),
        others.collect::<String>()
    )
}

/// The same for a whole line.
pub fn line_help() -> String {
    format!(
        "As for the other commands: {}, /dev/ttyACM0, /dev/ttyUSB0,baud=115200,stream=ttl1, COM3, tcp:HOST:PORT or can:PORT",
        target()
    )
}

/// What the window's `--open` takes.
pub fn open_help() -> String {
    format!("Connect at once: {}, a port such as /dev/ttyACM0 or COM3, or tcp:HOST:PORT", target())
}

/// What `--address` of simulated units takes.
pub fn unit_help() -> String {
    let units =
        "Address, a comma-separated list or a range (0x80-0x84): one simulated unit for each, on one line";
    format!("{units}: {}", addresses_text())
}

/// A text for as long as the program runs, as pages need it.
fn kept(text: String) -> &'static str {
    Box::leak(text.into_boxed_str())
}
