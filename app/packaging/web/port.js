// Stands in for the serial ports of a browser in the page's test: one adapter, whose bytes the test carries to a simulated controller.
"use strict";

globalThis.standIn = (() => {
    const CHOSEN = "standInChosen";
    const lost = () => new DOMException("The device has been lost.", "NetworkError");
    const text = bytes => btoa(String.fromCharCode(...bytes));
    const bytesOf = letters => Uint8Array.from(atob(letters), letter => letter.charCodeAt(0));

    const port = {
        readable: null, writable: null,
        getInfo: () => ({ usbVendorId: 0x0403, usbProductId: 0x6001 }),
        async open({ baudRate }) {
            if (port.readable) {
                throw new DOMException("The port is already open.", "InvalidStateError");
            }
            standInTells(`open ${baudRate}`);
            port.readable = new ReadableStream({ start(controller) { port.come = controller; } });
            port.writable = new WritableStream({ write(bytes) { standInTells(`bytes ${text(bytes)}`); } });
        },
        async setSignals() {},
        async close() {
            if (port.readable?.locked || port.writable?.locked) {
                throw new TypeError("Cannot close a port whose streams are locked.");
            }
            port.readable = port.writable = null;
            standInTells("close");
        },
    };
    const serial = new EventTarget();
    serial.getPorts = async () => sessionStorage.getItem(CHOSEN) ? [port] : [];
    serial.requestPort = async () => {
        if (!navigator.userActivation.isActive) {
            throw new DOMException("Must be handling a user gesture to show a permission request.", "SecurityError");
        }
        sessionStorage.setItem(CHOSEN, "yes");
        return port;
    };
    Object.defineProperty(Navigator.prototype, "serial", { get: () => serial });

    return {
        feed: letters => { if (port.readable) { port.come.enqueue(bytesOf(letters)); } },
        pull() {
            const come = port.come;
            port.readable = port.writable = null;
            come.error(lost());
            serial.dispatchEvent(Object.defineProperty(new Event("disconnect"), "target", { value: port }));
        },
        hide(isHidden) {
            Object.defineProperty(document, "hidden", { value: isHidden, configurable: true });
            document.dispatchEvent(new Event("visibilitychange"));
        },
    };
})();
