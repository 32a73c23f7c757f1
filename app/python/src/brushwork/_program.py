"""Finds the program and runs its commands."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import Any, Sequence

from ._errors import ProgramMissing, failure

VARIABLE = "BRUSHWORK_PROGRAM"
"""Names the program in place of the one that came with the package."""

NO_CONSOLE: int = getattr(subprocess, "CREATE_NO_WINDOW", 0)


def program() -> Path:
    """The program that this package runs: that of ``BRUSHWORK_PROGRAM``, the wheel's own, or the one on the path."""
    named = os.environ.get(VARIABLE)
    if named:
        return Path(named)
    name = "brushwork.exe" if sys.platform == "win32" else "brushwork"
    folders = [sysconfig.get_path("scripts"), sysconfig.get_path("scripts", sysconfig.get_preferred_scheme("user"))]
    for folder in folders:
        if folder and (Path(folder) / name).is_file():
            return Path(folder) / name
    found = shutil.which(name)
    if found is None:
        raise ProgramMissing(f"{name} is neither in {' nor in '.join(map(str, folders))} nor on the path", 1)
    return Path(found)


def start(arguments: Sequence[str], **pipes: Any) -> subprocess.Popen[str]:
    """Starts a command that goes on by itself."""
    try:
        return subprocess.Popen([str(program()), *arguments], text=True, encoding="utf-8", creationflags=NO_CONSOLE, **pipes)
    except OSError as error:
        raise ProgramMissing(f"{program()} cannot be started: {error}", 1) from error


def run(arguments: Sequence[str], accepted: Sequence[int] = (0,), timeout: float | None = None) -> tuple[int, str]:
    """Runs a command to its end; gives its exit code, one of the accepted, and its standard output."""
    process = start(arguments, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    try:
        output, said = process.communicate(timeout=timeout)
    except BaseException:
        # SIGTERM stops the motors first.
        process.terminate()
        process.communicate()
        raise
    if process.returncode not in accepted:
        raise failure(process.returncode, said)
    return process.returncode, output


def ask(arguments: Sequence[str], accepted: Sequence[int] = (0,), timeout: float | None = None) -> Any:
    """Runs a command with ``--json`` and gives what it printed."""
    return json.loads(run([*arguments, "--json"], accepted, timeout)[1])
