// The serial ports that the browser lets this page reach. The browser reads and writes whenever the program gives way; the program takes what
// has come. What stops the motors is kept here too, and written when the program cannot do it.
"use strict";

globalThis.brushworkSerial = (() => {
    // More bytes than that do not wait for the program: it has not looked for long, and takes none of them for an answer.
    const MOST_WAITING = 65536;
    // As long as the program's own second process waits where there is one.
    const STANDS_STILL_MS = 350;
    const LOOK_MS = 100;
    // Bytes that a port does not take are not waited for longer when it is given back.
    const LAST_WRITES_MS = 500;

    const ports = new Map();
    let newest = 0, isChanged = true, refusal = "", wake = () => {};

    const pause = milliseconds => new Promise(done => setTimeout(done, milliseconds));
    const told = error => error?.message || String(error);

    function changed() {
        isChanged = true;
        globalThis.wasm_bindgen?.brushwork_ports_changed?.();
    }

    function meet(device) {
        for (const port of ports.values()) {
            if (port.device === device && port.isThere) {
                return;
            }
        }
        ports.set(++newest, { device, isThere: true, held: [] });
        changed();
    }

    function part(device) {
        for (const port of ports.values()) {
            if (port.device === device && port.isThere) {
                port.isThere = false;
                lose(port, "The device has been lost.");
                changed();
            }
        }
    }

    function lose(port, why) {
        port.isOpen = false;
        port.gone ??= why;
        port.held = [];
        wake();
    }

    function granted() {
        if (!isChanged) {
            return undefined;
        }
        isChanged = false;
        const numbers = [];
        for (const [number, port] of ports) {
            if (port.isThere) {
                const { usbVendorId, usbProductId } = port.device.getInfo();
                numbers.push(number, usbVendorId ?? 0, usbProductId ?? 0);
            }
        }
        return new Uint32Array(numbers);
    }

    async function choose() {
        try {
            meet(await navigator.serial.requestPort());
        } catch (error) {
            // Nothing is said to who has closed the browser's list.
            if (error.name !== "NotFoundError") {
                refusal = told(error);
                changed();
            }
        }
    }

    async function open(number, baudRate) {
        const port = ports.get(number);
        Object.assign(port, { isOpen: false, gone: undefined, come: [], waiting: 0, unwritten: 0, held: [], isMoving: false });
        try {
            await port.closing;
            await port.device.open({ baudRate, bufferSize: 4096 });
            // As the installed program does: a controller whose script has taken the USB port gives it back while RTS is on.
            await port.device.setSignals?.({ dataTerminalReady: true, requestToSend: true }).catch(() => {});
            port.writer = port.device.writable.getWriter();
            port.isOpen = port.isOurs = true;
            read(port);
        } catch (error) {
            lose(port, told(error));
        }
    }

    async function read(port) {
        let why = "The device has been lost.";
        // Noise, a break and a full buffer end a stream, and the port has another one then. It has none when the device is gone.
        while (port.isOpen && port.device.readable) {
            const reader = port.reader = port.device.readable.getReader();
            try {
                for (;;) {
                    const { value, done } = await reader.read();
                    if (done) {
                        return port.isOpen && lose(port, why);
                    }
                    keep(port, value);
                }
            } catch (error) {
                why = told(error);
            } finally {
                reader.releaseLock();
            }
        }
        if (port.isOpen) {
            lose(port, why);
        }
    }

    function keep(port, bytes) {
        if (port.waiting + bytes.length <= MOST_WAITING) {
            port.waiting += bytes.length;
            port.come.push(bytes);
        }
        wake();
    }

    function take(number) {
        const port = ports.get(number);
        const bytes = new Uint8Array(port.waiting);
        let at = 0;
        for (const piece of port.come) {
            bytes.set(piece, at);
            at += piece.length;
        }
        port.come = [];
        port.waiting = 0;
        return bytes;
    }

    function send(port, bytes) {
        if (!port.isOpen) {
            return;
        }
        port.unwritten += bytes.length;
        port.writer.write(bytes).then(
            () => { port.unwritten -= bytes.length; },
            error => port.isOpen && lose(port, told(error)));
    }

    // From now on these are written, with so much silence between two, when the program cannot do it; nothing where there are none.
    function hold(number, writes, gapMs) {
        Object.assign(ports.get(number), { held: writes, gapMs });
    }

    function sendHeld(port) {
        port.held.forEach((bytes, index) => index ? setTimeout(send, index * port.gapMs, port, bytes.slice()) : send(port, bytes.slice()));
    }

    // Writes what every port holds; whether there was anything.
    function stopAll() {
        const holding = [...ports.values()].filter(port => port.isOpen && port.held.length);
        holding.forEach(sendHeld);
        return holding.length > 0;
    }

    function close(number) {
        const port = ports.get(number);
        if (port.isOurs) {
            port.isOurs = port.isOpen = false;
            port.closing = giveBack(port);
        }
    }

    async function giveBack(port) {
        await Promise.race([port.writer.close(), pause(LAST_WRITES_MS)]).catch(() => {});
        await port.reader.cancel().catch(() => {});
        port.writer.releaseLock();
        await port.device.close().catch(() => {});
    }

    // One wait at a time: the program has one call that can be held.
    function wait(milliseconds) {
        return new Promise(done => {
            const timer = setTimeout(done, milliseconds);
            wake = () => { clearTimeout(timer); done(); };
        });
    }

    const reaches = () => "serial" in navigator && brushworkPauses;

    let ready = Promise.resolve();
    if ("serial" in navigator) {
        // Those that were chosen earlier are here without being asked for.
        ready = navigator.serial.getPorts().then(devices => devices.forEach(meet), () => {});
        navigator.serial.addEventListener("connect", event => meet(event.target));
        navigator.serial.addEventListener("disconnect", event => part(event.target));
        setInterval(() => {
            for (const port of ports.values()) {
                if (port.isMoving && performance.now() - port.livedAt > STANDS_STILL_MS) {
                    port.isMoving = false;
                    sendHeld(port);
                }
            }
        }, LOOK_MS);
    }

    return {
        ready, reaches, granted, choose, open, take, hold, close, wait, stopAll,
        takeRefusal() { const said = refusal; refusal = ""; return said || undefined; },
        isOpen: number => ports.get(number).isOpen,
        gone: number => ports.get(number).gone,
        write: (number, bytes) => send(ports.get(number), bytes),
        unwritten: number => ports.get(number).unwritten,
        moving(number, isMoving) { Object.assign(ports.get(number), { isMoving, livedAt: performance.now() }); },
        lives(number) { ports.get(number).livedAt = performance.now(); },
        stop: number => sendHeld(ports.get(number)),
    };
})();
