"""Rendering: pictures and layers as arrays."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NoReturn, Union

import numpy as np
from numpy.typing import NDArray

from . import _moire, _scene
from ._errors import RenderWarning
from ._options import Device, Path, Progress, RenderOptions, check, takes
from ._picture import Picture
from ._progress import Bar
from ._scene import Scene

if TYPE_CHECKING:
    from typing_extensions import Self, Unpack

#: Layers that count, which are whole numbers; 0 where there is nothing.
_COUNTED = {"instance", "material"}


class Renderer:
    """A device that is kept over renders, with its pipelines and the textures of the last scene.

    It may be used by several threads, which it serves one after the other; two renderers work at the same time. In a
    ``with`` statement the device is given back at the end.

    Parameters
    ----------
    device : str, int or list, optional
        One that :func:`moire.devices` lists: its index, a part of its name, ``"cpu"`` or ``"gpu"``; or ``"oracle"``,
        which is float64 on the CPU; or a list of several that share the work. The default is the first discrete GPU,
        otherwise an integrated one, otherwise a CPU driver.

    Examples
    --------
    >>> with moire.Renderer("cpu") as renderer:
    ...     pictures = [renderer.render("@quad", size=(size, size)) for size in (16, 32)]
    >>> [picture.size for picture in pictures]
    [(16, 16), (32, 32)]
    """

    def __init__(self, device: Device = None) -> None:
        if device is None:
            devices: list[str] = []
        elif isinstance(device, (str, int)):
            devices = [str(device)]
        elif isinstance(device, Iterable):
            devices = [str(one) for one in device]
        else:
            raise TypeError(f"device: expected a name, an index or a list of them, found {device!r}")
        prepare_drivers()
        self._native = _moire.Renderer(devices)

    @property
    def device(self) -> str:
        """The device's name; several are joined by ``" + "``."""
        return self._native.device

    @takes(RenderOptions)
    def render(
        self, scene: Union[Scene, Path], *, progress: Progress = None, **options: Unpack[RenderOptions]
    ) -> Picture:
        """Render a scene. Other threads run meanwhile, and Ctrl-C raises ``KeyboardInterrupt``.

        The options are those of ``moire render``; what is not given is the scene's own.

        Parameters
        ----------
        scene : Scene or path
            What to render.
        progress : callable or True, optional
            A function that is called with the fraction that is done, and cancels by returning ``False``; or a bar.
        spp : int, optional
            Samples per pixel.
        pattern : str, optional
            Sample pattern within a pixel, such as ``"sobol-owen"``.
        filter, mip, method, footprint : str, optional
            How textures are read: filter and levels of every sampler, by the device or the shader, and the footprint
            over which look-ups are averaged.
        size : (int, int), optional
            Width and height in pixels.
        crop : (int, int, int, int), optional
            Render a part only: x and y of its top left corner, width and height.
        seed : int, optional
            Seed of the samples.
        algorithm : str, optional
            ``"samples"``, ``"cone"``, ``"adaptive"`` or ``"auto"``.
        precision : str, optional
            Precision of geometry.
        pixel_filter, pixel_filter_radius : str and float, optional
            The reconstruction filter, and its radius in pixels.
        shared : bool, optional
            Use one set of displacements for all pixels.
        budget : float or str, optional
            Render for this time and then stop: seconds, or a text such as ``"50ms"``.
        target_error : float, optional
            Render until the RMSE is estimated to be this.
        allow_nonfinite : bool, optional
            Accept NaN and infinity in textures.

        Returns
        -------
        Picture
            Its ``array`` is linear light, and its ``report`` tells samples, times and estimated errors.
        """
        return self._render(scene, check(options, RenderOptions), progress)

    def _render(self, scene: Union[Scene, Path], options: dict[str, Any], progress: Progress) -> Picture:
        """Render, and warn at the place that called the caller."""
        with Bar(progress) as callback:
            array, told = self._native.render(_scene.of(scene)._native, options, callback)
        picture = Picture._rendered(array, told)
        for warning in picture.report["warnings"]:
            warnings.warn(warning, RenderWarning, stacklevel=3)
        return picture

    @takes(RenderOptions)
    def aov(
        self,
        scene: Union[Scene, Path],
        names: Union[str, Iterable[str]],
        *,
        progress: Progress = None,
        **options: Unpack[RenderOptions],
    ) -> dict[str, NDArray[Any]]:
        """Measure layers: what each pixel sees beside its colour. See :func:`moire.aov`."""
        wanted = [name.strip() for name in names.split(",")] if isinstance(names, str) else list(names)
        given, read = check(options, RenderOptions), _scene.of(scene)
        native = read._with_shapes() if "instance" in wanted else read._native
        with Bar(progress) as callback:
            layers = self._native.aov(native, list(dict.fromkeys(wanted)), given, callback)
        return {name: _layer(name, values) for name, values in layers}

    def close(self) -> None:
        """Give the device back. A closed renderer renders no more."""
        self._native.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __reduce__(self) -> NoReturn:
        raise TypeError("a moire.Renderer holds a device and is not copied or pickled; make one in each process")

    def __repr__(self) -> str:
        return f"<moire.Renderer on {self.device}>"


@takes(RenderOptions)
def render(
    scene: Union[Scene, Path],
    *,
    device: Device = None,
    progress: Progress = None,
    **options: Unpack[RenderOptions],
) -> Picture:
    """Render a scene once, on a device that is opened for it. A :class:`Renderer` keeps its device.

    Parameters
    ----------
    scene : Scene or path
        What to render.
    device : str, int or list, optional
        As :class:`Renderer` takes it.
    progress, **options
        Those of :meth:`Renderer.render`.

    Examples
    --------
    >>> picture = moire.render("@lecture", spp=4, pattern="sobol-owen", filter="ewa", footprint="cone", size=(64, 48))
    >>> picture.array.shape
    (48, 64, 3)
    """
    given = check(options, RenderOptions)
    with Renderer(device) as renderer:
        return renderer._render(scene, given, progress)


@takes(RenderOptions)
def aov(
    scene: Union[Scene, Path],
    names: Union[str, Iterable[str]],
    *,
    device: Device = None,
    progress: Progress = None,
    **options: Unpack[RenderOptions],
) -> dict[str, NDArray[Any]]:
    """Measure layers: what each pixel sees beside its colour.

    Parameters
    ----------
    scene : Scene or path
        What is seen.
    names : str or list of str
        The layers, such as ``"depth,normal"``; those of ``moire render --aov``.
    device, progress, **options
        Those of :func:`render`.

    Returns
    -------
    dict of arrays
        Height × width, or height × width × channels if there are several. Where a pixel has no value it is NaN;
        ``instance`` and ``material`` are whole numbers from 1, and 0 there.

    Examples
    --------
    >>> layers = moire.aov("@lecture", "depth,normal", size=(64, 48))
    >>> layers["depth"].shape, layers["normal"].shape
    ((48, 64), (48, 64, 3))
    """
    with Renderer(device) as renderer:
        return renderer.aov(scene, names, progress=progress, **options)


def prepare_drivers() -> None:
    """Give drivers a folder for compiled shaders where the user's own cannot be written, as the program does."""
    found = _moire.driver_cache()
    if found is not None:
        os.environ.setdefault(*found)


def _layer(name: str, values: NDArray[np.float32]) -> NDArray[Any]:
    flat = values[:, :, 0] if values.shape[2] == 1 else values
    return np.nan_to_num(flat, nan=0.0).astype(np.uint32) if name in _COUNTED else flat
