"""The options of functions by name: their types, and the signatures that ``help`` and editors show."""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Iterable
from typing import Any, Literal, Optional, TypedDict, TypeVar, Union

#: A path, or where a scene is expected ``@NAME`` for one that the program has in itself.
Path = Union[str, "os.PathLike[str]"]
#: Called with the fraction in [0, 1] that is done; ``True`` draws a bar on stderr. ``False`` as an answer cancels.
Progress = Union[Callable[[float], Any], bool, None]
#: A device as the option ``--device`` takes it, or several that share the work.
Device = Union[str, int, Iterable[Union[str, int]], None]

Algorithm = Literal["samples", "adaptive", "beam", "auto", "cone"]
ColorSpace = Literal["linear", "srgb"]
Filter = Literal[
    "nearest", "linear", "cubic", "stochastic", "anisotropic", "ewa", "summed-area", "lanczos-2", "lanczos-3"
]
Footprint = Literal["none", "cone", "differentials"]
Gamut = Literal["srgb", "display-p3"]
Method = Literal["shader", "hardware"]
Mip = Literal["none", "nearest", "linear", "stored"]
Pattern = Literal[
    "center", "grid", "random", "stratified", "multi-jittered", "halton", "sobol-owen", "blue-noise", "n-rooks"
]
PixelFilter = Literal["box", "tent", "gaussian", "mitchell", "blackman-harris"]
Precision = Literal["auto", "single", "double"]
ToneMap = Literal["none", "reinhard", "filmic", "aces", "aces-narkowicz", "agx"]


class RenderOptions(TypedDict, total=False):
    """The options of :meth:`moire.Renderer.render`. What is missing or ``None`` is the scene's own."""

    spp: Optional[int]
    pattern: Optional[Pattern]
    filter: Optional[Filter]
    size: Optional[tuple[int, int]]
    crop: Optional[tuple[int, int, int, int]]
    seed: Optional[int]
    algorithm: Optional[Algorithm]
    method: Optional[Method]
    mip: Optional[Mip]
    footprint: Optional[Footprint]
    precision: Optional[Precision]
    pixel_filter: Optional[PixelFilter]
    pixel_filter_radius: Optional[float]
    shared: Optional[bool]
    budget: Union[float, str, None]
    target_error: Optional[float]
    allow_nonfinite: Optional[bool]


class DisplayOptions(TypedDict, total=False):
    """How linear light becomes what a screen shows. What is missing or ``None`` is not done."""

    exposure: Optional[float]
    white_balance: Optional[float]
    tone_map: Optional[ToneMap]
    gamut: Optional[Gamut]


class SaveOptions(DisplayOptions, total=False):
    """The options of :meth:`moire.Picture.save`."""

    png_bits: Optional[Literal[8, 16]]
    jpeg_quality: Optional[int]


Function = TypeVar("Function", bound=Callable[..., Any])


def takes(options: Any) -> Callable[[Function], Function]:
    """Let the signature of a function list these options in place of ``**options``, and refuse others."""

    def adorn(function: Function) -> Function:
        own = inspect.signature(function)
        kept = [one for one in own.parameters.values() if one.kind is not inspect.Parameter.VAR_KEYWORD]
        more = [
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=_shown(kind))
            for name, kind in options.__annotations__.items()
        ]
        function.__signature__ = own.replace(parameters=[*kept, *more])  # type: ignore[attr-defined]
        return function

    return adorn


def check(given: Any, options: Any) -> dict[str, Any]:
    """Return options as a dictionary; refuse what there is not, as Python does for arguments."""
    known = options.__annotations__
    for name in given:
        if name not in known:
            raise TypeError(f"unexpected keyword argument {name!r}; there are {', '.join(sorted(known))}")
    return dict(given)


def _shown(kind: Any) -> str:
    return str(getattr(kind, "__forward_arg__", kind))
