//! A small drawing of the whole chain, from the computer to the encoder, with what is likely wrong marked in it.

use brushwork_tuning::cause::Cause;
use egui::{
    Align2, Color32, CornerRadius, FontId, Painter, Pos2, Rect, Role, Sense, Shape, Stroke, StrokeKind, Ui,
    Vec2, WidgetInfo, pos2, vec2,
};

use crate::messages::SpokenMessage;
use crate::theme::Palette;

/// Size of the drawing, points.
const SIZE: Vec2 = vec2(388.0, 134.0);

/// A pair of wires.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Wires {
    #[default]
    Sound,
    Crossed,
    Cut,
    Loose,
}

/// What is at the shaft.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Shaft {
    #[default]
    Free,
    Blocked,
    /// A carriage at the end of its travel.
    EndOfTravel,
    Slipping,
    /// A weight that pulls one way.
    Loaded,
}

/// What the encoder is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Disc {
    #[default]
    Sound,
    Coarse,
    /// Counts go from 4095 on to 0.
    Wrapping,
}

/// The chain and what is wrong in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sketch {
    leads: Wires,
    signals: Wires,
    cable: Wires,
    shaft: Shaft,
    disc: Disc,
    is_battery_low: bool,
    /// The controller itself is marked, with a word.
    unit: Option<&'static str>,
    /// What the drawing says, in a few words.
    pub caption: &'static str,
}

impl Sketch {
    /// A chain that is as it should be.
    pub fn sound(caption: &'static str) -> Self {
        Self { caption, ..Self::default() }
    }

    /// The drawing for a cause; none where there is nothing to look at.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn of(cause: Cause) -> Option<Self> {
        let sound = Self::default();
        let unit = |word, caption| Self { unit: Some(word), caption, ..sound };
        Some(match cause {
            Cause::EncoderReversed => Self {
                leads: Wires::Crossed,
                signals: Wires::Crossed,
                caption: "The motor leads OR the encoder's A and B are swapped (one of the two, not both)",
                ..sound
            },
            Cause::NothingCounted => Self {
                signals: Wires::Cut,
                shaft: Shaft::Blocked,
                caption: "The encoder is open, a motor lead is open, or the shaft is held",
                ..sound
            },
            Cause::CountsStopped => Self {
                signals: Wires::Cut,
                shaft: Shaft::Blocked,
                caption: "The encoder is open, or the shaft is held",
                ..sound
            },
            Cause::EncoderDead | Cause::EncoderLost => Self {
                signals: Wires::Cut,
                caption: "The encoder's plug, its supply or its cable is open",
                ..sound
            },
            Cause::EncoderFlipped => {
                Self { signals: Wires::Loose, caption: "A lead of the encoder has a loose contact", ..sound }
            }
            Cause::MotorOpen | Cause::MotorOpened => {
                Self { leads: Wires::Cut, caption: "A motor lead, a brush or a fuse is open", ..sound }
            }
            Cause::ShaftLocked | Cause::Stalled => Self {
                shaft: Shaft::Blocked,
                caption: "The shaft is held: a brake, a jam, an end stop",
                ..sound
            },
            Cause::TravelLimit => Self {
                shaft: Shaft::EndOfTravel,
                caption: "The axis stands too near to an end of its travel",
                ..sound
            },
            Cause::OutsideTravel => Self {
                shaft: Shaft::EndOfTravel,
                caption: "The axis stands outside the travel that was given",
                ..sound
            },
            Cause::NarrowTravel => Self {
                shaft: Shaft::EndOfTravel,
                caption: "The travel is too narrow, or the axis too near to one of its ends",
                ..sound
            },
            Cause::LimitNotTaken => unit("A ?", "The controller did not take the highest current of the run"),
            Cause::Lopsided | Cause::Asymmetric | Cause::HeavyLoad => Self {
                shaft: Shaft::Loaded,
                caption: "Something pulls one way: a weight, a spring, a jam",
                ..sound
            },
            Cause::PoorFit => Self {
                shaft: Shaft::Slipping,
                caption: "A coupling, a belt or the encoder slips on its shaft",
                ..sound
            },
            Cause::TooCoarse => Self { disc: Disc::Coarse, caption: "Too few counts for each turn", ..sound },
            Cause::WrappingEncoder => Self {
                disc: Disc::Wrapping,
                caption: "The reading jumps from 4095 to 0 in each turn",
                ..sound
            },
            Cause::BatteryLow => {
                Self { is_battery_low: true, caption: "The main battery sags or is empty", ..sound }
            }
            Cause::LinkLost => {
                Self { cable: Wires::Cut, caption: "The cable to the controller is open", ..sound }
            }
            Cause::ControllerFault => unit("!", "The controller reports a fault: see Device Status"),
            Cause::OverCurrent => unit("A >", "The motor took more current than the run was allowed"),
            Cause::CurrentLimited => unit("A =", "The current limit held the motor back for most of the run"),
            Cause::TorqueMode => {
                unit("L R", "L and R are both set: what is asked for is a current, not a duty")
            }
            Cause::Refused => unit("?", "The controller did not take a command"),
            Cause::UnknownLaw => unit("?", "The controller's loop follows no law that is known"),
            Cause::NoDirectLoop => unit("0", "A position loop alone gives no duty here: choose PIV"),
            Cause::NotVerified => unit("~", "The loop oscillates more than the model predicts"),
            _ => return None,
        })
    }
}

