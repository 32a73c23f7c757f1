//! An X server without a screen, and the picture that is on it.
//!
//! Xvfb keeps its frame buffer in a file (XWD format), so that a test can see what a person would without any other tool.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use tempfile::TempDir;

use crate::program::Program;
use crate::wait;

/// Between two looks at the picture.
const LOOK_INTERVAL: Duration = Duration::from_millis(100);

/// A running Xvfb of 1280 x 800 pixels.
pub struct Screen {
    display: String,
    folder: TempDir,
    #[cfg_attr(not(unix), expect(dead_code, reason = "it ends with this, and there are no signals to send"))]
    server: Program,
}

/// The window of `program` on a display, drawn by Mesa's software renderer.
#[must_use]
pub fn on_display(program: &str, display: &str) -> Command {
    let mut command = Command::new(program);
    command.env("DISPLAY", display).env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    command.env("LIBGL_ALWAYS_SOFTWARE", "1");
    command
}

impl Screen {
    /// Starts a server on a free display number.
    ///
    /// # Panics
    /// When Xvfb is not installed or does not start. `BRUSHWORK_LEAVE_OUT=xvfb` leaves the tests that need it out.
    #[must_use]
    pub fn start() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let frame_buffer = folder.path().to_string_lossy().into_owned();
        let arguments = ["-displayfd", "1", "-screen", "0", "1280x800x24", "-nolisten", "tcp", "-fbdir"];
        let mut server = Program::start("Xvfb", &[&arguments[..], &[&frame_buffer]].concat());
        let Some(number) = server.next_line(wait::LIMIT) else {
            panic!("Xvfb names no display: {:?}", server.finish(wait::LIMIT))
        };
        Self { display: format!(":{}", number.trim()), folder, server }
    }

    /// The value for the environment variable `DISPLAY`.
    #[must_use]
    pub fn display(&self) -> &str {
        &self.display
    }

    /// The server dies, and every window on it loses its display.
    #[cfg(unix)]
    pub fn kill(&self) {
        self.server.signal("KILL");
    }

    /// What is on the screen; none while Xvfb has not made its file.
    #[must_use]
    pub fn picture(&self) -> Option<Picture> {
        Picture::read(&self.folder.path().join("Xvfb_screen0"))
    }

    /// Looks until the picture satisfies `is_it`; none when it never does.
    #[must_use]
    pub fn wait_for(&self, is_it: impl Fn(&Picture) -> bool) -> Option<Picture> {
        let end = Instant::now() + wait::LIMIT;
        while Instant::now() < end {
            if let Some(picture) = self.picture().filter(&is_it) {
                return Some(picture);
            }
            std::thread::sleep(LOOK_INTERVAL);
        }
        None
    }
}

/// Red, green and blue, row by row.
pub struct Picture {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Three bytes a pixel.
    pub rgb: Vec<u8>,
}

impl Picture {
    /// Reads an X window dump of 32 bits a pixel, little-endian, as Xvfb writes it at depth 24.
    fn read(path: &Path) -> Option<Self> {
        const FIXED_HEADER_WORDS: usize = 25;
        const COLOUR_BYTES: usize = 12;
        let dump = fs::read(path).ok()?;
        let word = |index: usize| -> Option<usize> {
            let bytes = dump.get(index * 4..index * 4 + 4)?;
            Some(u32::from_be_bytes(bytes.try_into().ok()?) as usize)
        };
        let (header_size, width, height) = (word(0)?, word(4)?, word(5)?);
        let (row_bytes, colours) = (word(12)?, word(19)?);
        if header_size < FIXED_HEADER_WORDS * 4 {
            return None;
        }
        let pixels = dump.get(header_size + colours * COLOUR_BYTES..)?;
        let mut rgb = Vec::with_capacity(width * height * 3);
        for row in pixels.chunks_exact(row_bytes).take(height) {
            for pixel in row.chunks_exact(4).take(width) {
                rgb.extend([pixel[2], pixel[1], pixel[0]]);
            }
        }
        (rgb.len() == width * height * 3).then_some(Self { width, height, rgb })
    }

    /// Keeps it as a PNG file.
    ///
    /// # Panics
    /// When the file cannot be written.
    #[cfg(target_os = "linux")]
    pub fn keep(&self, path: &Path) {
        let (width, height) = (self.width as u32, self.height as u32);
        let image = image::RgbImage::from_raw(width, height, self.rgb.clone()).expect("three bytes a pixel");
        image.save(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    }

    /// Pixels of an indicator that says OK, whatever the theme's exact green.
    #[must_use]
    pub fn green(&self) -> usize {
        let is_green =
            |pixel: &&[u8]| pixel[1] > pixel[0].saturating_add(60) && pixel[1] > pixel[2].saturating_add(40);
        self.rgb.chunks_exact(3).filter(is_green).count()
    }

    /// How many different colours it has: a blank screen has one, a window with text some hundred.
    #[must_use]
    pub fn colours(&self) -> usize {
        let mut colours: Vec<&[u8]> = self.rgb.chunks_exact(3).collect();
        colours.sort_unstable();
        colours.dedup();
        colours.len()
    }
}
