"""Scenes: a file, a text or a dictionary, with values in place of some of its own."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Optional, Union

from . import _moire, _toml

#: A path, or ``@NAME`` for a scene that the program has in itself.
Path = Union[str, "os.PathLike[str]"]


class Scene:
    """A scene to render. It keeps all rules of the scene format; one that breaks them is a :class:`moire.SceneError`.

    ``path`` is a scene file, a model, or ``@NAME`` for a scene of the program (:func:`moire.scenes`). ``set`` has values
    in place of some of the scene's, by the keys that ``moire render --set`` takes::

        moire.Scene("@lecture", set={"sampling.spp": 16, "sampler.*.filter": "ewa"})

    ``camera`` is a camera of a glTF file, by its number from 0 or its name. A scene does not change; :meth:`set` and
    :meth:`with_` return another one.
    """

    def __init__(self, path: Path, *, set: Optional[Mapping[str, Any]] = None, camera: Union[int, str, None] = None) -> None:
        self._init(os.fspath(path), None, _settings(set or {}), None if camera is None else str(camera))

    def _init(self, path: Optional[str], text: Optional[str], settings: list[str], camera: Optional[str]) -> None:
        self._path, self._text, self._settings, self._camera = path, text, settings, camera
        self._native = _moire.Scene(path, text, settings, camera, False)

    @classmethod
    def _make(cls, path: Optional[str], text: Optional[str], settings: list[str], camera: Optional[str]) -> Scene:
        scene = cls.__new__(cls)
        scene._init(path, text, settings, camera)
        return scene

    @classmethod
    def from_toml(cls, text: str, *, set: Optional[Mapping[str, Any]] = None) -> Scene:
        """Read a scene from the text of a scene file. Paths in it are relative to the current folder."""
        return cls._make(None, text, _settings(set or {}), None)

    @classmethod
    def from_dict(cls, scene: Mapping[str, Any]) -> Scene:
        """Build a scene from the sections of the scene format: dictionaries, and lists of them where there are several::

            moire.Scene.from_dict({
                "image": {"width": 64, "height": 64},
                "camera": {"eye": [0, 0, 5], "look_at": [0, 0, 0], "vertical_fov": 40},
                "sphere": [{"center": [0, 0, 0], "radius": 1}],
            })
        """
        return cls.from_toml(_toml.document(scene))

    def set(self, key: str, value: Any) -> Scene:
        """Return the scene with another value of a key, such as ``scene.set("sampling.spp", 64)``."""
        return self.with_(**{key: value})

    def with_(self, **values: Any) -> Scene:
        """Return the scene with other values of keys: ``scene.with_(**{"sampler.ground.filter": "ewa"})``."""
        return self._make(self._path, self._text, self._settings + _settings(values), self._camera)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture in pixels."""
        return self._native.size

    @property
    def spp(self) -> int:
        """Samples per pixel."""
        return self._native.spp

    @property
    def pattern(self) -> str:
        """The sample pattern within a pixel."""
        return self._native.pattern

    @property
    def algorithm(self) -> str:
        """The rendering algorithm."""
        return self._native.algorithm

    def _with_shapes(self) -> _moire.Scene:
        """Return the scene whose meshes are shapes of their own, which the layer ``instance`` numbers."""
        return _moire.Scene(self._path, self._text, self._settings, self._camera, True)

    def __repr__(self) -> str:
        width, height = self.size
        return f"<moire.Scene {self._path or 'of a text'}: {width}×{height}, {self.spp} spp, {self.pattern}>"


def of(scene: Union[Scene, Path]) -> Scene:
    """Return a scene, which is read if its path is given."""
    return scene if isinstance(scene, Scene) else Scene(scene)


def _settings(values: Mapping[str, Any]) -> list[str]:
    return [f"{key}={_toml.value(value, key)}" for key, value in values.items()]
