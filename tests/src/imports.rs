//! Which file of a crate imports from which, and where the imports run in a circle.
//!
//! What counts is `use`, and a path in code that begins with `crate`, `self` or `super`; both outside `#[cfg(test)]`. A name that a
//! file passes on leads to the file that holds it.

use std::collections::{BTreeMap, BTreeSet};

/// A file that takes something from another file of its crate.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Import {
    /// The file with the `use`.
    pub from: String,
    /// The line, counted from 1.
    pub line: usize,
    /// The file that holds what is imported.
    pub to: String,
}

/// The imports between a crate's files, sorted; a file is its path below `src` and its text.
#[must_use]
pub fn imports(files: &[(&str, &str)]) -> Vec<Import> {
    let tree = Crate::read(files);
    let mut found = BTreeSet::new();
    for (name, module) in &tree.modules {
        for line in &module.uses {
            for place in tree.places(name, &line.path, 0) {
                let to = &tree.modules[place].file;
                if *to != module.file {
                    found.insert(Import { from: module.file.clone(), line: line.line, to: to.clone() });
                }
            }
        }
    }
    found.into_iter().collect()
}

/// Groups of files that reach each other by imports, the largest first.
#[must_use]
pub fn circles(imports: &[Import]) -> Vec<BTreeSet<&str>> {
    let starts: BTreeSet<&str> = imports.iter().map(|import| import.from.as_str()).collect();
    let reached: BTreeMap<&str, BTreeSet<&str>> =
        starts.into_iter().map(|start| (start, reached(imports, &[start]))).collect();
    let meets = |from: &str, to: &str| reached.get(from).is_some_and(|files| files.contains(to));
    let mut found: BTreeSet<BTreeSet<&str>> = BTreeSet::new();
    for (start, files) in reached.iter().filter(|(start, files)| files.contains(*start)) {
        found.insert(files.iter().copied().filter(|file| meets(file, start)).collect());
    }
    let mut found: Vec<BTreeSet<&str>> = found.into_iter().collect();
    found.sort_by_key(|circle| std::cmp::Reverse(circle.len()));
    found
}

/// The files to which imports lead from some files, over any number of others.
#[must_use]
pub fn reached<'a>(imports: &'a [Import], starts: &[&str]) -> BTreeSet<&'a str> {
    let mut reached = BTreeSet::new();
    let mut open = starts.to_vec();
    while let Some(file) = open.pop() {
        let first = imports.partition_point(|import| import.from.as_str() < file);
        for import in imports[first..].iter().take_while(|import| import.from == file) {
            if reached.insert(import.to.as_str()) {
                open.push(&import.to);
            }
        }
    }
    reached
}

/// A crate's modules by their path, `gui::graph`; the root is the empty path.
#[derive(Default)]
struct Crate {
    modules: BTreeMap<String, Module>,
}

#[derive(Default)]
struct Module {
    file: String,
    items: BTreeSet<String>,
    uses: Vec<Use>,
}

/// One name of a `use`: `use a::{b as c}` is the path `a::b` under the name `c`.
#[derive(Debug, PartialEq, Eq)]
struct Use {
    path: Vec<String>,
    name: String,
    line: usize,
}

impl Crate {
    fn read(files: &[(&str, &str)]) -> Self {
        let mut tree = Self::default();
        let mut tests = Vec::new();
        // Beside a library the program is a crate of its own.
        let has_library = files.iter().any(|(file, _)| *file == "lib.rs");
        for (file, source) in files.iter().filter(|(file, _)| !(has_library && *file == "main.rs")) {
            let module = module_of(file);
            let mut reader = Reader::new(file, source, &mut tree, &mut tests);
            reader.read(module);
        }
        tree.modules.retain(|name, _| !tests.iter().any(|test| is_below(name, test)));
        tree
    }

    /// The modules that hold what a path in a module names; none for another crate's.
    fn places(&self, module: &str, path: &[String], depth: usize) -> Vec<&str> {
        const DEEPEST: usize = 16;
        let Some((first, mut rest)) = path.split_first().filter(|_| depth < DEEPEST) else {
            return Vec::new();
        };
        let mut here = match first.as_str() {
            "crate" => vec![String::new()],
            "self" => vec![module.to_owned()],
            "super" => vec![parent(module).to_owned()],
            _ => return self.below(module, path, depth, false),
        };
        while let Some((_, after)) = rest.split_first().filter(|(word, _)| *word == "super") {
            here = here.iter().map(|name| parent(name).to_owned()).collect();
            rest = after;
        }
        here.iter().flat_map(|name| self.below(name, rest, depth, true)).collect()
    }

