//! The names of fields, each a type of its own: a name that no layout has does not compile.

/// The name of a field, known to the compiler.
pub trait Name: Copy {
    /// As the traffic decoder and the reference page show it.
    const TEXT: &'static str;
}

/// A name in small letters, as text.
macro_rules! small {
    ($name:ident) => {{
        const SMALL: [u8; stringify!($name).len()] = $crate::packet_serial::name::letters(stringify!($name));
        match str::from_utf8(&SMALL) {
            Ok(text) => text,
            Err(_) => panic!("a name is ASCII"),
        }
    }};
}

pub(super) use small;

macro_rules! names {
    ($($name:ident)*) => {
        $(
            #[doc = concat!("The field that the table calls by this name: `", stringify!($name), "` in small letters.")]
            #[allow(non_camel_case_types)]
            #[derive(Clone, Copy, Debug)]
            pub struct $name;

            impl Name for $name {
                const TEXT: &'static str = small!($name);
            }
        )*

        /// Every name.
        #[cfg(test)]
        pub(super) const ALL: &[&str] = &[$($name::TEXT),*];
    };
}

pub(super) const fn letters<const LENGTH: usize>(name: &str) -> [u8; LENGTH] {
    let mut letters = [0; LENGTH];
    letters.copy_from_slice(name.as_bytes());
    letters.make_ascii_lowercase();
    letters
}

names! {
    ACCEL ACCEL_M1 ACCEL_M2 ACTION ADDRESS AMPLITUDE AUTO_OFFSET AVERAGE_SPEED BUFFER BUFFER_M1 BUFFER_M2
    CENTER COB_ID COMMAND CONFIG CURRENT_M1 CURRENT_M2 D D1 D2 DATA DEADBAND DEADBAND_MAX DEADBAND_MIN
    DEADZONE DECEL DECEL_M1 DECEL_M2 DELAY DISTANCE DISTANCE_M1 DISTANCE_M2 DOUTS DUTY DUTY_1 DUTY_2 DUTY_3
    DUTY_4 DUTY_5 DUTY_M1 DUTY_M2 ENCODER ENCODER_M1 ENCODER_M2 ERRORS ERROR_M1 ERROR_M2 HYSTERESIS I
    IDLE_M1 IDLE_M2 INDEX INDUCTANCE KEY LENGTH LEVEL_1 LEVEL_2 LEVEL_3 LIMIT_M1 LIMIT_M2 LOAD_HOME LOCK
    LOGIC LOGIC_BATTERY LOW_PASS MAIN MAIN_BATTERY MARK MAX MAX_ACTION MAX_I MAX_OUTPUT MIN MIN_ACTION
    MIN_OUTPUT MIXED MODE MODE_1 MODE_2 MODE_M1 MODE_M2 NODE NODE_ID P PERCENT PERIOD POSITION
    POSITION_ERROR_M1 POSITION_ERROR_M2 POSITION_M1 POSITION_M2 POTENTIOMETER POWER POWER_EXPONENT POWER_MIN
    PRESENT QPPS RATE RAW_SPEED_M1 RAW_SPEED_M2 RESISTANCE RESULT RTR S1_CENTER S1_FORWARD_DEADBAND
    S1_FORWARD_LIMIT S1_MAX S1_MIN S1_REVERSE_DEADBAND S1_REVERSE_LIMIT S2_CENTER S2_FORWARD_DEADBAND
    S2_FORWARD_LIMIT S2_MAX S2_MIN S2_REVERSE_DEADBAND S2_REVERSE_LIMIT S3 S4 S5 SERIAL_NUMBER SIGNALS SIZE
    SPEED SPEED_ERROR_M1 SPEED_ERROR_M2 SPEED_M1 SPEED_M2 STATUS STATUS_M1 STATUS_M2 STREAMS SUBINDEX TARGET
    TEMPERATURE_1 TEMPERATURE_2 TICK TIMEOUT TIMEOUT_M1 TIMEOUT_M2 TYPE VALUE VERSION
}
