//! The eight bytes of an SDO frame, from client to server and back (CiA 301, SDO protocols).
//!
//! Byte 0 is the command: specifier in bits 7 to 5; of an initiation bits 3 and 2 say how many of four bytes are unused, bit 1
//! that the value is in the frame ("expedited"), bit 0 that its size is told; of a segment bit 4 toggles, bits 3 to 1 say how many
//! of seven bytes are unused, bit 0 that it is the last.

use super::abort::Abort;
use super::size::{EXPEDITED_BYTES, SEGMENT_BYTES};

/// What a client asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// Read an object.
    Upload {
        /// The object.
        index: u16,
        /// Its part.
        subindex: u8,
    },
    /// Read the next segment.
    UploadSegment {
        /// Alternates from one segment to the next, beginning with `false`.
        toggle: bool,
    },
    /// Write an object whose value is in this frame.
    DownloadExpedited {
        /// The object.
        index: u16,
        /// Its part.
        subindex: u8,
        /// The value and unused bytes behind it.
        data: [u8; EXPEDITED_BYTES],
        /// Bytes in use.
        length: u8,
    },
    /// Write an object whose value follows in segments.
    DownloadSegmented {
        /// The object.
        index: u16,
        /// Its part.
        subindex: u8,
        /// Bytes of the value, if told.
        size: Option<u32>,
    },
    /// A segment of the value.
    DownloadSegment {
        /// Alternates.
        toggle: bool,
        /// The bytes and unused ones behind them.
        data: [u8; SEGMENT_BYTES],
        /// Bytes in use.
        length: u8,
        /// Whether it is the last.
        is_last: bool,
    },
    /// Gives the access up.
    Abort {
        /// The object.
        index: u16,
        /// Its part.
        subindex: u8,
        /// Why.
        code: Abort,
    },
}

/// What a server answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Response {
    /// The value is in this frame.
    UploadExpedited {
        /// The object.
        index: u16,
        /// Its part.
        subindex: u8,
        /// The value and unused bytes behind it.
        data: [u8; EXPEDITED_BYTES],
        /// Bytes in use, if told.
        length: Option<u8>,
    },
    /// The value follows in segments.
    UploadSegmented {
        /// The object.
        index: u16,
        /// Its part.
        subindex: u8,
        /// Bytes of the value, if told.
        size: Option<u32>,
    },
    /// A segment of the value.
    UploadSegment {
        /// Alternates.
        toggle: bool,
        /// The bytes and unused ones behind them.
        data: [u8; SEGMENT_BYTES],
        /// Bytes in use.
        length: u8,
        /// Whether it is the last.
        is_last: bool,
    },
    /// The write has begun, or is done if it was expedited.
    Downloaded {
        /// The object.
        index: u16,
        /// Its part.
        subindex: u8,
    },
    /// The segment was taken.
    SegmentDownloaded {
        /// Alternates.
        toggle: bool,
    },
    /// The access is refused or given up.
    Abort {
        /// The object.
        index: u16,
        /// Its part.
        subindex: u8,
        /// Why.
        code: Abort,
    },
}

const TOGGLE: u8 = 0x10;
const LAST: u8 = 0x01;
const EXPEDITED: u8 = 0x02;
const SIZED: u8 = 0x01;
const ABORT: u8 = 0x80;

impl Request {
    /// The bytes.
    #[must_use]
    pub fn bytes(&self) -> [u8; 8] {
        match *self {
            Self::Upload { index, subindex } => headed(0x40, index, subindex, [0; 4]),
            Self::UploadSegment { toggle } => [0x60 | toggled(toggle), 0, 0, 0, 0, 0, 0, 0],
            Self::DownloadExpedited { index, subindex, data, length } => {
                headed(0x20 | EXPEDITED | SIZED | unused_of_4(length), index, subindex, data)
            }
            Self::DownloadSegmented { index, subindex, size } => sized(0x20, index, subindex, size),
            Self::DownloadSegment { toggle, data, length, is_last } => segment(toggle, data, length, is_last),
            Self::Abort { index, subindex, code } => headed(ABORT, index, subindex, code.0.to_le_bytes()),
        }
    }

    /// Reads the data of a frame; `None` if it is no request of this protocol.
    #[must_use]
    pub fn read(bytes: &[u8]) -> Option<Self> {
        let bytes: [u8; 8] = bytes.try_into().ok()?;
        let (command, index, subindex, data) = parts(bytes);
        Some(match command >> 5 {
            0 => {
                let (toggle, data, length, is_last) = read_segment(bytes);
                Self::DownloadSegment { toggle, data, length, is_last }
            }
            1 if command & EXPEDITED != 0 => {
                let length = if command & SIZED != 0 { used_of_4(command) } else { EXPEDITED_BYTES as u8 };
                Self::DownloadExpedited { index, subindex, data, length }
            }
            1 => Self::DownloadSegmented { index, subindex, size: read_size(command, data) },
            2 => Self::Upload { index, subindex },
            3 => Self::UploadSegment { toggle: command & TOGGLE != 0 },
            4 => Self::Abort { index, subindex, code: Abort(u32::from_le_bytes(data)) },
            _ => return None,
        })
    }
}

