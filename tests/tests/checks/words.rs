//! Keeps the vocabulary: what people read has one name for each act and thing, as the table in CONTRIBUTING.md says.

use std::collections::BTreeSet;

use brushwork_tests::workspace;

/// One row of the table: the name, and what is not to be said in its place.
struct Name {
    say: String,
    not: Vec<String>,
}

fn table() -> Vec<Name> {
    let text = workspace::read("CONTRIBUTING.md");
    let from = text.split("| Say | Of | Not |").nth(1).expect("the table is there");
    let rows = from.lines().skip(2).take_while(|line| line.starts_with("| "));
    rows.map(|row| {
        let cells: Vec<&str> = row.trim_matches('|').split(" | ").map(str::trim).collect();
        let [say, _, not] = cells[..] else { panic!("three columns: {row}") };
        let not = not.split(", ").map(str::to_lowercase).collect();
        Name { say: say.to_owned(), not }
    })
    .collect()
}

/// The string literals of a source's shipped part, with the line of each: no comments, no messages to programmers.
fn literals(source: &str) -> Vec<(usize, String)> {
    let shipped = source.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let mut found = Vec::new();
    let letters: Vec<char> = shipped.chars().collect();
    let starts =
        |at: usize, text: &str| text.chars().enumerate().all(|(n, c)| letters.get(at + n) == Some(&c));
    let (mut at, mut line) = (0, 1);
    while at < letters.len() {
        match letters[at] {
            '\n' => {
                line += 1;
                at += 1;
            }
            '/' if starts(at, "//") => {
                while at < letters.len() && letters[at] != '\n' {
                    at += 1;
                }
            }
            // A letter in quotes, which may be a quote itself; a lifetime has no second one.
            '\'' if letters.get(at + 1) == Some(&'\\') => at += 4,
            '\'' if letters.get(at + 2) == Some(&'\'') => at += 3,
            'r' if starts(at, "r#\"") => {
                let text: String = letters[at + 3..].iter().collect();
                let end = text.find("\"#").unwrap_or(text.len());
                line += text[..end].matches('\n').count();
                at += 3 + text[..end].chars().count() + 2;
                found.push((line, text[..end].to_owned()));
            }
            '"' => {
                let begun = at;
                let (text, end) = quoted(&letters, at + 1);
                line += letters[at..end].iter().filter(|letter| **letter == '\n').count();
                let before: String = letters[begun.saturating_sub(24)..begun].iter().collect();
                if !to_programmers(&before) {
                    found.push((line, text));
                }
                at = end;
            }
            _ => at += 1,
        }
    }
    found
}

/// A quoted text from behind its first quote, its breaks taken out, and where it ends.
fn quoted(letters: &[char], mut at: usize) -> (String, usize) {
    let mut text = String::new();
    while let Some(letter) = letters.get(at) {
        match (letter, letters.get(at + 1)) {
            ('"', _) => return (text, at + 1),
            ('\\', Some('\n')) => {
                at += 2;
                while letters.get(at).is_some_and(|letter| letter.is_whitespace()) {
                    at += 1;
                }
            }
            ('\\', Some(next)) => {
                text.push(if *next == 'n' { '\n' } else { *next });
                at += 2;
            }
            (letter, _) => {
                text.push(*letter);
                at += 1;
            }
        }
    }
    (text, at)
}

/// What stands before a text that only a programmer ever reads.
fn to_programmers(before: &str) -> bool {
    let dense = before.trim_end();
    ["expect(", "panic!(", "unreachable!(", "reason =", "include_str!(", "cfg(", "rename ="]
        .iter()
        .any(|end| dense.ends_with(end))
}

/// Whether a text has these words, and not as a part of others.
fn says(text: &str, words: &str) -> bool {
    let lower = text.to_lowercase().replace('\n', " ");
    let is_edge = |letter: Option<char>| {
        letter.is_none_or(|letter| !letter.is_alphanumeric() && letter != '-' && letter != '_')
    };
    lower.match_indices(words).any(|(at, _)| {
        is_edge(lower[..at].chars().next_back()) && is_edge(lower[at + words.len()..].chars().next())
    })
}

/// The texts that people read, with where they stand: of the program and of its front page.
fn texts() -> Vec<(String, String)> {
    let is_shipped = |path: &String| {
        let roots = ["app/", "device/", "tuning/src/"];
        roots.iter().any(|root| path.starts_with(root))
            && path.contains("/src/")
            && !path.contains("/tests/")
            && !path.ends_with("/tests.rs")
    };
    let mut texts = Vec::new();
    for path in workspace::rust_files().into_iter().filter(is_shipped) {
        let of_file = literals(&workspace::read(&path));
        texts.extend(of_file.into_iter().map(|(line, text)| (format!("{path}:{line}"), text)));
    }
    let lines = workspace::read("README.md");
    texts.extend(
        lines.lines().enumerate().map(|(at, line)| (format!("README.md:{}", at + 1), line.to_owned())),
    );
    texts
}

#[test]
fn texts_are_read_as_people_read_them() {
    let source = "// \"nobody\"\nlet a = '\"'; say(\"No unit \\\n     answers.\"); b.expect(\"nobody\"); r#\"a \"raw\" one\"#; 'x'";
    let read: Vec<String> = literals(source).into_iter().map(|(_, text)| text).collect();
    assert_eq!(read, ["No unit answers.", "a \"raw\" one"]);
    assert!(says("Nobody answers.", "nobody") && says("Save, at power up.", "at power up"));
    assert!(!says("a set-point", "point") && !says("burner", "burn") && !says("--learn-anew", "anew"));
}

#[test]
fn the_table_has_each_name_once_and_none_of_them_is_one_not_to_be_said() {
    let table = table();
    assert!(table.len() > 20, "{}", table.len());
    let names: BTreeSet<&str> = table.iter().map(|name| name.say.as_str()).collect();
    assert_eq!(names.len(), table.len());
    for name in &table {
        for other in table.iter().flat_map(|other| &other.not) {
            assert!(!says(&name.say, other), "{} is both said and not said", name.say);
        }
    }
}

#[test]
fn what_people_read_has_one_name_for_each_act_and_thing() {
    let (table, texts) = (table(), texts());
    println!("{} texts", texts.len());
    assert!(texts.len() > 5000, "{}: the texts are not found any more", texts.len());
    let mut faults = Vec::new();
    for (place, text) in &texts {
        for name in &table {
            let said = name.not.iter().filter(|words| says(text, words));
            faults.extend(
                said.map(|words| format!("{place}: \"{words}\" where it is \"{}\": {text}", name.say)),
            );
        }
    }
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}
