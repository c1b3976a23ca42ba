"""Textures from arrays."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _moire
from ._errors import SceneError

if TYPE_CHECKING:
    from ._picture import Picture

#: What texels are made of.
Image = Union[ArrayLike, "Picture"]

#: Texels each way: a device has fewer, and says so itself.
_MOST = 1 << 20


def is_image(value: Any) -> bool:
    """Return whether a value is an array or a picture, rather than the name of a file."""
    return value is not None and not isinstance(value, (str, bytes, os.PathLike))


def of(image: Image, name: str) -> _moire.Texels:
    """Return the texels of an array: those of the texture ``name``, for errors."""
    if not is_image(image):
        raise SceneError(f"texture {name!r}: expected an array or a picture, found {image!r}")
    values = np.asarray(image)
    component = {"u1": "unorm8", "u2": "unorm16"}.get(values.dtype.str[1:], "float32")
    if component == "float32":
        if values.dtype.kind != "f":
            raise SceneError(
                f"texture {name!r}: expected uint8, uint16 or floats, found {values.dtype}",
                "array.astype(np.uint8) has 0 to 255, array.astype(np.float32) linear light of about 0 to 1",
            )
        with np.errstate(over="ignore"):
            values = values.astype(np.float32, copy=False)
    if values.ndim == 2:
        values = values[:, :, None]
    if values.ndim != 3 or not 1 <= values.shape[2] <= 4 or 0 in values.shape or max(values.shape) > _MOST:
        raise SceneError(
            f"texture {name!r}: expected height × width, or height × width × 1 to 4 channels, found the shape "
            f"{np.shape(image)}"
        )
    if values.shape[2] == 3:
        opaque = {"unorm8": 255, "unorm16": 65535}.get(component, 1.0)
        alpha = np.full((*values.shape[:2], 1), opaque, dtype=values.dtype)
        values = np.concatenate([values, alpha], axis=2)
    height, width, channels = values.shape
    native = values.astype(values.dtype.newbyteorder("="), copy=False)
    return _moire.Texels(width, height, channels, component, native.tobytes())
