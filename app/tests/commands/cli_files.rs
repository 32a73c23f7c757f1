//! No command takes a file away unasked: what it writes is new, or replaced with `--force`, and never what it reads.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::{MetadataExt as _, symlink};
use std::path::{Path, PathBuf};
use std::process::Stdio;

use crate::cli::{DONE, Run, Simulated, name, program, run};
use brushwork_child::Child;
use tempfile::TempDir;

const FAILED: i32 = 1;
const PRECIOUS: &str = "precious";

fn brushwork(arguments: &[&str]) -> Run {
    run(program().args(arguments))
}

/// A folder with a file that must stay, and a link to it.
fn folder() -> (TempDir, PathBuf, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let [file, link] = ["precious", "link"].map(|name| folder.path().join(name));
    fs::write(&file, PRECIOUS).expect("the folder is the test's");
    symlink(&file, &link).expect("the folder is the test's");
    (folder, file, link)
}

fn script(folder: &Path) -> PathBuf {
    let path = folder.join("door.mcl");
    fs::write(&path, "end\n").expect("the folder is the test's");
    path
}

#[test]
fn every_command_that_writes_a_file_leaves_one_that_exists() {
    let (folder, file, link) = folder();
    let script = script(folder.path());
    let image = folder.path().join("new.bin");
    brushwork(&["firmware", "image", name(&image)]).ended_with(DONE);
    let port = folder.path().join("port");
    for target in [&file, &link] {
        let target = name(target);
        for arguments in [
            &["settings", "export", target][..],
            &["tune", "velocity", "--report", target],
            &["firmware", "image", target],
            &["firmware", "update", name(&image), "--accept-risk", "--backup", target],
            &["mcl", "build", name(&script), "-o", target],
            &["sim", "--pty", name(&port), "--truth", target],
            &["bench", "tuning", "--plants", "1", "--write-oracle", target],
        ] {
            let refused = brushwork(arguments).ended_with(FAILED);
            assert!(refused.stderr.contains("Give --force to replace it"), "{arguments:?}: {refused:#?}");
            assert_eq!(fs::read_to_string(&file).unwrap(), PRECIOUS, "{arguments:?}");
            assert!(fs::symlink_metadata(&link).unwrap().is_symlink(), "{arguments:?}");
        }
    }
    // A pseudo-terminal takes the place of no file, and there is no leave for that.
    for port in [&file, &link] {
        brushwork(&["sim", "--pty", name(port)]).ended_with(FAILED).explains("is already there");
        let refused = brushwork(&["monitor", "--for", "1", "--pty", name(port)]).explains("is already there");
        assert_ne!(refused.code, DONE);
    }
    let dangling = folder.path().join("dangling");
    symlink(folder.path().join("unplugged"), &dangling).unwrap();
    brushwork(&["sim", "--pty", name(&dangling)])
        .ended_with(FAILED)
        .explains("a link to a file that is not there");
    assert_eq!(fs::read_to_string(&file).unwrap(), PRECIOUS);
}

#[test]
fn with_leave_a_link_is_replaced_and_not_what_it_leads_to() {
    let (_folder, file, link) = folder();
    brushwork(&["settings", "export", name(&link), "--force"]).ended_with(DONE);
    assert_eq!(fs::read_to_string(&file).unwrap(), PRECIOUS);
    assert!(fs::symlink_metadata(&link).unwrap().is_file());
    brushwork(&["settings", "diff", name(&link)]).ended_with(DONE);
}

#[test]
fn a_script_is_never_replaced_by_its_image() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let script = script(folder.path());
    let [soft, hard] = ["soft", "hard"].map(|name| folder.path().join(name));
    symlink(&script, &soft).unwrap();
    fs::hard_link(&script, &hard).unwrap();
    for target in [&script, &soft, &hard] {
        for force in [&[][..], &["--force"]] {
            let refused = brushwork(&[&["mcl", "build", name(&script), "-o", name(target)], force].concat());
            assert!(refused.ended_with(FAILED).stderr.contains("is the file that the command reads"));
            assert_eq!(fs::read_to_string(&script).unwrap(), "end\n");
        }
    }
    brushwork(&["mcl", "build", name(&script)]).ended_with(DONE);
    brushwork(&["mcl", "build", name(&script)]).ended_with(FAILED).explains("door.mcli exists already");
    brushwork(&["mcl", "build", name(&script), "--force"]).ended_with(DONE);
}

#[test]
fn standard_output_and_devices_are_written_to() {
    let profile = brushwork(&["settings", "export", "/dev/stdout"]).ended_with(DONE);
    assert!(profile.stdout.starts_with('{') && profile.stdout.contains("\"schema\""), "{profile:#?}");
    brushwork(&["firmware", "image", "/dev/null"]).ended_with(DONE);
    let (folder, ..) = folder();
    // A file behind standard output gets it before what is said of it.
    let into = fs::File::create(folder.path().join("out")).unwrap();
    let mut export = program();
    export.args(["settings", "export", "/dev/stdout"]);
    let ended =
        Child::spawn(&export, [Stdio::null(), into.into(), Stdio::null()]).finish(crate::wait::PATIENCE);
    assert!(ended.success());
    let out = fs::read_to_string(folder.path().join("out")).unwrap();
    assert!(out.starts_with('{') && out.ends_with("are in /dev/stdout.\n"), "{out}");
}

#[test]
fn the_truth_is_written_again_and_again_to_the_file_that_was_made_for_it() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let truth = folder.path().join("truth.json");
    {
        let _unit = Simulated::start(&["--truth", name(&truth)]);
        let number = || fs::metadata(&truth).ok().map(|found| found.ino());
        let first = crate::wait::until_some("the truth", number, || "none".to_owned());
        crate::wait::until(
            "another truth",
            || number().is_some_and(|now| now != first),
            || "the first".to_owned(),
        );
    }
    let port = folder.path().join("port");
    brushwork(&["sim", "--pty", name(&port), "--truth", name(&truth)])
        .ended_with(FAILED)
        .explains("truth.json exists already");
}
