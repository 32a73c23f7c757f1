//! What the graph of a link does with files, once per frame and when it is asked to.

use crate::messages::{GraphMessage, WindowStatusMessage};
use std::time::{Duration, SystemTime};

use brushwork_link::device::Sample;
use brushwork_link::{clock, work};
use crossbeam_channel::{TryRecvError, bounded};
use egui::{Color32, ColorImage, Rect};

use super::{Asked, Export, LEAST_PICTURE, OpenAs, Recording, Said, Stopping, size_text};
use crate::graph::live::Opened;
use crate::graph::picture::draw::Scene;
use crate::graph::picture::frame::Frame;
use crate::graph::picture::{Picture, legend, png, svg};
use crate::graph::runs::Run;
use crate::graph::{LiveGraph, Mark, Sheet, load};
use crate::model::message::Gravity;
use crate::theme::Palette;
use brushwork_core::recording::recorder::Recorder;
use brushwork_core::recording::{Form, Head, Reading, Record};

/// What is in view, drawn apart from the window.
struct Drawn {
    picture: Picture,
    whole: Rect,
    background: Color32,
    title: String,
}

impl Recording {
    /// What became of it, once it has ended.
    fn told(&self) -> Option<Said> {
        let progress = self.recorder.progress();
        let path = self.recorder.path().display().to_string();
        Some(match progress.ended? {
            Err(failure) => (Gravity::Error, failure),
            Ok(()) if progress.dropped > 0 => {
                let (samples, lost) = (progress.samples, progress.dropped);
                (Gravity::Warning, GraphMessage::RecordedInPart { samples, path, lost }.into())
            }
            Ok(()) => {
                let (samples, size) = (progress.samples, size_text(progress.bytes));
                let said = match self.stopping {
                    Some(Stopping::LinkEnded) => GraphMessage::RecordedUntilLost { samples, path, size },
                    Some(Stopping::OtherChannels) => GraphMessage::RecordedUntilOther { samples, path, size },
                    Some(Stopping::Asked) | None => GraphMessage::Recorded { samples, path, size },
                };
                (Gravity::Note, said.into())
            }
        })
    }
}

impl LiveGraph {
    /// Looks after files: once per frame. `now` is the link's time, while there is a link.
    pub fn poll_files(&mut self, now: Option<Duration>, dark: bool) -> Vec<Said> {
        self.files.dark = dark;
        self.files.clocks = now.map(|now| (clock::today(), now)).or(self.files.clocks);
        let mut said = Vec::new();
        self.poll_recording(&mut said);
        self.poll_loading(&mut said);
        self.files.working.retain(|working| match working.try_recv() {
            Ok(text) => {
                said.push(text);
                false
            }
            Err(error) => error == TryRecvError::Empty,
        });
        self.poll_dialog();
        said
    }

    fn poll_recording(&mut self, said: &mut Vec<Said>) {
        let mut goes_on = |recording: &Recording| {
            let told = recording.told();
            let goes_on = told.is_none();
            said.extend(told);
            goes_on
        };
        self.files.finishing.retain(&mut goes_on);
        self.files.recording.take_if(|recording| !goes_on(recording));
    }

    fn poll_loading(&mut self, said: &mut Vec<Said>) {
        let Some(loading) = &self.files.loading else { return };
        let answer = match loading.answer.try_recv() {
            Err(TryRecvError::Empty) => return,
            Err(TryRecvError::Disconnected) => Err(GraphMessage::NoThread.into()),
            Ok(answer) => answer,
        };
        let (name, open_as) = (loading.name.clone(), loading.open_as);
        self.files.loading = None;
        self.files.open_next();
        match answer {
            Err(sentence) => said.push((Gravity::Error, sentence)),
            Ok(loaded) => {
                if let Some(note) = &loaded.note {
                    said.push((Gravity::Warning, note.clone()));
                }
                match open_as {
                    OpenAs::Run => self.runs.push(Run::new(name, loaded.track)),
                    OpenAs::Recording => self.show_recording(name, loaded),
                }
            }
        }
    }

