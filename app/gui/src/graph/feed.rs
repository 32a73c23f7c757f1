//! What the link tells the graph: samples with their own times, and events that become marks.

use crate::family;
use crate::graph::messages::MarkMessage;
use crate::messages::NameMessage;
use brushwork_link::device::{Drive, DriveCommand, Event, Reading, Sample};
use brushwork_values::Motor;

use super::series::NOT_READ;
use super::{LiveGraph, MarkKind};

impl LiveGraph {
    /// Takes a sample of the unit that is looked at.
    pub fn take(&mut self, sample: &Sample) {
        let replied_s = sample.replied_at.as_secs_f64();
        if let Some(expected) = self.next_sequence
            && sample.sequence > expected
        {
            self.lost(sample.sequence - expected);
        }
        self.next_sequence = Some(sample.sequence + 1);
        self.record_sample(sample);
        let count = self.live.channels.len();
        let (mut values, mut times_s) = (vec![NOT_READ; count], vec![replied_s; count]);
        for (column, reading) in self.columns_of(sample) {
            values[column] = reading.value;
            times_s[column] = reading.read_at().as_secs_f64();
        }
        self.push_read(replied_s, &values, |column| times_s[column]);
    }

    /// What a sample has of the channels of this graph, in their order.
    pub(super) fn columns_of(&self, sample: &Sample) -> impl Iterator<Item = (usize, Reading)> {
        let read = |key: &str| sample.readings().iter().find(|reading| reading.channel.key == key).copied();
        let channels = self.live.track.channels.iter().enumerate();
        channels.filter_map(move |(column, info)| Some((column, read(&info.key)?)))
    }

    /// Leaves a mark for an event that is one, at the event's own time or else at `now_s`.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn note(&mut self, event: &Event, now_s: f64) {
        match event {
            Event::Driven { sent_at, drive, .. } => {
                self.mark(sent_at.as_secs_f64(), MarkKind::Drive, drive_text(drive));
            }
            Event::Stopped(report) => self.mark(report.written_at.as_secs_f64(), MarkKind::Stop, "Stop"),
            Event::Armed { scope, .. } => {
                let scope = match self.family {
                    Some(known) => family::armed_text(family::of(known), *scope),
                    None => scope.to_string(),
                };
                self.mark(now_s, MarkKind::Arm, NameMessage::ArmedFor { scope }.to_string());
            }
            Event::Disarmed(reason) => self.mark(now_s, MarkKind::Arm, reason.to_string()),
            Event::Connected(identity) => {
                identity.title().clone_into(&mut self.files.device);
                self.family = Some(identity.family);
                let model = identity.model.and_then(|model| identity.family.model(model));
                let pins = || identity.channels().iter().filter(|channel| channel.is_pin()).count();
                self.pins =
                    model.map(|model| model.pins.len()).filter(|count| *count > 0).unwrap_or_else(pins);
            }
            Event::Lost(_) => self.mark(now_s, MarkKind::Note, "Link lost"),
            _ => {}
        }
    }
}

/// A motion command in a few words.
fn drive_text(drive: &Drive) -> String {
    let of = |motor: Motor| drive.of(motor).map(|command| format!("{motor} {}", command_text(&command)));
    Motor::BOTH.into_iter().filter_map(of).collect::<Vec<_>>().join(", ")
}

fn command_text(command: &DriveCommand) -> String {
    match command {
        DriveCommand::Duty { duty, .. } => MarkMessage::Duty { percent: duty * 100.0 + 0.0 }.to_string(),
        DriveCommand::Speed { speed_counts_per_s, .. } => {
            MarkMessage::Speed { speed: *speed_counts_per_s }.to_string()
        }
        DriveCommand::Distance { distance_counts, speed_counts_per_s, .. } => {
            MarkMessage::Distance { distance: *distance_counts, speed: *speed_counts_per_s }.to_string()
        }
        DriveCommand::Position { position_counts, .. } => {
            MarkMessage::Position { position: *position_counts }.to_string()
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use brushwork_link::device::Channel;
    use brushwork_mcp_client::channels::CHANNELS;

    use super::*;
    use crate::model::channels::graph_channels;

    const MS: fn(u64) -> Duration = Duration::from_millis;

    #[test]
    fn each_reading_keeps_the_time_of_its_own_exchange() {
        let mut graph = LiveGraph::new(graph_channels(CHANNELS), 0.1);
        let mut sample = Sample::new(0x80);
        sample.set(Channel::M1_PWM, 10.0, MS(1000), MS(1002));
        sample.set(Channel::MAIN_BATTERY, 24.0, MS(1010), MS(1014));
        graph.take(&sample);
        let history = &graph.live.track.history;
        let column = |channel: Channel| graph.live.track.channel_of_key(channel.key).unwrap();
        let (pwm_s, _) = history.reading(column(Channel::M1_PWM), 0).unwrap();
        let (battery_s, volts) = history.reading(column(Channel::MAIN_BATTERY), 0).unwrap();
        assert!((pwm_s - 1.001).abs() < 2e-5 && (battery_s - 1.012).abs() < 2e-5, "{pwm_s} {battery_s}");
        assert_eq!(volts, 24.0);
        assert_eq!(history.reading(column(Channel::M2_PWM), 0), None);
    }

    #[test]
    fn samples_that_were_thrown_away_are_counted_and_leave_a_gap() {
        let mut graph = LiveGraph::new(graph_channels(CHANNELS), 0.1);
        for sequence in [7, 8, 12] {
            let mut sample = Sample::new(0x80);
            sample.sequence = sequence;
            sample.set(Channel::M1_PWM, 1.0, MS(sequence * 100), MS(sequence * 100));
            graph.take(&sample);
        }
        assert_eq!(graph.rate.lost, 3);
        assert_eq!(graph.live.track.history.rows(), 0..4);
    }

    #[test]
    fn commands_leave_marks_at_the_time_they_were_sent() {
        let mut graph = LiveGraph::new(graph_channels(CHANNELS), 0.1);
        let drive = Drive::one(Motor::M2, DriveCommand::duty(0.255));
        graph.note(&Event::Driven { address: 0x80, sent_at: MS(1500), drive }, 9.0);
        graph.note(&Event::Disarmed(brushwork_link::device::DisarmReason::Asked), 9.0);
        let marks: Vec<_> = graph.live.track.marks.iter().collect();
        assert_eq!((marks[0].at_s, marks[0].text.as_str()), (1.5, "M2 duty 25.5 %"));
        assert_eq!((marks[1].at_s, marks[1].kind), (9.0, MarkKind::Arm));
    }
}
