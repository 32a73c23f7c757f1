//! What guided tuning and tuning by hand show, in words.

use brushwork_core::messages::EndedMessage;
use brushwork_values::{Message, Motor, messages};

messages! {
    /// What keeps gains from being stiffer.
    pub enum BoundMessage {
        Sensitivity "the maximum sensitivity Ms",
        Lag "the lag of the loop: Ms with the largest lag that is likely",
        LightLoad "a lighter load: Ms at half the inertia",
        DutyNoise "the duty noise, which the rounding of counts makes",
        Backlash "the backlash of the mechanics: a quicker integral would make it hunt",
    }
}

messages! {
    /// What to do next in tuning by hand, by the last moves of the motor.
    pub enum AdviceMessage {
        Watching "Watching the motor: leave the slider where it is for a moment.",
        ArmAndMove "Arm the screen and move the slider; then wait a second.",
        NoQpps "QPPS is 0. Measure or enter it first.",
        NoTravel "Min and Max leave no travel, so the slider has nowhere to go. Set them under Position loop, or press No end stops in the first step.",
        VelocityGains "P, I or D of the velocity loop are not 0. Set them to 0, or leave them if that loop is tuned already, and go on.",
        Ready { qpps: i64, min: i64, max: i64 } "QPPS is {qpps} counts/s and the travel goes from {min} to {max} counts. If that is right, go on.",
        QppsReady { qpps: i64 } "QPPS is {qpps} counts/s. If that is right, go on.",
        RunsAway "It runs away at full duty: stop. The motor leads or the encoder wires are swapped; swap one of the two, not both.",
        Vibrates { speed_percent: f64, duty_percent: f64 } "It vibrates: ± {speed_percent:.0} % of the speed, ± {duty_percent:.0} % duty.",
        VibratesLessP { vibrates: Message } "{vibrates} Take P to two thirds.",
        VibratesLessI { vibrates: Message } "{vibrates} Take I back.",
        VibratesLess { vibrates: Message } "{vibrates} Take D back, or I and P if D is 0.",
        HardlyTurns "It hardly moves. Raise P.",
        Turns "It turns and the loop has it. Go on to P.",
        NearSpeed { below_percent: f64 } "Smooth, and {below_percent:.1} % off. Go on to I.",
        BelowWithP { below_percent: f64 } "Smooth, but {below_percent:.0} % below the setpoint. Raise P.",
        BelowWithI { below_percent: f64 } "{below_percent:.1} % below the setpoint. Raise I.",
        OvershootsWithI { percent: f64 } "Exact, but the last change overshot by {percent:.0} %. Take I back a little.",
        SpeedDone "Exact and smooth. You are done; save it when you like.",
        Hunts { counts: f64 } "It hunts about the setpoint: ± {counts:.0} counts.",
        Overshot { percent: f64 } "The last move overshot by {percent:.0} %.",
        HuntsLessD { hunts: Message } "{hunts} Take D back, then P.",
        HuntsInDeadzone { hunts: Message } "{hunts} Widen the deadzone, or take I back.",
        HardlyGoes "It hardly moves. Go on to P, and raise it.",
        Goes "It goes and stops. Go on to P and D.",
        OvershotMoreD { overshot: Message } "{overshot} Raise D.",
        OvershotABit { overshot: Message } "{overshot} Raise D until it does not.",
        ShortWithP { counts: f64 } "No overshoot, and {counts:.0} counts from the setpoint. Raise P.",
        AtSetpoint "No overshoot, and at the setpoint. Raise P and D for more speed, or go on.",
        ShortWithI { counts: f64 } "{counts:.0} counts from the setpoint. Raise I, and Max I if that does nothing.",
        PositionDone "At the setpoint and quiet. You are done; save it when you like.",
    }
}

