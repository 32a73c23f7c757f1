//! How the numbers that the tuner decides by are kept: a struct for each stage, every field with its unit, its source and its value in one place.
//!
//! A stage reads its own as `STAGE.field`. For a sensitivity run ([`crate::sensitivity`]) one of them can be multiplied by a factor, before the first is read.

use std::sync::OnceLock;
use std::time::Duration;

/// Declares the thresholds of one stage: `/// What they are for` `STAGE: Struct { /// unit, source  name: type = value, … }`. A value may use those above it.
macro_rules! thresholds {
    ($(#[$about:meta])* $visible:vis $stage:ident: $Struct:ident { $($(#[$doc:meta])* $name:ident: $type:ty = $value:expr,)+ }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug)]
        pub struct $Struct { $($(#[$doc])* pub $name: $type,)+ }

        $(#[$about])*
        $visible static $stage: std::sync::LazyLock<$Struct> = std::sync::LazyLock::new(|| {
            $(let $name: $type = $crate::thresholds::now(stringify!($stage), stringify!($name), $value);)+
            $Struct { $($name,)+ }
        });

        impl $Struct {
            /// Their names and values, for the list of all.
            pub(crate) fn listed() -> Vec<$crate::thresholds::Threshold> {
                vec![$($crate::thresholds::Threshold {
                    stage: stringify!($stage),
                    name: stringify!($name),
                    value: format!("{:?}", $stage.$name),
                },)+]
            }
        }
    };
}
pub(crate) use thresholds;

/// One threshold, as the list of all shows it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Threshold {
    /// The stage it belongs to, for example `MARGIN`.
    pub stage: &'static str,
    /// Its name within the stage.
    pub name: &'static str,
    /// Its value in force.
    pub value: String,
}

/// The threshold that is changed: stage, name, factor.
pub(crate) static SCALED: OnceLock<(String, String, f64)> = OnceLock::new();

/// The value of a threshold in this process.
pub(crate) fn now<T: Scaled>(stage: &str, name: &str, value: T) -> T {
    match SCALED.get() {
        Some((of, named, by)) if of == stage && named == name => value.scaled(*by),
        _ => value,
    }
}

/// What a sensitivity run can multiply.
pub(crate) trait Scaled: Copy {
    /// It, times `by`.
    fn scaled(self, by: f64) -> Self;
}

impl Scaled for f64 {
    fn scaled(self, by: f64) -> Self {
        self * by
    }
}

macro_rules! whole_numbers {
    ($($type:ty),*) => {$(
        impl Scaled for $type {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss, clippy::cast_lossless)]
            fn scaled(self, by: f64) -> Self {
                let scaled = (self as f64 * by).round() as Self;
                match (scaled == self, by > 1.0) {
                    (false, _) => scaled,
                    (true, true) => self + 1,
                    (true, false) => self - 1,
                }
            }
        }
    )*};
}
whole_numbers!(usize, u32, i32, i64);

impl Scaled for Duration {
    fn scaled(self, by: f64) -> Self {
        self.mul_f64(by)
    }
}

impl<A: Scaled, B: Scaled> Scaled for (A, B) {
    fn scaled(self, by: f64) -> Self {
        (self.0.scaled(by), self.1.scaled(by))
    }
}

impl<A: Scaled, B: Scaled, C: Scaled> Scaled for (A, B, C) {
    fn scaled(self, by: f64) -> Self {
        (self.0.scaled(by), self.1.scaled(by), self.2.scaled(by))
    }
}

impl<T: Scaled, const N: usize> Scaled for [T; N] {
    fn scaled(self, by: f64) -> Self {
        self.map(|each| each.scaled(by))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_move_by_one_at_least_and_every_part_of_a_threshold_moves() {
        assert_eq!((3_usize.scaled(0.8), 3_usize.scaled(1.25), 40_u32.scaled(1.25)), (2, 4, 50));
        assert_eq!((0.5, 8_i32).scaled(0.5), (0.25, 4));
        assert_eq!([2.0, 4.0].scaled(1.25), [2.5, 5.0]);
        assert_eq!(Duration::from_secs(2).scaled(1.5), Duration::from_secs(3));
    }
}
