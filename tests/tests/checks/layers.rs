//! Keeps the layers: which crate may know which, and what may not be found where.
//!
//! The rules are those of `ARCHITECTURE.md`; a new arrow is written down in both places.

use std::collections::BTreeSet;

use brushwork_tests::rust_source::{code_lines, without_tests};
use brushwork_tests::workspace::{self, DependencyKind, Member, Metadata};

/// The arrows that ship: a crate and the crates of this workspace it may use.
const ARROWS: [(&str, &[&str]); 36] = [
    (
        "brushwork",
        &[
            "brushwork-cli",
            "brushwork-core",
            "brushwork-family",
            "brushwork-gui",
            "brushwork-link",
            "brushwork-mcp",
            "brushwork-mcp-client",
            "brushwork-mcp-sim",
            "brushwork-mcp-wire",
            "brushwork-motion-mind",
            "brushwork-motion-mind-client",
            "brushwork-motorvator",
            "brushwork-motorvator-client",
            "brushwork-plant",
            "brushwork-script",
            "brushwork-suprmotr",
            "brushwork-suprmotr-client",
            "brushwork-tuning-bench",
            "brushwork-values",
        ],
    ),
    (
        "brushwork-cli",
        &[
            "brushwork-canopen",
            "brushwork-core",
            "brushwork-link",
            "brushwork-mcp",
            "brushwork-mcp-client",
            "brushwork-mcp-sim",
            "brushwork-mcp-wire",
            "brushwork-motion-mind",
            "brushwork-motion-mind-client",
            "brushwork-motion-mind-sim",
            "brushwork-motion-mind-wire",
            "brushwork-motorvator",
            "brushwork-motorvator-client",
            "brushwork-motorvator-sim",
            "brushwork-motorvator-wire",
            "brushwork-plant",
            "brushwork-script",
            "brushwork-suprmotr",
            "brushwork-suprmotr-client",
            "brushwork-suprmotr-macros",
            "brushwork-suprmotr-sim",
            "brushwork-suprmotr-wire",
            "brushwork-tuning",
            "brushwork-values",
        ],
    ),
    (
        "brushwork-core",
        &[
            "brushwork-canopen",
            "brushwork-family",
            "brushwork-link",
            "brushwork-mcp",
            "brushwork-mcp-client",
            "brushwork-mcp-wire",
            "brushwork-motion-mind",
            "brushwork-plant",
            "brushwork-script",
            "brushwork-suprmotr",
            "brushwork-tuning",
            "brushwork-values",
        ],
    ),
    (
        "brushwork-gui",
        &[
            "brushwork-canopen",
            "brushwork-core",
            "brushwork-link",
            "brushwork-mcp-client",
            "brushwork-mcp-wire",
            "brushwork-motion-mind-axis",
            "brushwork-motion-mind-client",
            "brushwork-motion-mind-wire",
            "brushwork-motorvator-client",
            "brushwork-motorvator-wire",
            "brushwork-plant",
            "brushwork-raster",
            "brushwork-script",
            "brushwork-suprmotr",
            "brushwork-suprmotr-client",
            "brushwork-suprmotr-macros",
            "brushwork-suprmotr-wire",
            "brushwork-tuning",
            "brushwork-values",
        ],
    ),
    ("brushwork-packaging", &["brushwork", "brushwork-cli"]),
    ("brushwork-tuning", &[]),
    (
        "brushwork-tuning-bench",
        &[
            "brushwork-mcp-axis",
            "brushwork-mcp-sim",
            "brushwork-mcp-wire",
            "brushwork-motion-mind-axis",
            "brushwork-motion-mind-sim",
            "brushwork-motion-mind-wire",
            "brushwork-plant",
            "brushwork-suprmotr-axis",
            "brushwork-suprmotr-sim",
            "brushwork-suprmotr-wire",
            "brushwork-tuning",
            "brushwork-values",
        ],
    ),
    ("brushwork-link", &["brushwork-canopen", "brushwork-values"]),
    (
        "brushwork-family",
        &[
            "brushwork-canopen",
            "brushwork-link",
            "brushwork-plant",
            "brushwork-script",
            "brushwork-tuning",
            "brushwork-values",
        ],
    ),
    (
        "brushwork-mcp",
        &[
            "brushwork-canopen",
            "brushwork-family",
            "brushwork-link",
            "brushwork-mcp-axis",
            "brushwork-mcp-client",
            "brushwork-mcp-sim",
            "brushwork-mcp-wire",
            "brushwork-plant",
            "brushwork-script",
            "brushwork-tuning",
            "brushwork-values",
        ],
    ),
    (
        "brushwork-motion-mind",
        &[
            "brushwork-family",
            "brushwork-link",
            "brushwork-motion-mind-axis",
            "brushwork-motion-mind-client",
            "brushwork-motion-mind-sim",
            "brushwork-motion-mind-wire",
            "brushwork-plant",
            "brushwork-tuning",
            "brushwork-values",
        ],
    ),
    ("brushwork-plant", &["brushwork-values"]),
    ("brushwork-canopen", &[]),
    ("brushwork-mcp-wire", &["brushwork-canopen", "brushwork-values"]),
    (
        "brushwork-mcp-client",
        &["brushwork-canopen", "brushwork-link", "brushwork-mcp-wire", "brushwork-values"],
    ),
    ("brushwork-mcp-axis", &["brushwork-mcp-wire", "brushwork-tuning", "brushwork-values"]),
    (
        "brushwork-mcp-sim",
        &[
            "brushwork-canopen",
            "brushwork-mcp-wire",
            "brushwork-plant",
            "brushwork-script",
            "brushwork-values",
        ],
    ),
    ("brushwork-motion-mind-wire", &["brushwork-values"]),
    ("brushwork-motion-mind-client", &["brushwork-link", "brushwork-motion-mind-wire", "brushwork-values"]),
    ("brushwork-motion-mind-axis", &["brushwork-motion-mind-wire", "brushwork-tuning"]),
    ("brushwork-motion-mind-sim", &["brushwork-motion-mind-wire", "brushwork-plant", "brushwork-values"]),
    ("brushwork-suprmotr-axis", &["brushwork-suprmotr-wire", "brushwork-tuning"]),
    ("brushwork-suprmotr-macros", &["brushwork-script", "brushwork-suprmotr-wire"]),
    ("brushwork-suprmotr-sim", &["brushwork-plant", "brushwork-suprmotr-wire", "brushwork-values"]),
    (
        "brushwork-suprmotr",
        &[
            "brushwork-family",
            "brushwork-link",
            "brushwork-plant",
            "brushwork-suprmotr-axis",
            "brushwork-suprmotr-client",
            "brushwork-suprmotr-macros",
            "brushwork-suprmotr-sim",
            "brushwork-suprmotr-wire",
            "brushwork-tuning",
            "brushwork-values",
        ],
    ),
    ("brushwork-suprmotr-wire", &["brushwork-values"]),
    ("brushwork-suprmotr-client", &["brushwork-link", "brushwork-suprmotr-wire", "brushwork-values"]),
    ("brushwork-motorvator-wire", &[]),
    ("brushwork-motorvator-client", &["brushwork-link", "brushwork-motorvator-wire", "brushwork-values"]),
    (
        "brushwork-motorvator",
        &[
            "brushwork-family",
            "brushwork-link",
            "brushwork-motorvator-client",
            "brushwork-motorvator-sim",
            "brushwork-motorvator-wire",
            "brushwork-plant",
            "brushwork-script",
        ],
    ),
    ("brushwork-motorvator-sim", &["brushwork-motorvator-wire", "brushwork-plant", "brushwork-script"]),
    ("brushwork-script", &[]),
    ("brushwork-values", &[]),
    ("brushwork-raster", &[]),
    ("brushwork-child", &[]),
    (
        "brushwork-tests",
        &[
            "brushwork",
            "brushwork-canopen",
            "brushwork-child",
            "brushwork-cli",
            "brushwork-core",
            "brushwork-family",
            "brushwork-gui",
            "brushwork-link",
            "brushwork-mcp",
            "brushwork-mcp-axis",
            "brushwork-mcp-client",
            "brushwork-mcp-sim",
            "brushwork-mcp-wire",
            "brushwork-motion-mind",
            "brushwork-motion-mind-axis",
            "brushwork-motion-mind-client",
            "brushwork-motion-mind-sim",
            "brushwork-motion-mind-wire",
            "brushwork-motorvator-wire",
            "brushwork-plant",
            "brushwork-script",
            "brushwork-suprmotr",
            "brushwork-suprmotr-client",
            "brushwork-suprmotr-macros",
            "brushwork-suprmotr-sim",
            "brushwork-suprmotr-wire",
            "brushwork-tuning",
            "brushwork-tuning-bench",
            "brushwork-values",
        ],
    ),
];

