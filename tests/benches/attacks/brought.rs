//! Readers of the later families, and of what a person brings: a file that is dropped, text that is pasted or typed.

use std::path::Path;

use brushwork_cli::mcp::decoder::meanings;
use brushwork_core::known_file::recognise;
use brushwork_gui::mcl::doc_id::DocId;
use brushwork_gui::mcl::document::Document;
use brushwork_gui::mcp::model::composer::Composer;
use brushwork_link::exchange::Permit;
use brushwork_mcp_wire::packet_serial::{Address, COMMANDS, Generation};
use brushwork_motorvator_wire::host::{HostAnswer, HostOrder};
use brushwork_motorvator_wire::{Order, parse_line_of_board};
use brushwork_suprmotr_macros as macros;
use brushwork_suprmotr_wire as suprmotr;
use brushwork_tests::workspace;

pub fn lines_of_suprmotr() -> Vec<Vec<u8>> {
    let lines = ["\u{1}0MA100,WS,MD1\r", "MR-5000,WA100,RP5\r!'", "FE0,DI100,DP20\rTS\r"];
    lines.map(|line| line.as_bytes().to_vec()).to_vec()
}

pub fn reports_of_suprmotr() -> Vec<Vec<u8>> {
    let reports = ["0P:+0000012345\r\n\u{3}", "S:14 00 00 82 7F 00\r\n\u{3}", "0C: 00FF FFFF\r\n\u{3}"];
    // Which command it answers stands in front.
    reports.map(|report| [&[7_u8][..], report.as_bytes()].concat()).to_vec()
}

pub fn macros() -> Vec<Vec<u8>> {
    vec![b"const FAR = 20000\nmacro home = 1\n  FE 0\n  WS 0\n  DH\nend\n".to_vec()]
}

pub fn files_of_all_kinds() -> Vec<Vec<u8>> {
    let folder = workspace::root().join("tests/net/files");
    let entries = std::fs::read_dir(folder).expect("the net has files");
    let mut paths: Vec<_> =
        entries.flatten().map(|entry| entry.path()).filter(|path| path.is_file()).collect();
    paths.sort();
    paths.iter().map(|path| std::fs::read(path).expect("a file of the repository")).collect()
}

/// What a controller finds in what it receives; what it understands can be written again.
pub fn suprmotr_lines(bytes: &[u8]) {
    let mut reader = suprmotr::Reader::new();
    for byte in bytes {
        if let Some(suprmotr::Received::Line(line)) = reader.feed(*byte, true) {
            for radix in [suprmotr::Radix::Decimal, suprmotr::Radix::Hexadecimal] {
                let parsed = suprmotr::parse_line(&line, radix);
                drop(suprmotr::describe_line(&parsed.line));
                if parsed.error.is_none()
                    && parsed.line.commands.iter().all(|command| command.check().is_ok())
                {
                    parsed.line.encode(radix).expect("what came as a line goes as one");
                }
            }
        }
    }
}

pub fn suprmotr_reports(bytes: &[u8]) {
    let Some((first, report)) = bytes.split_first() else { return };
    let Some(mnemonic) = suprmotr::Mnemonic::from_number(*first) else { return };
    let command = suprmotr::Command::plain(mnemonic);
    for radix in [suprmotr::Radix::Decimal, suprmotr::Radix::Hexadecimal] {
        if let suprmotr::Progress::Done { report, used } =
            suprmotr::parse_report(&command, radix, b"TS\r", report)
        {
            assert!(used <= bytes.len());
            drop(suprmotr::describe_report(&report));
        }
    }
}

pub fn suprmotr_macros(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    drop(macros::check(&text));
    let once = macros::format(&text);
    assert_eq!(macros::format(&once), once, "one style");
}

pub fn motorvator_lines(bytes: &[u8]) {
    for line in bytes.split(|byte| *byte == b'\r') {
        drop((parse_line_of_board(line), HostAnswer::parse(line)));
        if let Some(Order::Data(frame)) = Order::of_line(line) {
            let _ = HostOrder::parse(&frame);
        }
    }
}

pub fn bytes_in_words(bytes: &[u8]) {
    drop(meanings(&String::from_utf8_lossy(bytes)));
}

/// The first byte chooses the command, the lines are its arguments.
pub fn composed(bytes: &[u8]) {
    let Some((first, text)) = bytes.split_first() else { return };
    let text = String::from_utf8_lossy(text);
    let command = &COMMANDS[usize::from(*first) % COMMANDS.len()];
    for generation in Generation::ALL {
        let mut composer = Composer::default();
        composer.choose(command.number, generation);
        for (argument, typed) in composer.arguments.iter_mut().zip(text.lines()) {
            typed.clone_into(argument);
        }
        composer.search = text.lines().next().unwrap_or_default().to_owned();
        let _ = composer.found(generation).count();
        drop(composer.prepare(Address::DEFAULT, generation, Permit::default()));
    }
}

pub fn dropped(path: &Path) {
    drop(recognise(path));
}

/// Text from the clipboard in the middle of a script, undone again.
pub fn pasted(bytes: &[u8]) {
    let mut document = Document::new(DocId(1), "a.mcl".to_owned(), "main\nend\n");
    document.go_to_line(1);
    let text = String::from_utf8_lossy(bytes);
    document.paste(&text);
    drop(document.cut());
    if !text.is_empty() {
        document.undo();
    }
    document.undo();
    assert_eq!(document.text.line_count(), 3, "all of it is gone again");
}
