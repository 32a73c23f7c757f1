//! The download of a script into an MCP.

use crate::mcp::messages::DownloadMessage;
use brushwork_link::Job;
use brushwork_mcp_client::messages::McpActMessage;
use brushwork_mcp_client::script::{Downloaded, ScriptImage, Verified, download};

/// Downloads a file's bytes; comes to a clause of what was sent.
pub fn download_job(bytes: &[u8]) -> Result<Job<String>, String> {
    let image = ScriptImage::from_file(bytes).map_err(|error| error.to_string())?;
    Ok(Job::new(McpActMessage::DownloadScript, image.download_limit(), move |context| {
        let is_simulated = context.is_simulated();
        download(context, &image, is_simulated).map(|done| reported(&done))
    }))
}

/// What was sent and how far it is known to have arrived.
fn reported(done: &Downloaded) -> String {
    let verified = match done.verified {
        Verified::Content => "verified".to_owned(),
        Verified::Status => "each block confirmed".to_owned(),
        Verified::Alike(byte) => DownloadMessage::BlocksAnswered { byte }.to_string(),
    };
    let foreign = if done.is_foreign { " A simulated controller does not run it." } else { "" };
    DownloadMessage::Sent { bytes: done.bytes, seconds: done.took.as_secs_f64(), verified, foreign }
        .to_string()
}