    fn show_recording(&mut self, name: String, loaded: load::Loaded) {
        let load::Loaded { track, began, note, left_out } = loaded;
        let mut sheet = Sheet::new(track);
        sheet.whole_from_s = sheet.track.began_s;
        let shown_live = |key: &str| self.live.channels.iter().any(|live| live.shown && live.info.key == key);
        let has_data =
            |index: usize| !sheet.track.history.summary(index, f64::NEG_INFINITY, f64::INFINITY).0.is_empty();
        let with_data: Vec<usize> = (0..sheet.channels.len()).filter(|index| has_data(*index)).collect();
        let same: Vec<usize> =
            with_data.iter().copied().filter(|index| shown_live(&sheet.channels[*index].info.key)).collect();
        let shown = if same.is_empty() { with_data.into_iter().take(4).collect() } else { same };
        for (index, channel) in sheet.channels.iter_mut().enumerate() {
            channel.shown = shown.contains(&index);
        }
        sheet.selected = shown.first().copied().unwrap_or(0);
        sheet.look_at_all();
        sheet.fit_shown();
        self.legend = None;
        self.opened = Some(Opened { name, sheet, began, note, left_out });
    }

    fn poll_dialog(&mut self) {
        let Some((asked, dialog)) = &self.files.dialog else { return };
        let asked = *asked;
        let Some(chosen) = dialog.chosen() else { return };
        self.files.dialog = None;
        match (asked, chosen.first()) {
            (Asked::Folder, Some(path)) => self.files.folder = path.display().to_string(),
            (Asked::Open, Some(_)) => self.files.open_together(&chosen),
            (Asked::Folder | Asked::Open, None) => {}
        }
    }

    /// The recording that is looked at goes; the live graph was sampled all the time.
    pub fn close_recording(&mut self) {
        self.legend = None;
        self.opened = None;
    }

    /// Begins to record what comes in from now on.
    pub fn record(&mut self, form: Form) {
        if self.files.is_recording() {
            return;
        }
        // A slow disk may still be at the last one.
        self.files.finishing.extend(self.files.recording.take());
        let base = self
            .files
            .clocks
            .map_or(Duration::from_secs_f64(self.live.newest_s().max(0.0)), |(_, link)| link);
        let columns = self.live.track.channels.iter().map(load::column_of).collect();
        let head = Head { columns, began: self.files.wall(base), device: self.files.device.clone() };
        let path = self.files.free_path(form.extension());
        match Recorder::start(&path, form, head) {
            Ok(recorder) => self.files.recording = Some(Recording { recorder, base, stopping: None }),
            Err(error) => {
                self.files.say(Gravity::Error, WindowStatusMessage::NotRecorded { error: error.to_string() });
            }
        }
    }

    /// The link is gone: so is what could be recorded.
    pub fn link_ended(&mut self) {
        self.push_gap();
        self.end_recording(Stopping::LinkEnded);
    }

    pub(in crate::graph) fn end_recording(&mut self, why: Stopping) {
        if let Some(recording) =
            self.files.recording.as_mut().filter(|recording| recording.stopping.is_none())
        {
            recording.stopping = Some(why);
            recording.recorder.stop();
        }
    }

    pub(in crate::graph) fn record_sample(&self, sample: &Sample) {
        self.files.record_record(|base| {
            let since = |at: Duration| u64::try_from(at.saturating_sub(base).as_micros()).unwrap_or(u64::MAX);
            let readings: Vec<_> = self
                .columns_of(sample)
                .map(|(column, read)| Reading {
                    column,
                    value: read.value,
                    requested_us: since(read.requested_at),
                    replied_us: since(read.replied_at),
                })
                .collect();
            (!readings.is_empty()).then_some(Record::Sample(readings))
        });
    }

    pub(in crate::graph) fn record_mark(&self, mark: &Mark) {
        self.files.record_record(|base| {
            let since_s = (mark.at_s - base.as_secs_f64()).max(0.0);
            let at_us = (since_s * 1e6).round() as u64;
            Some(Record::Mark { at_us, kind: mark.kind.word().to_owned(), text: mark.text.clone() })
        });
    }

    pub(in crate::graph) fn record_gap(&self, at_s: f64) {
        self.files.record_record(|base| {
            let since_s = (at_s - base.as_secs_f64()).max(0.0);
            Some(Record::Gap { at_us: (since_s * 1e6).round() as u64 })
        });
    }

