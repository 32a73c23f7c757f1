//! `brushwork mcl` from outside: what stands on standard output, the exit codes, input, faults, files in their places.
#![cfg(unix)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use brushwork_tests::program::Child;
use brushwork_tests::wait::LIMIT;

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");

/// Runs `brushwork mcl` with something on standard input.
fn mcl(arguments: &[&str], input: &str) -> Output {
    let mut command = Command::new(BRUSHWORK);
    command.arg("mcl").args(arguments);
    Child::output(&command, input.as_bytes(), LIMIT)
}

fn shown(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn script(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, text).expect("the script can be written");
    path
}

fn path(path: &Path) -> &str {
    path.to_str().expect("a plain path")
}

#[test]
fn run_prints_the_bytes_of_stream_0_alone_and_ends_with_the_script() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = script(
        folder.path(),
        "a.mcl",
        "main\nputs 0,[\"hello\",13]\npause 5000\nputs 0,[0,255,dec 7]\nend\n",
    );
    let output = mcl(&["run", path(&file)], "");
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert_eq!(output.stdout, b"hello\r\x00\xFF7");
    assert!(shown(&output.stderr).contains("W402"), "the warning stands on standard error");
}

#[test]
fn run_ends_at_its_limit_and_feeds_gets_from_standard_input() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = script(
        folder.path(),
        "b.mcl",
        "n var long\nmain\ngets 0,[dec n]\nputs 0,[dec n * 2,10]\ngoto main\n",
    );
    let output = mcl(&["run", "--limit", "2s", path(&file)], "1 20\n300\n");
    assert_eq!((output.status.code(), shown(&output.stdout)), (Some(0), "2\n40\n600\n".to_owned()));
}

#[test]
fn a_motor_turns_while_a_script_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "power 0,16000,100000\npause 1000\nif MOTORENCPOS(0) > 100 then turned\nputs 0,[\"stands\"]\nend\nturned\nputs 0,[\"turned\"]\nend\n";
    let file = script(folder.path(), "c.mcl", text);
    assert_eq!(shown(&mcl(&["run", path(&file)], "").stdout), "turned");
}

#[test]
fn a_script_finds_the_devices_that_are_put_on_its_buses() {
    let folder = tempfile::tempdir().expect("a folder");
    // MCP manual 3.4.1, I2COUT: the MPU-6050 answers 0x68 to WHOAMI.
    let text = "temp var long\npause 10\ni2cout error,10,[0xd0,0x75]\ni2coutns error,10,[0xd1]\ni2cin error,10,[temp]\n\
                puts 0,[dec temp]\nend\nerror\nputs 0,[\"I2C Error:\",dec i2cerror]\nend\n";
    let i2c = script(folder.path(), "i2c.mcl", text);
    assert_eq!(shown(&mcl(&["run", "-q", path(&i2c), "--i2c", "mpu6050"], "").stdout), "104");
    assert!(shown(&mcl(&["run", "-q", path(&i2c)], "").stdout).starts_with("I2C Error:"));
    let text = "letter var byte\nputs 1,[\"ab\"]\ngets 1,[letter]\nputs 0,[letter]\ngets 1,[letter]\nputs 0,[letter]\nend\n";
    let can = script(folder.path(), "can.mcl", text);
    let output = mcl(&["run", path(&can), "--can-peer", "echo", "--limit", "2s"], "");
    assert_eq!((output.status.code(), shown(&output.stdout)), (Some(0), "ab".to_owned()));
    assert_eq!(shown(&mcl(&["run", path(&can), "--limit", "2s"], "").stdout), "");
    let refused = mcl(&["run", path(&i2c), "--i2c", "mpu6050", "--stream", "2"], "");
    assert_eq!(refused.status.code(), Some(2), "{refused:?}");
    assert!(shown(&refused.stderr).contains("the same pins"), "{refused:?}");
}

