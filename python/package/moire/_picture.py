"""Pictures: arrays of linear light, and the files that are made of them."""

from __future__ import annotations

import json
import os
import warnings
from typing import TYPE_CHECKING, Any, Optional

import numpy as np
from numpy.typing import NDArray

from . import _moire
from ._errors import OptionsError, RenderWarning
from ._options import DisplayOptions, Path, SaveOptions, check, takes

if TYPE_CHECKING:
    from typing_extensions import Self, Unpack


class Picture:
    """A picture in linear light.

    Parameters
    ----------
    array : array
        Height × width × 3, or height × width for grey, in linear light. ``uint8`` and ``uint16`` are decoded from sRGB.

    Attributes
    ----------
    array : numpy.ndarray
        float32 of height × width × 3 in C order, the top row first. Of a render it is the renderer's own memory, not a
        copy; it may be changed.
    report : dict
        What is known of the render, as ``moire render --json`` prints it: ``device``, ``samples``, ``seconds``,
        ``reached``, ``estimated_rmse``, ``options``, ``warnings`` and others. Empty for other pictures.
    """

    array: NDArray[np.float32]
    report: dict[str, Any]
    #: The record of the render as JSON, the digest of its pixels, its corner in a larger picture and the size of that.
    _record: Optional[str]
    _digest: Optional[int]
    _placement: Optional[tuple[int, int, int, int]]
    #: The files that a picture shall not replace, and what they are.
    _inputs: list[tuple[str, str]]

    def __init__(self, array: Any) -> None:
        self.array = rgb(array)
        self.report = {}
        self._record = self._digest = self._placement = None
        self._inputs = []

    @classmethod
    def _rendered(cls, array: NDArray[np.float32], told: str) -> Self:
        picture = cls(array)
        known = json.loads(told)
        picture.report, picture._record, picture._inputs = known["report"], known["record"], known["inputs"]
        picture._placement = known["placement"]
        picture._digest = _moire.digest(picture.array)
        return picture

    @classmethod
    def open(cls, path: Path) -> Self:
        """Read a picture file; 8- and 16-bit values are decoded from sRGB, float values are linear."""
        return cls(_moire.read(os.fspath(path)))

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        height, width, _ = self.array.shape
        return width, height

    @property
    def record(self) -> Optional[dict[str, Any]]:
        """How the picture was rendered, as its files tell; ``None`` if ``array`` has changed since, or for others."""
        if self._record is None or _moire.digest(rgb(self.array)) != self._digest:
            return None
        found: dict[str, Any] = json.loads(self._record)
        return found

    @takes(SaveOptions)
    def save(self, path: Path, *, metadata: bool = True, **options: Unpack[SaveOptions]) -> None:
        """Write the picture. The file appears complete or not at all.

        Parameters
        ----------
        path : path
            The ending selects the format: ``.exr`` and ``.hdr`` keep linear light, ``.png``, ``.jpg`` and ``.tif`` are
            encoded for a screen, which is what the options from ``exposure`` to ``gamut`` are about.
        metadata : bool
            Write how the picture was rendered into the file, so that ``moire render --from FILE`` makes it again:
            scene, options, seed, version. Pictures whose ``array`` was changed have no such record.
        exposure : float, optional
            Stops, before the tone map.
        white_balance : float, optional
            Colour temperature, in kelvin, of the light that shall look white.
        tone_map, gamut : str, optional
            As ``moire render`` has them.
        png_bits : {8, 16}, optional
            Bits per channel of PNG files.
        jpeg_quality : int, optional
            1 to 100; the default is 95.

        Examples
        --------
        >>> picture = moire.render("@quad")
        >>> picture.save("quad.png", exposure=0.5, tone_map="agx")
        >>> moire.read_record("quad.png")["scene"]["path"]
        '@quad'
        """
        given, name = check(options, SaveOptions), os.fspath(path)
        for own, what in self._inputs:
            if os.path.exists(name) and os.path.exists(own) and os.path.samefile(name, own):
                raise OptionsError(
                    f"{name}: this is {what}, which the picture would replace", "choose another name for the picture"
                )
        idle = [option for option in DisplayOptions.__annotations__ if given.get(option) is not None]
        if idle and name.lower().endswith((".exr", ".hdr")):
            told = f"{', '.join(idle)}: no effect, as OpenEXR and Radiance HDR keep linear light"
            warnings.warn(told, RenderWarning, stacklevel=2)
        array = rgb(self.array)
        is_rendered = metadata and self._digest is not None and _moire.digest(array) == self._digest
        _moire.save(array, name, given, self._record if is_rendered else None, self._placement)

    @takes(DisplayOptions)
    def srgb(self, **options: Unpack[DisplayOptions]) -> NDArray[np.uint8]:
        """Return the picture as a screen shows it: uint8 of height × width × 3, for Matplotlib or Pillow.

        The values are those of a PNG file; the options are those of :meth:`save`.

        Examples
        --------
        >>> moire.Picture([[0.0, 0.5, 1.0]]).srgb()[0, :, 0].tolist()
        [0, 188, 255]
        """
        return _moire.screen(rgb(self.array), check(options, DisplayOptions))

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> NDArray[Any]:
        if copy is False and dtype is not None and np.dtype(dtype) != self.array.dtype:
            raise ValueError(f"a picture is float32; as {np.dtype(dtype)} it would be a copy")
        if dtype is not None and np.dtype(dtype) != self.array.dtype:
            return self.array.astype(dtype)
        return self.array.copy() if copy else self.array

    def _repr_png_(self) -> bytes:
        return _moire.png(rgb(self.array), {})

    def __repr__(self) -> str:
        width, height = self.size
        made = f", {self.report['samples']:g} samples on {self.report['device']}" if self.report else ""
        return f"<moire.Picture {width}×{height}{made}>"


def read_record(path: Path) -> Optional[dict[str, Any]]:
    """Return how a picture file was rendered, if it tells.

    Returns
    -------
    dict or None
        ``scene``, ``options``, ``settings``, ``device`` and ``version``.
    """
    text = _moire.record(os.fspath(path))
    found: Optional[dict[str, Any]] = None if text is None or not text.startswith("{") else json.loads(text)
    return found


def rgb(array: Any) -> NDArray[np.float32]:
    """Return an array as a picture: float32 of height × width × 3, in one piece. Grey is replicated.

    Values of 8 and 16 bits are decoded from sRGB, as those of files.
    """
    if isinstance(array, Picture):
        return array.array
    values = np.asarray(array)
    if values.dtype.kind not in "fiub":
        raise OptionsError(f"a picture is an array of numbers, not of {values.dtype}")
    if values.dtype in (np.uint8, np.uint16):
        values = _decoded(values)
    with np.errstate(over="ignore"):
        values = values.astype(np.float32, copy=False)
    if values.ndim == 2:
        values = np.repeat(values[:, :, None], 3, axis=2)
    if values.ndim != 3 or values.shape[2] != 3 or 0 in values.shape:
        raise OptionsError(f"a picture is an array of height × width × 3, not of shape {values.shape}")
    return np.ascontiguousarray(values)


def _decoded(values: NDArray[Any]) -> NDArray[np.float64]:
    """Return the linear light of values of 8 or 16 bits."""
    encoded = values / np.float64(np.iinfo(values.dtype).max)
    decoded: NDArray[np.float64] = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    return decoded
