//! The files that commands write: one place that never takes a file away unasked.
//!
//! What exists is replaced with `--force` alone, in one step and as itself: a symbolic link is replaced, not what it leads to. What a
//! command reads it never replaces. Standard output by its path, pipes and devices are written to and need no leave.

use std::fs::{self, File, Metadata};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use clap::Args;

use super::interrupt::meanwhile;
use super::{Exit, Interrupt};

/// Whether a file that exists may be replaced.
#[derive(Debug, Clone, Copy, Default, Args)]
pub struct Replace {
    /// Replace the file that is written if it exists already.
    #[arg(long)]
    pub force: bool,
}

/// Why a file is not written. The text is a sentence or two.
#[derive(Debug, thiserror::Error)]
pub enum NewFileError {
    /// Something of that name is there.
    #[error(
        "{} exists already and was not replaced. Give --force to replace it, or choose another name.",
        path.display()
    )]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// A symbolic link of that name is there; what it leads to is never written to.
    #[error(
        "{} is a symbolic link to {} and nothing was written through it. Give --force to replace it, not what it leads to, or choose another name.",
        path.display(),
        target.display()
    )]
    Link {
        /// The link.
        path: PathBuf,
        /// What it says.
        target: PathBuf,
    },
    /// The command reads that file.
    #[error(
        "{} is the file that the command reads, so it is not written over, with --force neither. Choose another name.",
        path.display()
    )]
    OwnInput {
        /// The file.
        path: PathBuf,
    },
    /// It is no place for a file.
    #[error("{} is a folder. Name a file in it.", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
    },
    /// The system refused.
    #[error("Could not write {}: {source}. Check the folder, your rights there and the free space.", path.display())]
    System {
        /// The file.
        path: PathBuf,
        /// What it said.
        source: io::Error,
    },
}

impl From<NewFileError> for Exit {
    /// Says it on standard error.
    fn from(error: NewFileError) -> Self {
        let is_ended = matches!(&error, NewFileError::System { source, .. } if source.kind() == io::ErrorKind::Interrupted);
        if is_ended { Self::Interrupted } else { Self::Failed.saying(error) }
    }
}

/// A file that a command is to write.
#[derive(Debug)]
pub struct NewFile<'a> {
    path: &'a Path,
    may_replace: bool,
    inputs: Vec<PathBuf>,
    /// Whether this command has made it, so that it may be replaced again.
    is_ours: bool,
}

impl<'a> NewFile<'a> {
    /// A file of that name.
    pub fn new(path: &'a Path, replace: Replace) -> Self {
        Self { path, may_replace: replace.force, inputs: Vec::new(), is_ours: false }
    }

    /// It must not be that file, which the command reads; `-` is standard input.
    #[must_use]
    pub fn apart_from(mut self, input: &Path) -> Self {
        let is_standard = input == Path::new("-");
        self.inputs.push(if is_standard { PathBuf::from("/dev/stdin") } else { input.to_owned() });
        self
    }

    /// Refuses what [`NewFile::write`] would refuse, before there is anything to lose.
    ///
    /// # Errors
    /// If it is an input, a folder, or exists and may not be replaced.
    pub fn check(&self) -> Result<(), NewFileError> {
        let path = || self.path.to_owned();
        if self.inputs.iter().any(|input| is_same(self.path, input)) {
            return Err(NewFileError::OwnInput { path: path() });
        }
        match fs::symlink_metadata(self.path) {
            Ok(found) if found.is_dir() => Err(NewFileError::Folder { path: path() }),
            Ok(_) if self.may_replace || self.is_ours || is_stream(self.path) => Ok(()),
            Ok(_) => Err(exists(self.path)),
            // Nothing is there, or writing will say what is wrong.
            Err(_) => Ok(()),
        }
    }

    /// Writes it, whole or not at all.
    ///
    /// # Errors
    /// As [`NewFile::check`], and if the system refuses; what was there is as it was then.
    #[allow(clippy::wildcard_enum_match_arm, reason = "the enum is not ours")]
    pub fn write(&mut self, bytes: &[u8]) -> Result<(), NewFileError> {
        self.check()?;
        let written = if is_stream(self.path) {
            write_to_stream(self.path, bytes)
        } else if self.may_replace || self.is_ours {
            replace(self.path, bytes)
        } else {
            create(self.path, bytes)
        };
        written.map_err(|source| match source.kind() {
            io::ErrorKind::AlreadyExists => exists(self.path),
            _ => NewFileError::System { path: self.path.to_owned(), source },
        })?;
        self.is_ours = true;
        Ok(())
    }
}

/// What is met where a file is to be new.
fn exists(path: &Path) -> NewFileError {
    match fs::read_link(path) {
        Ok(target) => NewFileError::Link { path: path.to_owned(), target },
        Err(_) => NewFileError::Exists { path: path.to_owned() },
    }
}

/// Makes a file that is not there; whoever was quicker keeps his.
fn create(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::options().write(true).create_new(true).open(path)?;
    file.write_all(bytes).inspect_err(|_| {
        // Ours, and no use to anybody. The first error is the one to tell.
        let _ = fs::remove_file(path);
    })
}

/// Puts a whole file in the place of whatever has that name.
fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let name =
        path.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "it names no file"))?;
    let beside = path.with_file_name(format!(".{}.{}.tmp", name.to_string_lossy(), std::process::id()));
    let permissions =
        fs::symlink_metadata(path).ok().filter(Metadata::is_file).map(|found| found.permissions());
    create(&beside, bytes)
        .and_then(|()| permissions.map_or(Ok(()), |permissions| fs::set_permissions(&beside, permissions)))
        .and_then(|()| fs::rename(&beside, path))
        .inspect_err(|_| {
            let _ = fs::remove_file(&beside);
        })
}

