//! The film of README: connect to a simulated controller, drive it by hand, tune it, see the result; in virtual time, so that it is the same on
//! every computer.
//!
//! `BRUSHWORK_FILM=1 cargo test --workspace --test gui film::` draws it to `assets/pictures/film.png`, an animated PNG.

use std::fs::{self, File};
use std::io::BufWriter;
use std::path::Path;
use std::time::Duration;

use brushwork_gui::tune::Loop;
use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_plant::presets;
use brushwork_tuning::report::Verdict;
use brushwork_values::Motor;
use egui::{Pos2, Theme, pos2};
use image::RgbaImage;

use crate::support::bench::Bench;
use crate::support::palette::Palette;

const KEPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/pictures/film.png");
const SIZE: [f32; 2] = [1024.0, 700.0];
/// How long each picture of it is seen, and how much of the window's time lies between two.
const SEEN: Duration = Duration::from_millis(200);
/// The same in the middle of the tuning run, which is shown faster.
const BETWEEN_IN_RUN: Duration = Duration::from_millis(1200);
/// How long a hand takes from one button to the next, in pictures.
const WAY: u16 = 4;
/// What the whole of it may last.
const LASTS_S: std::ops::RangeInclusive<f64> = 20.0..=38.0;
const MOST_BYTES: u64 = 3_000_000;
/// Colours, and the number of none: what is as in the picture before.
const COLOURS: usize = 255;
const AS_BEFORE: u8 = 255;

/// A hand and a camera before the window.
struct Film {
    bench: Bench,
    pointer: Pos2,
    pictures: Option<Vec<RgbaImage>>,
    taken: usize,
}

impl Film {
    fn new() -> Self {
        let axis = presets::lookup("small-gearmotor").expect("a preset");
        let default = ControllerConfig::default();
        let world = presets::world_of(axis, axis, default.model.pins.len());
        let unit = Controller::new(ControllerConfig { world, ..default }).expect("the preset is sound");
        let bench = Bench::of_sized(unit, SIZE, Theme::Dark);
        let pictures = std::env::var_os("BRUSHWORK_FILM").map(|_| Vec::new());
        Self { bench, pointer: pos2(500.0, 400.0), pictures, taken: 0 }
    }

    fn take(&mut self) {
        self.taken += 1;
        if let Some(pictures) = &mut self.pictures {
            pictures.push(self.bench.harness.render().expect("a picture"));
        }
    }

    /// Lets so much time pass, and takes a picture each `between`.
    fn roll(&mut self, time: Duration, between: Duration) {
        for _ in 0..time.as_millis() / between.as_millis() {
            self.bench.pass(between);
            self.take();
        }
    }

    fn look(&mut self, milliseconds: u64) {
        self.roll(Duration::from_millis(milliseconds), SEEN);
    }

    /// Brings the pointer onto a button.
    #[track_caller]
    fn go(&mut self, label: &str) {
        self.bench.button(label).scroll_to_me();
        self.bench.pass(SEEN);
        let (from, to) = (self.pointer, self.bench.button(label).rect().center());
        for step in 1..=WAY {
            self.pointer = from.lerp(to, f32::from(step) / f32::from(WAY));
            self.bench.harness.hover_at(self.pointer);
            self.bench.pass(SEEN);
            self.take();
        }
    }

    #[track_caller]
    fn click(&mut self, label: &str) {
        self.go(label);
        self.bench.press(label);
        self.look(600);
    }

    #[track_caller]
    fn hold(&mut self, label: &str, milliseconds: u64) {
        self.go(label);
        self.bench.hold(label);
        self.look(milliseconds);
        self.bench.let_go(label);
    }

    /// P of the velocity loop that the controller works with.
    fn velocity_p(&self) -> u32 {
        self.bench
            .line
            .with(|bus| bus.controllers()[0].settings().motors[Motor::M1.index()].motion.velocity_p_raw)
    }

    fn lasts_s(&self) -> f64 {
        SEEN.as_secs_f64() * self.taken as f64
    }
}

/// A part of a picture that has changed, and since when it is seen.
struct Change {
    at: (usize, usize),
    size: (usize, usize),
    indices: Vec<u8>,
    pictures: u16,
}

/// What each picture changes in the one before it.
fn changes(pictures: &[Vec<u8>], (width, height): (usize, usize)) -> Vec<Change> {
    let mut found: Vec<Change> = Vec::new();
    let mut before: Option<&Vec<u8>> = None;
    for picture in pictures {
        let is_new = |at: usize| before.is_none_or(|before| before[at] != picture[at]);
        let new: Vec<(usize, usize)> =
            (0..picture.len()).filter(|at| is_new(*at)).map(|at| (at % width, at / width)).collect();
        let span = |of: fn(&(usize, usize)) -> usize, all: usize| {
            let bounds = (new.iter().map(of).min(), new.iter().map(of).max());
            bounds.0.zip(bounds.1).map_or(0..0, |(first, last)| first..(last + 1).min(all))
        };
        let (columns, rows) = (span(|at| at.0, width), span(|at| at.1, height));
        match found.last_mut() {
            Some(last) if new.is_empty() => last.pictures += 1,
            _ => {
                let within =
                    rows.clone().flat_map(|row| columns.clone().map(move |column| row * width + column));
                let indices = within.map(|at| if is_new(at) { picture[at] } else { AS_BEFORE }).collect();
                let (at, size) = ((columns.start, rows.start), (columns.len(), rows.len()));
                found.push(Change { at, size, indices, pictures: 1 });
            }
        }
        before = Some(picture);
    }
    found
}

