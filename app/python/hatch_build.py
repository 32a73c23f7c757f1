"""Puts the built program into the wheel: that of ``BRUSHWORK_PROGRAM``, or ``target/release/brushwork`` of the tree.

``BRUSHWORK_PLATFORM`` names the platform of a program that was built for another machine or an older one: "manylinux_2_31_x86_64", "win_amd64".
"""

from __future__ import annotations

import os
import sys
import sysconfig
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

BUILD = "cargo build --release --locked -p brushwork --no-default-features"


class ProgramHook(BuildHookInterface):  # type: ignore[type-arg]
    """Adds the program and says which platform the wheel is for."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        if version == "editable":
            return  # An editable installation runs the program of BRUSHWORK_PROGRAM or of the path.
        name = "brushwork.exe" if sys.platform == "win32" else "brushwork"
        usual = Path(self.root).parents[1] / "target" / "release" / name
        program = Path(os.environ.get("BRUSHWORK_PROGRAM") or usual).resolve()
        if not program.is_file():
            raise FileNotFoundError(f"{program} is not there to be packed: run `{BUILD}` first, or name the program in BRUSHWORK_PROGRAM")
        platform = os.environ.get("BRUSHWORK_PLATFORM") or sysconfig.get_platform()
        build_data["pure_python"] = False
        build_data["tag"] = "py3-none-" + platform.replace("-", "_").replace(".", "_")
        build_data["shared_scripts"] = {str(program): "brushwork" + program.suffix}