impl Response {
    /// The bytes.
    #[must_use]
    pub fn bytes(&self) -> [u8; 8] {
        match *self {
            Self::UploadExpedited { index, subindex, data, length } => {
                let size = length.map_or(0, |length| SIZED | unused_of_4(length));
                headed(0x40 | EXPEDITED | size, index, subindex, data)
            }
            Self::UploadSegmented { index, subindex, size } => sized(0x40, index, subindex, size),
            Self::UploadSegment { toggle, data, length, is_last } => segment(toggle, data, length, is_last),
            Self::Downloaded { index, subindex } => headed(0x60, index, subindex, [0; 4]),
            Self::SegmentDownloaded { toggle } => [0x20 | toggled(toggle), 0, 0, 0, 0, 0, 0, 0],
            Self::Abort { index, subindex, code } => headed(ABORT, index, subindex, code.0.to_le_bytes()),
        }
    }

    /// Reads the data of a frame; `None` if it is no response of this protocol.
    #[must_use]
    pub fn read(bytes: &[u8]) -> Option<Self> {
        let bytes: [u8; 8] = bytes.try_into().ok()?;
        let (command, index, subindex, data) = parts(bytes);
        Some(match command >> 5 {
            0 => {
                let (toggle, data, length, is_last) = read_segment(bytes);
                Self::UploadSegment { toggle, data, length, is_last }
            }
            1 => Self::SegmentDownloaded { toggle: command & TOGGLE != 0 },
            2 if command & EXPEDITED != 0 => {
                let length = (command & SIZED != 0).then(|| used_of_4(command));
                Self::UploadExpedited { index, subindex, data, length }
            }
            2 => Self::UploadSegmented { index, subindex, size: read_size(command, data) },
            3 => Self::Downloaded { index, subindex },
            4 => Self::Abort { index, subindex, code: Abort(u32::from_le_bytes(data)) },
            _ => return None,
        })
    }
}

fn headed(command: u8, index: u16, subindex: u8, data: [u8; 4]) -> [u8; 8] {
    let [low, high] = index.to_le_bytes();
    let [a, b, c, d] = data;
    [command, low, high, subindex, a, b, c, d]
}

fn parts(bytes: [u8; 8]) -> (u8, u16, u8, [u8; 4]) {
    let [command, low, high, subindex, a, b, c, d] = bytes;
    (command, u16::from_le_bytes([low, high]), subindex, [a, b, c, d])
}

fn sized(command: u8, index: u16, subindex: u8, size: Option<u32>) -> [u8; 8] {
    let flag = if size.is_some() { SIZED } else { 0 };
    headed(command | flag, index, subindex, size.unwrap_or(0).to_le_bytes())
}

fn read_size(command: u8, data: [u8; 4]) -> Option<u32> {
    (command & SIZED != 0).then(|| u32::from_le_bytes(data))
}

fn unused_of_4(length: u8) -> u8 {
    4_u8.saturating_sub(length) << 2
}

fn used_of_4(command: u8) -> u8 {
    4 - ((command >> 2) & 3)
}

fn toggled(toggle: bool) -> u8 {
    if toggle { TOGGLE } else { 0 }
}

fn segment(toggle: bool, data: [u8; SEGMENT_BYTES], length: u8, is_last: bool) -> [u8; 8] {
    let unused = (SEGMENT_BYTES as u8).saturating_sub(length) << 1;
    let [a, b, c, d, e, f, g] = data;
    [toggled(toggle) | unused | u8::from(is_last), a, b, c, d, e, f, g]
}

