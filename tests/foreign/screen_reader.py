#!/usr/bin/env python3
"""The guided path by a screen reader's interface alone: AT-SPI over D-Bus, no mouse, no key, no picture.

Finds the window on the session bus of DBUS_SESSION_BUS_ADDRESS, finds what it needs by role and name, acts through the interfaces Action and
Value, and hears the announcements of live regions: from an empty start to a simulated controller whose motor was seen to turn the right
way, whose velocity loop is tuned, and whose settings are saved. A line on standard output for each step; exit code 1, with what was on the
screen, where a step fails.

Needs at-spi2-core, python3-dbus and python3-gi (Debian's names).
"""
import os
import sys
import time

import dbus
from dbus.mainloop.glib import DBusGMainLoop
from gi.repository import GLib

ACCESSIBLE = "org.a11y.atspi.Accessible"
ACTION = "org.a11y.atspi.Action"
PROPERTIES = "org.freedesktop.DBus.Properties"
ROOT = "/org/a11y/atspi/accessible/root"
PATIENCE_S = float(os.environ.get("BRUSHWORK_PATIENCE_S", "90"))
# How often a run is begun that this computer may be too late for.
RUNS = 10
# Numbers of states in the AT-SPI protocol (atspi-constants.h).
SENSITIVE = 24
# Numbers of roles there: what can be used, each of which has to have a name.
USABLE = {
    7: "check box", 8: "check menu item", 11: "combo box", 32: "list item", 35: "menu item", 43: "push button", 44: "radio button",
    51: "slider", 52: "spin button", 61: "text", 62: "toggle button", 79: "entry",
}


class Failed(Exception):
    pass


class Reader:
    def __init__(self):
        session = dbus.SessionBus()
        status = session.get_object("org.a11y.Bus", "/org/a11y/bus")
        for name in ("IsEnabled", "ScreenReaderEnabled"):
            status.Set("org.a11y.Status", name, True, dbus_interface=PROPERTIES)
        address = status.GetAddress(dbus_interface="org.a11y.Bus")
        self.bus = dbus.bus.BusConnection(address)
        self.heard = []
        # How many of them were heard before the last act.
        self.since = 0
        self.bus.add_signal_receiver(self.hear, "Announcement", "org.a11y.atspi.Event.Object")
        registry = self.bus.get_object("org.a11y.atspi.Registry", "/org/a11y/atspi/registry")
        for event in ("object:announcement", "object:state-changed"):
            registry.RegisterEvent(event, dbus_interface="org.a11y.atspi.Registry", signature="s")
        self.app = None

    def hear(self, _detail, _one, _two, text, *_rest):
        self.heard.append(str(text))

    def turn(self, seconds=0.1):
        """Lets time pass and takes in the signals that came."""
        end = time.monotonic() + seconds
        context = GLib.MainContext.default()
        while time.monotonic() < end:
            while context.pending():
                context.iteration(False)
            time.sleep(0.02)

    def until(self, what, holds):
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            try:
                found = holds()
            except dbus.DBusException:
                # What was there a moment ago is gone, as after a change of screen.
                found = None
            if found:
                return found
            self.turn()
        raise Failed(f"no {what} within {PATIENCE_S:.0f} s")

    def at(self, reference):
        name, path = reference
        return self.bus.get_object(name, path, introspect=False)

    def open(self):
        def registered():
            desktop = self.at(("org.a11y.atspi.Registry", ROOT))
            children = desktop.GetChildren(dbus_interface=ACCESSIBLE)
            return children[0] if children else None

        self.app = self.until("window in the registry", registered)

    def tree(self):
        """Every object in view: reference, role, name."""
        left, all_of_it = [self.app], []
        while left:
            reference = left.pop()
            item = self.at(reference)
            try:
                role = int(item.GetRole(dbus_interface=ACCESSIBLE))
                name = str(item.Get(ACCESSIBLE, "Name", dbus_interface=PROPERTIES))
                children = item.GetChildren(dbus_interface=ACCESSIBLE)
            except dbus.DBusException:
                continue
            all_of_it.append((reference, role, name))
            left.extend(reversed(children))
        return all_of_it

    def states(self, reference):
        low, high = self.at(reference).GetState(dbus_interface=ACCESSIBLE)
        bits = int(low) | int(high) << 32
        return {number for number in range(64) if bits >> number & 1}

    def find(self, name, usable=True):
        def there():
            for reference, role, of in self.tree():
                if of == name and (not usable or role in USABLE):
                    if not usable or SENSITIVE in self.states(reference):
                        return reference
            return None

        return self.until(f"{name!r} that can be used", there)

    def press(self, name):
        reference = self.find(name)
        self.since = len(self.heard)
        done = self.at(reference).DoAction(0, dbus_interface=ACTION)
        if not done:
            raise Failed(f"{name!r} takes no action")
        self.turn(0.4)

    def set_value(self, name, value):
        reference = self.find(name)
        self.at(reference).Set("org.a11y.atspi.Value", "CurrentValue", dbus.Double(value), dbus_interface=PROPERTIES, signature="ssv")
        self.turn(0.4)

    def sees(self, part):
        return self.until(f"words {part!r}", lambda: any(part in name for _, _, name in self.tree()))

    def hears(self, *parts):
        """The first announcement with one of these."""

        def heard():
            return next((text for text in self.heard[self.since :] if any(part in text for part in parts)), None)

        return self.until(f"announcement {' or '.join(parts)!r}", heard)

    def nameless(self):
        return [USABLE[role] for _, role, name in self.tree() if role in USABLE and not name.strip()]


