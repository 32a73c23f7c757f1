"""``python -m brushwork``: the program itself."""

import subprocess
import sys

from ._program import program

sys.exit(subprocess.call([str(program()), *sys.argv[1:]]))