/// Writes an animated PNG that begins again at its end.
fn write(pictures: &[RgbaImage], path: &Path) -> Result<(), png::EncodingError> {
    let (width, height) = pictures[0].dimensions();
    let palette = Palette::of(pictures, COLOURS);
    let indices: Vec<Vec<u8>> = pictures.iter().map(|picture| palette.indices(picture)).collect();
    let changes = changes(&indices, (width as usize, height as usize));
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(path)?), width, height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    let mut colours = palette.bytes();
    colours.resize(3 * (usize::from(AS_BEFORE) + 1), 0);
    encoder.set_palette(colours);
    let mut opacity = vec![u8::MAX; usize::from(AS_BEFORE) + 1];
    opacity[usize::from(AS_BEFORE)] = 0;
    encoder.set_trns(opacity);
    encoder.set_compression(png::Compression::High);
    encoder.set_filter(png::Filter::NoFilter);
    encoder.set_animated(changes.len() as u32, 0)?;
    encoder.set_blend_op(png::BlendOp::Over)?;
    let mut writer = encoder.write_header()?;
    for change in changes {
        writer.set_frame_delay(SEEN.as_millis() as u16 * change.pictures, 1000)?;
        // Each step by itself has to leave the part inside of the picture.
        writer.reset_frame_position()?;
        writer.set_frame_dimension(change.size.0 as u32, change.size.1 as u32)?;
        writer.set_frame_position(change.at.0 as u32, change.at.1 as u32)?;
        writer.write_image_data(&change.indices)?;
    }
    writer.finish()
}

/// How long a kept film lasts, in seconds.
fn lasts_s(path: &Path) -> f64 {
    let file = std::io::BufReader::new(File::open(path).expect("the film is kept"));
    let mut reader = png::Decoder::new(file).read_info().expect("it is a PNG");
    let animation = reader.info().animation_control.expect("it is animated");
    let mut buffer = vec![0; reader.output_buffer_size().expect("it fits into memory")];
    let frames = (0..animation.num_frames).map(|_| {
        reader.next_frame(&mut buffer).expect("its pictures can be read");
        let shown = reader.info().frame_control.expect("each is shown for a time");
        f64::from(shown.delay_num) / f64::from(shown.delay_den)
    });
    frames.sum()
}

#[test]
fn the_film_of_the_readme_connects_drives_and_tunes() {
    let mut film = Film::new();
    film.look(1000);
    film.click("Open MCP266");
    film.look(2400);
    film.click("PWM Settings");
    film.click("Arm");
    let still = film.bench.truth().axes[0].encoder_counts;
    film.hold("M1 jog forward", 3000);
    assert!(film.bench.truth().axes[0].encoder_counts > still + 1000, "the motor turns");
    film.look(1000);
    film.click("Velocity Settings");
    film.click("Arm");
    film.bench.open_tab("Tune");
    film.click("Tune M1");
    for _ in 0..100 {
        if !film.bench.model().front.tune.is_running() {
            break;
        }
        film.roll(BETWEEN_IN_RUN, BETWEEN_IN_RUN);
    }
    let run = film.bench.model().front.tune.front(Loop::Velocity).run().cloned();
    let run = run.unwrap_or_else(|| panic!("no run: {:?}", film.bench.said()));
    assert_eq!(run.report.verdict, Verdict::Tuned, "{:?}", run.report.causes);
    film.look(3000);
    let before = film.velocity_p();
    film.click("Apply (RAM)");
    film.look(3000);
    assert!(film.bench.both_stand());
    assert_ne!(film.velocity_p(), before, "the gains are applied");
    println!("{:.1} s", film.lasts_s());
    assert!(LASTS_S.contains(&film.lasts_s()), "{:.1} s", film.lasts_s());
    if let Some(pictures) = &film.pictures {
        write(pictures, Path::new(KEPT)).expect("it can be written");
    }
}

#[test]
fn the_kept_film_is_short_and_small() {
    let path = Path::new(KEPT);
    let bytes = fs::metadata(path).expect("it is kept").len();
    assert!(bytes < MOST_BYTES, "{bytes} bytes");
    let lasts_s = lasts_s(path);
    assert!(LASTS_S.contains(&lasts_s), "{lasts_s:.1} s");
}
