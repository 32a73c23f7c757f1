//! The registers of the loop by the keys of their settings: those of the terms, and the bits of FUNCTION and FUNCTION2 that make it
//! (Motion Mind manual 3.14 and figures 20 and 21).

use super::registers::{MotionMindHeld, MotionMindProposal, MotionMindRegisters, bits};
use brushwork_motion_mind_wire::FUNCTION_BITS;
use brushwork_tuning::registers::{FeedForward, RegisterField, RegisterTable};

/// Where a key's value stands.
enum Place<'r> {
    Byte(&'r mut u8),
    Word(&'r mut u16),
    Bit(&'r mut u16, u16),
}

macro_rules! registers {
    ($($place:ident($part:ident $(, $bit:ident)?) $form:ident $key:literal $label:literal $(in $range:expr,)? $hint:literal;)*) => {
        static FIELDS: [RegisterField; 12] = [$(RegisterField::$form($key, $label, $($range,)? $hint)),*];

        /// Where the register of a key is held.
        fn place<'r>(of: &'r mut MotionMindRegisters, key: &str) -> Option<Place<'r>> {
            match key {
                $($key => Some(Place::$place(&mut of.$part $(, bits::$bit)?)),)*
                _ => None,
            }
        }
    };
}

registers! {
    Word(pterm) number "register.pterm" "PTERM" in (0.0, 65_535.0),
        "On the position error; on its sum under a speed command";
    Word(iterm) number "register.iterm" "ITERM" in (0.0, 65_535.0),
        "On the sum of the position errors; none under a speed command";
    Word(dterm) number "register.dterm" "DTERM" in (0.0, 65_535.0),
        "On the change of the error: the error of the speed under a speed command";
    Byte(pidscalar) number "register.pidscalar" "PIDSCALAR" in (0.0, 32.0),
        "The sum of the terms is divided by two to this power";
    Byte(velocity_ff) number "register.velocityff" "VELOCITYFF" in (0.0, 255.0),
        "Duty for a speed by itself: counts per loop x this / 255";
    Word(deadband) number "register.deadband" "DEADBAND" in (0.0, 1_023.0),
        "Errors up to this many counts are none, where ENABLEDB is set";
    Bit(function, SATPROT) switch "function.satprot" "SATPROT"
        "Bounds the sum of the errors closely and stops it at full duty";
    Bit(function, ENABLEDB) switch "function.enabledb" "ENABLEDB" "No duty inside DEADBAND";
    Bit(function, ACTIVESTOP) switch "function.activestop" "ACTIVESTOP"
        "A duty of 0 shorts the motor instead of letting it coast";
    Bit(function, DISABLEPID) switch "function.disablepid" "DISABLEPID" "The loop gives no duty";
    Bit(function2, NEWVELMODE) switch "function2.newvelmode" "NEWVELMODE"
        "Speed moves work on speeds, and their output is added up";
    Bit(function2, FASTPID) switch "function2.fastpid" "FASTPID"
        "A loop of 0.5 ms, which serial commands do not have";
}

impl RegisterTable for MotionMindProposal {
    fn fields() -> Vec<&'static RegisterField> {
        FIELDS.iter().collect()
    }

    fn raw(&self, key: &str) -> Option<i64> {
        Some(match place(&mut self.motion_mind?, key)? {
            Place::Byte(byte) => i64::from(*byte),
            Place::Word(word) => i64::from(*word),
            Place::Bit(word, bit) => i64::from(*word & bit != 0),
        })
    }

    fn set_raw(&mut self, key: &str, raw: i64) {
        let within = |most: i64| raw.clamp(0, most);
        match self.motion_mind.as_mut().and_then(|registers| place(registers, key)) {
            // Held to the width of the register.
            Some(Place::Byte(byte)) => *byte = within(0xFF) as u8,
            Some(Place::Word(word)) => *word = within(0xFFFF) as u16,
            Some(Place::Bit(word, bit)) => *word = if raw == 0 { *word & !bit } else { *word | bit },
            None => {}
        }
    }

    fn blank(_with_position: bool) -> Self {
        Self { motion_mind: Some(MotionMindRegisters::default()) }
    }

    fn has_a_loop(&self) -> bool {
        let terms = self.motion_mind.map(|registers| [registers.pterm, registers.iterm, registers.dterm]);
        terms.is_some_and(|terms| terms.iter().any(|term| *term > 0))
    }

    fn is_one_set(&self) -> bool {
        true
    }

    fn feed_forward(&self, qpps: f64) -> Option<FeedForward> {
        let registers = self.motion_mind?;
        let raw = i64::from(registers.velocity_ff);
        Some(FeedForward { register: "VELOCITYFF", raw, share: registers.covered(qpps) })
    }
}

