//! One measured figure with its target beside it.

use serde::Serialize;
use serde::ser::{SerializeStruct as _, Serializer};

/// Heads of the table.
pub const MARKS: [&str; 6] = ["BENCH", "FIGURE", "VALUE", "TARGET", "MET", "NOTE"];

/// What a figure should be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Target {
    /// This or more.
    AtLeast(f64),
    /// This or less.
    AtMost(f64),
    /// Less than this.
    Below(f64),
}

/// A measured figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    bench: &'static str,
    name: String,
    value: f64,
    unit: &'static str,
    decimals: usize,
    target: Option<Target>,
    highest_possible: Option<f64>,
    note: String,
}

impl Figure {
    /// A figure that is only stated.
    pub fn new(
        bench: &'static str,
        name: impl Into<String>,
        value: f64,
        unit: &'static str,
        decimals: usize,
    ) -> Self {
        let name = name.into();
        Self { bench, name, value, unit, decimals, target: None, highest_possible: None, note: String::new() }
    }

    /// The same, held to a target.
    pub fn target(mut self, target: Target) -> Self {
        self.target = Some(target);
        self
    }

    /// The same, which cannot truly be above `highest`: what is above is a fault of the measurement.
    pub fn cannot_exceed(mut self, highest: f64) -> Self {
        self.highest_possible = Some(highest);
        self
    }

    /// The same with a remark.
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.note = note.into();
        self
    }

    /// Whether the target is met; none where there is no target. A measurement at fault meets nothing.
    pub fn is_met(&self) -> Option<bool> {
        if self.is_fault() {
            return Some(false);
        }
        self.target.map(|target| match target {
            Target::AtLeast(least) => self.value >= least,
            Target::AtMost(most) => self.value <= most,
            Target::Below(limit) => self.value < limit,
        })
    }

    /// Whether the value cannot be true.
    fn is_fault(&self) -> bool {
        !self.value.is_finite() || self.highest_possible.is_some_and(|highest| self.value > highest)
    }

    fn full_note(&self) -> String {
        match (self.is_fault(), self.highest_possible) {
            (true, Some(highest)) => format!("FAULT OF THE MEASUREMENT: above {highest}; {}", self.note),
            (true, None) => format!("FAULT OF THE MEASUREMENT: no number; {}", self.note),
            _ => self.note.clone(),
        }
    }

    /// The figure's row under [`MARKS`].
    pub fn cells(&self) -> Vec<String> {
        let decimals = self.decimals;
        let target = self.target.map_or_else(String::new, |target| match target {
            Target::AtLeast(least) => format!(">= {least}"),
            Target::AtMost(most) => format!("<= {most}"),
            Target::Below(limit) => format!("< {limit}"),
        });
        let met = match self.is_met() {
            Some(true) => "yes",
            Some(false) => "NO",
            None => "stated",
        };
        vec![
            self.bench.to_owned(),
            self.name.clone(),
            format!("{:.decimals$} {}", self.value, self.unit).trim_end().to_owned(),
            target,
            met.to_owned(),
            self.full_note(),
        ]
    }
}

impl Serialize for Figure {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("Figure", 7)?;
        object.serialize_field("bench", self.bench)?;
        object.serialize_field("figure", &self.name)?;
        object.serialize_field("value", &self.value)?;
        object.serialize_field("unit", self.unit)?;
        object.serialize_field("target", &self.target)?;
        object.serialize_field("met", &self.is_met())?;
        object.serialize_field("note", &self.full_note())?;
        object.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn link_use(value: f64) -> Figure {
        Figure::new("link", "use", value, "", 3).target(Target::AtLeast(0.9)).cannot_exceed(1.0)
    }

    #[test]
    fn a_target_is_met_at_its_very_value_and_missed_below() {
        assert_eq!(link_use(0.9).is_met(), Some(true));
        assert_eq!(link_use(0.899).is_met(), Some(false));
        let p99 = Figure::new("stop", "p99", 10.0, "ms", 2).target(Target::Below(10.0));
        assert_eq!(p99.is_met(), Some(false));
        assert_eq!(Figure::new("sim", "speed", 1.0, "x", 0).is_met(), None);
    }

    #[test]
    fn what_cannot_be_true_is_a_fault_of_the_measurement_and_meets_nothing() {
        let figure = link_use(1.02);
        assert_eq!(figure.is_met(), Some(false));
        assert!(figure.cells()[5].starts_with("FAULT OF THE MEASUREMENT"), "{:?}", figure.cells());
        assert_eq!(link_use(f64::NAN).is_met(), Some(false));
    }

    #[test]
    fn json_carries_value_target_and_verdict() {
        let json = serde_json::to_value(link_use(0.95)).unwrap();
        assert_eq!(json["target"], serde_json::json!({ "at_least": 0.9 }));
        assert_eq!((json["value"].as_f64(), json["met"].as_bool()), (Some(0.95), Some(true)));
    }
}
