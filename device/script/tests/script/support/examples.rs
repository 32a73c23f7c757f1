//! The example programs of the manual; see `tests/manual.rs` for the form of their files.

/// One example of the manual.
pub struct Example<'a> {
    pub title: &'a str,
    pub corrections: Vec<(String, String)>,
    pub expected: Vec<&'a str>,
    pub text: String,
}

/// The examples of a file.
pub fn examples(file: &str) -> Vec<Example<'_>> {
    let mut examples: Vec<Example<'_>> = Vec::new();
    for line in file.lines() {
        if let Some(title) = line.strip_prefix("=== ") {
            examples.push(Example {
                title,
                corrections: Vec::new(),
                expected: Vec::new(),
                text: String::new(),
            });
            continue;
        }
        let Some(example) = examples.last_mut() else { continue };
        if let Some(correction) = line.strip_prefix("! ") {
            let (change, why) = correction.rsplit_once(" : ").expect("a correction says why");
            assert!(!why.trim().is_empty());
            let (from, to) = change.split_once(" -> ").expect("a correction says what for what");
            example.corrections.push((from.replace('~', "\n"), to.replace('~', "\n")));
        } else if let Some(expected) = line.strip_prefix("? ") {
            example.expected.push(expected);
        } else {
            example.text += line;
            example.text += "\n";
        }
    }
    examples
}

/// The program after its corrections.
pub fn corrected(example: &Example<'_>) -> String {
    let mut text = example.text.clone();
    for (from, to) in &example.corrections {
        if from == "^" {
            text.insert_str(0, to);
            continue;
        }
        assert!(text.contains(from.as_str()), "{}: nothing to correct: {from:?}", example.title);
        text = text.replacen(from.as_str(), to, 1);
    }
    text
}
