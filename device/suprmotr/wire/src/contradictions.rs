//! Where the manual contradicts itself or its own examples, and what counts here. What an example shows counts more than what a sentence
//! says, the command reference more than the short form. "Known" is what controllers of other makers with the same language do.

use serde::Serialize;

/// One place where the manual says two things.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Contradiction {
    /// Its number, from 1 on.
    pub number: u8,
    /// The sections of the manual.
    pub at: &'static str,
    /// What it says.
    pub says: &'static str,
    /// What counts.
    pub counts: &'static str,
}

macro_rules! contradictions {
    ($($number:literal $at:literal $says:literal => $counts:literal;)*) => {
        /// All of them.
        pub static CONTRADICTIONS: &[Contradiction] =
            &[$(Contradiction { number: $number, at: $at, says: $says, counts: $counts }),*];
    };
}

contradictions! {
    1 "Address Selection" "after power-up no controller is selected; or all are, and report a copyright notice" => "none is, and nothing is reported; a client selects first and drops what waits";
    2 "Key features, Address Selection" "16 controllers on a line; or 32" => "16: one character, 0 to F, for V is all of them";
    3 "Address Selection, Short Form" "DA defines the address; DB does" => "DB; DA is the acceleration";
    4 "Address Selection" "the address is kept in EEPROM; or read from channels 14 to 16 at reset" => "EEPROM; the pins are an option of the simulator";
    5 "Address Selection" "01 35 54 54 13 selects and asks; 13 is no hexadecimal number there" => "01 35 54 54 0D";
    6 "Address Selection" "a board is set to address 5, and key 4 is pressed" => "meant as it stands: no unit answers";
    7 "Character description" "the columns of decimal and hexadecimal numbers" => "their headings are swapped";
    8 "Reply Termination, examples" "0P0:+0000020002, 5p0:+000300, 5T:+0000000000 and T:" => "the first is sent unless another form is chosen; all are read";
    9 "Command Reference, examples" "the letter O stands for the address 0" => "the digit 0";
    10 "Define Integral Limit, Define I-Term" "dI and gI, and \"unless di sets the limit\"" => "DL and GL";
    11 "Get Acceleration" "letter A; the example has L, which is also the integral limit's" => "A is sent, A and L are read; of GL L is sent, L and M are read";
    12 "Short Form" "TD reports N and DU lists D; GP reports G and TG lists P; TO reports o or O" => "TG and DU report what the single commands do; letters in either case";
    13 "Tell Status" "EE is the sixth byte; the errors are headed Byte_5" => "six bytes, the error last; five are read too";
    14 "Define Following Error" "SM, DE or Define Following Error" => "SM; DE is no command";
    15 "Move Absolute" "24-bit integers; positions to 1 073 741 843" => "2^30 - 1 = 1,073,741,823 on both sides of 0";
    16 "Define Velocity" "1000 to 255,000; 0 to 1,000,000; the factory has 20,000" => "0 to 1,000,000";
    17 "Define P-Term, Define I-Term" "words of 16 bits; 0 to 255" => "0 to 255, above it error 06";
    18 "Macro Definition, Short Form" "macros 0 to 14; 1 to 31" => "0 to 14, above it error 06";
    19 "Tell Macro" "TM 0 lists all; TZ lists macro 0" => "both";
    20 "Tell Macro" "mc1,mr555,ws,gh; MD11, MR+0000000500,..." => "the second is sent, both are read";
    21 "Repeat" "l+1 times; n" => "n more times: RP99 makes 100";
    22 "Some more macros" "macro 12 goes in the negative direction and has MR500,RP5" => "MR-500,RP9 is meant";
    23 "Increment Analog Output" "a definition that begins with mc2" => "md2";
    24 "Execute if Off" "the examples of XN once more" => "the one with xf3";
    25 "Tell Channel" "8 bits for 16 channels" => "four hexadecimal digits are sent, any count is read";
    26 "Key features, Tell Analog Input" "eight inputs; TA takes 0 to 2" => "0 to 2, above it error 06";
    27 "Address Selection" "DP55,DI10,DL100,DP200 sets the gains" => "the last one is DD200";
    28 "Reset Controller, Update" "RT brings default values; UD's are active at power-up" => "what UD stored, else the factory's";
    29 "Find Edge" "E1 and E2; the connector has negative and positive limit" => "E1 is the negative, E2 the positive";
    30 "Factory Settings, Short Form" "DV and DA; SV and SA" => "both";
    31 "Abort Motion, Sub-Commands" "AB takes 0 or 1; AB alone" => "AB alone is AB0";
    32 "Some more macros" "MA without a number" => "MA0";
}