messages! {
    /// What is said of the runs of the tuner.
    pub enum RunMessage {
        SecondsLeft { seconds: f64 } "about {seconds:.0} s left",
        Tuning { motor: Motor } "Tuning {motor}",
        TookBack { limit: Message } "The run took gains back, since the machine was rougher than the model. {limit}",
        Limited { by: Message, percent: f64, level: f64 } "Limited by {by}; {percent:.0} % of what level {level:.0} allows.",
        Beyond { by: Message, percent: f64, level: f64 } "Beyond {by}; {percent:.0} % of what level {level:.0} allows.",
        LimitedAtAnyLevel { by: Message } "Limited by {by}.",
        BeyondAtAnyLevel { by: Message } "Beyond {by}.",
        Unlimited "No bound limits here: stiffer gains would overshoot more without following better, so the level changes little.",
        Cleared { motor: Motor } "L and R of {motor} are cleared. They are put back after the run.",
        StoppedBy { by: EndedMessage } "The run was stopped: {by}.",
        NotTuned { motor: Motor, number: usize, seconds: f64 } "{motor} was not tuned · run {number} · {seconds:.1} s",
        Ended { verdict: &'static str, number: usize, seconds: f64 } "{verdict} · run {number} · {seconds:.1} s",
        FeedForward { register: &'static str, raw: i64, percent: f64 } "Feed-forward: {register} {raw} gives {percent:.0} % of a speed's duty.",
        FeedForwardInPart { register: &'static str, raw: i64, percent: f64 } "Feed-forward: {register} {raw} gives {percent:.0} % of a speed's duty. The loop makes up for the rest; the design counts on no more than this.",
        Model { qpps: f64, gain_interval_percent: f64, time_constant_ms: f64, time_interval_percent: f64, friction_percent: f64, friction_interval_percent: f64 } "Motor: {qpps:.0} counts/s at full duty ± {gain_interval_percent:.2} %, time constant {time_constant_ms:.1} ms ± {time_interval_percent:.0} %, friction {friction_percent:.1} ± {friction_interval_percent:.1} % duty",
        Lag { low: f64, high: f64 } ", lag {low:.1} to {high:.1} ms",
        Backlash { counts: f64, interval: f64 } ", backlash of at least {counts:.1} ± {interval:.1} counts",
        Proposed { motor: Motor, field: &'static str } "{motor} proposed {field}",
        Rule { gains: String, ms: f64, overshoot_percent: f64 } "{gains}: Ms {ms:.2}, overshoot {overshoot_percent:.0} % on the model",
        Considered { level: f64 } "Considered on the model only: level {level:.0}, or gains by hand. Nothing was sent.",
        Trajectory { speed: f64, accel: f64 } "A trajectory that the motor follows: {speed:.0} counts/s, {accel:.0} counts/s² up and down.",
        TrajectoryOfBoth { speed: f64, accel: f64 } "One that both motors follow alike: {speed:.0} counts/s, {accel:.0} counts/s² up and down.",
        LikelySettling { low_ms: f64, high_ms: f64 } "Likely {low_ms:.0} to {high_ms:.0} ms, by what is known of motor and lag",
        LikelySensitivity { low: f64, high: f64 } "Likely {low:.2} to {high:.2}, by what is known of motor and lag",
        Inertia { calm: String, stable: String } "Other loads: Ms stays up to 2 at {calm} the inertia; the loop is stable at {stable}.",
        InertiaStable { stable: String } "Other loads: Ms is above 2 as it is; the loop is stable at {stable} the inertia.",
        Held { stall_percent: f64, duty_percent: f64, speed: f64 } "It holds a steady load of up to {stall_percent:.0} % of the stall torque ({duty_percent:.0} % duty) at {speed:.0} counts/s.",
        HeldWithOffset { stall_percent: f64, duty_percent: f64, speed: f64, behind: f64, unit: &'static str } "It bears a steady load of up to {stall_percent:.0} % of the stall torque ({duty_percent:.0} % duty) at {speed:.0} counts/s, and stays {behind:.0} {unit} behind under it.",
        Promised { promised: String } "The model gives {promised} for the same moves",
        Draw { number: usize } "Draw run {number}",
        Level { level: f64, seconds: f64 } "Level {level:.0}, {seconds:.1} s",
        Tune { motor: Motor } "Tune {motor}",
        LevelOf { motor: Motor } "{motor} level",
        Resistance { ohms: f64, interval: f64 } "Measured R {ohms:.3} ± {interval:.3} Ω",
        NoResistance { why: &'static str } "R of the winding was not reported: {why}",
    }
}

messages! {
    /// What the charts of the tuner are called.
    pub enum ChartMessage {
        Live { name: &'static str } "Live {name} of the run",
        Measured { name: &'static str } "Measured {name} over the predicted one",
        LoadStep { name: &'static str } "Predicted {name} under a load step",
        Step { name: &'static str } "Predicted step of the {name}",
        Goal { goal: f64 } "Ms of the level: {goal:.2}",
    }
}
