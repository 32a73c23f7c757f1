//! What is assumed of a firmware stands in the table of its examination, file by file: it is asked, or said why not.

use std::collections::BTreeSet;

use brushwork_family::examine::Assumed;
use brushwork_tests::rust_source::without_tests;
use brushwork_tests::workspace;

/// The families that can be examined, by their folders.
const FAMILIES: [(&str, &[Assumed]); 2] = [
    ("device/mcp/", brushwork_mcp::examine::table::ASSUMED),
    ("device/motion_mind/", brushwork_motion_mind::examine::table::ASSUMED),
];
const PARTS: [&str; 4] = ["axis/src/", "client/src/", "sim/src/", "wire/src/"];

/// Whether a source assumes something: in a comment, or of a form of a command.
fn assumes(source: &str) -> bool {
    without_tests(source).lines().map(str::trim_start).any(|line| {
        line.starts_with("//") && line.contains("Assumed")
            || line.contains(".assumed(") && !line.contains("fn ")
    })
}

#[test]
fn every_file_that_assumes_something_has_its_rows_in_the_table_of_the_examination_and_no_other_has() {
    let is_test = |path: &str| path.contains("/tests/") || path.ends_with("tests.rs");
    for (folder, table) in FAMILIES {
        let paths = workspace::rust_files().into_iter().filter(|path| !is_test(path));
        let ours = paths.filter_map(|path| Some((path.strip_prefix(folder)?.to_owned(), path)));
        let assuming: BTreeSet<String> = ours
            .filter(|(file, _)| PARTS.iter().any(|part| file.starts_with(part)))
            .filter(|(_, path)| assumes(&workspace::read(path)))
            .map(|(file, _)| file)
            .collect();
        let in_table: BTreeSet<String> = table.iter().map(|row| row.file.to_owned()).collect();
        let missing: Vec<_> = assuming.difference(&in_table).collect();
        let gone: Vec<_> = in_table.difference(&assuming).collect();
        assert!(
            missing.is_empty() && gone.is_empty(),
            "{folder}family/src/examine/table.rs lacks {missing:?} and has {gone:?}, which assume nothing any more"
        );
    }
}
