//! The endpoint on TCP: one client at a time, on this computer only.

use super::error::ServerError;
use super::line::{Heard, Line};
use std::io::{self, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::time::Duration;

/// Bytes taken at a time.
const CHUNK: usize = 4096;
/// Of one look at the line; a client that never ends does not keep the machine from going on.
const CHUNKS: usize = 16;
/// Longest sleep where the system cannot wait for a socket and a time at once.
#[cfg(not(unix))]
const NAP: Duration = Duration::from_millis(1);

/// A listening port and the client on it.
#[derive(Debug)]
pub struct TcpLine {
    listener: TcpListener,
    address: SocketAddr,
    client: Option<TcpStream>,
    unplugged: bool,
}

impl TcpLine {
    /// Listens on a loopback address.
    pub fn open(address: SocketAddr) -> Result<Self, ServerError> {
        if !address.ip().is_loopback() {
            return Err(ServerError::NotLoopback { address });
        }
        let listen = || {
            let listener = TcpListener::bind(address)?;
            listener.set_nonblocking(true)?;
            let address = listener.local_addr()?;
            Ok((listener, address))
        };
        let (listener, address) = listen().map_err(|source| ServerError::Listen { address, source })?;
        Ok(Self { listener, address, client: None, unplugged: false })
    }

    /// Where it listens, with the port the system gave.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    #[cfg(unix)]
    fn wait(&self, timeout: Duration) {
        use std::os::fd::AsFd;
        let listener = self.listener.as_fd();
        match &self.client {
            Some(client) => drop(super::wait::wait_for([listener, client.as_fd()], timeout)),
            None => drop(super::wait::wait_for([listener], timeout)),
        }
    }

    #[cfg(not(unix))]
    fn wait(&self, timeout: Duration) {
        super::wait::pause(timeout, NAP);
    }

    /// Takes a client where there is none, and turns others away at once.
    fn accept(&mut self) {
        while let Ok((stream, _)) = self.listener.accept() {
            let taken = self.client.is_some() || self.unplugged;
            if !taken && stream.set_nonblocking(true).and_then(|()| stream.set_nodelay(true)).is_ok() {
                self.client = Some(stream);
            }
        }
    }

    /// Takes all that the client has sent, so that one that has left after it is known to have left before the next one is taken.
    fn hear(&mut self, bytes: &mut Vec<u8>) -> Heard {
        for _ in 0..CHUNKS {
            match self.read(bytes) {
                Ok(true) if self.client.is_some() => {}
                Ok(true) => return Heard::Line,
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {
                    return Heard::Line;
                }
                Ok(false) | Err(_) => {
                    self.client = None;
                    return Heard::ClientLeft;
                }
            }
        }
        Heard::Line
    }

    fn read(&mut self, bytes: &mut Vec<u8>) -> io::Result<bool> {
        let Some(client) = &mut self.client else { return Ok(true) };
        let mut chunk = [0; CHUNK];
        let count = client.read(&mut chunk)?;
        bytes.extend_from_slice(&chunk[..count]);
        Ok(count > 0)
    }
}

impl Line for TcpLine {
    fn receive(&mut self, bytes: &mut Vec<u8>, timeout: Duration) -> Heard {
        self.wait(timeout);
        let heard = self.hear(bytes);
        self.accept();
        heard
    }

    fn send(&mut self, reply: &[u8]) {
        if let Some(client) = &mut self.client {
            // Whatever the client's full buffer does not take is lost; a client that is gone is noticed at the next read.
            let _ = client.write(reply);
        }
    }

    fn unplug(&mut self) {
        self.client = None;
        self.unplugged = true;
    }

    fn plug_in(&mut self) -> Result<(), ServerError> {
        self.unplugged = false;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line_with_client() -> (TcpLine, TcpStream) {
        let mut line = TcpLine::open(SocketAddr::from(([127, 0, 0, 1], 0))).unwrap();
        let client = TcpStream::connect(line.address()).unwrap();
        assert_eq!(line.receive(&mut Vec::new(), Duration::from_secs(1)), Heard::Line);
        (line, client)
    }

    /// A server that the system let wait finds the bytes of one client, its end and the next client at one look.
    #[test]
    fn a_client_that_comes_when_the_one_before_has_left_is_not_turned_away() {
        let (mut line, mut first) = line_with_client();
        first.write_all(b"last").unwrap();
        drop(first);
        let mut second = TcpStream::connect(line.address()).unwrap();
        let mut bytes = Vec::new();
        assert_eq!(line.receive(&mut bytes, Duration::from_secs(1)), Heard::ClientLeft);
        assert_eq!(bytes, b"last");
        bytes.clear();
        second.write_all(b"first").unwrap();
        assert_eq!(line.receive(&mut bytes, Duration::from_secs(1)), Heard::Line);
        assert_eq!(bytes, b"first");
    }

    #[test]
    fn a_second_client_beside_the_first_is_turned_away() {
        let (mut line, mut first) = line_with_client();
        let mut second = TcpStream::connect(line.address()).unwrap();
        first.write_all(b"mine").unwrap();
        let mut bytes = Vec::new();
        assert_eq!(line.receive(&mut bytes, Duration::from_secs(1)), Heard::Line);
        assert_eq!(bytes, b"mine");
        assert_eq!(second.read(&mut [0]).unwrap(), 0, "it is at its end");
    }
}
