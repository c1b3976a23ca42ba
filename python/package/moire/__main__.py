"""The program ``moire``: ``python -m moire render scene.toml``."""

from __future__ import annotations

import signal
import sys

from . import _moire
from ._render import prepare_drivers


def program() -> int:
    """Run the command line of this process and return its exit code."""
    # The program has a handler of its own while it renders; elsewhere Ctrl-C ends it as any other.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.stdout.flush()
    prepare_drivers()
    return _moire.main(["moire", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(program())
