//! Serial ports and pseudo-terminals. Only this file and that of the list know the `serialport` crate.

use super::byte_stream::{SecondWay, Transport, TransportError, WRITE_TIMEOUT};
use super::error::OpenError;
use super::refused;
use serialport::{ClearBuffer, ErrorKind, SerialPort};
use std::io;
use std::time::Duration;

/// An open serial port: eight data bits, no parity, one stop bit, no flow control.
pub struct SerialTransport {
    port: Box<dyn SerialPort>,
    path: String,
    byte_time: Duration,
    timeout: Duration,
    #[cfg(unix)]
    second: io::Result<std::os::fd::OwnedFd>,
}

impl SerialTransport {
    /// Opens `path`, be it listed or not, a pseudo-terminal or a link to one.
    ///
    /// RTS is raised where the port has it, since it forces packet serial on USB (MCP manual 1.9.3). Ports without that
    /// line, such as pseudo-terminals, answer ENOTTY, which is no error.
    pub fn open(path: &str, baud: u32) -> Result<Self, OpenError> {
        // Before the port is taken for this program alone. That it cannot be had is told when something is armed.
        #[cfg(unix)]
        let second = second_way(path);
        let mut port = open_port(path, baud).map_err(|error| explain(path, baud, &error))?;
        let _ = port.write_request_to_send(true);
        Ok(Self {
            port,
            path: path.to_owned(),
            byte_time: byte_time(baud),
            timeout: WRITE_TIMEOUT,
            #[cfg(unix)]
            second,
        })
    }

    /// Sets the wait of the next read or write; a system call on some systems, so only when it changes.
    fn wait_at_most(&mut self, timeout: Duration) -> Result<(), TransportError> {
        if self.timeout != timeout {
            self.port.set_timeout(timeout).map_err(|error| failed("setting up", error))?;
            self.timeout = timeout;
        }
        Ok(())
    }
}

impl Transport for SerialTransport {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        self.wait_at_most(WRITE_TIMEOUT)?;
        let mut written = 0;
        while written < bytes.len() {
            match self.port.write(&bytes[written..]) {
                Ok(0) => return Err(TransportError::WriteStuck { written, length: bytes.len() }),
                Ok(count) => written += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) if error.kind() == io::ErrorKind::TimedOut => {
                    return Err(TransportError::WriteStuck { written, length: bytes.len() });
                }
                Err(error) => return Err(TransportError::from_io("writing to", error)),
            }
        }
        Ok(())
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        self.wait_at_most(timeout)?;
        match self.port.read(buffer) {
            // A readable port that gives nothing is one whose device is gone.
            Ok(0) => Err(TransportError::Gone { detail: "end of file".to_owned() }),
            Ok(count) => Ok(count),
            Err(error) if nothing_yet(error.kind()) => Ok(0),
            Err(error) => Err(TransportError::from_io("reading from", error)),
        }
    }

    fn discard_input(&mut self) -> Result<usize, TransportError> {
        let waiting = self.port.bytes_to_read().map_err(|error| failed("looking at", error))?;
        if waiting > 0 {
            self.port.clear(ClearBuffer::Input).map_err(|error| failed("clearing", error))?;
        }
        Ok(usize::try_from(waiting).unwrap_or(usize::MAX))
    }

    fn describe(&self) -> String {
        self.path.clone()
    }

    fn byte_time(&self) -> Option<Duration> {
        Some(self.byte_time)
    }

    fn set_baud(&mut self, baud: u32) -> Result<bool, TransportError> {
        self.port.set_baud_rate(baud).map_err(|error| failed("setting up", error))?;
        self.byte_time = byte_time(baud);
        Ok(true)
    }

    #[cfg(unix)]
    fn second_way(&self) -> io::Result<SecondWay> {
        match &self.second {
            Ok(file) => Ok(SecondWay::Open(file.try_clone()?.into())),
            Err(error) => Err(io::Error::new(error.kind(), error.to_string())),
        }
    }

    #[cfg(not(unix))]
    fn second_way(&self) -> io::Result<SecondWay> {
        let baud = self.port.baud_rate().map_err(io::Error::from)?;
        Ok(SecondWay::Later(format!("{},baud={baud}", self.path)))
    }
}

/// Ten bits.
fn byte_time(baud: u32) -> Duration {
    Duration::from_secs(10) / baud.max(1)
}

/// The port as a plain file. It does not wait for a carrier, nor does it become this program's terminal.
#[cfg(unix)]
fn second_way(path: &str) -> io::Result<std::os::fd::OwnedFd> {
    use rustix::fs::{Mode, OFlags, open};
    Ok(open(path, OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC, Mode::empty())?)
}

fn open_port(path: &str, baud: u32) -> serialport::Result<Box<dyn SerialPort>> {
    let builder = serialport::new(path, baud).timeout(WRITE_TIMEOUT);
    match builder.clone().open() {
        // A pseudo-terminal of macOS refuses the call that sets a rate; rate 0 leaves it out.
        Err(error) if cfg!(target_os = "macos") && error.kind == ErrorKind::Unknown => {
            builder.baud_rate(0).open()
        }
        opened => opened,
    }
}

