"""The exceptions: one class for each kind of error, all of them subclasses of :class:`Error`."""

from __future__ import annotations

from typing import ClassVar, Optional


class Error(Exception):
    """An error of moire. The message names the place; ``help`` is the next step, if the message does not state it."""

    #: True if the same work may succeed when it is retried.
    is_transient: ClassVar[bool] = False

    def __init__(self, message: str, help: Optional[str] = None) -> None:
        super().__init__(message)
        self.help = help
        # Tracebacks show notes from Python 3.11 on.
        if help and hasattr(self, "add_note"):
            self.add_note(f"help: {help}")


class DeviceLostError(Error):
    """The device stopped answering: its driver crashed, or a watchdog reset it."""

    is_transient = True


class OutOfDeviceMemoryError(Error):
    """The device is out of memory."""

    is_transient = True


class OutOfHostMemoryError(Error):
    """The host is out of memory."""

    is_transient = True


class NoDeviceError(Error):
    """There is no Vulkan driver, or no device that matches the request."""


class UnsupportedError(Error):
    """The device lacks a feature that the scene or the options need."""


class FileError(Error):
    """A file cannot be read, decoded or written."""


class SceneError(Error):
    """The scene breaks a rule or a limit; the message has file, line, column and key."""


class OptionsError(Error):
    """An option, or a combination of options, is invalid."""


class Interrupted(Error):
    """The work was cancelled: a progress callback returned ``False``. Ctrl-C raises ``KeyboardInterrupt``."""


class InternalError(Error):
    """A fault of moire, of a library that it uses, or of the driver."""


class RenderWarning(UserWarning):
    """A warning about a picture that was rendered, such as of values that are not finite."""
