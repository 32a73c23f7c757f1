//! Frames in words, for traffic views.

use super::objects::command_of;
use crate::packet_serial::lookup;
use brushwork_canopen::sdo::{Request, Response};
use brushwork_canopen::{Emergency, Frame, Function, nmt};
use brushwork_values::hex;

/// What a frame says.
#[must_use]
pub fn describe_frame(frame: &Frame) -> String {
    if frame.is_remote() {
        return format!("{} is asked for", frame.id());
    }
    let reported = match Function::of(frame.id()) {
        Some(Function::Nmt) => nmt::Command::read(frame).map(|(command, node)| {
            let whom = node.map_or("all nodes".to_owned(), |node| node.to_string());
            format!("NMT to {whom}: {}", words_of(command))
        }),
        Some(Function::Heartbeat(node)) => {
            nmt::State::read(frame).map(|(_, state)| format!("{node} heartbeat: {state}"))
        }
        Some(Function::Emergency(node)) => Emergency::read(frame)
            .map(|emergency| format!("{node} emergency {:04X}: {}", emergency.code, emergency.class())),
        Some(Function::SdoRequest(node)) => {
            Request::read(frame.bytes()).map(|request| format!("{node} {}", request_words(&request)))
        }
        Some(Function::SdoResponse(node)) => {
            Response::read(frame.bytes()).map(|response| format!("{node} {}", response_words(&response)))
        }
        _ => None,
    };
    reported.unwrap_or_else(|| format!("{}: {}", frame.id(), hex(frame.bytes())))
}

fn words_of(command: nmt::Command) -> &'static str {
    match command {
        nmt::Command::Start => "start",
        nmt::Command::Stop => "stop",
        nmt::Command::EnterPreOperational => "enter pre-operational",
        nmt::Command::ResetNode => "reset node",
        nmt::Command::ResetCommunication => "reset communication",
    }
}

/// "2018:01" and the title of the command behind it, if there is one.
fn object(index: u16, subindex: u8) -> String {
    let title = command_of(index).and_then(lookup).map_or(String::new(), |row| format!(" ({})", row.title));
    format!("{index:04X}:{subindex:02X}{title}")
}

fn request_words(request: &Request) -> String {
    match *request {
        Request::Upload { index, subindex } => format!("reads {}", object(index, subindex)),
        Request::DownloadExpedited { index, subindex, data, length } => {
            format!("writes {}: {}", object(index, subindex), hex(&data[..usize::from(length)]))
        }
        Request::DownloadSegmented { index, subindex, size } => match size {
            Some(size) => format!("writes {}: {size} bytes follow", object(index, subindex)),
            None => format!("writes {}: segments follow", object(index, subindex)),
        },
        Request::UploadSegment { .. } => "reads the next segment".to_owned(),
        Request::DownloadSegment { data, length, .. } => {
            format!("writes a segment: {}", hex(&data[..usize::from(length)]))
        }
        Request::Abort { index, subindex, code } => format!("gives up {}: {code}", object(index, subindex)),
    }
}

fn response_words(response: &Response) -> String {
    match *response {
        Response::UploadExpedited { index, subindex, data, length } => {
            format!("holds {}: {}", object(index, subindex), hex(&data[..usize::from(length.unwrap_or(4))]))
        }
        Response::UploadSegmented { index, subindex, size } => match size {
            Some(size) => format!("holds {}: {size} bytes follow", object(index, subindex)),
            None => format!("holds {}: segments follow", object(index, subindex)),
        },
        Response::Downloaded { index, subindex } => format!("has taken {}", object(index, subindex)),
        Response::UploadSegment { data, length, .. } => {
            format!("segment: {}", hex(&data[..usize::from(length)]))
        }
        Response::SegmentDownloaded { .. } => "has taken the segment".to_owned(),
        Response::Abort { index, subindex, code } => format!("refuses {}: {code}", object(index, subindex)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_canopen::{CanId, NodeId};

    #[test]
    fn frames_are_told_in_words() {
        let three = NodeId::new(3).unwrap();
        let reported = |id, bytes: &[u8]| describe_frame(&Frame::data(CanId::Standard(id), bytes).unwrap());
        assert_eq!(reported(0x703, &[5]), "node 3 heartbeat: operational");
        assert_eq!(reported(0x000, &[0x81, 3]), "NMT to node 3: reset node");
        assert_eq!(
            reported(0x603, &[0x40, 0x18, 0x20, 0, 0, 0, 0, 0]),
            "node 3 reads 2018:00 (read main battery)"
        );
        assert_eq!(
            reported(0x583, &[0x80, 0x18, 0x20, 0, 0, 0, 2, 6]),
            "node 3 refuses 2018:00 (read main battery): the object does not exist (0602 0000)"
        );
        assert_eq!(reported(0x123, &[1, 2]), "123: 01 02");
        let emergency = Emergency { node: three, code: 0x8130, register: 0x11, data: [0; 5] };
        assert_eq!(describe_frame(&emergency.frame()), "node 3 emergency 8130: monitoring");
    }
}
