//! Whether an image may be sent to a unit.

use brushwork_mcp_wire::loader::{Image, ImageError, SimulatedImage};
use brushwork_mcp_wire::models::Model;

use brushwork_link::device::Identity;
use brushwork_link::transport::Stream;

/// Why an image is not sent to a unit. Each is a clause for a sentence.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unsuitable {
    /// The bytes are no image for the family.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// The unit's model is not known.
    #[error(
        "the controller calls itself \"{version}\", which is no known model, so what it takes is not known"
    )]
    UnknownModel {
        /// Its version text.
        version: String,
    },
    /// An image for simulated controllers, and the controller is real.
    #[error("it was made for simulated controllers and would leave a real one without firmware")]
    OnlySimulated,
    /// An image for another model.
    #[error("it was made for the {made_for}, and this is a {model}")]
    OtherModel {
        /// The image's model.
        made_for: &'static str,
        /// The unit's.
        model: &'static str,
    },
    /// The port is not USB.
    #[error("the loader answers over USB alone, and this port is {stream}")]
    NotUsb {
        /// What it is.
        stream: Stream,
    },
}

/// Takes the bytes of a file as an image for this unit.
///
/// # Errors
/// A clause that says why it is not sent.
pub fn suit(
    bytes: Vec<u8>,
    identity: &Identity,
    model: Option<&'static Model>,
    stream: Option<Stream>,
) -> Result<Image, Unsuitable> {
    let Some(model) = model else {
        return Err(Unsuitable::UnknownModel { version: identity.version_text.clone() });
    };
    if let Some(stream) = stream.filter(|stream| *stream != Stream::Usb) {
        return Err(Unsuitable::NotUsb { stream });
    }
    let image = suit_model(bytes, model, identity.simulated)?;
    match image.simulated() {
        Some(made) if made.model.key != model.key => {
            Err(Unsuitable::OtherModel { made_for: made.model.name, model: model.name })
        }
        _ => Ok(image),
    }
}

/// Takes the bytes of a file as an image for a unit of a model, as far as nobody can ask the unit itself: it waits in its loader.
///
/// # Errors
/// A clause that says why it is not sent.
pub fn suit_model(bytes: Vec<u8>, model: &Model, is_simulated: bool) -> Result<Image, Unsuitable> {
    if SimulatedImage::is_marked(&bytes) && !is_simulated {
        return Err(Unsuitable::OnlySimulated);
    }
    Ok(Image::new(bytes, model.family)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_mcp_wire::models;
    use brushwork_mcp_wire::packet_serial::Generation;

    fn unit(simulated: bool) -> Identity {
        Identity {
            family: crate::MCP,
            address: 0x80,
            protocol: "packet serial",
            version_text: "MCP266 2x60A v1.0.0".to_owned(),
            model: Some("MCP266"),
            firmware: "1.0.0".to_owned(),
            generation: crate::firmware_of(Generation::Gen1),
            facts: brushwork_link::device::Facts::new(crate::McpFacts {
                generation: Generation::Gen1,
                is_mcp: true,
                is_node: false,
                motors: 2,
            }),
            also_answers: Vec::new(),
            simulated,
            port: "test".to_owned(),
            notes: Vec::new(),
        }
    }

    fn made_for(model: &str) -> Vec<u8> {
        let model = models::lookup(model).unwrap();
        let image = SimulatedImage { model, version: "1.1.0".to_owned(), generation: Generation::Gen1 };
        image.bytes().unwrap()
    }

    fn check(bytes: Vec<u8>, simulated: bool, stream: Option<Stream>) -> Result<Image, Unsuitable> {
        suit(bytes, &unit(simulated), models::lookup("mcp266"), stream)
    }

    #[test]
    fn an_image_for_simulated_controllers_never_goes_to_a_real_one() {
        assert!(check(made_for("mcp266"), true, Some(Stream::Usb)).is_ok());
        assert_eq!(check(made_for("mcp266"), false, Some(Stream::Usb)), Err(Unsuitable::OnlySimulated));
        let cut = made_for("mcp266")[..300].to_vec();
        assert_eq!(check(cut, false, None), Err(Unsuitable::OnlySimulated));
    }

    #[test]
    fn an_image_for_another_model_is_refused() {
        let error = check(made_for("mcp263"), true, None).unwrap_err();
        assert_eq!(error.to_string(), "it was made for the MCP263, and this is a MCP266");
    }

    #[test]
    fn size_port_and_an_unknown_model_are_looked_at() {
        assert!(matches!(check(vec![1, 2], false, None), Err(Unsuitable::Image(ImageError::Size { .. }))));
        let ttl = check(made_for("mcp266"), true, Some(Stream::Ttl1)).unwrap_err();
        assert!(ttl.to_string().contains("TTL UART1"), "{ttl}");
        let unknown = suit(made_for("mcp266"), &unit(true), None, None);
        assert!(matches!(unknown, Err(Unsuitable::UnknownModel { .. })));
    }
}
