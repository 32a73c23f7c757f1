//! What can go wrong with an update.

/// What can go wrong, sentence by sentence. To be shown before anything is sent, and to be accepted expressly.
#[must_use]
pub fn risks(simulated: bool) -> Vec<&'static str> {
    let mut risks = vec![
        "The controller first erases its flash memory. If its power fails during that, it is dead for good: there is no recovery \
         (MCP manual 1.3.2).",
        "Feed it from a full battery or a dependable supply, and leave power and USB cable alone until it is done.",
        "A transfer that breaks after the erase leaves the controller without firmware, waiting in its loader. Switch it off and \
         on, then send the image again; the update resumes there.",
        "Motors are stopped first and are not driven while the update runs. Make sure that nothing falls or rolls without them.",
        "Settings are backed up first. Whether a controller keeps them through an update is not public: compare after it.",
    ];
    if simulated {
        risks.push(
            "This controller is simulated. It can be killed too, and is as new when it is started again.",
        );
    } else {
        risks.extend([
            "No firmware image is published. The file is yours, and this program cannot tell whether it is firmware at all, or \
             whether it is for this model: what a controller checks of an image is not public.",
            "The transfer has no checksum. A byte that changes on its way is not noticed.",
            "The loader's protocol is known from the maker's class library of 2015 to 2020. This program has sent images to simulated \
             controllers only, never to a real one.",
        ]);
    }
    risks
}
