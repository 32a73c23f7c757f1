//! What the window's tests share.
#![allow(dead_code, reason = "each test file uses its own part of this")]

pub mod alone;
pub mod bench;
pub mod causes;
pub mod cpu;
pub mod hand;
pub mod line;
pub mod lockstep;
pub mod one;
pub mod palette;
pub mod tuning;
pub mod wait;
pub mod words;

/// Names the families that this window's tests have.
pub fn install_families() {
    brushwork_link::install(&[
        &brushwork_mcp_client::McpDriver,
        &brushwork_motion_mind_client::MotionMindDriver,
    ]);
    brushwork_family::simulator::install(&[
        &brushwork_mcp::McpSimulator,
        &brushwork_motion_mind::MotionMindSimulator,
    ]);
    brushwork_family::examine::install(&[&brushwork_mcp::McpExaminer]);
    brushwork_gui::install(&[&brushwork_gui::mcp::Mcp, &brushwork_gui::motion_mind::MotionMind]);
}
