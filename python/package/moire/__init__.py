"""moire renders textured scenes with Vulkan compute, with or without a GPU, and measures the error of its pictures.

A :class:`Scene` is read from a file or built; :func:`render` makes a :class:`Picture` of it, an array of linear light::

    import moire

    scene = moire.Scene("@lecture", set={"sampling.spp": 16})
    picture = moire.render(scene, size=(320, 200))
    picture.save("lecture.png")
    print(moire.compare(picture, moire.render(scene, size=(320, 200), spp=256)).rmse)

Errors are subclasses of :class:`Error`, one for each kind. The program ``moire`` is installed beside the module.
"""

from __future__ import annotations

import json as _json
from typing import Any

from . import _moire
from ._errors import (
    DeviceLostError,
    Error,
    FileError,
    InternalError,
    Interrupted,
    NoDeviceError,
    OptionsError,
    OutOfDeviceMemoryError,
    OutOfHostMemoryError,
    RenderWarning,
    SceneError,
    UnsupportedError,
)
from ._measure import Comparison, Study, compare, study
from ._options import DisplayOptions, RenderOptions, SaveOptions
from ._picture import Picture, read_record
from ._render import Renderer, aov, prepare_drivers as _prepare_drivers, render
from ._scene import Scene
from ._sheet import Sheet, sheet

__version__: str = _moire.__version__


def scenes() -> dict[str, str]:
    """Return the scenes that the program has in itself, by name, with what each shows.

    Examples
    --------
    >>> "@lecture" in moire.scenes()
    True
    """
    return _moire.scenes()


def devices() -> list[dict[str, Any]]:
    """Return the Vulkan devices of this machine.

    Returns
    -------
    list of dict
        ``index``, ``name``, ``kind``, ``driver``, ``limits``, and ``default``: whether it is taken if none is named.
    """
    _prepare_drivers()
    found: list[dict[str, Any]] = _json.loads(_moire.devices())
    return found


__all__ = [
    "Comparison",
    "DeviceLostError",
    "DisplayOptions",
    "Error",
    "FileError",
    "InternalError",
    "Interrupted",
    "NoDeviceError",
    "OptionsError",
    "OutOfDeviceMemoryError",
    "OutOfHostMemoryError",
    "Picture",
    "RenderOptions",
    "RenderWarning",
    "Renderer",
    "SaveOptions",
    "Scene",
    "SceneError",
    "Sheet",
    "Study",
    "UnsupportedError",
    "__version__",
    "aov",
    "compare",
    "devices",
    "read_record",
    "render",
    "scenes",
    "sheet",
    "study",
]