/// Arrows for tests alone: the window is tried against simulated controllers, the program from outside.
const TEST_ARROWS: [(&str, &[&str]); 4] = [
    ("brushwork", &["brushwork-canopen", "brushwork-child"]),
    ("brushwork-core", &["brushwork-mcp-sim"]),
    (
        "brushwork-gui",
        &[
            "brushwork-child",
            "brushwork-family",
            "brushwork-mcp",
            "brushwork-mcp-sim",
            "brushwork-motion-mind",
            "brushwork-motion-mind-sim",
            "brushwork-motorvator",
            "brushwork-motorvator-sim",
            "brushwork-suprmotr-sim",
        ],
    ),
    ("brushwork-packaging", &["brushwork-child"]),
];

/// Crates from outside that only some of ours may use, by the start of their name.
const KEPT_TO: [(&str, &[&str]); 7] = [
    // The program itself draws what it measures the cost of.
    ("egui", &["brushwork", "brushwork-gui", "brushwork-raster"]),
    ("epaint", &["brushwork-gui", "brushwork-raster"]),
    ("eframe", &["brushwork-gui"]),
    ("winit", &["brushwork-gui"]),
    ("rfd", &["brushwork-gui"]),
    ("clap", &["brushwork", "brushwork-cli", "brushwork-packaging"]),
    ("serialport", &["brushwork-link"]),
];

