//! The node's side: one access at a time, to whatever has the objects.

use super::abort::Abort;
use super::message::{Request, Response};
use super::size::{EXPEDITED_BYTES, SEGMENT_BYTES};

/// A value of more bytes than this is not taken.
const LONGEST_VALUE: usize = 256;

/// The objects of a node.
pub trait Dictionary {
    /// The value of an object, little-endian.
    ///
    /// # Errors
    /// Why it cannot be read.
    fn read(&mut self, index: u16, subindex: u8) -> Result<Vec<u8>, Abort>;

    /// Sets an object.
    ///
    /// # Errors
    /// Why it is not taken.
    fn write(&mut self, index: u16, subindex: u8, value: &[u8]) -> Result<(), Abort>;
}

/// The server of a node.
#[derive(Clone, Debug, Default)]
pub struct Server {
    open: Option<Open>,
}

/// An access in segments that is under way.
#[derive(Clone, Debug)]
struct Open {
    index: u16,
    subindex: u8,
    toggle: bool,
    kind: Kind,
}

#[derive(Clone, Debug)]
enum Kind {
    Upload { value: Vec<u8>, sent: usize },
    Download { value: Vec<u8>, size: Option<u32> },
}

impl Server {
    /// Takes the data of a request frame and says what goes back. A new access replaces one that is under way.
    pub fn take(&mut self, bytes: &[u8], objects: &mut dyn Dictionary) -> Option<[u8; 8]> {
        let Some(request) = Request::read(bytes) else {
            // Block transfer and what is reserved; the object stands where an initiation has it.
            let (index, subindex) = match bytes {
                [_, low, high, subindex, ..] => (u16::from_le_bytes([*low, *high]), *subindex),
                _ => return None,
            };
            self.open = None;
            return Some(Response::Abort { index, subindex, code: Abort::UNKNOWN_COMMAND }.bytes());
        };
        let response = match request {
            Request::Upload { index, subindex } => self.begin_upload(index, subindex, objects),
            Request::UploadSegment { toggle } => self.upload_segment(toggle),
            Request::DownloadExpedited { index, subindex, data, length } => {
                self.open = None;
                finish(index, subindex, objects.write(index, subindex, &data[..usize::from(length)]))
            }
            Request::DownloadSegmented { index, subindex, size } => {
                self.begin_download(index, subindex, size)
            }
            Request::DownloadSegment { toggle, data, length, is_last } => {
                self.download_segment(toggle, &data[..usize::from(length)], is_last, objects)
            }
            Request::Abort { .. } => {
                self.open = None;
                return None;
            }
        };
        Some(response.bytes())
    }

    /// Forgets an access that is under way.
    pub fn reset(&mut self) {
        self.open = None;
    }

    fn begin_upload(&mut self, index: u16, subindex: u8, objects: &mut dyn Dictionary) -> Response {
        self.open = None;
        let value = match objects.read(index, subindex) {
            Ok(value) => value,
            Err(code) => return Response::Abort { index, subindex, code },
        };
        if (1..=EXPEDITED_BYTES).contains(&value.len()) {
            let mut data = [0; EXPEDITED_BYTES];
            data[..value.len()].copy_from_slice(&value);
            return Response::UploadExpedited { index, subindex, data, length: Some(value.len() as u8) };
        }
        let size = u32::try_from(value.len()).ok();
        self.open = Some(Open { index, subindex, toggle: false, kind: Kind::Upload { value, sent: 0 } });
        Response::UploadSegmented { index, subindex, size }
    }

    fn upload_segment(&mut self, asked: bool) -> Response {
        let Some(mut open) = self.open.take() else { return abort(0, 0, Abort::UNKNOWN_COMMAND) };
        let Kind::Upload { value, sent } = &mut open.kind else {
            return abort(open.index, open.subindex, Abort::UNKNOWN_COMMAND);
        };
        if asked != open.toggle {
            return abort(open.index, open.subindex, Abort::TOGGLE);
        }
        let rest = value.get(*sent..).unwrap_or_default();
        let used = rest.len().min(SEGMENT_BYTES);
        let mut data = [0; SEGMENT_BYTES];
        data[..used].copy_from_slice(&rest[..used]);
        let is_last = rest.len() <= SEGMENT_BYTES;
        *sent += used;
        open.toggle = !asked;
        if !is_last {
            self.open = Some(open);
        }
        Response::UploadSegment { toggle: asked, data, length: used as u8, is_last }
    }

    fn begin_download(&mut self, index: u16, subindex: u8, size: Option<u32>) -> Response {
        self.open = None;
        if size.is_some_and(|size| size as usize > LONGEST_VALUE) {
            return abort(index, subindex, Abort::TOO_LONG);
        }
        let kind = Kind::Download { value: Vec::new(), size };
        self.open = Some(Open { index, subindex, toggle: false, kind });
        Response::Downloaded { index, subindex }
    }

    fn download_segment(
        &mut self,
        toggle: bool,
        bytes: &[u8],
        is_last: bool,
        objects: &mut dyn Dictionary,
    ) -> Response {
        let Some(mut open) = self.open.take() else { return abort(0, 0, Abort::UNKNOWN_COMMAND) };
        let (index, subindex) = (open.index, open.subindex);
        let Kind::Download { value, size } = &mut open.kind else {
            return abort(index, subindex, Abort::UNKNOWN_COMMAND);
        };
        if toggle != open.toggle {
            return abort(index, subindex, Abort::TOGGLE);
        }
        value.extend_from_slice(bytes);
        if value.len() > LONGEST_VALUE {
            return abort(index, subindex, Abort::TOO_LONG);
        }
        if !is_last {
            open.toggle = !toggle;
            self.open = Some(open);
            return Response::SegmentDownloaded { toggle };
        }
        if size.is_some_and(|size| size as usize != value.len()) {
            return abort(index, subindex, Abort::LENGTH);
        }
        match objects.write(index, subindex, value) {
            Ok(()) => Response::SegmentDownloaded { toggle },
            Err(code) => abort(index, subindex, code),
        }
    }
}

fn finish(index: u16, subindex: u8, written: Result<(), Abort>) -> Response {
    match written {
        Ok(()) => Response::Downloaded { index, subindex },
        Err(code) => abort(index, subindex, code),
    }
}

fn abort(index: u16, subindex: u8, code: Abort) -> Response {
    Response::Abort { index, subindex, code }
}