    /// The same for a path that begins in the module itself; `sure` when a name that is not found is still its own.
    fn below(&self, module: &str, path: &[String], depth: usize, sure: bool) -> Vec<&str> {
        let Some((name, content)) = self.modules.get_key_value(module) else { return Vec::new() };
        let Some((first, rest)) = path.split_first() else { return vec![name] };
        if first == "*" {
            return vec![name];
        }
        let child = join(module, first);
        let mut found = if self.modules.contains_key(&child) {
            self.below(&child, rest, depth, true)
        } else {
            Vec::new()
        };
        if (found.is_empty() || rest.is_empty()) && content.items.contains(first) {
            found.push(name);
        }
        if found.is_empty() || rest.is_empty() {
            let mut is_passed_on = false;
            for line in content.uses.iter().filter(|line| line.name == *first && line.path != path) {
                is_passed_on = true;
                let onward: Vec<String> = line.path.iter().chain(rest).cloned().collect();
                found.extend(self.places(module, &onward, depth + 1));
            }
            if is_passed_on {
                return found;
            }
        }
        if found.is_empty() {
            for line in content.uses.iter().filter(|line| line.name == "*" && depth < 4) {
                for place in self.places(module, &line.path, depth + 1) {
                    let content = &self.modules[place];
                    let holds = content.items.contains(first)
                        || content.uses.iter().any(|line| line.name == *first)
                        || self.modules.contains_key(&join(place, first));
                    if holds {
                        found.extend(self.below(place, path, depth + 1, true));
                    }
                }
            }
        }
        if found.is_empty() && sure { vec![name] } else { found }
    }
}

/// `gui/graph/mod.rs` and `gui/graph.rs` are `gui::graph`.
fn module_of(file: &str) -> String {
    let stem = file.trim_end_matches(".rs");
    let stem = stem.strip_suffix("/mod").unwrap_or(stem);
    if stem == "lib" || stem == "main" { String::new() } else { stem.replace('/', "::") }
}

fn join(module: &str, name: &str) -> String {
    if module.is_empty() { name.to_owned() } else { format!("{module}::{name}") }
}

fn parent(module: &str) -> &str {
    module.rsplit_once("::").map_or("", |(parent, _)| parent)
}

fn is_below(module: &str, above: &str) -> bool {
    module.strip_prefix(above).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

/// Walks through one file's words.
struct Reader<'a> {
    file: &'a str,
    words: Vec<(String, usize)>,
    at: usize,
    tree: &'a mut Crate,
    tests: &'a mut Vec<String>,
}

impl<'a> Reader<'a> {
    fn new(file: &'a str, source: &str, tree: &'a mut Crate, tests: &'a mut Vec<String>) -> Self {
        Self { file, words: words(source), at: 0, tree, tests }
    }

    fn word(&self, ahead: usize) -> &str {
        self.words.get(self.at + ahead).map_or("", |(word, _)| word.as_str())
    }

    fn starts_with(&self, words: &[&str]) -> bool {
        words.iter().enumerate().all(|(ahead, word)| self.word(ahead) == *word)
    }

    fn read(&mut self, module: String) {
        const ITEMS: [&str; 8] = ["fn", "struct", "enum", "union", "trait", "type", "const", "static"];
        if self.starts_with(&["#", "!", "[", "cfg", "(", "test", ")", "]"]) {
            self.tests.push(module);
            return;
        }
        // Open braces; those of modules carry the path outside.
        let mut open: Vec<Option<String>> = Vec::new();
        let mut here = module;
        self.enter(&here);
        while self.at < self.words.len() {
            let is_module = open.iter().all(Option::is_some);
            if self.starts_with(&["#", "[", "cfg", "(", "test", ")", "]"])
                || self.starts_with(&["#", "[", "cfg", "(", "all", "(", "test", ","])
            {
                self.skip_item(&here);
                continue;
            }
            match self.word(0) {
                "use" => {
                    self.read_use(&here);
                    continue;
                }
                "mod" if self.word(2) == "{" => {
                    open.push(Some(here.clone()));
                    here = join(&here, self.word(1));
                    self.enter(&here);
                    self.at += 2;
                }
                "{" => open.push(None),
                "}" => {
                    if let Some(Some(outside)) = open.pop() {
                        here = outside;
                    }
                }
                "crate" | "super" | "self" if self.word(1) == "::" => self.read_path(&here),
                "macro_rules" => self.add_item(&here, 2),
                word if is_module && ITEMS.contains(&word) => self.add_item(&here, 1),
                _ => {}
            }
            self.at += 1;
        }
    }

