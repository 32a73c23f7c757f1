//! Standard output that survives a closed pipe: a failed write is an answer, not a panic.

use std::fmt::Display;
use std::io::{self, Write};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use serde_json::Value;

/// Why printing stopped.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The reader of our standard output has gone.
    #[error("standard output was closed")]
    Closed,
    /// Something else, such as a full disk.
    #[error("standard output can't be written: {0}")]
    Io(io::Error),
}

impl From<io::Error> for OutputError {
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe { Self::Closed } else { Self::Io(error) }
    }
}

/// Where a command's data goes.
pub struct Output {
    writer: Box<dyn Write>,
    /// JSON that is kept for one array, while a command goes to several controllers.
    kept: Option<Vec<Value>>,
}

impl Output {
    /// Standard output, flushed at every line.
    #[must_use]
    pub fn stdout() -> Self {
        Self { writer: Box::new(Watched(io::stdout())), kept: None }
    }

    /// A sink of the caller's.
    #[cfg(test)]
    pub fn to(writer: Box<dyn Write>) -> Self {
        Self { writer, kept: None }
    }

    /// Keeps JSON from now on instead of writing it.
    pub fn keep_json(&mut self) {
        self.kept = Some(Vec::new());
    }

    /// What was kept since the last time: nothing, the value, or an array of several. From now on JSON is written again.
    pub fn take_json(&mut self) -> Value {
        let mut kept = self.kept.take().unwrap_or_default();
        if kept.len() > 1 { Value::Array(kept) } else { kept.pop().unwrap_or_default() }
    }

    /// Writes one line.
    pub fn line(&mut self, text: impl Display) -> Result<(), OutputError> {
        self.writer.write_all(format!("{text}\n").as_bytes())?;
        self.writer.flush()?;
        Ok(())
    }

    /// Writes lines.
    pub fn lines(&mut self, lines: impl IntoIterator<Item = impl Display>) -> Result<(), OutputError> {
        lines.into_iter().try_for_each(|line| self.line(line))
    }

    /// Writes bytes as they are.
    pub fn bytes(&mut self, bytes: &[u8]) -> Result<(), OutputError> {
        self.writer.write_all(bytes)?;
        self.writer.flush()?;
        Ok(())
    }

    /// Writes a value as indented JSON.
    pub fn json(&mut self, value: &impl serde::Serialize) -> Result<(), OutputError> {
        if let Some(kept) = &mut self.kept {
            kept.push(serde_json::to_value(value).map_err(io::Error::from)?);
            return Ok(());
        }
        let text = serde_json::to_string_pretty(value).map_err(io::Error::from)?;
        self.line(text)
    }

    /// Writes a value as one line of JSON.
    pub fn json_line(&mut self, value: &impl serde::Serialize) -> Result<(), OutputError> {
        let text = serde_json::to_string(value).map_err(io::Error::from)?;
        self.line(text)
    }

    /// Writes rows in columns wide enough for their widest cell.
    pub fn table(&mut self, heads: &[&str], rows: &[Vec<String>]) -> Result<(), OutputError> {
        let width_of = |column: usize| {
            let cells = rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count());
            cells.chain([heads[column].chars().count()]).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..heads.len()).map(width_of).collect();
        self.line(padded(heads.iter().copied(), &widths))?;
        for row in rows {
            self.line(padded(row.iter().map(String::as_str), &widths))?;
        }
        Ok(())
    }
}

/// Since when a line is being written that nobody takes, in ms of [`clock_ms`]; 0 while none is.
static WRITES_SINCE_MS: AtomicU64 = AtomicU64::new(0);

/// How long what is being written now has not been taken, as where a pipe is full.
pub fn held_for() -> Duration {
    match WRITES_SINCE_MS.load(Ordering::SeqCst) {
        0 => Duration::ZERO,
        since_ms => Duration::from_millis(clock_ms().saturating_sub(since_ms)),
    }
}

/// Never 0.
fn clock_ms() -> u64 {
    static BEGUN: OnceLock<Instant> = OnceLock::new();
    let passed = BEGUN.get_or_init(Instant::now).elapsed().as_millis();
    u64::try_from(passed).unwrap_or(u64::MAX).saturating_add(1)
}

/// A stream of the process, whose reader may take nothing for as long as it likes.
struct Watched<W>(W);

impl<W: Write> Watched<W> {
    fn watched<T>(&mut self, write: impl FnOnce(&mut W) -> T) -> T {
        WRITES_SINCE_MS.store(clock_ms(), Ordering::SeqCst);
        let written = write(&mut self.0);
        WRITES_SINCE_MS.store(0, Ordering::SeqCst);
        written
    }
}

impl<W: Write> Write for Watched<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.watched(|writer| writer.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.watched(Write::flush)
    }
}

/// Says something to the person at the terminal; a closed standard error is nobody to tell.
pub fn say(text: impl Display) {
    let _ = writeln!(Watched(io::stderr()), "{text}");
}

fn padded<'a>(cells: impl Iterator<Item = &'a str>, widths: &[usize]) -> String {
    let line: Vec<String> = cells.zip(widths).map(|(cell, &width)| format!("{cell:<width$}")).collect();
    line.join("  ").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::super::exit::Exit;
    use super::*;

    struct Gone;

    impl Write for Gone {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(io::ErrorKind::BrokenPipe.into())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_closed_pipe_ends_the_command_as_interrupted() {
        let error = Output::to(Box::new(Gone)).line("x").unwrap_err();
        assert_eq!(Exit::from(error), Exit::Interrupted);
    }

    #[test]
    fn columns_are_as_wide_as_their_widest_cell() {
        assert_eq!(padded(["a", "b"].into_iter(), &[3, 1]), "a    b");
        assert_eq!(padded(["a", ""].into_iter(), &[3, 4]), "a");
    }
}
