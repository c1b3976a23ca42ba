"""Measuring: two pictures, and error against time."""

from __future__ import annotations

import json
import math
import os
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Optional, Union

from numpy.typing import ArrayLike

from . import _moire, _scene
from ._render import Picture, Progress, _bar, rgb
from ._scene import Path, Scene


@dataclass(frozen=True)
class Comparison:
    """The measures of two pictures in linear light. Means are over pixels that are NaN in neither."""

    width: int
    height: int
    rmse: float
    mse: float
    #: Mean of (a − b)² / (b² + 0.01), where b is the reference.
    relative_mse: float
    #: The largest difference of one channel, and the first pixel (x, y) that has it.
    max: float
    max_at: Optional[tuple[int, int]]
    #: In decibels; infinite if the pictures are equal.
    psnr: float
    #: Mean FLIP, from 0 to 1.
    flip: float
    #: The fraction of pixels that differ by more than a step of an 8-bit file.
    over_1_255: float
    over_1_255_pixels: int
    #: The largest difference of one clipped, sRGB-encoded channel.
    max_encoded: float
    nan_pixels: int


def compare(a: Union[Picture, Path, ArrayLike], b: Union[Picture, Path, ArrayLike]) -> Comparison:
    """Compare two pictures of the same size; ``b`` is the reference. Each is a picture, an array or a file."""
    if _is_path(a) and _is_path(b):
        told = _moire.compare_files(os.fspath(a), os.fspath(b))  # type: ignore[arg-type]
    else:
        told = _moire.compare(_array(a), _array(b))
    measures = json.loads(told)
    # JSON has no numbers that are not finite.
    if measures["psnr"] is None:
        measures["psnr"] = math.inf if measures["mse"] == 0 else math.nan
    for name, value in measures.items():
        measures[name] = math.nan if value is None and name != "max_at" else value
    if measures["max_at"] is not None:
        measures["max_at"] = tuple(measures["max_at"])
    return Comparison(**measures)


class Study(list[dict[str, Any]]):
    """The points of a study, one record each: ``method``, ``spp``, ``samples``, ``seconds`` (one of each repeat),
    ``errors`` (``rmse``, ``flip`` and others), ``command`` and more. ``record`` is the whole of ``study.json``, ``folder``
    that of the page and plots, if it was kept."""

    def __init__(self, record: dict[str, Any], folder: Optional[str]) -> None:
        super().__init__(record["points"])
        self.record = record
        self.folder = folder

    @property
    def recommendation(self) -> Optional[str]:
        """What to use, in words."""
        analysis = self.record.get("analysis")
        return analysis["recommendation"] if analysis else None

    @property
    def notes(self) -> list[str]:
        """What was left out, and why."""
        return self.record["notes"]


def study(
    scene: Union[Scene, Path],
    *,
    methods: Union[str, Iterable[str], None] = None,
    spp: Iterable[int] = (1, 4, 16, 64, 256),
    budget: Optional[float] = None,
    error: Optional[float] = None,
    repeats: int = 3,
    size: Optional[tuple[int, int]] = None,
    device: Union[str, int, None] = None,
    reference: Optional[Path] = None,
    seconds: float = 600.0,
    out: Optional[Path] = None,
    progress: Progress = None,
) -> Study:
    """Measure which anti-aliasing method has the smallest error in a given time; the options are those of ``moire study``.

    ``methods`` are names such as ``"random,stratified+cone+ewa"`` or ``"best"``. ``budget`` asks for the least error within
    a time of rendering, ``error`` for the least time to an RMSE. ``reference`` is a picture file or ``"oracle"``. ``out`` is a
    folder for the page, the plots and ``study.json``; the same call goes on from there after Ctrl-C. Without it there is
    no page. A scene that was not read from a file is written to ``scene.toml`` there.
    """
    read = _scene.of(scene)
    names = methods.split(",") if isinstance(methods, str) else list(methods or [])
    options = {
        "methods": [name.strip() for name in names],
        "spp": [int(count) for count in spp],
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
    with _bar(progress) as callback:
        if out is not None:
            told = _moire.study(read._native, read._text, os.fspath(out), options, arguments, callback)
            return Study(json.loads(told), os.fspath(out))
        with tempfile.TemporaryDirectory(prefix="moire-study-") as folder:
            told = _moire.study(read._native, read._text, folder, options, arguments, callback)
            return Study(json.loads(told), None)


def _is_path(picture: Any) -> bool:
    return isinstance(picture, (str, os.PathLike))


def _array(picture: Any) -> Any:
    if isinstance(picture, Picture):
        return rgb(picture.array)
    return _moire.read(os.fspath(picture)) if _is_path(picture) else rgb(picture)
