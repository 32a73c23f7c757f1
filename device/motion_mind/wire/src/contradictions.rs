//! Where the manual contradicts itself or its own examples, and what counts here. What an example shows counts more than what a sentence
//! says, a register's own chapter more than a mode's.

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
    1 "5.2.1" "what return bits add is sent most significant byte first; the example has the least first" => "least first, as everywhere";
    2 "5.2.1" "the sum is over the data bytes; the example includes the address" => "the address is included";
    3 "5.2, figure 20" "return bits change every reply but that of reads; or of reads and writes" => "writes are acknowledged plainly";
    4 "5.3.1" "the decimal checksum of the example is 12" => "18, which is the hexadecimal 12";
    5 "5.9.2, figure 22" "bit 0 of STATUS is the positive limit; or the negative" => "bit 0 NEGLIMIT, bit 1 POSLIMIT";
    6 "5.9.2, figure 22" "read 97 lists ten bits; STATUS has eleven" => "ten are sent, eleven are taken";
    7 "4.7, figure 20" "SAVEPOS stores after ten minutes; or after five" => "five";
    8 "4.3, figure 20" "LASTRC takes the mean of 32 pulses; or of 64" => "64";
    9 "4.3 to 4.8, figures 18 and 20" "LOADPOS or POSPWRUP, RCPOS or ENCFDBCK, AMPLIMIT or AMPSLIMIT" => "the names of figures 18 and 20";
    10 "4.3, figure 20" "the dead band of R/C positions is RCBAND; or DEADBAND" => "DEADBAND";
    11 "6.2" "15 steps of RCBAND are 1.467 to 1.533 ms" => "1.474 to 1.526 ms, by the step of 1736 ns";
    12 "6.2" "20 steps of DEADBAND are 0.98 V" => "0.098 V";
    13 "4.8" "ADX2 reaches 4046" => "2046";
    14 "3.11" "-1 is seven times F" => "eight times";
    15 "3.17, figure 21" "the multipliers are bits 2 to 6; or 2 to 7" => "2 to 7";
    16 "4.4, figure 18" "TIMER is 0 to 255; or 1 to 255" => "1 to 255; a 0 acts as 1";
    17 "5.9.1" "the highest eight bits of a mask are for later; or registers 24 to 31" => "registers 24 to 31";
    18 "5.4 to 5.6" "mode 4 counts every edge; or as switch 7 says" => "as switch 7 says";
    19 "2.1, 5.1, figure 21" "there are two baud rates; or three; or four" => "four; of both bits 115,200 wins";
    20 "3.1, 3.2, 3.5" "the motor supply is at most 24, 32 or 36 V" => "24 V in use, 32 V at the very most";
    21 "5.1, figure 18" "ADDRESS is 0 to 255; two digits; and from 99 on everybody" => "1 to 98 are offered";
    22 "3.4, 5.8, 5.13" "numbers and titles of sections and tables stand twice" => "nothing follows from them";
    23 "figure 18" "VELOCITYLIMIT and PWMLIMIT begin at 1; programs in use write 0 and expect an acknowledge" => "a unit takes what fits the bytes; a client warns";
}
