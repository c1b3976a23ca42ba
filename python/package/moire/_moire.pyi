"""The compiled part of the module; use the names of ``moire`` itself."""

from collections.abc import Callable
from typing import Any, Optional, final

import numpy as np
from numpy.typing import NDArray

__version__: str
__all__ = [
    "Renderer",
    "Scene",
    "Texels",
    "__version__",
    "compare",
    "compare_files",
    "devices",
    "digest",
    "driver_cache",
    "main",
    "png",
    "read",
    "record",
    "save",
    "scenes",
    "screen",
    "study",
    "vocabulary",
]

@final
class Texels:
    def __new__(cls, width: int, height: int, channels: int, component: str, bytes: bytes) -> Texels: ...
    def __getnewargs__(self) -> tuple[int, int, int, str, bytes]: ...

@final
class Scene:
    def __new__(
        cls,
        path: Optional[str],
        text: Optional[str],
        settings: list[str],
        camera: Optional[str],
        keeps_meshes: bool,
        textures: list[tuple[str, Texels, Optional[str]]],
    ) -> Scene: ...
    @property
    def size(self) -> tuple[int, int]: ...
    @property
    def spp(self) -> int: ...
    @property
    def pattern(self) -> str: ...
    @property
    def algorithm(self) -> str: ...
    @property
    def textures(self) -> dict[str, str]: ...

@final
class Renderer:
    def __new__(cls, devices: list[str]) -> Renderer: ...
    @property
    def device(self) -> str: ...
    def close(self) -> None: ...
    def render(
        self, scene: Scene, options: dict[str, Any], progress: Optional[Callable[[float], Any]]
    ) -> tuple[NDArray[np.float32], str]: ...
    def aov(
        self, scene: Scene, names: list[str], options: dict[str, Any], progress: Optional[Callable[[float], Any]]
    ) -> list[tuple[str, NDArray[np.float32]]]: ...

def main(arguments: list[str]) -> int: ...
def scenes() -> dict[str, str]: ...
def devices() -> str: ...
def driver_cache() -> Optional[tuple[str, str]]: ...
def vocabulary() -> list[tuple[str, list[str]]]: ...
def read(path: str) -> NDArray[np.float32]: ...
def record(path: str) -> Optional[str]: ...
def save(
    array: NDArray[np.float32],
    path: str,
    options: dict[str, Any],
    record: Optional[str],
    placement: Optional[tuple[int, int, int, int]],
) -> None: ...
def png(array: NDArray[np.float32], options: dict[str, Any]) -> bytes: ...
def screen(array: NDArray[np.float32], options: dict[str, Any]) -> NDArray[np.uint8]: ...
def digest(array: NDArray[np.float32]) -> int: ...
def compare(a: NDArray[np.float32], b: NDArray[np.float32]) -> dict[str, Any]: ...
def compare_files(a: str, b: str) -> dict[str, Any]: ...
def study(
    scene: Scene,
    text: Optional[str],
    out: str,
    options: dict[str, Any],
    arguments: list[str],
    progress: Optional[Callable[[float], Any]],
) -> str: ...
