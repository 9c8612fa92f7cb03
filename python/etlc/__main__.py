"""python -m etlc: the command etlc that belongs to this package."""

import os
import sys

from ._process import command_path
from .errors import Error

if __name__ == "__main__":
    try:
        command = command_path()
    except Error as error:
        sys.exit(f"python -m etlc: {error}")
    os.execv(command, [command, *sys.argv[1:]])
