//! A crude reader of Rust files: enough to count lines and functions and to look for a word in code.
//!
//! It trusts rustfmt (a function ends at the brace in its own column) and does not parse.

/// A function and where it stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Function {
    /// Its name.
    pub name: String,
    /// The line of its `fn`, counted from 1.
    pub line: usize,
    /// Lines from `fn` to the closing brace, both counted.
    pub length_lines: usize,
}

/// The part of a file above its first `#[cfg(test)]`.
#[must_use]
pub fn without_tests(source: &str) -> &str {
    source.find("\n#[cfg(test)]").map_or(source, |end| &source[..end])
}

/// Every function with a body, in order.
#[must_use]
pub fn functions(source: &str) -> Vec<Function> {
    let lines: Vec<&str> = source.lines().collect();
    let mut found = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        let Some(name) = function_name(line) else { continue };
        if let Some(length_lines) = body_length(&lines[index..]) {
            found.push(Function { name: name.to_owned(), line: index + 1, length_lines });
        }
    }
    found
}

/// The file's lines with comments and the text inside string literals blanked, so that only code is searched.
#[must_use]
pub fn code_lines(source: &str) -> Vec<String> {
    source.lines().map(code_of).collect()
}

fn function_name(line: &str) -> Option<&str> {
    let mut rest = line.trim_start();
    for word in ["pub ", "pub(crate) ", "pub(super) ", "const ", "async "] {
        rest = rest.strip_prefix(word).unwrap_or(rest);
    }
    let name = rest.strip_prefix("fn ")?;
    let end = name.find(|c: char| !c.is_alphanumeric() && c != '_')?;
    Some(&name[..end])
}

/// Lines up to the brace that closes in the first line's column; none for a declaration without a body.
fn body_length(lines: &[&str]) -> Option<usize> {
    let first = lines.first()?;
    let column = first.len() - first.trim_start().len();
    if first.ends_with('}') {
        return Some(1);
    }
    for (index, line) in lines.iter().enumerate() {
        let same_column = line.len() - line.trim_start().len() == column;
        if index > 0 && same_column && line.trim_start().starts_with('}') {
            return Some(index + 1);
        }
        if same_column && line.ends_with(';') {
            return None;
        }
    }
    None
}

fn code_of(line: &str) -> String {
    let mut code = String::with_capacity(line.len());
    let mut in_string = false;
    let mut previous = ' ';
    for (index, c) in line.char_indices() {
        if !in_string && line[index..].starts_with("//") {
            break;
        }
        let is_quote = c == '"' && previous != '\\' && previous != '\'';
        if is_quote {
            in_string = !in_string;
        }
        if !in_string || is_quote {
            code.push(c);
        }
        previous = c;
    }
    code
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_function_is_as_long_as_from_its_fn_to_its_brace() {
        let source =
            "pub fn one() {\n    two();\n}\n\ntrait T {\n    fn declared(&self);\n    fn short() {}\n}\n";
        let found: Vec<(String, usize)> =
            functions(source).into_iter().map(|f| (f.name, f.length_lines)).collect();
        assert_eq!(found, [("one".to_owned(), 3), ("short".to_owned(), 1)]);
    }

    #[test]
    fn a_signature_over_several_lines_counts_as_part_of_the_function() {
        let source = "    fn long(\n        a: u8,\n    ) -> u8 {\n        a\n    }\n";
        assert_eq!(functions(source)[0].length_lines, 5);
    }

    #[test]
    fn words_in_comments_and_strings_are_not_code() {
        assert_eq!(code_of("let a = \"std::fs\"; // std::net"), "let a = \"\"; ");
        assert_eq!(code_of("std::fs::read(path)"), "std::fs::read(path)");
    }

    #[test]
    fn the_test_module_is_cut_off() {
        assert_eq!(without_tests("fn a() {}\n#[cfg(test)]\nmod tests {}\n"), "fn a() {}");
    }
}
