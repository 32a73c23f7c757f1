//! What a program that holds a line leaves for others of the same user: a file in the folder of what is kept, which only that user can read.
//!
//! It names the line by what it is, not by what it was called, so that links to a port and names of a host lead to it.

use std::collections::hash_map::RandomState;
use std::fs::{self, File};
use std::hash::BuildHasher as _;
use std::io::{self, Write as _};
use std::net::{SocketAddr, ToSocketAddrs as _};
use std::path::{Path, PathBuf};

use brushwork_link::{ConnectTarget, bounded};
use serde::{Deserialize, Serialize};

/// The folder of the notes.
pub(super) const FOLDER: &str = "held";
/// No note is longer.
const LONGEST: u64 = 8 * 1024;
/// No more are looked at, the latest first: what died without clearing up leaves its note until somebody asks for its line.
const MOST: usize = 256;

/// Who holds a line, and how it is asked to stop it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Note {
    /// What runs: "brushwork drive".
    pub program: String,
    /// Its process number.
    pub process: u32,
    /// The line, by every name that it goes by.
    pub lines: Vec<String>,
    /// Where it listens, on this computer alone.
    pub at: SocketAddr,
    /// Who asks says this, to show that it could read the note.
    pub question: String,
    /// Who answers says this, to show that it wrote the note: another program may have the port of one that died.
    pub answer: String,
}

impl Note {
    /// Writes it where nobody else can read it.
    pub(super) fn leave(&self, folder: &Path) -> io::Result<PathBuf> {
        make_private(folder)?;
        let path = folder.join(format!("{}-{}.json", self.process, &secret()[..16]));
        let mut file = create_private(&path)?;
        // One write: whoever reads it sees all or nothing.
        file.write_all(&serde_json::to_vec(self)?)?;
        Ok(path)
    }

    /// The notes of those that hold one of these lines.
    pub(super) fn of(folder: &Path, lines: &[String]) -> Vec<(PathBuf, Self)> {
        let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
        let left_at = |entry: &fs::DirEntry| entry.metadata().and_then(|known| known.modified()).ok();
        let mut entries: Vec<_> = entries.flatten().map(|entry| (left_at(&entry), entry.path())).collect();
        entries.sort_unstable_by(|left, right| right.cmp(left));
        let paths = entries.into_iter().take(MOST).map(|(_, path)| path);
        let notes = paths.filter_map(|path| Some((Self::read(&path)?, path)));
        let is_meant = |note: &Self| note.lines.iter().any(|line| lines.contains(line));
        notes.filter(|(note, _)| is_meant(note)).map(|(note, path)| (path, note)).collect()
    }

    fn read(path: &Path) -> Option<Self> {
        let bytes = bounded::read(File::open(path).ok()?, LONGEST).ok()?;
        let note: Self = serde_json::from_slice(&bytes).ok()?;
        note.at.ip().is_loopback().then_some(note)
    }
}

/// A word that nobody can guess: what the standard library's hash tables are protected by, 256 bits of it, which comes from the system.
pub(super) fn secret() -> String {
    (0..4_u64).map(|turn| format!("{:016x}", RandomState::new().hash_one(turn))).collect()
}

/// The names of the line that a target means; none of a simulated one, which is in the program itself.
pub(super) fn lines_of(target: &ConnectTarget) -> Vec<String> {
    match target {
        ConnectTarget::Serial { path, .. } => vec![port_of(path)],
        ConnectTarget::Tcp { address, .. } => {
            let found = address.to_socket_addrs().into_iter().flatten();
            found.map(|at| format!("tcp:{}", SocketAddr::new(at.ip().to_canonical(), at.port()))).collect()
        }
        ConnectTarget::Can { adapter, .. } => lines_of(adapter),
        ConnectTarget::Sim(_) => Vec::new(),
    }
}

