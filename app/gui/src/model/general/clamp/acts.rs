//! What General Settings does for the voltage clamp test.

use std::time::Duration;

use brushwork_link::device::{ArmScope, QueuedJob};
use brushwork_link::settings::{Group, SettingValue};
use crossbeam_channel::bounded;

use super::{ClampTest, Running};
use crate::model::general::section::Section;
use crate::model::{General, GeneralView};
use brushwork_core::motion::clamp::{self, STEPS, Task};

impl General {
    /// What can be armed here: the clamp test on its own page.
    pub fn arm_scope(&self) -> Option<ArmScope> {
        let is_open = self.section == Section::ClampTest && !self.is_filtered() && self.sheet.is_none();
        is_open.then_some(ArmScope::ClampTest)
    }

    /// What was found says nothing of another unit.
    pub(in crate::model::general) fn forget_clamp_test(&mut self) {
        if !self.clamp.job.is_running() {
            self.clamp = ClampTest::default();
        }
    }
}

impl GeneralView<'_> {
    /// Begins the clamp test; what to ask of the device thread. Nothing while other work runs.
    pub fn begin_clamp_test(&mut self) -> Option<QueuedJob> {
        if self.is_busy() {
            return None;
        }
        let limit_volts = self.clamp.limit(self.unit());
        let test = &mut self.clamp;
        let task = Task {
            motor: test.motor,
            limit_volts,
            down_duty_per_s: (test.down_percent_per_s / 100.0).clamp(0.2, 20.0),
            hold: Duration::from_secs_f64(test.hold_s.clamp(0.2, 10.0)),
        };
        let (sender, found) = bounded(STEPS);
        let job = test.job.begin(clamp::job(task, sender))?;
        test.running = Some(Running { task, found });
        test.steps.clear();
        test.verdict = None;
        Some(job)
    }

    /// Outputs that are set to clamp over-voltage, from 1.
    pub fn clamping_outputs(&self) -> Vec<usize> {
        let Some(unit) = self.unit() else { return Vec::new() };
        let rows = unit.table().group(Group::OUTPUTS).filter(|row| row.pattern == "dout.{n}.action");
        let clamps = |row: &&brushwork_link::settings::Row| {
            unit.on_controller(&row.key) == Some(SettingValue::Choice("over_voltage"))
        };
        rows.filter(clamps).filter_map(|row| row.instance.as_ref().map(|one| one.number)).collect()
    }
}
