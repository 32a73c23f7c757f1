//! What a RoboClaw does by its control pins and its configuration word: emergency stop, limit and home switches, homing at power-up,
//! R/C and analog inputs, simple serial, control outputs, battery cut-off (RoboClaw manual 2018).
//!
//! Assumed, all in this folder, since no public source says it:
//! - the configuration word but for its address counts from a power up on, and packet serial goes on over USB in every mode;
//! - an open pin is pulled up, and a pin reads low below 1.5 V; D1 and D2 are the outputs CTRL1 and CTRL2 of earlier firmware;
//! - a latching emergency stop is released by command 200 where 201 allows it, as a button is;
//! - a switch for both ends stops the direction in which the motor ran when it closed, backward if it stood;
//! - homing is by duty whatever loops are set, 25 % in generation 4, which has no setting for it, and any command ends it; without a
//!   time-out it does not begin;
//! - in R/C and analog mode packet serial moves nothing; R/C pulses go from 1000 to 2000 us and their center is what they are at first,
//!   1500 us with MCU; pulses that stop for 250 ms are lost; the flip switch turns both motors round; an open analog input is a stop;
//!   the range and the limits of generation 4 are in us, in mV, and in 1/32767 of full output, and zeros leave the unit's own;
//! - exponential is a square; behind a deadband the slope begins at its edge; a motor goes on by its input after an emergency stop;
//! - a cell is cut off at 3.0 V and full at 4.2 V; with automatic offset the maximum is so much above the voltage at power-up;
//! - slave mode, relay mode, swapped buttons, encoder toggle and RS-485 direction have no effect here.

mod homing;
mod inputs;
mod outputs;
mod pins;
mod state;
mod word;

pub(super) use state::{Control, follow_rate};
