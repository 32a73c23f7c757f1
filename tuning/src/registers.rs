//! The registers of a loop by the keys of their settings, for those who show, change and write them without knowing whose they are.

/// What a register is to a person.
#[derive(Clone, Copy, Debug)]
pub struct RegisterField {
    /// The key of its setting: behind "motor1." or "motor2." where it is one of a motor.
    pub key: &'static str,
    /// Whether each motor has one.
    pub of_motor: bool,
    /// Its name.
    pub label: &'static str,
    /// What it holds.
    pub form: Form,
    /// What it does, where the name alone does not say it.
    pub hint: &'static str,
    /// The unit of its value.
    pub unit: &'static str,
    /// Wire value of 1.
    pub scale: f64,
    /// How many decimals are shown.
    pub decimals: usize,
    /// Change per arrow key.
    pub step: f64,
    /// The values that it can have.
    pub range: (f64, f64),
}

/// What a register holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A number.
    Number,
    /// A bit: 0 or 1.
    Switch,
}

/// How much of a speed's duty a register of feed-forward gives by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeedForward {
    /// Name of the register.
    pub register: &'static str,
    /// What it holds.
    pub raw: i64,
    /// Share of the duty that the speed takes; more than 1 is more than it takes.
    pub share: f64,
}

/// Registers that can be asked for by key. A key that these registers do not have gives no value.
pub trait RegisterTable: Copy + PartialEq {
    /// All that there can be, in the order of a screen.
    fn fields() -> Vec<&'static RegisterField>;
    /// The raw value of one.
    fn raw(&self, key: &str) -> Option<i64>;
    /// Sets one that there is; a value beyond its width is held to it.
    fn set_raw(&mut self, key: &str, raw: i64);
    /// All that a controller has, at 0; those of a position loop of its own where that is asked for.
    fn blank(with_position: bool) -> Self;
    /// Those that a speed move goes by.
    #[must_use]
    fn of_speed(self) -> Self {
        self
    }
    /// Whether there is a gain at all: without any there is no loop to draw.
    fn has_a_loop(&self) -> bool;
    /// Whether they are one set for all kinds of moves, so that none is written before all are known.
    fn is_one_set(&self) -> bool {
        false
    }
    /// What a register of feed-forward gives of the duty for a speed, where there is one.
    fn feed_forward(&self, _qpps: f64) -> Option<FeedForward> {
        None
    }

    /// Those whose raw values are told; `None` while one of them is not known.
    fn of_values(raw: &dyn Fn(&RegisterField) -> Option<i64>, with_position: bool) -> Option<Self> {
        let mut found = Self::blank(with_position);
        for field in Self::fields() {
            if found.raw(field.key).is_some() {
                found.set_raw(field.key, raw(field)?);
            }
        }
        Some(found)
    }

    /// The value of one as a person reads it.
    fn value(&self, field: &RegisterField) -> Option<f64> {
        self.raw(field.key).map(|raw| raw as f64 / field.scale)
    }

    /// Sets one, rounded to what the register can hold.
    fn set_value(&mut self, field: &RegisterField, value: f64) {
        let value = value.clamp(field.range.0, field.range.1);
        self.set_raw(field.key, (value * field.scale).round() as i64);
    }

    /// Whether both stand for the same gains, whatever else of their registers differs.
    fn same_gains(&self, other: &Self) -> bool {
        Self::fields().iter().all(|field| self.raw(field.key) == other.raw(field.key))
    }
}

impl RegisterField {
    /// A whole number of a register that all motors share.
    #[must_use]
    pub const fn number(
        key: &'static str,
        label: &'static str,
        range: (f64, f64),
        hint: &'static str,
    ) -> Self {
        let form = Form::Number;
        Self { key, of_motor: false, label, form, hint, unit: "", scale: 1.0, decimals: 0, step: 1.0, range }
    }

    /// A bit of such a register.
    #[must_use]
    pub const fn switch(key: &'static str, label: &'static str, hint: &'static str) -> Self {
        Self { form: Form::Switch, ..Self::number(key, label, (0.0, 1.0), hint) }
    }

    /// The value as it is shown.
    #[must_use]
    pub fn text(&self, value: f64) -> String {
        match self.form {
            Form::Number => format!("{value:.*}", self.decimals),
            Form::Switch => if value == 0.0 { "clear" } else { "set" }.to_owned(),
        }
    }

    /// Whether the model knows what it does, so that it can be tried there.
    #[must_use]
    pub fn is_modelled(&self) -> bool {
        self.form == Form::Number || matches!(self.label, "SATPROT" | "ENABLEDB")
    }

    /// Whether it is P, I or D.
    #[must_use]
    pub fn is_term(&self) -> bool {
        let name = self.key.rsplit('.').next().unwrap_or_default();
        matches!(name, "p" | "i" | "d" | "pterm" | "iterm" | "dterm")
    }
}