    fn enter(&mut self, module: &str) {
        let file = self.file.to_owned();
        self.tree.modules.entry(module.to_owned()).or_default().file = file;
    }

    fn add_item(&mut self, module: &str, ahead: usize) {
        let name = self.word(ahead).to_owned();
        self.tree.modules.entry(module.to_owned()).or_default().items.insert(name);
    }

    /// Over an attribute and what it stands on; a module that it declares in another file is one of tests.
    fn skip_item(&mut self, module: &str) {
        let mut depth = 0;
        while self.at < self.words.len() {
            match self.word(0) {
                "{" | "(" | "[" => depth += 1,
                "}" | ")" | "]" => depth -= 1,
                "mod" if depth == 0 && self.word(2) == ";" => {
                    let test = join(module, self.word(1));
                    self.tests.push(test);
                }
                _ => {}
            }
            let is_end = depth == 0 && matches!(self.word(0), ";" | "}");
            if depth >= 0 {
                self.at += 1;
            }
            if is_end || depth < 0 {
                return;
            }
        }
    }

    fn read_use(&mut self, module: &str) {
        self.at += 1;
        let mut found = Vec::new();
        // A path of another crate by its full name.
        if self.word(0) != "::" {
            self.read_branch(&[], &mut found);
        }
        self.tree.modules.entry(module.to_owned()).or_default().uses.extend(found);
    }

    /// A path in the midst of code, up to its last name.
    fn read_path(&mut self, module: &str) {
        let line = self.words.get(self.at).map_or(0, |(_, line)| *line);
        let mut path = vec![self.word(0).to_owned()];
        while self.word(1) == "::" && self.word(2).starts_with(char::is_alphabetic) {
            self.at += 2;
            path.push(self.word(0).to_owned());
        }
        let name = String::new();
        self.tree.modules.entry(module.to_owned()).or_default().uses.push(Use { path, name, line });
    }

    fn read_branch(&mut self, stem: &[String], found: &mut Vec<Use>) {
        let mut path = stem.to_vec();
        let line = self.words.get(self.at).map_or(0, |(_, line)| *line);
        loop {
            match self.word(0) {
                "{" => {
                    while self.at < self.words.len() && self.word(0) != "}" {
                        self.at += 1;
                        if self.word(0) != "}" {
                            self.read_branch(&path, found);
                        }
                    }
                    self.at += 1;
                    return;
                }
                "::" => {}
                "self" if !path.is_empty() => {}
                "" | ";" | "," | "}" | "as" => break,
                word => path.push(word.to_owned()),
            }
            self.at += 1;
        }
        let mut name = path.last().cloned().unwrap_or_default();
        if self.word(0) == "as" {
            name = self.word(1).to_owned();
            self.at += 2;
        }
        found.push(Use { path, name, line });
    }
}

/// Names, `::` and other signs, each with its line; no comments, no literals.
fn words(source: &str) -> Vec<(String, usize)> {
    let text: Vec<char> = source.chars().collect();
    let mut found = Vec::new();
    let mut line = 1;
    let mut at = 0;
    while at < text.len() {
        let end = end_of_word(&text, at);
        let is_word = text[at].is_alphanumeric() || text[at] == '_';
        if end == at + 1 && !text[at].is_whitespace() || is_word || text[at] == ':' {
            found.push((text[at..end].iter().collect(), line));
        }
        line += text[at..end].iter().filter(|c| **c == '\n').count();
        at = end;
    }
    found
}

/// Where what begins here ends: a name, a comment, a literal, `::`, or one sign.
fn end_of_word(text: &[char], at: usize) -> usize {
    let has = |at: usize, c: char| text.get(at) == Some(&c);
    let while_true = |from: usize, test: &dyn Fn(usize) -> bool| {
        (from..text.len()).find(|at| !test(*at)).unwrap_or(text.len())
    };
    match text[at] {
        '/' if has(at + 1, '/') => while_true(at, &|i| text[i] != '\n'),
        '/' if has(at + 1, '*') => {
            (while_true(at + 2, &|i| !(text[i] == '*' && has(i + 1, '/'))) + 2).min(text.len())
        }
        ':' if has(at + 1, ':') => at + 2,
        '"' => end_of_string(text, at + 1),
        '\'' if has(at + 1, '\\') => (while_true(at + 3, &|i| text[i] != '\'') + 1).min(text.len()),
        '\'' if has(at + 2, '\'') => at + 3,
        'r' | 'b' | 'c' if is_raw_string(text, at) => end_of_raw_string(text, at),
        c if c.is_alphanumeric() || c == '_' => {
            while_true(at, &|i| text[i].is_alphanumeric() || text[i] == '_')
        }
        _ => at + 1,
    }
}