/// Writes on where this program's own output stands, or at the end of what is there.
fn write_to_stream(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let is_one_of = |names: [&str; 3]| names.iter().any(|name| path == Path::new(name));
    if is_one_of(["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"]) {
        let mut out = io::stdout();
        return out.write_all(bytes).and_then(|()| out.flush());
    }
    if is_one_of(["/dev/stderr", "/dev/fd/2", "/proc/self/fd/2"]) {
        return io::stderr().write_all(bytes);
    }
    let (path, bytes) = (path.to_owned(), bytes.to_vec());
    // A pipe is opened when somebody reads from it, which may be never.
    let write = move || File::options().append(true).open(path)?.write_all(&bytes);
    let ended = || io::Error::from(io::ErrorKind::Interrupted);
    let written = meanwhile(write, &|| Interrupt::of_process().breathe()).map_err(|_| ended())?;
    written.unwrap_or_else(|| Err(ended()))
}

/// Whether the path leads to something that is written to and not replaced: standard output, a pipe, a device.
fn is_stream(path: &Path) -> bool {
    let is_open_file = ["/dev/stdout", "/dev/stderr"].iter().any(|open| path == Path::new(open))
        || ["/dev/fd", "/proc/self/fd"].iter().any(|open| path.starts_with(open));
    is_open_file || fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir())
}

/// Whether both names lead to one file, by links of either kind too.
fn is_same(path: &Path, input: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt as _;
        let id = |path: &Path| fs::metadata(path).ok().map(|found| (found.dev(), found.ino()));
        id(path).is_some_and(|own| id(input) == Some(own))
    }
    #[cfg(not(unix))]
    fs::canonicalize(path).is_ok_and(|own| fs::canonicalize(input).is_ok_and(|other| own == other))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASKED: Replace = Replace { force: true };
    const UNASKED: Replace = Replace { force: false };

    fn text(path: &Path) -> String {
        fs::read_to_string(path).unwrap()
    }

    #[test]
    fn a_file_that_exists_is_replaced_only_when_asked_for() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out");
        NewFile::new(&path, UNASKED).write(b"first").unwrap();
        let refused = NewFile::new(&path, UNASKED).write(b"second").unwrap_err();
        assert!(
            refused.to_string().ends_with("Give --force to replace it, or choose another name."),
            "{refused}"
        );
        assert!(NewFile::new(&path, UNASKED).check().is_err());
        assert_eq!(text(&path), "first");
        NewFile::new(&path, ASKED).write(b"third").unwrap();
        assert_eq!(text(&path), "third");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing else is left");
        let into_folder = NewFile::new(folder.path(), ASKED).write(b"x").unwrap_err();
        assert!(into_folder.to_string().contains("is a folder"), "{into_folder}");
    }

    #[test]
    fn what_a_command_made_itself_it_may_write_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out");
        let mut file = NewFile::new(&path, UNASKED);
        for number in ["1", "2", "3"] {
            file.write(number.as_bytes()).unwrap();
            assert_eq!(text(&path), number);
        }
    }

    #[test]
    fn who_was_quicker_after_the_check_keeps_his_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out");
        let mut file = NewFile::new(&path, UNASKED);
        file.check().unwrap();
        fs::write(&path, "precious").unwrap();
        assert!(matches!(create(&path, b"x"), Err(error) if error.kind() == io::ErrorKind::AlreadyExists));
        assert!(file.write(b"x").is_err());
        assert_eq!(text(&path), "precious");
    }

    #[cfg(unix)]
    #[test]
    fn links_are_replaced_themselves_and_an_input_never_is_by_whatever_name() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let [path, soft, hard, dangling] =
            ["in", "soft", "hard", "dangling"].map(|name| folder.path().join(name));
        fs::write(&path, "precious").unwrap();
        symlink(&path, &soft).unwrap();
        fs::hard_link(&path, &hard).unwrap();
        symlink(folder.path().join("nowhere"), &dangling).unwrap();
        for name in [&path, &soft, &hard] {
            let refused = NewFile::new(name, ASKED).apart_from(&path).write(b"x").unwrap_err();
            assert!(matches!(refused, NewFileError::OwnInput { .. }), "{refused}");
            assert!(NewFile::new(name, UNASKED).write(b"x").is_err());
        }
        let met = NewFile::new(&dangling, UNASKED).write(b"x").unwrap_err().to_string();
        assert!(met.contains("is a symbolic link to") && met.contains("nowhere"), "{met}");
        assert!(!folder.path().join("nowhere").exists());
        NewFile::new(&soft, ASKED).write(b"new").unwrap();
        assert_eq!((text(&path).as_str(), text(&soft).as_str()), ("precious", "new"));
        assert!(fs::symlink_metadata(&soft).unwrap().is_file());
    }

    #[cfg(unix)]
    #[test]
    fn devices_and_pipes_are_written_to() {
        NewFile::new(Path::new("/dev/null"), UNASKED).write(b"x").unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
        let reported = NewFile::new(Path::new("/dev/full"), UNASKED).write(b"x").unwrap_err().to_string();
        assert!(reported.starts_with("Could not write /dev/full: No space left"), "{reported}");
    }
}
