//! Holds every crate of the lock file against the licence list of `deny.toml`, with no tool to install.
//!
//! `cargo deny check` does more (advisories, sources); `tests/run` uses it where it is installed.

use brushwork_tests::workspace::{self, Metadata};

/// The `allow = [...]` list of `deny.toml`.
fn allowed() -> Vec<String> {
    let text = workspace::read("deny.toml");
    let list = text.split("allow = [").nth(1).and_then(|rest| rest.split("\n]").next()).unwrap_or_default();
    list.lines()
        .filter_map(|line| line.trim().strip_prefix('"')?.split('"').next().map(str::to_owned))
        .collect()
}

/// Whether the expression can be met from the list: `OR` needs one side, `AND` both.
///
/// Parentheses appear in practice only around an `OR`, as in `(MIT OR Apache-2.0) AND Unicode-3.0`.
fn is_met(expression: &str, allowed: &[String]) -> bool {
    let expression = expression.replace('/', " OR ");
    split_outside_parentheses(&expression, " AND ").iter().all(|part| {
        let part = part.trim();
        let inner = part.strip_prefix('(').and_then(|part| part.strip_suffix(')')).unwrap_or(part);
        split_outside_parentheses(inner, " OR ").iter().any(|choice| {
            let choice = choice.trim();
            if choice.contains(" AND ") || choice.starts_with('(') {
                is_met(choice, allowed)
            } else {
                allowed.iter().any(|name| name == choice)
            }
        })
    })
}

fn split_outside_parentheses<'a>(text: &'a str, separator: &str) -> Vec<&'a str> {
    let mut parts = Vec::new();
    let (mut start, mut depth) = (0, 0_usize);
    for (index, c) in text.char_indices() {
        match c {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ if depth == 0 && text[index..].starts_with(separator) && index >= start => {
                parts.push(&text[start..index]);
                start = index + separator.len();
            }
            _ => {}
        }
    }
    parts.push(&text[start.min(text.len())..]);
    parts
}

#[test]
fn every_crate_we_ship_has_a_licence_we_allow() {
    let allowed = allowed();
    assert!(allowed.contains(&"MIT".to_owned()), "deny.toml was not understood: {allowed:?}");
    let faults: Vec<String> = Metadata::load()
        .outsiders
        .iter()
        .filter(|outsider| !outsider.license.as_deref().is_some_and(|license| is_met(license, &allowed)))
        .map(|outsider| format!("{}: {:?}", outsider.name, outsider.license))
        .collect();
    assert!(faults.is_empty(), "licences that deny.toml does not allow:\n{}", faults.join("\n"));
}

#[test]
fn licence_expressions_are_read_as_spdx_says() {
    let allowed = ["MIT", "Zlib"].map(str::to_owned);
    for (expression, met) in [
        ("MIT", true),
        ("GPL-3.0", false),
        ("GPL-3.0 OR MIT", true),
        ("Apache-2.0/MIT", true),
        ("MIT AND GPL-3.0", false),
        ("(GPL-3.0 OR MIT) AND Zlib", true),
        ("(GPL-3.0 OR MIT) AND Unicode-3.0", false),
        ("GPL-3.0 OR (MIT AND Zlib)", true),
    ] {
        assert_eq!(is_met(expression, &allowed), met, "{expression}");
    }
}
