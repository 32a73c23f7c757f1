// Starts the program and hands it the time. Nothing is fetched, so that the page works from a folder as from a server.
"use strict";

const word = document.getElementById("word");

function say(text) {
    word.textContent = text;
    word.hidden = false;
}

function failed(what) {
    brushworkSerial.stopAll();
    say("Brushwork has stopped by a bug of its own. Reload the page; what was saved is still there. " + what);
}

// Whether it still gets out when a tab is closed is up to the browser.
addEventListener("pagehide", () => brushworkSerial.stopAll());
addEventListener("error", event => failed(event.message));
addEventListener("unhandledrejection", event => failed(event.reason));

// Where the browser can hold a call in its middle (JavaScript Promise Integration), long jobs let the window draw. Elsewhere they run at once.
globalThis.brushworkPauses = "Suspending" in WebAssembly && "promising" in WebAssembly;
globalThis.brushwork_pause = () => {};
globalThis.brushwork_wait = () => {};

const TURN_MS = 15;
const moment = () => new Promise(done => setTimeout(done, TURN_MS));

const instantiate = WebAssembly.instantiate;
WebAssembly.instantiate = (program, imports) => {
    for (const part of Object.values(imports)) {
        for (const name of Object.keys(part)) {
            for (const [ours, held] of [[/brushwork_?pause/, moment], [/brushwork_?wait/, brushworkSerial.wait]]) {
                if (brushworkPauses && ours.test(name)) {
                    part[name] = new WebAssembly.Suspending(held);
                }
            }
        }
    }
    return instantiate(program, imports);
};

function unpacked(text) {
    const letters = atob(text);
    const bytes = new Uint8Array(letters.length);
    for (let at = 0; at < letters.length; at++) {
        bytes[at] = letters.charCodeAt(at);
    }
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Response(stream).arrayBuffer();
}

async function run() {
    await brushworkSerial.ready;
    const program = await wasm_bindgen({ module_or_path: await unpacked(brushworkProgram) });
    word.hidden = true;
    // A browser lets a hidden page work once a second or less: what drives a motor is stopped at once, and by the program once more.
    document.addEventListener("visibilitychange", () => {
        if (document.hidden && brushworkSerial.stopAll()) {
            program.brushwork_hidden();
        }
    });
    const turn = brushworkPauses ? WebAssembly.promising(program.brushwork_turn) : program.brushwork_turn;
    for (;;) {
        await turn();
        await moment();
    }
}

if ("DecompressionStream" in globalThis && "WebAssembly" in globalThis) {
    run();
} else {
    say("This browser is too old for Brushwork: it needs WebAssembly, WebGL and DecompressionStream.");
}
