//! The bits of FUNCTION, FUNCTION2 and STATUS (Motion Mind manual, figures 20 to 22).

/// One bit of a register.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bit {
    /// Its number, from 0.
    pub number: u8,
    /// Its name in the manual's figures.
    pub name: &'static str,
    /// What it does or says when it is set.
    pub set_means: &'static str,
}

impl Bit {
    /// The register value that has only this bit set.
    pub const fn mask(self) -> u16 {
        1 << self.number
    }
}

macro_rules! bits {
    ($(#[$doc:meta])* $module:ident, $table:ident: $($number:literal $constant:ident $name:literal $means:literal;)*) => {
        $(#[$doc])*
        pub static $table: &[Bit] = &[$(Bit { number: $number, name: $name, set_means: $means }),*];

        /// Masks of the bits of the same name in the table.
        pub mod $module {
            $(#[doc = $means] pub const $constant: u16 = 1 << $number;)*
        }
    };
}

bits! {
    /// FUNCTION, register 3.
    function, FUNCTION_BITS:
    0 POSPWRUP "POSPWRUP" "POSITION is loaded from EEPROM at power-up instead of starting at 0";
    1 RETPOS "RETPOS" "POSITION is returned instead of the acknowledge";
    2 RETVEL "RETVEL" "VELOCITY is returned instead of the acknowledge";
    3 RETTIME "RETTIME" "TIME is returned instead of the acknowledge";
    4 SATPROT "SATPROT" "the integral sum is limited to 4096 and stops while the output is saturated; clear: 120,000";
    5 SAVEPOS "SAVEPOS" "mode 4: POSITION is stored after 5 minutes without motion";
    6 VELLIMIT "VELLIMIT" "mode 4: moves are limited to VELOCITYLIMIT and feed-forward is used";
    7 ACTIVESTOP "ACTIVESTOP" "a stopped motor is shorted to ground; clear: it floats";
    8 LASTRC "LASTRC" "mode 0: a bad pulse is replaced by the mean of 64 good ones; clear: it stops the motor";
    9 ADSTEP "ADSTEP" "modes 0 to 2: the step limit is VELOCITYLIMIT, not the analog pin (after a reset)";
    10 ADSERIAL "ADSERIAL" "mode 5: the setpoint comes over serial";
    11 ENABLEDB "ENABLEDB" "modes 4 and 5: no drive inside DEADBAND, except at a commanded velocity";
    12 RCPOS "RCPOS-ENCFDBCK" "mode 0: R/C position control; mode 5: feedback from the encoder";
    13 VIRTLIMIT "VIRTLIMIT" "VNLIMIT and VPLIMIT act";
    14 DISABLEPID "DISABLEPID" "the output of the PID is off";
    15 DISABLEBLINK "DISABLEBLINK" "no blinking at power-up, so that the unit starts faster";
}

bits! {
    /// FUNCTION2, register 30. Of bits 0 and 1, and of bits 2 to 7, the highest that is set wins.
    function2, FUNCTION2_BITS:
    0 FREQ_HALF "FREQ/2" "PWM at 9 kHz";
    1 FREQ_DOUBLE "FREQX2" "PWM at 36 kHz";
    2 ADX2 "ADX2" "mode 5 with the encoder: setpoint = analog input x 2";
    3 ADX4 "ADX4" "mode 5 with the encoder: setpoint = analog input x 4";
    4 ADX8 "ADX8" "mode 5 with the encoder: setpoint = analog input x 8";
    5 ADX16 "ADX16" "mode 5 with the encoder: setpoint = analog input x 16";
    6 ADX32 "ADX32" "mode 5 with the encoder: setpoint = analog input x 32";
    7 ADX64 "ADX64" "mode 5 with the encoder: setpoint = analog input x 64";
    8 OVERTEMP "OVERTEMP" "the protection against overheating is OFF";
    9 PULSEFB "PULSEFB" "mode 4: the feedback is the width of a pulse";
    10 BAUD38400 "BAUD38400" "38,400 baud after the next power-up";
    11 NEWVELMODE "NEWVELMODE" "the velocity loop works on the error of velocity";
    12 BAUD115200 "BAUD115200" "115,200 baud after the next power-up";
    13 FASTPID "FASTPID" "PID every 500 us (firmware A and newer; not with serial or velocity control)";
}

bits! {
    /// STATUS, register 16.
    status, STATUS_BITS:
    0 NEGLIMIT "NEGLIMIT" "the negative limit input is at ground";
    1 POSLIMIT "POSLIMIT" "the positive limit input is at ground";
    2 BRAKE "BRAKE" "the brake input is at ground";
    3 INDEX "INDEX" "the index input is at ground";
    4 BADRC "BADRC" "the R/C pulse is missing, too short or too long";
    5 VNLIMIT "VNLIMIT" "the motor is at the negative virtual limit";
    6 VPLIMIT "VPLIMIT" "the motor is at the positive virtual limit";
    7 CURRENTLIMIT "CURRENTLIMIT" "the current is above AMPSLIMIT and the drive is reduced";
    8 PWMLIMIT "PWMLIMIT" "the drive is at PWMLIMIT";
    9 INPOSITION "INPOSITION" "the motor is where it was sent";
    10 TEMPFAULT "TEMPFAULT" "the bridge is off because it is too hot";
}
