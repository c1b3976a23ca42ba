"""Measuring: two pictures, and error against time."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Optional, Union

from numpy.typing import ArrayLike

from . import _moire, _scene
from ._options import Path, Progress
from ._picture import Picture, rgb
from ._progress import Bar
from ._render import prepare_drivers
from ._scene import Scene


@dataclass(frozen=True)
class Comparison:
    """The measures of two pictures in linear light. Means are over pixels that are NaN in neither.

    Attributes
    ----------
    width, height : int
        Size in pixels.
    rmse, mse, relative_mse : float
        Root mean square error, its square, and the mean of (a − b)² / (b² + 0.01), where b is the reference.
    max, max_at : float and (int, int)
        The largest difference of one channel, and the first pixel (x, y) that has it.
    psnr : float
        In decibels; infinite if the pictures are equal.
    flip : float
        Mean FLIP, from 0 to 1.
    over_1_255, over_1_255_pixels : float and int
        The pixels that differ by more than a step of an 8-bit file: their fraction, and their number.
    max_encoded : float
        The largest difference of one clipped, sRGB-encoded channel.
    nan_pixels : int
        Pixels that are NaN in either.
    """

    width: int
    height: int
    rmse: float
    mse: float
    relative_mse: float
    max: float
    max_at: Optional[tuple[int, int]]
    psnr: float
    flip: float
    over_1_255: float
    over_1_255_pixels: int
    max_encoded: float
    nan_pixels: int


def compare(a: Union[Picture, Path, ArrayLike], b: Union[Picture, Path, ArrayLike]) -> Comparison:
    """Compare two pictures of the same size.

    Parameters
    ----------
    a, b : Picture, array or path
        The pictures; ``b`` is the reference. Arrays are linear light, or sRGB of 8 or 16 bits.

    Examples
    --------
    >>> a, b = np.zeros((4, 4, 3)), np.zeros((4, 4, 3))
    >>> a[1, 2] = 0.5
    >>> found = moire.compare(a, b)
    >>> found.max, found.max_at, found.rmse
    (0.5, (2, 1), 0.125)
    """
    if _is_path(a) and _is_path(b):
        return Comparison(**_moire.compare_files(os.fspath(a), os.fspath(b)))  # type: ignore[arg-type]
    return Comparison(**_moire.compare(_array(a), _array(b)))


class Study(list[dict[str, Any]]):
    """The points of a study, one record each.

    A record has ``method``, ``spp``, ``samples``, ``seconds`` (one of each repeat), ``errors`` (``rmse``, ``flip`` and
    others), ``command`` and more.

    Attributes
    ----------
    record : dict
        The whole of ``study.json``: device, conditions, reference, methods, points, analysis, notes.
    folder : str or None
        The folder of the page and plots, if it was kept.
    """

    def __init__(self, record: dict[str, Any], note: Optional[str] = None, folder: Optional[str] = None) -> None:
        super().__init__(record["points"])
        self.record = record
        self.folder = folder
        self._note = note

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.record, self._note, self.folder)

    @property
    def recommendation(self) -> Optional[str]:
        """What to use, in words."""
        analysis = self.record.get("analysis")
        return analysis["recommendation"] if analysis else None

    @property
    def notes(self) -> list[str]:
        """What was left out, and why; and whether the machine was too busy to tell the best from the next."""
        return [*self.record["notes"], *([self._note] if self._note else [])]

    def __repr__(self) -> str:
        methods = {point["method"] for point in self}
        return (
            f"<moire.Study of {len(self)} points, {len(methods)} methods: {self.recommendation or 'no recommendation'}>"
        )


def study(
    scene: Union[Scene, Path],
    *,
    methods: Union[str, Iterable[str], None] = None,
    spp: Union[int, Iterable[int]] = (1, 4, 16, 64, 256),
    budget: Union[float, str, None] = None,
    error: Optional[float] = None,
    repeats: int = 3,
    size: Optional[tuple[int, int]] = None,
    device: Union[str, int, None] = None,
    reference: Optional[Path] = None,
    seconds: Union[float, str] = 600.0,
    out: Optional[Path] = None,
    progress: Progress = None,
) -> Study:
    """Measure which anti-aliasing method has the smallest error in a given time, as ``moire study`` does.

    Parameters
    ----------
    scene : Scene or path
        What is rendered.
    methods : str or list of str, optional
        Names such as ``"random,stratified+cone+ewa"`` or ``"best"``; the default is all patterns, and filters if there
        are textures.
    spp : int or list of int
        Samples per pixel.
    budget, error : float, optional
        Recommend what errs least within this time of rendering, such as ``"50ms"`` or 0.05 seconds, or what comes to
        this RMSE fastest.
    repeats : int
        Renders of each point, of whose times the median counts.
    size : (int, int), optional
        Width and height in pixels.
    device : str or int, optional
        One that :func:`moire.devices` lists.
    reference : path, optional
        A picture file or ``"oracle"``; the default is many samples on the device.
    seconds : float or str
        Time limit of the study, such as ``"10min"``; the longest points are left out if it does not suffice.
    out : path, optional
        Folder for the page, the plots and ``study.json``; the same call goes on from there after Ctrl-C. Without it
        there is no page. A scene that was not read from a file is written to ``scene.toml`` there.
    progress : callable or True, optional
        As :meth:`Renderer.render` takes it.

    Returns
    -------
    Study
        A list of records, with ``recommendation``, ``notes`` and the whole ``record``.
    """
    prepare_drivers()
    read = _scene.of(scene)
    names = methods.split(",") if isinstance(methods, str) else list(methods or [])
    options = {
        "methods": [name.strip() for name in names],
        "spp": [spp] if isinstance(spp, int) else list(spp),
        "budget": budget,
        "error": error,
        "repeats": repeats,
        "size": size,
        "device": None if device is None else str(device),
        "reference": None if reference is None else os.fspath(reference),
        "seconds": seconds,
    }
    arguments: list[str] = []
    if read._camera is not None:
        arguments += ["--camera", read._camera]
    for setting in read._settings:
        arguments += ["--set", setting]
    if size is not None:
        arguments += ["--size", f"{size[0]}x{size[1]}"]
    if device is not None:
        arguments += ["--device", str(device)]
    with Bar(progress) as callback:
        if out is not None:
            told = _moire.study(read._native, read._text, os.fspath(out), options, arguments, callback)
            record, note = json.loads(told)
            return Study(record, note, os.fspath(out))
        with tempfile.TemporaryDirectory(prefix="moire-study-") as folder:
            told = _moire.study(read._native, read._text, folder, options, arguments, callback)
            record, note = json.loads(told)
            return Study(record, note)


def _is_path(picture: Any) -> bool:
    return isinstance(picture, (str, os.PathLike))


def _array(picture: Any) -> Any:
    if isinstance(picture, Picture):
        return rgb(picture.array)
    return _moire.read(os.fspath(picture)) if _is_path(picture) else rgb(picture)