/// Draws it.
pub fn sketch_ui(ui: &mut Ui, sketch: &Sketch) {
    let width = SIZE.x.min(ui.available_width());
    let (rect, response) = ui.allocate_exact_size(vec2(width, SIZE.y), Sense::hover());
    response.widget_info(|| {
        WidgetInfo::labeled(Role::Image, true, SpokenMessage::Sketch { caption: sketch.caption }.to_string())
    });
    let palette = Palette::of(ui);
    let painter = ui.painter().with_clip_rect(rect);
    painter.rect(rect, 4.0, palette.ground, Stroke::new(1.0, palette.line), StrokeKind::Inside);
    let pen = Pen { painter, palette, origin: rect.min, scale: width / SIZE.x };
    pen.chain(sketch);
    let font = FontId::proportional(11.0);
    let text = pen.painter.layout(sketch.caption.to_owned(), font, palette.text, width - 16.0);
    let at = pos2(rect.left() + 8.0, rect.bottom() - 5.0 - text.size().y);
    pen.painter.galley(at, text, palette.text);
}

/// Draws in the drawing's own coordinates.
struct Pen<'a> {
    painter: Painter,
    palette: &'a Palette,
    origin: Pos2,
    scale: f32,
}

impl Pen<'_> {
    fn at(&self, x: f32, y: f32) -> Pos2 {
        self.origin + vec2(x * self.scale, y)
    }

    fn line(&self, points: &[(f32, f32)], color: Color32, width: f32) {
        let points = points.iter().map(|(x, y)| self.at(*x, *y)).collect();
        self.painter.add(Shape::line(points, Stroke::new(width, color)));
    }

    fn word(&self, x: f32, y: f32, text: &str, color: Color32, size: f32) {
        self.painter.text(self.at(x, y), Align2::CENTER_CENTER, text, FontId::proportional(size), color);
    }

    fn body(&self, from: (f32, f32), to: (f32, f32), color: Color32) {
        let rect = Rect::from_min_max(self.at(from.0, from.1), self.at(to.0, to.1));
        let stroke = Stroke::new(1.4, color);
        self.painter.rect(rect, CornerRadius::same(4), self.palette.raised, stroke, StrokeKind::Inside);
    }

    /// A cross in a ring: here.
    fn mark(&self, x: f32, y: f32) {
        let (at, color) = (self.at(x, y), self.palette.error);
        self.painter.circle(at, 7.5, self.palette.ground, Stroke::new(1.6, color));
        for arm in [vec2(3.2, 3.2), vec2(3.2, -3.2)] {
            self.painter.line_segment([at - arm, at + arm], Stroke::new(1.8, color));
        }
    }

    fn chain(&self, sketch: &Sketch) {
        let palette = self.palette;
        self.body((10.0, 34.0), (54.0, 66.0), palette.weak_text);
        self.word(32.0, 50.0, "PC", palette.text, 11.0);
        self.pair((54.0, 50.0), (92.0, 50.0), sketch.cable, 0.0);
        let unit_color = if sketch.unit.is_some() { palette.error } else { palette.weak_text };
        self.body((92.0, 22.0), (168.0, 96.0), unit_color);
        self.word(130.0, 34.0, "controller", palette.weak_text, 10.0);
        if let Some(word) = sketch.unit {
            self.word(130.0, 62.0, word, palette.error, 20.0);
            self.mark(166.0, 22.0);
        }
        self.battery(sketch.is_battery_low);
        self.pair((168.0, 44.0), (226.0, 44.0), sketch.leads, 12.0);
        self.word(197.0, 30.0, "motor", palette.weak_text, 9.5);
        self.signals(sketch.signals);
        self.motor(sketch);
    }

    fn battery(&self, is_low: bool) {
        let color = if is_low { self.palette.error } else { self.palette.weak_text };
        self.body((14.0, 80.0), (50.0, 96.0), color);
        self.line(&[(52.0, 85.0), (52.0, 91.0)], color, 3.0);
        let cells = if is_low { 1 } else { 4 };
        for cell in 0..cells {
            let x = 19.0 + 8.0 * cell as f32;
            self.line(&[(x, 84.0), (x, 92.0)], color, 4.0);
        }
        self.line(&[(54.0, 88.0), (92.0, 88.0)], color, 1.4);
        if is_low {
            self.mark(72.0, 88.0);
        }
    }

    /// Two wires side by side, `apart` from each other; one where they are not.
    fn pair(&self, from: (f32, f32), to: (f32, f32), state: Wires, apart: f32) {
        let wrong = state != Wires::Sound;
        let color = if wrong { self.palette.error } else { self.palette.weak_text };
        let middle = (0.5 * (from.0 + to.0), 0.5 * (from.1 + to.1));
        let both: &[f32] = if apart > 0.0 { &[-0.5, 0.5] } else { &[0.0] };
        for side in both {
            let (start, end) = ((from.0, from.1 + side * apart), (to.0, to.1 + side * apart));
            match state {
                Wires::Sound => self.line(&[start, end], color, 1.5),
                Wires::Crossed => {
                    let crossed = (to.0, to.1 - side * apart);
                    self.line(
                        &[start, (middle.0 - 10.0, start.1), (middle.0 + 10.0, crossed.1), crossed],
                        color,
                        1.8,
                    );
                }
                Wires::Cut => {
                    self.line(&[start, (middle.0 - 8.0, start.1)], color, 1.5);
                    self.line(&[(middle.0 + 8.0, end.1), end], color, 1.5);
                }
                Wires::Loose => {
                    let wave = (0..=12).map(|n| {
                        let part = n as f32 / 12.0;
                        let swing = if n % 2 == 0 { -2.0 } else { 2.0 };
                        (start.0 + part * (end.0 - start.0), start.1 + swing)
                    });
                    self.line(&wave.collect::<Vec<_>>(), color, 1.5);
                }
            }
        }
        if matches!(state, Wires::Cut | Wires::Loose) {
            self.mark(middle.0, middle.1);
        }
    }

    /// The encoder's wires run below the motor.
    fn signals(&self, state: Wires) {
        self.pair((168.0, 84.0), (300.0, 84.0), state, 9.0);
        let color = if state == Wires::Sound { self.palette.weak_text } else { self.palette.error };
        for (x, from) in [(300.0, 79.5), (309.0, 88.5)] {
            self.line(&[(300.0, from), (x, from), (x, 68.0)], color, 1.5);
        }
        self.word(206.0, 96.0, "encoder A, B", self.palette.weak_text, 9.5);
    }

    fn motor(&self, sketch: &Sketch) {
        let palette = self.palette;
        let center = self.at(248.0, 44.0);
        self.painter.circle(center, 22.0, palette.raised, Stroke::new(1.6, palette.weak_text));
        self.word(248.0, 44.0, "M", palette.text, 15.0);
        self.line(&[(270.0, 44.0), (360.0, 44.0)], palette.weak_text, 4.0);
        self.disc(sketch.disc, sketch.shaft == Shaft::Slipping);
        match sketch.shaft {
            Shaft::Free | Shaft::Slipping => {
                self.line(&[(360.0, 30.0), (360.0, 58.0)], palette.weak_text, 3.0);
            }
            Shaft::Blocked => {
                for y in [24.0, 52.0] {
                    self.body((338.0, y), (366.0, y + 12.0), palette.error);
                    for n in 0..4 {
                        let x = 341.0 + 7.0 * n as f32;
                        self.line(&[(x, y + 11.0), (x + 5.0, y + 1.0)], palette.error, 1.2);
                    }
                }
                self.mark(374.0, 44.0);
            }
            Shaft::EndOfTravel => {
                self.line(&[(332.0, 66.0), (382.0, 66.0)], palette.weak_text, 2.0);
                self.line(&[(381.0, 52.0), (381.0, 80.0)], palette.error, 3.5);
                self.body((356.0, 54.0), (377.0, 66.0), palette.warning);
                self.mark(372.0, 44.0);
            }
            Shaft::Loaded => {
                self.painter.circle(
                    self.at(360.0, 44.0),
                    10.0,
                    palette.raised,
                    Stroke::new(1.5, palette.weak_text),
                );
                self.line(&[(370.0, 44.0), (370.0, 74.0)], palette.error, 1.5);
                self.body((361.0, 74.0), (380.0, 90.0), palette.error);
            }
        }
    }

    fn disc(&self, disc: Disc, slips: bool) {
        let palette = self.palette;
        let wrong = disc != Disc::Sound || slips;
        let color = if wrong { palette.error } else { palette.weak_text };
        let center = self.at(304.0, 44.0);
        self.painter.circle(center, 20.0, palette.raised, Stroke::new(1.5, color));
        let slots = match disc {
            Disc::Coarse => 4,
            Disc::Sound | Disc::Wrapping => 20,
        };
        for n in 0..slots {
            let angle = n as f32 * std::f32::consts::TAU / slots as f32;
            let out = vec2(angle.cos(), angle.sin());
            self.painter.line_segment([center + 12.0 * out, center + 18.0 * out], Stroke::new(1.3, color));
        }
        if disc == Disc::Wrapping {
            self.word(304.0, 44.0, "0", palette.error, 12.0);
        }
        if slips {
            self.line(&[(284.0, 20.0), (304.0, 16.0), (324.0, 20.0)], palette.error, 1.6);
            self.line(&[(318.0, 15.0), (324.0, 20.0), (317.0, 23.0)], palette.error, 1.6);
            self.mark(282.0, 22.0);
        } else if disc != Disc::Sound {
            self.mark(322.0, 26.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_cause_with_something_to_look_at_has_a_drawing_of_its_own() {
        let causes = [
            Cause::EncoderReversed,
            Cause::EncoderDead,
            Cause::EncoderFlipped,
            Cause::MotorOpen,
            Cause::ShaftLocked,
            Cause::TravelLimit,
            Cause::Lopsided,
            Cause::PoorFit,
            Cause::TooCoarse,
            Cause::WrappingEncoder,
            Cause::BatteryLow,
            Cause::LinkLost,
            Cause::ControllerFault,
            Cause::OverCurrent,
            Cause::CurrentLimited,
            Cause::TorqueMode,
            Cause::NotVerified,
        ];
        for (index, cause) in causes.iter().enumerate() {
            let sketch = Sketch::of(*cause).unwrap_or_else(|| panic!("{cause:?}"));
            for earlier in &causes[..index] {
                assert_ne!(Sketch::of(*earlier), Some(sketch), "{cause:?} {earlier:?}");
            }
        }
        assert_eq!(Sketch::of(Cause::Stopped), None);
    }
}
