//! The client's side of one access to an object.

use super::abort::Abort;
use super::message::{Request, Response};
use super::size::{EXPEDITED_BYTES, SEGMENT_BYTES};

/// A value of more bytes than this is given up: no object of a motor controller is that long.
const LONGEST_VALUE: usize = 4096;

/// One read or write of an object, frame by frame.
#[derive(Clone, Debug)]
pub struct Transfer {
    index: u16,
    subindex: u8,
    step: Step,
}

#[derive(Clone, Debug)]
enum Step {
    Upload,
    UploadSegments { toggle: bool, got: Vec<u8>, size: Option<u32> },
    Download { data: Vec<u8> },
    DownloadSegments { toggle: bool, data: Vec<u8>, sent: usize },
}

/// What a response leads to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Progress {
    /// These bytes go out next.
    Send([u8; 8]),
    /// Done; what was read, nothing for a write.
    Done(Vec<u8>),
    /// The node refused.
    Refused(Abort),
    /// The response makes no sense; the abort goes out, and the access is over.
    GiveUp {
        /// The bytes that tell the node.
        bytes: [u8; 8],
        /// Why.
        code: Abort,
    },
    /// It answers something else, an access given up earlier for instance, and is passed by.
    Passed,
}

impl Transfer {
    /// Reads an object.
    #[must_use]
    pub fn upload(index: u16, subindex: u8) -> Self {
        Self { index, subindex, step: Step::Upload }
    }

    /// Writes an object.
    #[must_use]
    pub fn download(index: u16, subindex: u8, data: &[u8]) -> Self {
        Self { index, subindex, step: Step::Download { data: data.to_vec() } }
    }

    /// The first bytes to send.
    #[must_use]
    pub fn begin(&self) -> [u8; 8] {
        let (index, subindex) = (self.index, self.subindex);
        match &self.step {
            Step::Download { data } | Step::DownloadSegments { data, .. } => match expedited(data) {
                Some((data, length)) => Request::DownloadExpedited { index, subindex, data, length },
                None => Request::DownloadSegmented { index, subindex, size: u32::try_from(data.len()).ok() },
            },
            Step::Upload | Step::UploadSegments { .. } => Request::Upload { index, subindex },
        }
        .bytes()
    }

    /// The bytes that tell the node that this access is given up.
    #[must_use]
    pub fn abort(&self, code: Abort) -> [u8; 8] {
        Request::Abort { index: self.index, subindex: self.subindex, code }.bytes()
    }

    /// Takes the data of a response frame.
    pub fn take(&mut self, bytes: &[u8]) -> Progress {
        let Some(response) = Response::read(bytes) else { return self.give_up(Abort::UNKNOWN_COMMAND) };
        match response {
            Response::Abort { index, subindex, code } if self.is_about(index, subindex) => {
                Progress::Refused(code)
            }
            Response::UploadExpedited { index, subindex, data, length }
                if self.is_about(index, subindex) && matches!(self.step, Step::Upload) =>
            {
                Progress::Done(data[..usize::from(length.unwrap_or(EXPEDITED_BYTES as u8))].to_vec())
            }
            Response::UploadSegmented { index, subindex, size }
                if self.is_about(index, subindex) && matches!(self.step, Step::Upload) =>
            {
                self.step = Step::UploadSegments { toggle: false, got: Vec::new(), size };
                Progress::Send(Request::UploadSegment { toggle: false }.bytes())
            }
            Response::UploadSegment { toggle, data, length, is_last } => {
                self.take_segment(toggle, &data[..usize::from(length)], is_last)
            }
            Response::Downloaded { index, subindex } if self.is_about(index, subindex) => {
                self.begin_segments()
            }
            Response::SegmentDownloaded { toggle } => self.segment_taken(toggle),
            Response::UploadExpedited { .. }
            | Response::UploadSegmented { .. }
            | Response::Downloaded { .. }
            | Response::Abort { .. } => Progress::Passed,
        }
    }

    fn is_about(&self, index: u16, subindex: u8) -> bool {
        (index, subindex) == (self.index, self.subindex)
    }

    fn give_up(&self, code: Abort) -> Progress {
        Progress::GiveUp { bytes: self.abort(code), code }
    }

    fn take_segment(&mut self, toggle: bool, bytes: &[u8], is_last: bool) -> Progress {
        let Step::UploadSegments { toggle: expected, got, size } = &mut self.step else {
            return Progress::Passed;
        };
        if toggle != *expected {
            return self.give_up(Abort::TOGGLE);
        }
        got.extend_from_slice(bytes);
        if got.len() > LONGEST_VALUE {
            return self.give_up(Abort::OUT_OF_MEMORY);
        }
        if !is_last {
            *expected = !toggle;
            return Progress::Send(Request::UploadSegment { toggle: !toggle }.bytes());
        }
        if size.is_some_and(|size| size as usize != got.len()) {
            return self.give_up(Abort::LENGTH);
        }
        Progress::Done(std::mem::take(got))
    }

    fn begin_segments(&mut self) -> Progress {
        let Step::Download { data } = &mut self.step else { return Progress::Passed };
        if expedited(data).is_some() {
            return Progress::Done(Vec::new());
        }
        self.step = Step::DownloadSegments { toggle: false, data: std::mem::take(data), sent: 0 };
        self.next_segment()
    }

    fn segment_taken(&mut self, taken: bool) -> Progress {
        let Step::DownloadSegments { toggle, data, sent } = &mut self.step else { return Progress::Passed };
        if taken != *toggle {
            return self.give_up(Abort::TOGGLE);
        }
        *sent += SEGMENT_BYTES;
        *toggle = !*toggle;
        if *sent >= data.len() { Progress::Done(Vec::new()) } else { self.next_segment() }
    }

    fn next_segment(&self) -> Progress {
        let Step::DownloadSegments { toggle, data, sent } = &self.step else { return Progress::Passed };
        let rest = data.get(*sent..).unwrap_or_default();
        let used = rest.len().min(SEGMENT_BYTES);
        let mut bytes = [0; SEGMENT_BYTES];
        bytes[..used].copy_from_slice(&rest[..used]);
        let is_last = rest.len() <= SEGMENT_BYTES;
        let segment = Request::DownloadSegment { toggle: *toggle, data: bytes, length: used as u8, is_last };
        Progress::Send(segment.bytes())
    }
}

/// A value that fits into one frame. One without bytes goes in segments, since four unused bytes cannot be told.
fn expedited(value: &[u8]) -> Option<([u8; EXPEDITED_BYTES], u8)> {
    if value.is_empty() || value.len() > EXPEDITED_BYTES {
        return None;
    }
    let mut data = [0; EXPEDITED_BYTES];
    data[..value.len()].copy_from_slice(value);
    Some((data, value.len() as u8))
}