/// Crates that would need a system package to build; they may be nowhere in the lock file's graph.
const NOWHERE: [&str; 4] = ["libudev-sys", "openssl-sys", "gtk-sys", "glib-sys"];

/// What the pure parts may not touch: clocks, files, sockets, threads, processes, the terminal.
const IMPURE: [&str; 9] = [
    "std::fs",
    "std::net",
    "std::thread",
    "std::process",
    "std::env",
    "Instant",
    "SystemTime",
    "crossbeam_channel",
    "std::sync::mpsc",
];

/// The pure parts: a source folder and the modules in it that are the named exception.
const PURE: [(&str, &[&str]); 16] = [
    ("device/canopen/src", &[]),
    ("device/values/src", &[]),
    ("device/mcp/axis/src", &[]),
    ("device/mcp/wire/src", &[]),
    ("device/mcp/sim/src", &[]),
    ("device/motion_mind/axis/src", &[]),
    ("device/motion_mind/wire/src", &[]),
    ("device/motion_mind/sim/src", &[]),
    ("device/suprmotr/macros/src", &[]),
    ("device/suprmotr/sim/src", &[]),
    ("device/suprmotr/wire/src", &[]),
    ("device/motorvator/wire/src", &[]),
    ("device/motorvator/sim/src", &[]),
    ("device/plant/src", &["server"]),
    ("device/script/src", &[]),
    ("tuning/src", &[]),
];