#[test]
fn a_fault_and_an_error_end_with_their_codes_and_name_the_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let file =
        script(folder.path(), "d.mcl", "i var byte\nl var byte(2)\ni = 2\nl(i) = 1\nputs 0,[l(0)]\nend\n");
    let output = mcl(&["run", path(&file)], "");
    assert_eq!(output.status.code(), Some(10), "{output:?}");
    assert!(shown(&output.stderr).contains("d.mcl:4: "), "{output:?}");
    let file = script(folder.path(), "e.mcl", "goto nowhere\n");
    for command in ["run", "check", "build", "disasm"] {
        let output = mcl(&[command, path(&file)], "");
        assert_eq!(output.status.code(), Some(9), "{command}: {output:?}");
    }
    assert!(!folder.path().join("e.mcli").exists());
}

#[test]
fn check_tells_everything_as_json_for_several_files_and_standard_input() {
    let folder = tempfile::tempdir().expect("a folder");
    let good = script(folder.path(), "good.mcl", "puts 0,[1]\nend\n");
    let output = mcl(&["check", "--json", path(&good), "-"], "a = 1\n");
    assert_eq!(output.status.code(), Some(9));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(report["files"][0]["ok"], true);
    let wrong = &report["files"][1]["diagnostics"][0];
    assert_eq!((wrong["code"].as_str(), wrong["line"].as_u64()), (Some("E302"), Some(1)));
    // The form that the help promises, with a hint and without.
    let output = mcl(&["check", "--json", "-"], "main\n\tgoto mian\nend\n");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let expected = serde_json::json!({ "files": [{
        "file": "standard input", "ok": false, "errors": 1, "warnings": 1, "diagnostics": [
            { "code": "W402", "severity": "warning", "line": 1, "column": 1, "end": { "line": 1, "column": 5 },
              "message": "Nothing jumps to `main`." },
            { "code": "E301", "severity": "error", "line": 2, "column": 7, "end": { "line": 2, "column": 11 },
              "message": "There is no label `mian`.", "hint": "Did you mean main?" },
        ] }] });
    assert_eq!(report, expected);
    assert_eq!(mcl(&["check", path(&folder.path().join("none.mcl"))], "").status.code(), Some(1));
}

#[test]
fn an_image_runs_and_is_listed_like_its_script() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = script(folder.path(), "f.mcl", "puts 0,[\"image\"]\nend\n");
    let output = mcl(&["build", "--json", path(&file)], "");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(report["files"][0]["models"][0]["fits"], true);
    let stack = serde_json::json!({ "values": 1024, "gosubs": 256, "assumed": true });
    assert_eq!(report["files"][0]["stack"], stack);
    assert!(
        shown(&mcl(&["build", "--force", path(&file)], "").stdout).contains("those of the stack are assumed")
    );
    let image = folder.path().join("f.mcli");
    assert_eq!(shown(&mcl(&["run", path(&image)], "").stdout), "image");
    assert!(shown(&mcl(&["disasm", path(&image)], "").stdout).contains("out-text"));
}

#[test]
fn fmt_rewrites_files_once_and_check_names_those_that_would_change() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = script(folder.path(), "g.mcl", "main\nif 1 then\nputs 0 ,[1] ; one\nendif\nend\n");
    let output = mcl(&["fmt", "--check", path(&file)], "");
    assert_eq!((output.status.code(), shown(&output.stdout).trim()), (Some(6), path(&file)));
    assert_eq!(mcl(&["fmt", path(&file)], "").status.code(), Some(0));
    let formatted = std::fs::read_to_string(&file).expect("the script");
    assert_eq!(formatted, "main\n    if 1 then\n        puts 0, [1]  ; one\n    endif\n    end\n");
    assert_eq!(mcl(&["fmt", "--check", path(&file)], "").status.code(), Some(0));
    assert_eq!(shown(&mcl(&["fmt", "-"], "a  =  1\n").stdout), "a = 1\n");
}

fn mcl_in_a_gigabyte(arguments: &[&str], input: &str) -> Output {
    in_a_gigabyte(&[&["mcl"], arguments].concat(), input)
}