/// Finds out why a port did not open. The crate has few kinds, so the system is asked again.
#[allow(clippy::wildcard_enum_match_arm, reason = "the enum is not ours")]
fn explain(path: &str, baud: u32, error: &serialport::Error) -> OpenError {
    let path = path.to_owned();
    let detail = error.description.clone();
    match error.kind {
        ErrorKind::Io(io::ErrorKind::PermissionDenied) => {
            OpenError::Permission { remedy: refused::permission_remedy(&path).into(), path }
        }
        ErrorKind::Io(io::ErrorKind::NotFound) => OpenError::NotFound { path },
        ErrorKind::NoDevice if refused::exists(&path) => OpenError::Busy {
            holder: refused::holder(&path).unwrap_or_else(|| "another program".into()),
            path,
        },
        ErrorKind::NoDevice => OpenError::NotFound { path },
        _ if refused::is_no_device(&path) => OpenError::NotASerialPort { path, detail },
        _ => OpenError::Port { path, baud, detail },
    }
}

fn failed(action: &'static str, error: serialport::Error) -> TransportError {
    TransportError::from_io(action, io::Error::from(error))
}

fn nothing_yet(kind: io::ErrorKind) -> bool {
    matches!(kind, io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted)
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;
    use serialport::TTYPort;
    use std::io::{Read, Write};

    /// A pseudo-terminal whose slave end nobody holds open.
    fn pseudo_terminal() -> (TTYPort, String) {
        let (master, slave) = TTYPort::pair().unwrap();
        let path = slave.name().unwrap();
        (master, path)
    }

    #[test]
    fn a_pseudo_terminal_opens_by_path_although_it_has_no_rts_and_carries_bytes_both_ways() {
        let (mut master, path) = pseudo_terminal();
        let mut transport = SerialTransport::open(&path, 115_200).unwrap();
        transport.write(&[0x80, 21]).unwrap();
        let mut request = [0; 2];
        master.read_exact(&mut request).unwrap();
        assert_eq!(request, [0x80, 21]);
        master.write_all(&[1, 2, 3]).unwrap();
        let mut buffer = [0; 8];
        assert_eq!(transport.read(&mut buffer, Duration::from_secs(1)).unwrap(), 3);
        assert_eq!(transport.read(&mut buffer, Duration::from_millis(1)).unwrap(), 0);
    }

    #[test]
    fn discarding_throws_away_what_has_arrived() {
        let (mut master, path) = pseudo_terminal();
        let mut transport = SerialTransport::open(&path, 115_200).unwrap();
        master.write_all(&[9; 5]).unwrap();
        let mut first = [0; 1];
        assert_eq!(transport.read(&mut first, Duration::from_secs(1)).unwrap(), 1);
        assert_eq!(transport.discard_input().unwrap(), 4);
        assert_eq!(transport.read(&mut first, Duration::from_millis(1)).unwrap(), 0);
    }

    #[test]
    fn a_port_that_is_open_already_is_called_busy_and_its_holder_is_named() {
        let (_master, path) = pseudo_terminal();
        let _first = SerialTransport::open(&path, 115_200).unwrap();
        let error = SerialTransport::open(&path, 115_200).err().unwrap();
        assert!(matches!(error, OpenError::Busy { .. }), "{error}");
        if cfg!(target_os = "linux") {
            assert!(error.to_string().contains(&format!("process {}", std::process::id())), "{error}");
        }
    }

    #[test]
    fn a_path_that_is_not_there_and_a_plain_file_are_told_apart() {
        let missing = SerialTransport::open("/dev/no-such-port", 9_600).err().unwrap();
        assert!(matches!(missing, OpenError::NotFound { .. }), "{missing}");
        let file = tempfile::NamedTempFile::new().unwrap();
        let plain = SerialTransport::open(file.path().to_str().unwrap(), 9_600).err().unwrap();
        assert!(matches!(plain, OpenError::NotASerialPort { .. }), "{plain}");
    }

    #[test]
    fn a_device_that_is_pulled_out_is_gone_for_reading_and_for_writing() {
        let (master, path) = pseudo_terminal();
        let mut transport = SerialTransport::open(&path, 115_200).unwrap();
        drop(master);
        assert!(matches!(
            transport.read(&mut [0; 4], Duration::from_millis(20)),
            Err(TransportError::Gone { .. })
        ));
        assert!(transport.write(&[1]).is_err());
    }

    #[test]
    fn the_time_of_a_byte_is_ten_bits() {
        let (_master, path) = pseudo_terminal();
        let mut transport = SerialTransport::open(&path, 1_000_000).unwrap();
        assert_eq!(transport.byte_time(), Some(Duration::from_micros(10)));
        assert!(transport.set_baud(500_000).unwrap(), "at another rate from now on");
        assert_eq!(transport.byte_time(), Some(Duration::from_micros(20)));
    }
}