def tune(reader):
    """Tunes M1. A run that a busy computer was too late for is begun again; what else ends one is a failure."""
    late = "M1 was not tuned: this computer answered late"
    for _ in range(RUNS):
        reader.press("Arm")
        reader.hears("Armed for the velocity screen")
        reader.press("Tune M1")
        # Nothing is asked of the window until it has told the end by itself: walking its objects takes it time that the run needs.
        if late not in reader.hears("M1 is tuned", "M1 was not tuned"):
            return
    raise Failed(f"this computer was too late for each of {RUNS} runs")


def path(reader):
    reader.open()
    reader.find("Open MCP266")
    yield "start page"
    reader.press("Open MCP266")
    reader.hears("onnected")
    reader.sees("What to do next")
    yield "connected"
    reader.press("Leave it out")
    reader.press("Go to PWM Settings: Direction")
    reader.press("Arm")
    reader.hears("Armed for the PWM screen")
    yield "armed"
    # An action is a press and no hold; the slider's value does what holding the jog button does.
    reader.set_value("M1 duty", 30.0)
    reader.sees("M1: They agree.")
    reader.press("Stop All")
    reader.hears("Stop")
    yield "the direction seen, and stopped"
    reader.press("Device Status")
    reader.press("Go to Velocity Settings: Tune")
    tune(reader)
    reader.press("Apply (RAM)")
    reader.press("Device Status")
    reader.sees("Step Velocity loop: done")
    yield "tuned"
    reader.press("Step Save: to do")
    reader.press("Save…")
    reader.press("Save")
    reader.hears("aved")
    reader.press("Device Status")
    reader.sees("Step Save: done")
    yield "saved"


def main():
    DBusGMainLoop(set_as_default=True)
    reader = Reader()
    try:
        for step in path(reader):
            nameless = reader.nameless()
            if nameless:
                raise Failed(f"after {step!r} these have no name: {nameless}")
            print(f"{step}: {len(reader.tree())} objects", flush=True)
        print("announced:", *reader.heard, sep="\n  ")
        return 0
    except Failed as why:
        print(f"FAILED: {why}", *(f"  {role}: {name}" for _, role, name in (reader.tree() if reader.app else []) if name), sep="\n")
        print("announced:", *reader.heard, sep="\n  ")
        return 1


if __name__ == "__main__":
    sys.exit(main())
