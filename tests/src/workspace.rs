//! The workspace as `cargo metadata` and the file tree describe it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use brushwork_child::Child;
use serde_json::Value;

use crate::wait;

/// The folder that holds the workspace's `Cargo.toml`.
#[must_use]
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().expect("the tests crate lies one folder below the root").to_path_buf()
}

/// Reads a file below the root; the path is in the panic message when it is not there.
#[must_use]
pub fn read(relative: &str) -> String {
    let path = root().join(relative);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Which table of a `Cargo.toml` names a dependency.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DependencyKind {
    /// `[dependencies]`: what ships.
    Normal,
    /// `[dev-dependencies]`: tests and benchmarks only.
    Dev,
    /// `[build-dependencies]`.
    Build,
}

/// One line of a dependency table.
#[derive(Debug, Clone)]
pub struct Dependency {
    /// The crate's name.
    pub name: String,
    /// The table it stands in.
    pub kind: DependencyKind,
    /// Whether only a feature asks for it.
    pub is_optional: bool,
}

/// One crate of this workspace.
#[derive(Debug, Clone)]
pub struct Member {
    /// The crate's name, for example `brushwork-link`.
    pub name: String,
    /// Its folder, relative to the root, with forward slashes.
    pub folder: String,
    /// Its dependency tables.
    pub dependencies: Vec<Dependency>,
}

/// A crate from outside that ends up in the lock file.
#[derive(Debug, Clone)]
pub struct Outsider {
    /// The crate's name.
    pub name: String,
    /// The licence expression of its manifest, if it has one.
    pub license: Option<String>,
}

/// The answer of `cargo metadata`, as far as the tests need it.
#[derive(Debug, Clone)]
pub struct Metadata {
    /// The crates of this workspace, by folder.
    pub members: Vec<Member>,
    /// Every other crate in the resolved graph, all targets and features.
    pub outsiders: Vec<Outsider>,
}

impl Metadata {
    /// Asks cargo, offline: what is not in the lock file is not part of the workspace.
    #[must_use]
    pub fn load() -> Self {
        let mut command = Command::new(env!("CARGO"));
        command.args(["metadata", "--format-version", "1", "--locked"]).current_dir(root());
        let output = Child::output(&command, b"", wait::LIMIT);
        assert!(output.status.success(), "cargo metadata: {}", String::from_utf8_lossy(&output.stderr));
        let json: Value = serde_json::from_slice(&output.stdout).expect("cargo metadata answers in JSON");
        Self::from_json(&json)
    }

    fn from_json(json: &Value) -> Self {
        let ids: Vec<&str> = array(json, "workspace_members").iter().filter_map(Value::as_str).collect();
        let (inside, outside): (Vec<&Value>, Vec<&Value>) =
            array(json, "packages").iter().partition(|package| ids.contains(&text(package, "id")));
        let mut members: Vec<Member> = inside.into_iter().map(member).collect();
        members.sort_by(|a, b| a.folder.cmp(&b.folder));
        let outsiders = outside
            .into_iter()
            .map(|package| Outsider {
                name: text(package, "name").to_owned(),
                license: package["license"].as_str().map(str::to_owned),
            })
            .collect();
        Self { members, outsiders }
    }

    /// The member of that name; the test fails when the workspace has none.
    #[must_use]
    pub fn member(&self, name: &str) -> &Member {
        self.members.iter().find(|member| member.name == name).unwrap_or_else(|| panic!("no crate {name}"))
    }
}

/// Every `.rs` file of the workspace, relative to the root, sorted.
#[must_use]
pub fn rust_files() -> Vec<String> {
    let mut found = Vec::new();
    collect_files(&root(), &root(), &mut |path| {
        if path.ends_with(".rs") {
            found.push(path.to_owned());
        }
    });
    found.sort();
    found
}

/// Every file that is written by people: all but what git ignores, pictures, fonts and the lock file.
#[must_use]
pub fn text_files() -> Vec<String> {
    const TEXT: [&str; 9] = [".rs", ".toml", ".md", ".py", ".json", ".txt", ".yml", ".sh", "/run"];
    let mut found = Vec::new();
    collect_files(&root(), &root(), &mut |path| {
        if TEXT.iter().any(|ending| path.ends_with(ending)) {
            found.push(path.to_owned());
        }
    });
    found.sort();
    found
}

/// The modules directly below a crate's `src`: `name.rs` and `name/`, without `lib` and `main`.
#[must_use]
pub fn first_level_modules(folder: &str) -> Vec<String> {
    let source = root().join(folder).join("src");
    let mut modules: Vec<String> = fs::read_dir(&source)
        .unwrap_or_else(|error| panic!("{}: {error}", source.display()))
        .filter_map(Result::ok)
        .filter(|entry| entry.path().is_dir() || entry.file_name().to_string_lossy().ends_with(".rs"))
        .map(|entry| entry.file_name().to_string_lossy().trim_end_matches(".rs").to_owned())
        .filter(|name| name != "lib" && name != "main")
        .collect();
    modules.sort();
    modules.dedup();
    modules
}

fn collect_files(root: &Path, folder: &Path, visit: &mut dyn FnMut(&str)) {
    const IGNORED: [&str; 5] = ["target", ".git", ".venv", "__pycache__", "corpus"];
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    for entry in entries.filter_map(Result::ok) {
        let path = entry.path();
        let name = entry.file_name();
        if path.is_dir() {
            if !IGNORED.iter().any(|ignored| name == *ignored) {
                collect_files(root, &path, visit);
            }
        } else if let Ok(relative) = path.strip_prefix(root) {
            visit(&relative.to_string_lossy().replace('\\', "/"));
        }
    }
}

fn member(package: &Value) -> Member {
    let manifest = Path::new(text(package, "manifest_path"));
    let folder = manifest.parent().and_then(|folder| folder.strip_prefix(root()).ok()).unwrap_or(manifest);
    Member {
        name: text(package, "name").to_owned(),
        folder: folder.to_string_lossy().replace('\\', "/"),
        dependencies: array(package, "dependencies").iter().map(dependency).collect(),
    }
}

fn dependency(line: &Value) -> Dependency {
    let kind = match line["kind"].as_str() {
        Some("dev") => DependencyKind::Dev,
        Some("build") => DependencyKind::Build,
        _ => DependencyKind::Normal,
    };
    Dependency { name: text(line, "name").to_owned(), kind, is_optional: line["optional"] == true }
}

fn array<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value[key].as_array().map_or(&[], Vec::as_slice)
}

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap_or_default()
}