    /// Writes all that is kept of what came in to a new file, with all its marks.
    pub fn save_history(&mut self) {
        let track = &self.live.track;
        let has_data =
            |index: &usize| !track.history.summary(*index, f64::NEG_INFINITY, f64::INFINITY).0.is_empty();
        let keys: Vec<String> = (0..track.channels.len())
            .filter(has_data)
            .map(|index| track.channels[index].key.clone())
            .collect();
        if keys.is_empty() {
            return self.files.say(Gravity::Warning, GraphMessage::NothingKept);
        }
        let (track, zero_s) = (track.clone(), track.began_s.unwrap_or(0.0));
        let began = self.files.wall(Duration::from_secs_f64(zero_s.max(0.0)));
        let path = self.files.free_path("csv");
        self.files.write(path, move || {
            load::csv_of(&track, &keys, zero_s, began).map_err(|error| error.to_string())
        });
    }

    /// Writes what is in view to a new file.
    pub fn export(&mut self, what: Export) {
        let extension = match what {
            Export::Csv => "csv",
            Export::Png => "png",
            Export::Svg => "svg",
        };
        let path = self.files.free_path(extension);
        let make: Box<dyn FnOnce() -> Result<Vec<u8>, String> + Send> = match what {
            Export::Csv => {
                let sheet = self.sheet();
                let (start_s, end_s) = sheet.window();
                let shown: Vec<String> =
                    sheet.channels.iter().filter(|c| c.shown).map(|c| c.info.key.clone()).collect();
                let track = sheet.track.cut(start_s, end_s);
                let zero_s = sheet.track.began_s.unwrap_or(0.0);
                let began = match &self.opened {
                    Some(opened) => opened.began.unwrap_or(SystemTime::UNIX_EPOCH),
                    None => self.files.wall(Duration::from_secs_f64(zero_s.max(0.0))),
                };
                Box::new(move || {
                    load::csv_of(&track, &shown, zero_s, began).map_err(|error| error.to_string())
                })
            }
            Export::Png => {
                let Drawn { picture, whole, background, .. } = self.picture();
                Box::new(move || png::png(&picture, whole, background).map_err(|error| error.to_string()))
            }
            Export::Svg => {
                let Drawn { picture, whole, background, title } = self.picture();
                Box::new(move || Ok(svg::svg(&picture, whole, background, &title).into_bytes()))
            }
        };
        self.files.write(path, make);
    }

    /// Draws what is in view for the clipboard, as it is written to a file.
    pub fn copy_picture(&mut self) {
        let Drawn { picture, whole, background, .. } = self.picture();
        let (sender, receiver) = bounded(1);
        let draw = move || {
            let (size, rgba) = png::pixels(&picture, whole, background);
            // The window may be gone.
            let _ = sender.send(ColorImage::from_rgba_unmultiplied(size, &rgba));
        };
        match work::spawn("copy picture", draw) {
            Ok(()) => self.files.copying = Some(receiver),
            Err(error) => {
                self.files.say(Gravity::Error, WindowStatusMessage::NotExported { error: error.to_string() });
            }
        }
    }

    /// The picture with a head and a legend, ready to be drawn elsewhere.
    fn picture(&self) -> Drawn {
        let palette: &'static Palette =
            Palette::of_theme(if self.files.dark { egui::Theme::Dark } else { egui::Theme::Light });
        let sheet = self.sheet();
        let size = self.last_plot_size.max(LEAST_PICTURE);
        let head = legend::Legend::of(
            self,
            palette,
            self.files.wall(Duration::from_secs_f64(sheet.newest_s().max(0.0))),
        );
        let height = legend::height(&head, size.x);
        let plot = Rect::from_min_size(egui::pos2(0.0, height), size);
        let frame = Frame::new(plot, sheet.window());
        let is_recording = self.opened.is_some();
        let scene = Scene {
            sheet,
            runs: &self.runs,
            align: self.align,
            palette,
            frame,
            pixels_per_point: 2.0,
            is_recording,
        };
        let mut picture = scene.picture();
        let whole = Rect::from_min_max(egui::Pos2::ZERO, plot.max);
        picture.push(legend::layer(&head, palette, whole));
        Drawn { picture, whole, background: palette.panel, title: head.title.clone() }
    }
}
