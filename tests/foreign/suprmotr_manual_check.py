"""The simulated SuprMotr, spoken to by a client that was written from the maker's manual alone and uses no line of this project's code.

Usage: suprmotr_manual_check.py PORT FORM ECHO. One board at address 0, at factory settings but for the form of its reports (full, address or id) and its
echo (on or off), not selected.
"""

import os
import re
import select
import sys
import time
import tty

import harness

PORT, FORM, ECHO = sys.argv[1], sys.argv[2], sys.argv[3] == "on"
ETX = b"\x03"
PATIENCE_S = 20  # for what must come, however busy the computer is
SILENCE_S = 0.2  # for what must not come

line = os.open(PORT, os.O_RDWR | os.O_NOCTTY)
tty.setraw(line)


def check(name, passed, detail=""):
    harness.report(name, passed, detail)


def send(text):
    os.write(line, text.encode("latin-1"))


def read(reports, within=PATIENCE_S):
    """What comes until so many reports have ended."""
    heard, end = b"", time.monotonic() + within
    while heard.count(ETX) < reports or reports == 0:
        left = end - time.monotonic()
        if left <= 0 or not select.select([line], [], [], left)[0]:
            break
        heard += os.read(line, 4096)
    return heard.decode("latin-1")


def ask(text, reports=1):
    """A command line or a character, and its reports without the echo."""
    send(text)
    heard = read(reports)
    if ECHO:
        if not heard.startswith(text):
            return f"not echoed: {heard!r}"
        heard = heard[len(text):]
    return heard


def tell(text):
    """A command that reports nothing; what it did is seen by the next one, which the board takes after it."""
    send(text)
    if ECHO:
        heard, end = b"", time.monotonic() + PATIENCE_S
        while len(heard) < len(text) and time.monotonic() < end:
            if select.select([line], [], [], 0.1)[0]:
                heard += os.read(line, len(text) - len(heard))
        return heard.decode("latin-1")
    return ""


def silence(text, echoed=False):
    """What comes for a text that is not answered. An echo is waited for, however late it is."""
    if echoed:
        return tell(text) + read(0, SILENCE_S)
    send(text)
    return read(0, SILENCE_S)


def head(letter, channel="0"):
    return {"full": f"0{letter}{channel}:", "address": f"0{letter}:", "id": f"{letter}:"}[FORM]


def number(letter, value=None):
    digits = r"[+-]\d{10}" if value is None else re.escape(f"{value:+011d}")
    return re.escape(head(letter)) + digits + "\r\n"


def status():
    """The six bytes of TS by its character; a command error is told once."""
    heard = ask("%")
    found = re.fullmatch(r"0?S:((?:[0-9A-F]{2} ){5}[0-9A-F]{2})\r\n\x03", heard)
    return [int(byte, 16) for byte in found[1].split()] if found else heard


def error_of(text):
    """The error number that a line leaves behind (Tell Status, EE)."""
    tell(text)
    time.sleep(0.02)
    told = status()
    return told[5] if isinstance(told, list) else told


# After power-up the controller is not addressed: nothing is reported before its address was sent.
check("not addressed at power-up", silence("TP\r") == "")
check("selected without an answer", silence("\x010", echoed=True) == ("\x010" if ECHO else ""))

# Reports: letter, sign and ten digits, CR LF ETX.
for command, letter, value in [
    ("TP", "P", 0), ("TT", "T", 0), ("TE", "E", 0), ("TF", "F", 0), ("TD", "N", 0), ("TV", "V", 0),
    ("GV", "Y", 20000), ("TY", "Y", 20000), ("GA", "A", 200000), ("TL", "A", 200000), ("GP", "G", 75), ("GI", "I", 0),
    ("GD", "D", 0), ("GL", "L", 100), ("TI", "X", 0), ("TB", "B", 0), ("TJ", "J", 0), ("TQ", "Q", None), ("CS", "C", None),
]:
    heard = ask(command + "\r")
    check(f"{command} reports {letter}", re.fullmatch(number(letter, value) + ETX.decode(), heard), repr(heard))
heard = ask("t p\r")
check("small letters and spaces", re.fullmatch(number("P", 0) + "\x03", heard), repr(heard))
heard = ask("\r")
check("a bare CR repeats the line", re.fullmatch(number("P", 0) + "\x03", heard), repr(heard))

# Several lines in one report, and several reports of one line.
heard = ask("TG\r")
gains = "".join(number(letter, value) for letter, value in [("G", 75), ("I", 0), ("D", 0), ("L", 100)])
check("TG tells four gains in one report", re.fullmatch(gains + "\x03", heard), repr(heard))
heard = ask("TP, TT ,TV\r", 3)
three = "".join(number(letter, 0) + "\x03" for letter in "PTV")
check("a compound line reports each", re.fullmatch(three, heard), repr(heard))

# Sub-commands need no CR.
for character, letter in [("'", "P"), ("?", "F"), ("\\", "X")]:
    heard = ask(character)
    check(f"{character} is a command by itself", re.fullmatch(number(letter, 0) + "\x03", heard), repr(heard))
