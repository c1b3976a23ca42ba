"""Progress: a callback, or a bar on stderr."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any, Optional

from ._options import Progress


class Bar:
    """A callback, or a bar on stderr for ``True``, which is cleared at the end."""

    WIDTH = 40

    def __init__(self, progress: Progress) -> None:
        if not (callable(progress) or progress is None or isinstance(progress, bool)):
            raise TypeError(f"progress: expected a function, True or None, found {progress!r}")
        self.draws = progress is True
        self.callback: Optional[Callable[[float], Any]] = None
        if self.draws:
            self.callback = self.draw
        elif not isinstance(progress, bool):
            self.callback = progress

    def draw(self, done: float) -> None:
        """Draw the bar."""
        full = round(done * self.WIDTH)
        sys.stderr.write(f"\r{'█' * full}{'░' * (self.WIDTH - full)} {done:4.0%}")
        sys.stderr.flush()

    def __enter__(self) -> Optional[Callable[[float], Any]]:
        return self.callback

    def __exit__(self, *_: object) -> None:
        if self.draws:
            sys.stderr.write("\r" + " " * (self.WIDTH + 5) + "\r")
            sys.stderr.flush()
