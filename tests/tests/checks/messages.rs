//! Keeps what is said to people in tables: each message known by one key, each sentence written once.

use brushwork_tests::workspace;
use std::collections::{BTreeMap, BTreeSet};

/// One member of a `messages!` table.
struct Said {
    key: String,
    words: String,
}

/// Every message of the program, by reading the tables in the sources.
fn said() -> Vec<Said> {
    let files = workspace::rust_files().into_iter().filter(|path| path.ends_with("/messages.rs"));
    files.filter(|path| path.contains("/src/")).flat_map(|path| of_file(&workspace::read(&path))).collect()
}

fn of_file(source: &str) -> Vec<Said> {
    let mut found = Vec::new();
    let mut theme = "";
    for line in source.lines() {
        if let Some(name) = line.strip_prefix("    pub enum ") {
            theme = name.trim_end_matches(" {");
        } else if let Some((head, words)) = line.strip_suffix("\",").and_then(|line| line.split_once(" \"")) {
            let member = head.split_whitespace().next().unwrap_or_default();
            found.push(Said { key: format!("{theme}.{member}"), words: words.to_owned() });
        }
    }
    found
}

/// The keys that share what `of` tells, where more than one does.
fn shared(said: &[Said], of: impl Fn(&Said) -> &str) -> Vec<Vec<&str>> {
    let mut by: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for one in said {
        by.entry(of(one)).or_default().push(&one.key);
    }
    by.into_values().filter(|keys| keys.len() > 1).collect()
}

#[test]
fn each_message_has_a_key_of_its_own() {
    let said = said();
    println!("{} messages of {} themes", said.len(), themes(&said));
    assert!(said.len() > 100, "the tables are not found any more");
    assert_eq!(shared(&said, |one| &one.key), Vec::<Vec<&str>>::new());
}

#[test]
fn no_two_messages_have_the_same_words() {
    assert_eq!(shared(&said(), |one| &one.words), Vec::<Vec<&str>>::new());
}

fn themes(said: &[Said]) -> usize {
    let mut themes: Vec<_> = said.iter().filter_map(|one| one.key.split('.').next()).collect();
    themes.dedup();
    themes.len()
}

/// The messages are all in files of that name, so that a catalogue can be made of them: nothing defines one elsewhere.
#[test]
fn tables_of_messages_stand_in_files_of_that_name() {
    let is_table = |path: &String| {
        let source = workspace::read(path);
        source.lines().any(|line| line.trim_start() == "messages! {")
    };
    let elsewhere: Vec<_> = workspace::rust_files()
        .into_iter()
        .filter(|path| path.contains("/src/") && !path.ends_with("/messages.rs") && is_table(path))
        .filter(|path| path != "device/values/src/message.rs" && !path.starts_with("tests/"))
        .collect();
    assert_eq!(elsewhere, Vec::<String>::new());
}

/// The crates whose sentences are all messages, and the names of fields that hold some.
const TYPED: [&str; 8] = [
    "device/link/",
    "device/family/",
    "device/mcp/client/",
    "device/motion_mind/client/",
    "device/suprmotr/client/",
    "device/motorvator/client/",
    "app/core/",
    "app/gui/",
];
const SENTENCES: [&str; 10] = [
    "summary",
    "sentence",
    "warnings",
    "notes",
    "came_back",
    "remedy",
    "cure",
    "left_out",
    "upgraded",
    "still_driven_by",
];

#[test]
fn what_people_read_is_no_bare_text() {
    let is_typed = |path: &String| TYPED.iter().any(|krate| path.starts_with(krate));
    let holds_text = |line: &str| {
        let field = line.trim_start().trim_start_matches("pub ").split_once(": ");
        field.is_some_and(|(name, kind)| SENTENCES.contains(&name) && kind.contains("String"))
    };
    let mut bare = Vec::new();
    for path in workspace::rust_files().into_iter().filter(is_typed) {
        let source = workspace::read(&path);
        let lines = source.lines().filter(|line| holds_text(line));
        bare.extend(lines.map(|line| format!("{path}: {}", line.trim())));
    }
    assert_eq!(bare, Vec::<String>::new());
}

/// How the command line and the window's message line say something, each without white space. What follows may be no text; the
/// message line takes messages alone, so that the compiler keeps texts out that were made before.
const SAYING: [&str; 6] =
    ["say(", "saying(", "messages.note(", "messages.warn(", "messages.fail(", "Effect::say("];

#[test]
fn what_is_said_is_no_bare_text() {
    let mut bare = Vec::new();
    let mut said = 0;
    let is_face = |path: &String| path.starts_with("app/cli/src/") || path.starts_with("app/gui/src/");
    for path in workspace::rust_files().into_iter().filter(is_face) {
        let source = workspace::read(&path);
        let shipped = source.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
        let dense: String = shipped.chars().filter(|letter| !letter.is_whitespace()).collect();
        for saying in SAYING {
            for (at, _) in dense.match_indices(saying) {
                let rest = &dense[at + saying.len()..];
                // The line may have its gravity, or whose it is, before its words.
                let is_name = |letter: char| letter.is_alphanumeric() || "_:.".contains(letter);
                let mut words = rest;
                while let Some(after) = words.trim_start_matches(is_name).strip_prefix(',') {
                    words = after;
                }
                said += 1;
                if words.starts_with('"') || words.starts_with("format!(") {
                    bare.push(format!("{path}: {saying}{}", rest.chars().take(60).collect::<String>()));
                }
            }
        }
    }
    assert!(said > 150, "{said}: what says something is not found any more");
    assert_eq!(bare, Vec::<String>::new());
}