/// Runs the program with a file as its input and at most 1 GiB of addresses, beyond which it is ended by a signal.
fn in_a_gigabyte(arguments: &[&str], input: &str) -> Output {
    let mut command = Command::new("sh");
    command.args(["-c", "ulimit -v 1048576 && exec \"$0\" \"$@\" <\"$INPUT\"", BRUSHWORK]);
    command.args(arguments).env("INPUT", input);
    Child::output(&command, b"", LIMIT)
}

#[cfg(target_os = "linux")]
#[test]
fn input_without_end_is_refused_with_a_sentence() {
    for command in ["check", "build", "run", "disasm", "fmt"] {
        let by_input = mcl_in_a_gigabyte(&[command, "-"], "/dev/zero");
        let by_name = mcl_in_a_gigabyte(&[command, "/dev/zero"], "/dev/null");
        for (output, name) in [(by_input, "-"), (by_name, "/dev/zero")] {
            assert_eq!(output.status.code(), Some(1), "{command} {name}: {}", shown(&output.stderr));
            let expected = format!(
                "Could not read {name}: it goes on after 16 MiB, and nothing that belongs here is as long"
            );
            assert!(shown(&output.stderr).starts_with(&expected), "{command}: {}", shown(&output.stderr));
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn every_command_that_reads_a_file_refuses_one_without_end() {
    let bound = "it goes on after 16 MiB, and nothing that belongs here is as long";
    for (arguments, code) in [
        (&["monitor", "--decode", "/dev/zero"][..], 1),
        (&["monitor", "--decode", "-"], 1),
        (&["settings", "diff", "/dev/zero", "/dev/zero"], 5),
        (&["settings", "import", "/dev/zero", "--connect", "sim:mcp266"], 5),
        (&["tune", "replay", "/dev/zero"], 1),
        (&["firmware", "update", "/dev/zero", "--connect", "sim:mcp266"], 1),
        (&["sim", "--like", "/dev/zero", "--pty", "unused"], 2),
    ] {
        let output = in_a_gigabyte(arguments, "/dev/zero");
        let said = shown(&output.stderr);
        assert!(said.contains(bound), "{arguments:?}: {:?}: {said}", output.status);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
    }
}

#[test]
fn hostile_scripts_are_answered_in_a_gigabyte() {
    let folder = tempfile::tempdir().expect("a folder");
    let long = format!("x var long\nx = x{}\nend\n", "+x".repeat(39_999));
    let longer = "end\n".repeat(600_000);
    for (name, text, code, said) in [
        ("nuls", "\0".repeat(50_000), 9, "49900 more errors than the 100 that are listed"),
        ("more-nuls", "\0".repeat(1_000_000), 9, "999900 more errors than the 100 that are listed"),
        ("sum", long, 0, "0 errors"),
        ("deep", "(".repeat(1_000_000), 9, "A statement cannot begin with `(`"),
        ("deeper", format!("a = {}", "(".repeat(1_000_000)), 9, "nested more than 100 levels deep"),
        (
            "long",
            longer,
            9,
            "long.mcl:524289:1: error E317: The text has 2400000 bytes; a program has at most 2097152",
        ),
    ] {
        let file = script(folder.path(), &format!("{name}.mcl"), &text);
        let output = mcl_in_a_gigabyte(&["check", path(&file)], "/dev/null");
        assert_eq!(output.status.code(), Some(code), "{name}: {}", shown(&output.stderr));
        assert!(shown(&output.stdout).contains(said), "{name}: {}", shown(&output.stdout));
        // A hundred errors with their lines, none of them drawn in full.
        assert!(output.stdout.len() < 200_000, "{name}: {} bytes", output.stdout.len());
    }
    let file = folder.path().join("long.mcl");
    let output = mcl_in_a_gigabyte(&["fmt", path(&file)], "/dev/null");
    assert_eq!(output.status.code(), Some(9), "{}", shown(&output.stderr));
}
