//! What the window for connecting to a CANopen bus holds.

use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use brushwork_link::Message;
use brushwork_link::transport::PortInfo;
use brushwork_link::transport::target::DEFAULT_ADAPTER_BAUD;
use crossbeam_channel::Receiver;

/// Baud rates that adapters are often set to.
pub const ADAPTER_BAUD_RATES: [u32; 6] = [38_400, 57_600, 115_200, 230_400, 460_800, 1_000_000];

/// The bus that is simulated in this program.
pub const SIMULATED_BUS: &str = "sim:mcp266,can";

/// The window and what was chosen in it.
#[derive(Clone, Debug)]
pub struct CanOpenChoice {
    pub open: bool,
    /// The adapter's port; none means the bus that is simulated in this program.
    pub port: Option<String>,
    pub form: Form,
    pub baud: u32,
    /// One node, or all that answer.
    pub node: Option<u8>,
    /// What comes of a node that is being started.
    pub starting: Option<Receiver<Result<Message, Message>>>,
}

impl Default for CanOpenChoice {
    fn default() -> Self {
        Self {
            open: false,
            port: None,
            form: Form::default(),
            baud: DEFAULT_ADAPTER_BAUD,
            node: None,
            starting: None,
        }
    }
}

impl CanOpenChoice {
    /// Opens the window, with the first serial port chosen that is no controller's own.
    pub fn show(&mut self, ports: &[PortInfo]) {
        self.open = true;
        if self.port.as_ref().is_none_or(|chosen| ports.iter().all(|port| port.name != *chosen)) {
            self.port = ports.iter().find(|port| !port.names_a_controller()).map(|port| port.name.clone());
        }
    }

    /// What a person would have typed.
    pub fn target(&self) -> String {
        let node = |id: u8| NodeId::new(id).map_or(String::new(), |node| format!(",node={}", node.get()));
        match &self.port {
            None => {
                let form = if self.form == Form::default() {
                    String::new()
                } else {
                    format!("={}", self.form.key())
                };
                format!("{SIMULATED_BUS}{form}{}", self.node.map_or(String::new(), node))
            }
            Some(port) => format!(
                "can:{port},baud={}{},form={}",
                self.baud,
                self.node.map_or(String::new(), node),
                self.form.key()
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_link::transport::ConnectTarget;

    #[test]
    fn what_is_chosen_is_what_would_be_typed() {
        let mut choice = CanOpenChoice::default();
        assert_eq!(choice.target(), "sim:mcp266,can");
        choice.form = Form::Binary;
        choice.node = Some(3);
        assert_eq!(choice.target(), "sim:mcp266,can=binary,node=3");
        choice.port = Some("/dev/ttyUSB0".to_owned());
        let target: ConnectTarget = choice.target().parse().unwrap();
        assert_eq!(target.to_string(), "can:/dev/ttyUSB0,node=3,form=binary");
    }

    #[test]
    fn an_adapter_is_chosen_before_a_controllers_own_port() {
        brushwork_link::install(&[
            &brushwork_mcp_client::McpDriver,
            &brushwork_motion_mind_client::MotionMindDriver,
        ]);
        let port = |name: &str, product: &str| PortInfo {
            name: name.to_owned(),
            product: Some(product.to_owned()),
            ..PortInfo::default()
        };
        let mut choice = CanOpenChoice::default();
        choice.show(&[port("/dev/ttyACM0", "MCP266 2x60A"), port("/dev/ttyUSB0", "FT232R USB UART")]);
        assert_eq!(choice.port.as_deref(), Some("/dev/ttyUSB0"));
        choice.show(&[]);
        assert_eq!(choice.port, None);
    }
}
