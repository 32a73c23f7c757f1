"""Talks to the test that started this script: asks for the simulator's truth, reports what was found.

One JSON object per line, out on standard output, answers in on standard input. The truth never passes the wire under test:
the test reads it from the simulator itself.
"""

import json
import sys
import time


def _send(message):
    sys.stdout.write(json.dumps(message) + "\n")
    sys.stdout.flush()


def _ask(message):
    _send(message)
    answer = sys.stdin.readline()
    if not answer:
        sys.exit("the test has gone")
    return json.loads(answer)


def truth():
    """What the simulator knows at this moment, as a dictionary."""
    return _ask({"ask": "truth"})


def act(action):
    """Does something to the simulated machine that no wire can do: presses the E-stop, blocks a shaft."""
    answer = _ask({"ask": "act", "action": action})
    if answer != "done":
        sys.exit(f"the test refused {action}: {answer}")


def report(name, passed, detail=""):
    """One finding: a method or a command, whether it did what it should, and why not."""
    _send({"report": name, "passed": bool(passed), "detail": str(detail)})


def figure(name, value, unit):
    """One measured figure, for the record."""
    _send({"figure": name, "value": value, "unit": unit})


def finish():
    """The last line: without it the test knows that the script broke off."""
    _send({"finished": True})


PATIENCE_S = 60  # however slow the machine is: nothing that works takes so long


def let_silence_be_noticed():
    """The line is silent until the controller has noticed, however late the thread that serves it is.

    Each question for the truth is answered between two looks at the line: the first ones find what was sent, the later ones nothing.
    """
    for _ in range(3):
        for _ in range(3):
            truth()
        time.sleep(0.015)


def reached(command, condition, meanwhile):
    """Whether the machine comes to `condition(truth)` after a command, kept alive by talking meanwhile.

    A script that a busy machine keeps from talking for a second meets the controller's own time-out: then once more.
    """
    tries, one_try_s = 6, 10
    for _ in range(tries):
        if not command():
            return False
        if wait_until(condition, one_try_s, meanwhile):
            return True
    return False


def eventually(condition, limit_s=PATIENCE_S):
    """Waits until `condition()` holds; returns whether it did."""
    return wait_until(lambda _: condition(), limit_s)


def wait_until(condition, limit_s=PATIENCE_S, meanwhile=lambda: None):
    """Waits until `condition(truth)` holds, doing something between two looks; returns whether it did."""
    deadline = time.monotonic() + limit_s
    while True:
        if condition(truth()):
            return True
        meanwhile()
        if time.monotonic() > deadline:
            return False
        time.sleep(0.005)
