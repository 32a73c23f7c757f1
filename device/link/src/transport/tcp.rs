//! Bytes over TCP: a serial server, or a simulated controller on another machine.
//!
//! A named thread reads, so that waiting for a byte has the resolution of a channel and not that of
//! a socket time-out (which some systems round up to several milliseconds).

use super::byte_stream::{SecondWay, Transport, TransportError, WRITE_TIMEOUT};
use crate::work::receive_within;
use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};
use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream, ToSocketAddrs};
use std::thread::JoinHandle;
use std::time::Duration;

/// How long a connection may take to be accepted.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(3);

type Chunk = Result<Vec<u8>, TransportError>;

/// A TCP connection to a controller.
pub struct TcpTransport {
    stream: TcpStream,
    chunks: Receiver<Chunk>,
    unread: Vec<u8>,
    lost: Option<TransportError>,
    reader: Option<JoinHandle<()>>,
    name: String,
}

impl TcpTransport {
    /// Connects to `address` ("host:port"), trying each address the name stands for.
    pub fn connect(address: &str) -> io::Result<Self> {
        let mut last = io::Error::new(io::ErrorKind::NotFound, "the name stands for no address");
        for candidate in address.to_socket_addrs()? {
            match TcpStream::connect_timeout(&candidate, CONNECT_TIMEOUT) {
                Ok(stream) => return Self::over(stream, format!("tcp:{address}")),
                Err(error) => last = error,
            }
        }
        Err(last)
    }

    fn over(stream: TcpStream, name: String) -> io::Result<Self> {
        stream.set_nodelay(true)?;
        stream.set_write_timeout(Some(WRITE_TIMEOUT))?;
        let (sender, chunks) = bounded(64);
        let source = stream.try_clone()?;
        let reader = std::thread::Builder::new()
            .name(format!("read {name}"))
            .spawn(move || read_all(source, &sender))?;
        Ok(Self { stream, chunks, unread: Vec::new(), lost: None, reader: Some(reader), name })
    }

    /// Takes in one chunk; remembers the reader's last word, since it is said only once.
    fn take(&mut self, chunk: Chunk) -> Result<(), TransportError> {
        match chunk {
            Ok(bytes) => self.unread.extend(bytes),
            Err(error) => {
                self.lost = Some(error.clone());
                return Err(error);
            }
        }
        Ok(())
    }

    fn last_word(&self) -> TransportError {
        let closed = || TransportError::Gone { detail: "the connection was closed".to_owned() };
        self.lost.clone().unwrap_or_else(closed)
    }
}

impl Transport for TcpTransport {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        let mut written = 0;
        while written < bytes.len() {
            match self.stream.write(&bytes[written..]) {
                Ok(0) => return Err(self.last_word()),
                Ok(count) => written += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => {
                    return Err(TransportError::WriteStuck { written, length: bytes.len() });
                }
                Err(error) => return Err(TransportError::from_io("writing to", error)),
            }
        }
        Ok(())
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        if self.unread.is_empty() {
            match receive_within(&self.chunks, timeout) {
                Ok(chunk) => self.take(chunk)?,
                Err(RecvTimeoutError::Timeout) => return Ok(0),
                Err(RecvTimeoutError::Disconnected) => return Err(self.last_word()),
            }
        }
        let count = self.unread.len().min(buffer.len());
        buffer[..count].copy_from_slice(&self.unread[..count]);
        self.unread.drain(..count);
        Ok(count)
    }

    fn discard_input(&mut self) -> Result<usize, TransportError> {
        while let Ok(chunk) = self.chunks.try_recv() {
            self.take(chunk)?;
        }
        let count = self.unread.len();
        self.unread.clear();
        Ok(count)
    }

    fn describe(&self) -> String {
        self.name.clone()
    }

    fn byte_time(&self) -> Option<Duration> {
        None
    }

    fn latency(&self) -> Duration {
        Duration::from_millis(250)
    }

    #[cfg(unix)]
    fn second_way(&self) -> io::Result<SecondWay> {
        Ok(SecondWay::Open(std::os::fd::OwnedFd::from(self.stream.try_clone()?).into()))
    }

    /// A socket is no file there.
    #[cfg(not(unix))]
    fn second_way(&self) -> io::Result<SecondWay> {
        Ok(SecondWay::Later(self.name.clone()))
    }
}

impl Drop for TcpTransport {
    fn drop(&mut self) {
        // Both only fail when the connection is already gone, which is what is wanted here.
        let _ = self.stream.shutdown(Shutdown::Both);
        while self.chunks.try_recv().is_ok() {}
        if let Some(reader) = self.reader.take() {
            let _ = reader.join();
        }
    }
}

/// Reads until the connection ends and says last why it did.
fn read_all(mut stream: TcpStream, chunks: &Sender<Chunk>) {
    let mut buffer = [0; 4096];
    loop {
        let chunk = match stream.read(&mut buffer) {
            Ok(0) => Err(TransportError::Gone { detail: "the far end closed the connection".to_owned() }),
            Ok(count) => Ok(buffer[..count].to_vec()),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => Err(TransportError::from_io("reading from", error)),
        };
        let ended = chunk.is_err();
        // A bounded wait: when the owner is being dropped nobody takes chunks any more.
        if chunks.send_timeout(chunk, WRITE_TIMEOUT).is_err() || ended {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::TcpListener;

    #[test]
    fn bytes_go_both_ways_and_the_end_of_the_connection_is_told() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap().to_string();
        let mut transport = TcpTransport::connect(&address).unwrap();
        let (mut far, _) = listener.accept().unwrap();
        transport.write(&[0x80, 21]).unwrap();
        let mut request = [0; 2];
        far.read_exact(&mut request).unwrap();
        assert_eq!(request, [0x80, 21]);
        far.write_all(&[7, 8, 9]).unwrap();
        let mut buffer = [0; 8];
        assert_eq!(transport.read(&mut buffer, Duration::from_secs(2)).unwrap(), 3);
        drop(far);
        let end = transport.read(&mut buffer, Duration::from_secs(2)).unwrap_err();
        assert!(matches!(end, TransportError::Gone { .. }), "{end:?}");
        let again = transport.read(&mut buffer, Duration::from_secs(2)).unwrap_err();
        assert_eq!(again.to_string(), end.to_string(), "the reason is kept");
    }

    #[test]
    fn nothing_to_read_is_zero_bytes_after_the_wait() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let mut transport = TcpTransport::connect(&listener.local_addr().unwrap().to_string()).unwrap();
        assert_eq!(transport.read(&mut [0; 4], Duration::from_millis(2)).unwrap(), 0);
    }
}
