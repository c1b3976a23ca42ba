"""Scenes: a file, a text or a dictionary, with values and arrays in place of some of its own."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

from . import _moire, _texels, _toml
from ._options import ColorSpace, Path

if TYPE_CHECKING:
    from typing_extensions import Self

    from ._texels import Image

#: A texture's name, its texels, and the color space of integers.
_Replaced = tuple[str, _moire.Texels, Optional[str]]


class Scene:
    """A scene to render. It keeps all rules of the scene format; one that breaks them is a :class:`moire.SceneError`.

    A scene does not change: :meth:`set`, :meth:`with_` and :meth:`with_texture` return another one. It can be copied
    and pickled, by its path or text.

    Parameters
    ----------
    path : path
        A scene file, a model, or ``@NAME`` for a scene of the program (:func:`moire.scenes`).
    set : mapping, optional
        Values in place of some of the scene's, by the keys that ``moire render --set`` takes.
    textures : mapping, optional
        Arrays in place of the texels of textures, by their names; see :meth:`with_texture`.
    camera : int or str, optional
        A camera of a glTF file, by its number from 0 or its name.

    Examples
    --------
    >>> scene = moire.Scene("@lecture", set={"sampling.spp": 16, "sampler.*.filter": "ewa"})
    >>> scene.spp
    16
    >>> scene
    <moire.Scene @lecture: 512×512, 16 spp, stratified>
    """

    _path: Optional[str]
    _text: Optional[str]
    _settings: list[str]
    _camera: Optional[str]
    _textures: list[_Replaced]
    _native: _moire.Scene

    def __init__(
        self,
        path: Path,
        *,
        set: Optional[Mapping[str, Any]] = None,
        textures: Optional[Mapping[str, Image]] = None,
        camera: Union[int, str, None] = None,
    ) -> None:
        named = None if camera is None else str(camera)
        self._init(os.fspath(path), None, _settings(set), named, _replaced(textures))

    def _init(
        self,
        path: Optional[str],
        text: Optional[str],
        settings: list[str],
        camera: Optional[str],
        textures: list[_Replaced],
    ) -> None:
        self._path, self._text, self._settings = path, text, settings
        self._camera, self._textures = camera, textures
        self._native = _moire.Scene(path, text, settings, camera, False, textures)

    @classmethod
    def _make(
        cls,
        path: Optional[str],
        text: Optional[str],
        settings: list[str],
        camera: Optional[str],
        textures: list[_Replaced],
    ) -> Self:
        scene = cls.__new__(cls)
        scene._init(path, text, settings, camera, textures)
        return scene

    @classmethod
    def from_toml(
        cls,
        text: str,
        *,
        set: Optional[Mapping[str, Any]] = None,
        textures: Optional[Mapping[str, Image]] = None,
    ) -> Self:
        """Read a scene from the text of a scene file. Paths in it are relative to the current folder."""
        if not isinstance(text, str):
            raise TypeError(f"expected the text of a scene, found {text!r}")
        return cls._make(None, text, _settings(set), None, _replaced(textures))

    @classmethod
    def from_dict(cls, scene: Mapping[str, Any]) -> Self:
        """Build a scene from the sections of the scene format.

        Sections are dictionaries, and lists of them where there are several. The ``file`` of a texture may be an array.

        Examples
        --------
        >>> scene = moire.Scene.from_dict({
        ...     "image": {"width": 64, "height": 64},
        ...     "camera": {"eye": [0, 0, 5], "look_at": [0, 0, 0], "vertical_fov": 40},
        ...     "texture": [{"name": "noise", "file": np.random.rand(8, 8)}],
        ...     "material": [{"name": "own", "model": "unlit", "texture": "noise"}],
        ...     "sphere": [{"center": [0, 0, 0], "radius": 1, "material": "own"}],
        ... })
        >>> scene.size
        (64, 64)
        """
        if not isinstance(scene, Mapping):
            raise TypeError(f"expected a dictionary of sections, found {scene!r}")
        sections, textures = dict(scene), []
        listed = sections.get("texture")
        if isinstance(listed, Sequence) and all(isinstance(texture, Mapping) for texture in listed):
            named = [dict(texture) for texture in listed]
            for texture in named:
                if _texels.is_image(texture.get("file")):
                    name = str(texture.get("name"))
                    textures.append((name, _texels.of(texture["file"], name), texture.get("color_space")))
                    texture["file"] = f"array of {name}"
            sections["texture"] = named
        return cls._make(None, _toml.document(sections), [], None, textures)

    def set(self, key: str, value: Any) -> Self:
        """Return the scene with another value of a key, such as ``scene.set("sampling.spp", 64)``."""
        return self.with_(**{key: value})

    def with_(self, **values: Any) -> Self:
        """Return the scene with other values of keys: ``scene.with_(**{"sampler.ground.filter": "ewa"})``."""
        settings = self._settings + _settings(values)
        return self._make(self._path, self._text, settings, self._camera, self._textures)

    def with_texture(self, name: str, image: Image, *, color_space: Optional[ColorSpace] = None) -> Self:
        """Return the scene with an array in place of the texels of a texture.

        Parameters
        ----------
        name : str
            The texture; :attr:`textures` has those of the scene. It keeps its other keys.
        image : array or Picture
            Height × width, or height × width × channels: 1 is grey, 2 grey and alpha, 3 colours, 4 colours and alpha.
            The top row is the first. ``uint8`` and ``uint16`` are read as from a file of 8 or 16 bits, floats are
            linear light.
        color_space : {"srgb", "linear"}, optional
            What integers mean; the default is what the scene says of the texture.

        Examples
        --------
        >>> checker = np.indices((64, 64)).sum(axis=0) // 8 % 2 * 1.0
        >>> moire.Scene("@quad").with_texture("poster", checker).textures["poster"]
        'an array of 64×64 texels, grey-float'
        """
        textures = [own for own in self._textures if own[0] != name]
        textures.append((name, _texels.of(image, name), color_space))
        return self._make(self._path, self._text, self._settings, self._camera, textures)

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

    @property
    def textures(self) -> Mapping[str, str]:
        """The textures by their names, with what each is read from; :meth:`with_texture` takes an array instead."""
        return Textures(self._native.textures)

    def _with_shapes(self) -> _moire.Scene:
        """Return the scene whose meshes are shapes of their own, which the layer ``instance`` numbers."""
        return _moire.Scene(self._path, self._text, self._settings, self._camera, True, self._textures)

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: Any) -> Self:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return self._make, (self._path, self._text, self._settings, self._camera, self._textures)

    def __repr__(self) -> str:
        width, height = self.size
        return f"<moire.Scene {self._path or 'of a text'}: {width}×{height}, {self.spp} spp, {self.pattern}>"


class Textures(Mapping[str, str]):
    """The textures of a scene by name."""

    def __init__(self, known: dict[str, str]) -> None:
        self._known = known

    def __getitem__(self, name: str) -> str:
        return self._known[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._known)

    def __len__(self) -> int:
        return len(self._known)

    def __repr__(self) -> str:
        return repr(self._known)

    if not TYPE_CHECKING:

        def __setitem__(self, name, image):
            raise TypeError(f"a scene does not change; use scene = scene.with_texture({name!r}, array)")


def of(scene: Union[Scene, Path]) -> Scene:
    """Return a scene, which is read if its path is given."""
    if isinstance(scene, Scene):
        return scene
    if not isinstance(scene, (str, os.PathLike)):
        raise TypeError(f"expected a moire.Scene or a path, found {scene!r}")
    return Scene(scene)


def _settings(values: Optional[Mapping[str, Any]]) -> list[str]:
    if not (values is None or isinstance(values, Mapping)):
        raise TypeError(f"set: expected a dictionary of keys and values, found {values!r}")
    return [f"{key}={_toml.value(value, key)}" for key, value in (values or {}).items()]


def _replaced(textures: Optional[Mapping[str, Image]]) -> list[_Replaced]:
    if not (textures is None or isinstance(textures, Mapping)):
        raise TypeError(f"textures: expected a dictionary of names and arrays, found {textures!r}")
    return [(name, _texels.of(image, name), None) for name, image in (textures or {}).items()]
