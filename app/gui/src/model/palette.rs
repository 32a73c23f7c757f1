//! The command palette: what was typed into it, and which of the rows that fit is chosen.

use nucleo_matcher::pattern::{CaseMatching, Normalization, Pattern};
use nucleo_matcher::{Config, Matcher, Utf32Str};

/// The palette while it is open.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Palette {
    pub query: String,
    /// Counted among the rows that fit.
    pub chosen: usize,
    /// The keyboard goes to its field in the next frame.
    pub is_new: bool,
}

impl Palette {
    pub fn opened() -> Self {
        Self { is_new: true, ..Self::default() }
    }
}

/// Which of `names` fit `query`, best first. Letters may be left out; an empty query fits all, in their order.
pub fn fitting(query: &str, names: &[String]) -> Vec<usize> {
    let mut matcher = Matcher::new(Config::DEFAULT);
    let pattern = Pattern::parse(query.trim(), CaseMatching::Ignore, Normalization::Smart);
    let mut letters = Vec::new();
    let mut fitting: Vec<(u32, usize)> = names
        .iter()
        .enumerate()
        .filter_map(|(index, name)| {
            pattern.score(Utf32Str::new(name, &mut letters), &mut matcher).map(|score| (score, index))
        })
        .collect();
    // Sorting is stable: equal ones stay in the order of the menus.
    fitting.sort_by_key(|(score, _)| std::cmp::Reverse(*score));
    fitting.into_iter().map(|(_, index)| index).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn best<'a>(query: &str, names: &[&'a str]) -> Option<&'a str> {
        let owned: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        fitting(query, &owned).first().map(|index| names[*index])
    }

    const NAMES: [&str; 5] =
        ["Read Settings", "Save Settings", "Default Settings", "Packet Serial Reference", "Stop All"];

    #[test]
    fn letters_may_be_left_out_and_words_may_be_given_in_any_order() {
        assert_eq!(best("stal", &NAMES), Some("Stop All"));
        assert_eq!(best("ser ref", &NAMES), Some("Packet Serial Reference"));
        assert_eq!(best("settings save", &NAMES), Some("Save Settings"));
        assert_eq!(best("DEF", &NAMES), Some("Default Settings"));
        assert_eq!(best("qqq", &NAMES), None);
    }

    #[test]
    fn without_a_query_all_stand_in_their_order() {
        let owned: Vec<String> = NAMES.iter().map(|name| (*name).to_owned()).collect();
        assert_eq!(fitting("  ", &owned), [0, 1, 2, 3, 4]);
    }
}
