"""Rendering: pictures and layers as arrays."""

from __future__ import annotations

import json
import os
import sys
import warnings
from collections.abc import Callable, Iterable
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _moire, _scene
from ._errors import RenderWarning
from ._scene import Path, Scene

#: Called with the fraction in [0, 1] that is done; ``True`` draws a bar on stderr. ``False`` as an answer cancels.
Progress = Union[Callable[[float], Any], bool, None]
#: A device as the option ``--device`` takes it, or several that share the work.
Device = Union[str, int, Iterable[Union[str, int]], None]

#: Layers that count, which are whole numbers; 0 where there is nothing.
_COUNTED = {"instance", "material"}


class Picture:
    """A picture in linear light.

    ``array`` is a NumPy array of float32 of height × width × 3, the top row first; it is the renderer's own memory, not a
    copy. ``report`` has what is known of the render: ``device``, ``samples``, ``seconds``, ``reached``,
    ``estimated_rmse``, ``outcome``, ``warnings`` and others.
    """

    def __init__(self, array: Any, report: Optional[dict[str, Any]] = None) -> None:
        self.array: NDArray[np.float32] = rgb(array)
        self.report: dict[str, Any] = report or {}

    @classmethod
    def open(cls, path: Path) -> Picture:
        """Read a picture file; 8- and 16-bit values are decoded from sRGB, float values are linear."""
        return cls(_moire.read(os.fspath(path)))

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        height, width, _ = self.array.shape
        return width, height

    def save(
        self,
        path: Path,
        *,
        exposure: Optional[float] = None,
        white_balance: Optional[float] = None,
        tone_map: Optional[str] = None,
        gamut: Optional[str] = None,
        png_bits: Optional[int] = None,
        jpeg_quality: Optional[int] = None,
    ) -> None:
        """Write the picture. The ending selects the format: ``.exr`` and ``.hdr`` keep linear light, ``.png``, ``.jpg`` and
        ``.tif`` are encoded for a screen, which is what the other arguments are about. The file appears complete or not
        at all."""
        options = {
            "exposure": exposure,
            "white_balance": white_balance,
            "tone_map": tone_map,
            "gamut": gamut,
            "png_bits": png_bits,
            "jpeg_quality": jpeg_quality,
        }
        _moire.save(rgb(self.array), os.fspath(path), options)

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> NDArray[Any]:
        if copy is False and dtype is not None and np.dtype(dtype) != self.array.dtype:
            raise ValueError(f"a picture is float32; as {np.dtype(dtype)} it would be a copy")
        if dtype is not None and np.dtype(dtype) != self.array.dtype:
            return self.array.astype(dtype)
        return self.array.copy() if copy else self.array

    def _repr_png_(self) -> bytes:
        return _moire.png(rgb(self.array))

    def __repr__(self) -> str:
        width, height = self.size
        made = f", {self.report['samples']:g} samples on {self.report['device']}" if self.report else ""
        return f"<moire.Picture {width}×{height}{made}>"