/// The registers for people: name, held, proposed, and what is on the wire; then the bits of FUNCTION that change.
pub(super) fn rows(held: &MotionMindHeld, proposed: &MotionMindProposal) -> Vec<[String; 4]> {
    let (Some(held), Some(new)) = (held.motion_mind, proposed.motion_mind) else { return Vec::new() };
    let old = held.registers;
    let pairs = [
        ("PTERM", u32::from(old.pterm), u32::from(new.pterm)),
        ("ITERM", u32::from(old.iterm), u32::from(new.iterm)),
        ("DTERM", u32::from(old.dterm), u32::from(new.dterm)),
        ("PIDSCALAR", u32::from(old.pidscalar), u32::from(new.pidscalar)),
        ("VELOCITYFF", u32::from(old.velocity_ff), u32::from(new.velocity_ff)),
        ("DEADBAND", u32::from(old.deadband), u32::from(new.deadband)),
        ("FUNCTION", u32::from(old.function), u32::from(new.function)),
        ("FUNCTION2", u32::from(old.function2), u32::from(new.function2)),
    ];
    let words =
        pairs.map(|(name, old, new)| [name.to_owned(), old.to_string(), new.to_string(), new.to_string()]);
    let changed = FUNCTION_BITS.iter().filter(|bit| (old.function ^ new.function) & bit.mask() != 0);
    let bits = changed.map(|bit| {
        let word = |function: u16| if function & bit.mask() == 0 { "clear" } else { "set" }.to_owned();
        [format!("  {}", bit.name), word(old.function), word(new.function), String::new()]
    });
    words.into_iter().chain(bits).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(registers: MotionMindRegisters) -> MotionMindProposal {
        MotionMindProposal { motion_mind: Some(registers) }
    }

    #[test]
    fn registers_that_are_told_by_key_come_back_and_one_that_is_not_known_leaves_none() {
        let full = of(MotionMindRegisters {
            pterm: 51_234,
            iterm: 7,
            dterm: 65_535,
            pidscalar: 11,
            velocity_ff: 255,
            deadband: 3,
            function: bits::SATPROT | bits::ACTIVESTOP,
            function2: bits::NEWVELMODE,
            virtual_limits: (0, 0),
        });
        assert_eq!(full.raw("function.satprot"), Some(1));
        assert_eq!(full.raw("velocity.p"), None, "it has no velocity P");
        assert_eq!(MotionMindProposal::of_values(&|field| full.raw(field.key), false), Some(full));
        let but_one = |field: &RegisterField| full.raw(field.key).filter(|_| field.key != "register.dterm");
        assert_eq!(MotionMindProposal::of_values(&but_one, false), None);
    }

    #[test]
    fn what_is_no_gain_makes_no_other_gains() {
        let mind =
            MotionMindRegisters { pterm: 5, virtual_limits: (-9, 9), ..MotionMindRegisters::default() };
        assert!(of(mind).same_gains(&of(MotionMindRegisters { virtual_limits: (0, 0), ..mind })));
        assert!(!of(mind).same_gains(&of(MotionMindRegisters { pterm: 6, ..mind })));
    }
}
