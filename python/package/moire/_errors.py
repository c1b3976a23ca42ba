"""The exceptions: one class for each kind of error, all of them subclasses of :class:`Error`."""

from __future__ import annotations

from typing import Any, ClassVar, Optional


class Error(Exception):
    """An error of moire, of any kind.

    The message names the place: the file, line and key, or the option.

    Attributes
    ----------
    help : str or None
        The next step, if the message does not state it. Tracebacks show it from Python 3.11 on.
    is_transient : bool
        True if the same work may succeed when it is retried.
    """

    is_transient: ClassVar[bool] = False
    help: Optional[str]

    def __init__(self, message: str = "", help: Optional[str] = None) -> None:
        super().__init__(message)
        self.help = help
        if help and hasattr(self, "add_note"):
            self.add_note(f"help: {help}")

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (*self.args, self.help)


class DeviceLostError(Error):
    """The device stopped answering: its driver crashed, or a watchdog reset it."""

    is_transient = True


class OutOfDeviceMemoryError(Error, MemoryError):
    """The device is out of memory."""

    is_transient = True


class OutOfHostMemoryError(Error, MemoryError):
    """The host is out of memory."""

    is_transient = True


class NoDeviceError(Error):
    """There is no Vulkan driver, or no device that matches the request."""


class UnsupportedError(Error):
    """The device or the process lacks something that the scene or the options need."""


class FileError(Error):
    """A file cannot be read, decoded or written."""


class SceneError(Error, ValueError):
    """The scene breaks a rule or a limit; the message has file, line, column and key."""


class OptionsError(Error, ValueError):
    """An option, or a combination of options, is invalid."""


class Interrupted(Error):
    """The work was cancelled: a progress callback returned ``False``. Ctrl-C raises ``KeyboardInterrupt``."""


class InternalError(Error):
    """A fault of moire, of a library that it uses, or of the driver."""


class RenderWarning(UserWarning):
    """A warning about a picture that was rendered, such as of a filter that has no effect."""