fn end_of_string(text: &[char], mut at: usize) -> usize {
    while at < text.len() && text[at] != '"' {
        at += if text[at] == '\\' { 2 } else { 1 };
    }
    (at + 1).min(text.len())
}

/// `r"`, `r#"`, `br"` and the like.
fn is_raw_string(text: &[char], at: usize) -> bool {
    let start = if text[at] == 'r' { at } else { at + 1 };
    let hashes = text.iter().skip(start + 1).take_while(|c| **c == '#').count();
    text.get(start) == Some(&'r') && text.get(start + 1 + hashes) == Some(&'"')
}

fn end_of_raw_string(text: &[char], at: usize) -> usize {
    let quote = text.iter().skip(at).position(|c| *c == '"').map_or(text.len(), |quote| at + quote);
    let hashes = text[at..quote].iter().filter(|c| **c == '#').count();
    let closes = |end: &usize| {
        text[*end] == '"' && text[end + 1..].iter().take_while(|c| **c == '#').count() >= hashes
    };
    (quote + 1..text.len()).find(closes).map_or(text.len(), |end| end + 1 + hashes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edges(files: &[(&str, &str)]) -> Vec<String> {
        imports(files).into_iter().map(|found| format!("{} {}", found.from, found.to)).collect()
    }

    #[test]
    fn paths_lead_to_the_files_they_name_and_those_of_other_crates_nowhere() {
        let files = [
            ("lib.rs", "pub mod a;\nmod b;\nuse b::Bee;\nuse std::fmt;\n"),
            ("a/mod.rs", "mod c;\nuse self::c::See;\nfn f() { use super::b::{self, Bee as Other}; }\n"),
            ("a/c.rs", "use crate::{b::Bee, a::*};\npub struct See;\n"),
            ("b.rs", "pub struct Bee;\nfn f() -> u8 { crate::a::c::See::default() }\n"),
        ];
        assert_eq!(
            edges(&files),
            [
                "a/c.rs a/mod.rs",
                "a/c.rs b.rs",
                "a/mod.rs a/c.rs",
                "a/mod.rs b.rs",
                "b.rs a/c.rs",
                "lib.rs b.rs"
            ]
        );
    }

    #[test]
    fn what_is_passed_on_leads_to_the_file_that_holds_it() {
        let files = [
            ("lib.rs", "mod a;\nmod user;\n"),
            ("a/mod.rs", "mod b;\npub use b::Bee;\npub use b::deep::*;\npub fn own() {}\n"),
            ("a/b/mod.rs", "pub mod deep;\npub struct Bee;\n"),
            ("a/b/deep.rs", "pub enum Deep { Down }\n"),
            ("user.rs", "use crate::a::Bee;\nuse crate::a::Deep::Down;\n"),
        ];
        let found = edges(&files);
        assert!(found.contains(&"user.rs a/b/mod.rs".to_owned()), "{found:?}");
        assert!(found.contains(&"user.rs a/b/deep.rs".to_owned()), "{found:?}");
        assert!(!found.contains(&"user.rs a/mod.rs".to_owned()), "{found:?}");
    }

    #[test]
    fn tests_comments_and_strings_import_nothing() {
        let files = [
            ("lib.rs", "mod a;\nmod b;\n#[cfg(test)]\nmod tests;\n"),
            (
                "a.rs",
                "// use crate::b::B;\nconst S: &str = \"use crate::b::B;\";\n#[cfg(test)]\nuse crate::b::B;\n\
                 #[cfg(test)]\nmod tests {\n    use crate::b::B;\n}\n",
            ),
            ("b.rs", "fn f<'a>(c: char) -> bool { c == '\"' }\nuse crate::a::S; pub struct B;\n"),
            ("tests.rs", "use crate::b::B;\n"),
        ];
        assert_eq!(edges(&files), ["b.rs a.rs"]);
    }

    #[test]
    fn files_that_reach_each_other_are_a_circle_and_a_chain_is_none() {
        let files = [
            ("lib.rs", "mod a;\nmod b;\nmod c;\nmod d;\n"),
            ("a.rs", "use crate::b::B;\npub struct A;\n"),
            ("b.rs", "use crate::c::C;\npub struct B;\n"),
            ("c.rs", "use super::a::A;\npub struct C;\n"),
            ("d.rs", "use crate::a::A;\n"),
        ];
        let imports = imports(&files);
        assert_eq!(circles(&imports), [BTreeSet::from(["a.rs", "b.rs", "c.rs"])]);
        assert_eq!(imports[0], Import { from: "a.rs".to_owned(), line: 1, to: "b.rs".to_owned() });
    }
}