/// What a link to a port leads to; on Windows, where there are no links, the name in one spelling.
fn port_of(path: &str) -> String {
    if cfg!(windows) {
        return path.trim_start_matches(r"\\.\").to_ascii_uppercase();
    }
    fs::canonicalize(path).map_or_else(|_| path.to_owned(), |real| real.to_string_lossy().into_owned())
}

#[cfg(unix)]
fn make_private(folder: &Path) -> io::Result<()> {
    use std::os::unix::fs::DirBuilderExt as _;
    fs::DirBuilder::new().recursive(true).mode(0o700).create(folder)
}

#[cfg(unix)]
fn create_private(path: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt as _;
    fs::OpenOptions::new().write(true).create_new(true).mode(0o600).open(path)
}

/// On Windows a user's own folders are the user's alone.
#[cfg(not(unix))]
fn make_private(folder: &Path) -> io::Result<()> {
    fs::create_dir_all(folder)
}

#[cfg(not(unix))]
fn create_private(path: &Path) -> io::Result<File> {
    File::create_new(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(target: &str) -> Vec<String> {
        lines_of(&target.parse().unwrap())
    }

    fn note_of(line: &str) -> Note {
        Note {
            program: "brushwork drive".to_owned(),
            process: 7,
            lines: vec![line.to_owned()],
            at: "127.0.0.1:5000".parse().unwrap(),
            question: secret(),
            answer: secret(),
        }
    }

    #[test]
    fn a_host_by_name_and_by_number_is_one_line_and_another_port_is_another() {
        assert_eq!(lines("tcp:127.0.0.1:5000"), ["tcp:127.0.0.1:5000"]);
        assert_eq!(lines("tcp:[::ffff:127.0.0.1]:5000"), lines("tcp:127.0.0.1:5000,latency=300"));
        assert!(lines("tcp:localhost:5000").contains(&"tcp:127.0.0.1:5000".to_owned()));
        assert_eq!(lines("can:tcp:127.0.0.1:5000,node=3"), lines("tcp:127.0.0.1:5000"));
        assert_ne!(lines("tcp:127.0.0.1:5001"), lines("tcp:127.0.0.1:5000"));
        assert!(lines("sim:").is_empty());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_a_port_is_the_port() {
        let folder = tempfile::tempdir().unwrap();
        let [port, link] = ["port", "by-id"].map(|name| folder.path().join(name));
        fs::write(&port, "").unwrap();
        std::os::unix::fs::symlink(&port, &link).unwrap();
        let [port, link] = [port, link].map(|path| lines(&format!("{},baud=9600", path.display())));
        assert_eq!(port, link);
    }

    #[cfg(unix)]
    #[test]
    fn a_note_is_read_by_its_user_alone() {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = tempfile::tempdir().unwrap();
        let held = folder.path().join(FOLDER);
        let note = note_of("/dev/ttyACM0");
        let path = note.leave(&held).unwrap();
        let rights = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!((rights(&held), rights(&path)), (0o700, 0o600));
        assert_eq!(Note::of(&held, &note.lines), [(path, note.clone())]);
        assert!(Note::of(&held, &["/dev/ttyACM1".to_owned()]).is_empty());
    }

    #[test]
    fn a_note_is_found_behind_those_of_any_number_of_dead_programs() {
        let folder = tempfile::tempdir().unwrap();
        let dead = note_of("/dev/ttyACM1");
        for _ in 0..2 * MOST {
            let path = dead.leave(folder.path()).unwrap();
            let before = std::time::SystemTime::now() - std::time::Duration::from_secs(60);
            File::options().write(true).open(path).unwrap().set_modified(before).unwrap();
        }
        let alive = Note { lines: vec!["/dev/ttyACM0".to_owned()], ..dead };
        let path = alive.leave(folder.path()).unwrap();
        assert_eq!(Note::of(folder.path(), &alive.lines), [(path, alive.clone())]);
    }

    #[test]
    fn no_two_secrets_are_alike() {
        let secrets: std::collections::BTreeSet<_> = (0..100).map(|_| secret()).collect();
        assert_eq!(secrets.len(), 100);
        assert!(secrets.iter().all(|secret| secret.len() == 64));
    }
}
