//! The house rules: layers, the map, licences, and what neither rustfmt nor clippy can see.

mod assumed;
mod circles;
mod families;
mod layers;
mod licences;
mod limited;
mod map;
mod messages;
mod thresholds;
mod tidy;
mod words;
