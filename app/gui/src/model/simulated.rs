//! Which simulated controller the device list offers: a model of either family, and how a Motion Mind's switches stand.

use brushwork_mcp_wire::models;
use brushwork_mcp_wire::models::MODELS;

/// The model that is offered at first.
pub const FIRST: &str = "mcp266";
/// The Motion Mind among the models.
pub const MOTION_MIND: &str = "motion-mind-3";

/// What is simulated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Simulated {
    /// A key of the models.
    pub model: String,
    /// Switches 2 to 4 of a Motion Mind.
    pub mode: u8,
    /// Switch 6 of a Motion Mind: lines of text in place of bytes.
    pub is_text: bool,
    /// What the first Motion Mind answers to.
    pub address: u8,
    /// How many Motion Minds share the bus; the others follow the first one's address.
    pub units: u8,
}

impl Default for Simulated {
    fn default() -> Self {
        Self { model: FIRST.to_owned(), mode: 4, is_text: false, address: 1, units: 1 }
    }
}

impl Simulated {
    /// Most of them on one simulated bus.
    pub const MOST_UNITS: u8 = 4;

    /// All models by key and name: first one of each family.
    pub fn models() -> impl Iterator<Item = (&'static str, &'static str)> {
        let is_first = |key: &str| key == FIRST;
        let listed = || MODELS.iter().map(|model| (model.key, model.name));
        let first = listed().filter(move |(key, _)| is_first(key));
        first
            .chain(std::iter::once((MOTION_MIND, "Motion Mind 3")))
            .chain(listed().filter(move |(key, _)| !is_first(key)))
    }

    pub fn is_motion_mind(&self) -> bool {
        self.model == MOTION_MIND
    }

    /// The model's name.
    pub fn name(&self) -> &str {
        if self.is_motion_mind() {
            return "Motion Mind 3";
        }
        models::lookup(&self.model).map_or(self.model.as_str(), |model| model.name)
    }

    /// What a person would type to connect to it.
    pub fn target(&self) -> String {
        if !self.is_motion_mind() {
            return format!("sim:{}", self.model);
        }
        let protocol = if self.is_text { "ascii" } else { "binary" };
        let mut text = format!("sim:{MOTION_MIND},mode={},protocol={protocol}", self.mode);
        let last = self.address.saturating_add(self.units.max(1) - 1).min(98);
        for address in self.address..=last {
            text += &format!(",address={address}");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_chosen_is_a_target_as_a_person_would_type_it() {
        let mut simulated = Simulated::default();
        assert_eq!(simulated.target(), "sim:mcp266");
        simulated.model = MOTION_MIND.to_owned();
        assert_eq!(simulated.target(), "sim:motion-mind-3,mode=4,protocol=binary,address=1");
        (simulated.is_text, simulated.units, simulated.address) = (true, 2, 7);
        assert_eq!(simulated.target(), "sim:motion-mind-3,mode=4,protocol=ascii,address=7,address=8");
    }
}