fn read_segment(bytes: [u8; 8]) -> (bool, [u8; SEGMENT_BYTES], u8, bool) {
    let [command, a, b, c, d, e, f, g] = bytes;
    let length = SEGMENT_BYTES as u8 - ((command >> 1) & 7);
    (command & TOGGLE != 0, [a, b, c, d, e, f, g], length, command & LAST != 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_are_those_of_cia_301() {
        let (index, subindex) = (0x1017, 0x00);
        for (request, bytes) in [
            // 40: initiate upload; index low, high; subindex; four reserved bytes
            (Request::Upload { index: 0x1018, subindex: 1 }, [0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0]),
            // 60, 70: upload segment, toggle 0 and 1
            (Request::UploadSegment { toggle: false }, [0x60, 0, 0, 0, 0, 0, 0, 0]),
            (Request::UploadSegment { toggle: true }, [0x70, 0, 0, 0, 0, 0, 0, 0]),
            // 2F, 2B, 27, 23: initiate download, expedited, 1 to 4 bytes; the value low byte first
            (
                Request::DownloadExpedited { index, subindex, data: [0x7F, 0, 0, 0], length: 1 },
                [0x2F, 0x17, 0x10, 0, 0x7F, 0, 0, 0],
            ),
            (
                Request::DownloadExpedited { index, subindex, data: [0xE8, 0x03, 0, 0], length: 2 },
                [0x2B, 0x17, 0x10, 0, 0xE8, 0x03, 0, 0],
            ),
            (
                Request::DownloadExpedited { index, subindex, data: [1, 2, 3, 0], length: 3 },
                [0x27, 0x17, 0x10, 0, 1, 2, 3, 0],
            ),
            (
                Request::DownloadExpedited { index, subindex, data: [1, 2, 3, 4], length: 4 },
                [0x23, 0x17, 0x10, 0, 1, 2, 3, 4],
            ),
            // 21: initiate download in segments, ten bytes
            (
                Request::DownloadSegmented { index, subindex, size: Some(10) },
                [0x21, 0x17, 0x10, 0, 10, 0, 0, 0],
            ),
            // 00: segment, toggle 0, all seven bytes, more follow; 19: toggle 1, three bytes (four unused), last
            (
                Request::DownloadSegment {
                    toggle: false,
                    data: [1, 2, 3, 4, 5, 6, 7],
                    length: 7,
                    is_last: false,
                },
                [0x00, 1, 2, 3, 4, 5, 6, 7],
            ),
            (
                Request::DownloadSegment {
                    toggle: true,
                    data: [8, 9, 10, 0, 0, 0, 0],
                    length: 3,
                    is_last: true,
                },
                [0x19, 8, 9, 10, 0, 0, 0, 0],
            ),
            // 80: abort; the code low byte first
            (
                Request::Abort { index, subindex, code: Abort::TIMED_OUT },
                [0x80, 0x17, 0x10, 0, 0x00, 0x00, 0x04, 0x05],
            ),
        ] {
            assert_eq!(request.bytes(), bytes, "{request:?}");
            assert_eq!(Request::read(&bytes), Some(request));
        }
    }

    #[test]
    fn responses_are_those_of_cia_301() {
        let (index, subindex) = (0x1000, 0x00);
        for (response, bytes) in [
            // 4F, 4B, 47, 43: expedited upload of 1 to 4 bytes; 42: expedited, size not told
            (
                Response::UploadExpedited { index, subindex, data: [1, 0, 0, 0], length: Some(1) },
                [0x4F, 0x00, 0x10, 0, 1, 0, 0, 0],
            ),
            (
                Response::UploadExpedited { index, subindex, data: [1, 2, 0, 0], length: Some(2) },
                [0x4B, 0x00, 0x10, 0, 1, 2, 0, 0],
            ),
            (
                Response::UploadExpedited { index, subindex, data: [1, 2, 3, 4], length: Some(4) },
                [0x43, 0x00, 0x10, 0, 1, 2, 3, 4],
            ),
            (
                Response::UploadExpedited { index, subindex, data: [1, 2, 3, 4], length: None },
                [0x42, 0x00, 0x10, 0, 1, 2, 3, 4],
            ),
            // 41: upload in segments, 19 bytes
            (
                Response::UploadSegmented { index, subindex, size: Some(19) },
                [0x41, 0x00, 0x10, 0, 19, 0, 0, 0],
            ),
            // 60: download initiated; 20, 30: segment taken
            (Response::Downloaded { index, subindex }, [0x60, 0x00, 0x10, 0, 0, 0, 0, 0]),
            (Response::SegmentDownloaded { toggle: false }, [0x20, 0, 0, 0, 0, 0, 0, 0]),
            (Response::SegmentDownloaded { toggle: true }, [0x30, 0, 0, 0, 0, 0, 0, 0]),
            // 05: last segment, five bytes (two unused)
            (
                Response::UploadSegment {
                    toggle: false,
                    data: [1, 2, 3, 4, 5, 0, 0],
                    length: 5,
                    is_last: true,
                },
                [0x05, 1, 2, 3, 4, 5, 0, 0],
            ),
            // 80: abort 0602 0000, no such object
            (
                Response::Abort { index, subindex, code: Abort::NO_OBJECT },
                [0x80, 0x00, 0x10, 0, 0x00, 0x00, 0x02, 0x06],
            ),
        ] {
            assert_eq!(response.bytes(), bytes, "{response:?}");
            assert_eq!(Response::read(&bytes), Some(response));
        }
    }

    #[test]
    fn other_specifiers_and_lengths_are_no_messages() {
        for command in [0xA0, 0xC0, 0xE0] {
            let bytes = [command, 0, 0, 0, 0, 0, 0, 0];
            assert_eq!((Request::read(&bytes), Response::read(&bytes)), (None, None));
        }
        assert_eq!(Request::read(&[0x40, 0, 0x10]), None);
        assert_eq!(Response::read(&[0; 9]), None);
    }
}