fn allowed(table: &[(&str, &[&'static str])], name: &str) -> BTreeSet<&'static str> {
    table.iter().filter(|(from, _)| *from == name).flat_map(|(_, to)| to.iter().copied()).collect()
}

fn ours<'a>(member: &'a Member, metadata: &'a Metadata) -> impl Iterator<Item = (&'a str, DependencyKind)> {
    member
        .dependencies
        .iter()
        .filter(|line| metadata.members.iter().any(|other| other.name == line.name))
        .map(|line| (line.name.as_str(), line.kind))
}

#[test]
fn crates_know_only_the_crates_below_them() {
    let metadata = Metadata::load();
    for member in &metadata.members {
        assert!(
            ARROWS.iter().any(|(name, _)| *name == member.name),
            "{} is not in the table of arrows: give it its line here and in the map of ARCHITECTURE.md",
            member.name
        );
        for (target, kind) in ours(member, &metadata) {
            let mut may = allowed(&ARROWS, &member.name);
            if kind == DependencyKind::Dev {
                may.extend(allowed(&TEST_ARROWS, &member.name));
            }
            assert!(may.contains(target), "{} may not depend on {target} ({kind:?})", member.name);
        }
    }
}

/// What judges the tuner is a tool of the developers: it comes into the program with a feature that what is packaged goes without.
#[test]
fn nothing_that_ships_needs_the_bench() {
    let metadata = Metadata::load();
    for member in &metadata.members {
        for line in member.dependencies.iter().filter(|line| line.name == "brushwork-tuning-bench") {
            assert!(line.is_optional || member.name == "brushwork-tests", "{} needs the bench", member.name);
        }
    }
}

#[test]
fn the_window_toolkit_and_the_serial_port_are_each_known_to_one_place() {
    let metadata = Metadata::load();
    for member in &metadata.members {
        for line in &member.dependencies {
            for (start, owners) in KEPT_TO {
                let is_kept = line.name == start || line.name.starts_with(&format!("{start}_"));
                assert!(
                    !is_kept || owners.contains(&member.name.as_str()),
                    "{} depends on {}, which is for {owners:?} alone",
                    member.name,
                    line.name
                );
            }
        }
    }
}

#[test]
fn nothing_needs_a_system_package_to_build() {
    let metadata = Metadata::load();
    for name in NOWHERE {
        assert!(metadata.outsiders.iter().all(|outsider| outsider.name != name), "{name} is in the graph");
    }
}

#[test]
fn codecs_and_the_core_of_the_simulator_have_no_clock_and_do_no_io() {
    let mut faults = Vec::new();
    for path in workspace::rust_files() {
        if !is_pure(&path) {
            continue;
        }
        let source = workspace::read(&path);
        for (index, line) in code_lines(without_tests(&source)).iter().enumerate() {
            for word in IMPURE.iter().filter(|word| line.contains(**word)) {
                faults.push(format!("{path}:{}: {word}", index + 1));
            }
        }
    }
    assert!(faults.is_empty(), "pure code reaches outside:\n{}", faults.join("\n"));
}

fn is_pure(path: &str) -> bool {
    PURE.iter().any(|(folder, exceptions)| {
        path.strip_prefix(folder).and_then(|rest| rest.strip_prefix('/')).is_some_and(|rest| {
            let module = rest.split('/').next().unwrap_or(rest).trim_end_matches(".rs");
            !exceptions.contains(&module)
        })
    })
}

#[test]
fn every_queue_has_a_bound_and_every_thread_a_name() {
    const BANNED: [&str; 4] = ["unbounded()", "unbounded::<", "mpsc::channel(", "thread::spawn("];
    let mut faults = Vec::new();
    for path in workspace::rust_files() {
        for (index, line) in code_lines(&workspace::read(&path)).iter().enumerate() {
            for word in BANNED.iter().filter(|word| line.contains(**word)) {
                faults.push(format!("{path}:{}: {word}", index + 1));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_crate_takes_the_lints_and_the_versions_of_the_workspace() {
    for member in Metadata::load().members {
        let manifest = workspace::read(&format!("{}/Cargo.toml", member.folder));
        assert!(manifest.contains("[lints]\nworkspace = true"), "{} has lints of its own", member.name);
        if !member.folder.starts_with("tests") {
            let root = workspace::read(&format!("{}/src/lib.rs", member.folder));
            let asks = root.contains("#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]");
            assert!(asks, "{} takes new members of an enum in silence", member.name);
        }
        let mut in_dependencies = false;
        for line in manifest.lines() {
            if line.starts_with('[') {
                in_dependencies = line.ends_with("dependencies]");
            } else if in_dependencies && line.contains('=') {
                assert!(
                    line.contains("workspace"),
                    "{}: the version of `{line}` belongs in the root",
                    member.name
                );
            }
        }
    }
}