/// A value that is a word of a sentence cannot be translated with it: each such sentence is a message of its own.
#[test]
fn no_message_is_given_a_word_as_its_value() {
    let keys: BTreeSet<String> = said().into_iter().map(|one| one.key.replace('.', "::")).collect();
    let mut given = Vec::new();
    let mut made = 0;
    let is_shipped = |path: &String| path.contains("/src/") && !path.contains("/tests/");
    for path in workspace::rust_files().into_iter().filter(is_shipped) {
        let source = workspace::read(&path);
        let shipped = source.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
        for (at, _) in shipped.match_indices(" {") {
            let is_name = |letter: char| letter.is_alphanumeric() || letter == ':';
            let before = &shipped[..at];
            let name = &before[before.trim_end_matches(is_name).len()..];
            if !keys.contains(name) {
                continue;
            }
            made += 1;
            let values = braced(&shipped[at + 2..]);
            let words = values.split('"').skip(1).step_by(2).filter(|text| is_word(text));
            given.extend(words.map(|word| format!("{path}: {name} is given \"{word}\"")));
        }
    }
    assert!(made > 500, "{made}: where messages are made is not found any more");
    assert_eq!(given, Vec::<String>::new());
}

/// What stands before the brace that closes.
fn braced(text: &str) -> &str {
    let mut depth = 1;
    let end = text.find(|letter| {
        depth += i32::from(letter == '{') - i32::from(letter == '}');
        depth == 0
    });
    &text[..end.unwrap_or(text.len())]
}

/// Whether a text has a word outside of what it formats, that is no unit and not the name of a variable of the build.
fn is_word(text: &str) -> bool {
    let outside = text.split('{').map(|part| part.split_once('}').map_or(part, |(_, rest)| rest));
    let mut words = outside.flat_map(|part| part.split(|letter: char| !letter.is_alphabetic()));
    let is_one = |word: &str| word.chars().count() > 1 && word.chars().any(char::is_lowercase);
    words.any(|word| is_one(word) && !SYMBOLS.contains(&word))
}

/// What the window puts together and is no message: the file, and why.
const NO_MESSAGES: [(&str, &str); 3] = [
    ("app/gui/src/graph/picture/svg.rs", "elements of SVG"),
    ("app/gui/src/mcl/printer.rs", "commands of a shell"),
    ("app/gui/src/screens/start.rs", "a command to be typed"),
];

/// Units and symbols, which are the same in each language.
const SYMBOLS: [&str; 10] = ["ms", "kB", "MB", "min", "Hz", "baud", "div", "counts", "Ms", "Ctrl"];

/// Prose has words with spaces between them or a value; a key, a target or a file's name has none, and a figure only its unit.
fn is_prose(text: &str) -> bool {
    let mut is_outside = true;
    let outside = |letter: &char| {
        is_outside = *letter != '{' && (is_outside || *letter == '}');
        is_outside
    };
    let words: String = text.chars().filter(outside).collect();
    let mut words =
        words.split(|letter: char| !letter.is_alphabetic()).filter(|word| word.chars().count() > 1);
    text.contains(' ') && words.any(|word| !SYMBOLS.contains(&word))
}

/// What `format!` and its kin are given first, in the shipped part of a source: their text, without the breaks of its lines.
fn formats(source: &str) -> Vec<String> {
    let shipped = source.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let of = |name: &str| shipped.split(name).skip(1).filter_map(literal).collect::<Vec<_>>();
    ["format!(", "format_args!(", "write!(", "writeln!("].into_iter().flat_map(of).collect()
}

/// The text with which the arguments begin, after whatever is written to.
fn literal(arguments: &str) -> Option<String> {
    let (before, rest) = arguments.split_once('"')?;
    let is_target =
        |letter: char| letter.is_alphanumeric() || letter.is_whitespace() || "_.&,*".contains(letter);
    if !before.chars().all(is_target) {
        return None;
    }
    let mut text = String::new();
    let mut letters = rest.chars();
    loop {
        match letters.next()? {
            '"' => return Some(text),
            '\\' => match letters.next()? {
                '\n' => letters = letters.as_str().trim_start().chars(),
                escaped => text.extend(['\\', escaped]),
            },
            letter => text.push(letter),
        }
    }
}

#[test]
fn what_the_window_shows_with_values_is_no_bare_text() {
    let source = "let a = format!(\"sim:{key}\"); write!(f, \"{} of \\\n    {all}\", 1)";
    assert_eq!(formats(source), ["sim:{key}", "{} of {all}"]);
    assert!(
        is_prose("{} of {all}")
            && is_prose("Motor {motor}")
            && !is_prose("{:.1} ms")
            && !is_prose("{name}.json")
    );
    let is_shown = |path: &String| {
        path.starts_with("app/gui/src/")
            && !path.ends_with("messages.rs")
            && !path.ends_with("tests.rs")
            && !path.contains("/tests/")
    };
    let (mut bare, mut seen) = (Vec::new(), 0);
    let mut excepted: Vec<&str> = NO_MESSAGES.iter().map(|(path, _)| *path).collect();
    for path in workspace::rust_files().into_iter().filter(is_shown) {
        let formats = formats(&workspace::read(&path));
        seen += formats.len();
        let prose: Vec<_> = formats.into_iter().filter(|text| is_prose(text)).collect();
        match NO_MESSAGES.iter().any(|(other, _)| *other == path) {
            true if !prose.is_empty() => excepted.retain(|other| *other != path),
            true => {}
            false => bare.extend(prose.into_iter().map(|text| format!("{path}: {text}"))),
        }
    }
    assert!(seen > 200, "{seen}: what makes texts is not found any more");
    assert_eq!(bare, Vec::<String>::new());
    assert_eq!(excepted, Vec::<&str>::new(), "exceptions that are none any more");
}