heard = ask("#")
check("# tells the channels", re.fullmatch(re.escape(head("H")) + r" ?[0-9A-F]+ [0-9A-F]+\r\n\x03", heard), repr(heard))
told = status()
check("the status has six bytes: selected, complete, limits on", told[0] & 0x80 and told[1] & 0x80 and told[2] & 1, told)
check("bit 0 of the status is the echo", bool(told[0] & 1) == ECHO, told)

# Analog lines.
tell("SO255\r")
heard = ask("TO\r")
check("SO and TO", heard == head("O") + "255\r\n\x03", repr(heard))
tell("SO0\r")
heard = ask("TA1\r")
check("TA1", re.fullmatch(re.escape(head("A", "1")) + r"\d{1,3}\r\n\x03", heard), repr(heard))
heard = ask("TA\r")
check("TA", re.fullmatch(re.escape(head("A")) + r" ?\d{1,3} \d{1,3}\r\n\x03", heard), repr(heard))

# Errors 01 to 0A, each cleared by TS.
for text, error in [
    ("ZZ", 1), ("1TP", 2), ("TP,", 3), ("DV-5", 4), ("DVX", 5), ("DP256", 6), ("SM40000", 6), ("MC15", 6), ("WN0", 7),
    ("MR5;", 8), ("TP" + " " * 300, 9), (",".join(["WS1"] * 16), 9), ("MD6," + ",".join(["WS1"] * 16), 10),
]:
    if text == "TP,":
        ask(text + "\r")
        told = status()
        got = told[5]
    else:
        got = error_of(text + "\r")
    check(f"error {error:02X} of {text[:12].strip()}", got == error, got)
    told = status()
    check(f"error {error:02X} of {text[:12].strip()} is told once", told[5] == 0 and told[0] & 4 == 0, told)
tell("AB\r")

# Hexadecimal numbers, in and out.
tell("HM\r")
heard = ask("GV\r")
check("hexadecimal reports", re.fullmatch(re.escape(head("Y")) + r"\+?0*4E20\r\n\x03", heard), repr(heard))
tell("DP4B\r")
heard = ask("GP\r")
check("hexadecimal parameters", re.fullmatch(re.escape(head("G")) + r"\+?0*4B\r\n\x03", heard), repr(heard))
check("number mode in the status", status()[0] & 0x40)
tell("DM\r")

# Moves: to a place, waited for, by a repeated line, by macros.
tell("MA500,WS100\r")
check("a wait in process is told", harness.eventually(lambda: status()[0] & 2 == 0))
heard = ask("TT\r")
check("MA sets the target", re.fullmatch(number("T", 500) + "\x03", heard), repr(heard))
heard = ask("TP,RP2\r", 3)
check("RP2 runs a line three times", heard.count("\x03") == 3, repr(heard))
for macro in ["MD1,MR100,WS10", "MD4,MC1,MC1,TT", "MD11, MR500,WS100,RP9", "MD0,TP"]:
    tell(macro + "\r")
heard = ask("TM11\r")
check("a macro is listed as the manual has it", heard == "MD11, MR+0000000500,WS+0000000100,RP+0000000009\r\n\x03", repr(heard))
heard = ask("TZ\r")
check("TZ lists macro 0", heard == "MD0, TP\r\n\x03", repr(heard))
tell("RZ\r")
heard = ask("TM\r")
check("all macros are listed in order", re.findall(r"MD(\d+)", heard) == ["1", "4", "11"], repr(heard))
heard = ask("MC4\r")
found = re.fullmatch(number("T") + "\x03", heard)
check("a macro calls a macro twice and goes on", found and 600 <= int(heard.split(":")[1][:11]) <= 700, repr(heard))
silent = silence("MC9\r", echoed=True)
check("an undefined macro does nothing", silent == ("MC9\r" if ECHO else "") and status()[5] == 0, repr(silent))
tell("MD8,WA60000,RP\r")
tell("MC8\r")
check("a macro that runs is told", harness.eventually(lambda: status()[0] & 0x10))
heard = ask("'")
check("a sub-command does not disturb it", status()[0] & 0x10, repr(heard))
tell("\x08")
check("backspace ends it", harness.eventually(lambda: status()[0] & 0x10 == 0))
tell("RM\r")
tell("MF\r")
check("MF lets the motor go", harness.eventually(lambda: status()[1] & 1))
tell("DH\r")
tell("MN\r")
check("MN holds it again", harness.eventually(lambda: status()[1] & 1 == 0))

# Addresses.
tell("DB5\r")
heard = ask("TB\r")
check("DB5 gives the address 5", heard.split(":")[1] == "+0000000005\r\n\x03", repr(heard))
send("\x014")
read(0, SILENCE_S)
check("a board of another address is silent", silence("TT\r") == "")
tell("\x01v")
heard = ask("TB\r")
check("v selects all", heard.split(":")[1] == "+0000000005\r\n\x03", repr(heard))
tell("DB0\r")
# The restart takes along what had not been echoed.
silence("RT\r")
check("RT leaves it not addressed", silence("TP\r") == "")
send("\x010")
read(0, SILENCE_S)
harness.finish()
