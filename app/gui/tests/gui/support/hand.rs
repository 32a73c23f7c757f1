//! A hand on the mouse: real pointer events, each click counted, and each figure that has to be typed.

use std::time::Duration;

use brushwork_link::Clock as _;

use super::bench::Bench;

/// How long a hand looks before it clicks.
const LOOK_MS: u64 = 600;

pub struct Hand {
    pub bench: Bench,
    pub clicks: usize,
    /// Keys for what no click gives: the digits of a figure.
    pub keys: usize,
    /// How often the wheel was turned to bring something into view.
    pub turns: usize,
    began: Duration,
}

impl Hand {
    /// Counts from here on.
    pub fn on(bench: Bench) -> Self {
        let began = bench.line.clock.now();
        Self { bench, clicks: 0, keys: 0, turns: 0, began }
    }

    /// Time since the hand began.
    pub fn took(&self) -> Duration {
        self.bench.line.clock.now() - self.began
    }

    /// Brings into view what is scrolled away, as with a wheel.
    #[track_caller]
    fn reach(&mut self, label: &str) {
        let before = self.bench.button(label).rect();
        self.bench.button(label).scroll_to_me();
        self.bench.pass_ms(LOOK_MS);
        self.turns += usize::from(self.bench.button(label).rect() != before);
    }

    /// Clicks what can be seen.
    #[track_caller]
    pub fn click(&mut self, label: &str) {
        self.reach(label);
        self.bench.press(label);
        self.clicks += 1;
    }

    /// Holds a button down.
    #[track_caller]
    pub fn hold(&mut self, label: &str, time: Duration) {
        self.bench.hold(label);
        self.bench.pass(time);
        self.bench.let_go(label);
        self.bench.pass_ms(1500);
        self.clicks += 1;
    }

    /// Clicks into a field, which selects what stands there, and types a figure.
    #[track_caller]
    pub fn figure(&mut self, field: &str, figure: &str) {
        self.click(field);
        for letter in figure.chars() {
            self.bench.harness.event(egui::Event::Text(letter.to_string()));
            self.bench.pass_ms(200);
            self.keys += 1;
        }
    }

    /// Waits for the end of a run.
    pub fn wait_for_run(&mut self) {
        for _ in 0..120 {
            self.bench.pass_ms(500);
            if !self.bench.model().front.tune.is_running() {
                break;
            }
        }
        self.bench.pass_ms(1500);
    }
}