class Renderer:
    """A device that is kept over renders, with its pipelines and the textures of the last scene.

    ``device`` is one that :func:`moire.devices` lists: its index, a part of its name, ``"cpu"`` or ``"gpu"``; or
    ``"oracle"``, which is float64 on the CPU; or a list of several that share the work. The default is the first discrete
    GPU, otherwise an integrated one, otherwise a CPU driver.
    """

    def __init__(self, device: Device = None) -> None:
        if device is None:
            devices: list[str] = []
        elif isinstance(device, (str, int)):
            devices = [str(device)]
        else:
            devices = [str(one) for one in device]
        self._native = _moire.Renderer(devices)

    @property
    def device(self) -> str:
        """The device's name; several are joined by ``" + "``."""
        return self._native.device

    def render(
        self,
        scene: Union[Scene, Path],
        *,
        spp: Optional[int] = None,
        pattern: Optional[str] = None,
        filter: Optional[str] = None,
        size: Optional[tuple[int, int]] = None,
        crop: Optional[tuple[int, int, int, int]] = None,
        seed: Optional[int] = None,
        algorithm: Optional[str] = None,
        method: Optional[str] = None,
        mip: Optional[str] = None,
        footprint: Optional[str] = None,
        precision: Optional[str] = None,
        pixel_filter: Optional[str] = None,
        pixel_filter_radius: Optional[float] = None,
        shared: Optional[bool] = None,
        budget: Optional[float] = None,
        target_error: Optional[float] = None,
        allow_nonfinite: bool = False,
        progress: Progress = None,
    ) -> Picture:
        """Render a scene; the options are those of ``moire render``, and what is not given is the scene's own.

        ``budget`` ends the render after this number of seconds, ``target_error`` at this estimated RMSE. Other threads of
        Python run meanwhile, and Ctrl-C raises ``KeyboardInterrupt``.
        """
        options = {name: own for name, own in locals().items() if name not in ("self", "scene", "progress")}
        return self._render(scene, options, progress)

    def _render(self, scene: Union[Scene, Path], options: dict[str, Any], progress: Progress) -> Picture:
        """Render, and warn at the place that called the caller."""
        with _bar(progress) as callback:
            array, report = self._native.render(_scene.of(scene)._native, options, callback)
        known = json.loads(report)
        for told in known["warnings"]:
            warnings.warn(told, RenderWarning, stacklevel=3)
        return Picture(array, known)

    def aov(
        self,
        scene: Union[Scene, Path],
        names: Union[str, Iterable[str]],
        *,
        progress: Progress = None,
        **options: Any,
    ) -> dict[str, NDArray[Any]]:
        """Measure layers: what each pixel sees beside its colour. See :func:`moire.aov`."""
        wanted = [name.strip() for name in names.split(",")] if isinstance(names, str) else list(names)
        check_options(options)
        read = _scene.of(scene)
        native = read._with_shapes() if "instance" in wanted else read._native
        with _bar(progress) as callback:
            layers = self._native.aov(native, list(dict.fromkeys(wanted)), options, callback)
        return {name: _layer(name, values) for name, values in layers}

    def __repr__(self) -> str:
        return f"<moire.Renderer on {self.device}>"


def render(
    scene: Union[Scene, Path], *, device: Device = None, progress: Progress = None, **options: Any
) -> Picture:
    """Render a scene once. The options are those of :meth:`Renderer.render`::

        picture = moire.render("@lecture", spp=64, pattern="sobol-owen", filter="ewa", footprint="cone")
        picture.array.mean(axis=(0, 1))
    """
    check_options(options)
    return Renderer(device)._render(scene, options, progress)


def aov(
    scene: Union[Scene, Path], names: Union[str, Iterable[str]], *, device: Device = None, **options: Any
) -> dict[str, NDArray[Any]]:
    """Measure layers: what each pixel sees beside its colour, such as ``"depth,normal"``.

    Returns an array for each: height × width, or height × width × channels if there are several. Where a pixel has no
    value it is NaN; ``instance`` and ``material`` are whole numbers from 1, and 0 there. The options are those of
    :meth:`Renderer.render`.
    """
    return Renderer(device).aov(scene, names, **options)


def check_options(options: dict[str, Any]) -> None:
    """Refuse options that a render has not, as Python does for arguments."""
    known = {*(Renderer.render.__kwdefaults__ or {})} - {"progress"}
    for name in options:
        if name not in known:
            raise TypeError(f"unexpected keyword argument {name!r}; there are {', '.join(sorted(known))}")


def rgb(array: Any) -> NDArray[np.float32]:
    """Return an array as a picture: float32 of height × width × 3, in one piece. Grey is replicated."""
    values = np.asarray(array, dtype=np.float32)
    if values.ndim == 2:
        values = np.repeat(values[:, :, None], 3, axis=2)
    if values.ndim != 3 or values.shape[2] != 3 or 0 in values.shape:
        raise ValueError(f"a picture is an array of height × width × 3, not of shape {values.shape}")
    return np.ascontiguousarray(values)


def _layer(name: str, values: NDArray[np.float32]) -> NDArray[Any]:
    flat = values[:, :, 0] if values.shape[2] == 1 else values
    return np.nan_to_num(flat, nan=0.0).astype(np.uint32) if name in _COUNTED else flat


class _bar:
    """A callback, or a bar on stderr for ``True``, which is cleared at the end."""

    WIDTH = 40

    def __init__(self, progress: Progress) -> None:
        self.draws = progress is True
        self.callback = self.draw if self.draws else progress or None

    def draw(self, done: float) -> None:
        full = round(done * self.WIDTH)
        sys.stderr.write(f"\r{'█' * full}{'░' * (self.WIDTH - full)} {done:4.0%}")
        sys.stderr.flush()

    def __enter__(self) -> Optional[Callable[[float], Any]]:
        return self.callback  # type: ignore[return-value]

    def __exit__(self, *_: object) -> None:
        if self.draws:
            sys.stderr.write("\r" + " " * (self.WIDTH + 5) + "\r")
            sys.stderr.flush()
