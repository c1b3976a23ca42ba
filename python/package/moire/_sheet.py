"""Settings side by side in one labelled picture or page, as ``moire sheet`` makes them."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Optional, Union

from . import _scene, _toml
from ._errors import OptionsError
from ._options import Path, RenderOptions, check, takes
from ._scene import Scene

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Sheet(list[dict[str, Any]]):
    """The cells of a sheet, one record each; a notebook shows the picture.

    A record has ``settings``, ``label``, ``rmse``, ``flip``, ``seconds`` (one of each repeat), ``command`` and more.

    Attributes
    ----------
    record : dict
        All that was measured: scene, device, axes, references, cells, warnings.
    """

    def __init__(self, record: dict[str, Any], png: Optional[bytes] = None) -> None:
        super().__init__(record["cells"])
        self.record = record
        self._png = png

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.record, self._png)

    def _repr_png_(self) -> Optional[bytes]:
        return self._png

    def __repr__(self) -> str:
        return f"<moire.Sheet of {len(self)} cells: {' × '.join(axis['name'] for axis in self.record['axes'])}>"


@takes(RenderOptions)
def sheet(
    scene: Union[Scene, Path],
    vary: Mapping[str, Iterable[Any]],
    *,
    out: Union[Path, Iterable[Path], None] = None,
    zoom: Optional[tuple[int, int, int, int]] = None,
    diff: bool = False,
    reference: Optional[Path] = None,
    repeats: int = 3,
    device: Union[str, int, None] = None,
    **options: Unpack[RenderOptions],
) -> Sheet:
    """Render a scene with each combination of the values of up to three settings, and measure error and time of each.

    It runs the program ``moire sheet``, which ends with this process and with Ctrl-C.

    Parameters
    ----------
    scene : Scene or path
        What is rendered: one of a file, without arrays as textures.
    vary : mapping
        Options of :meth:`Renderer.render`, or keys of the scene, with their values: columns, rows, blocks.
    out : path or list of paths, optional
        Pictures or pages to write: ``.png``, ``.jpg``, ``.tif``, ``.html``.
    zoom : (int, int, int, int), optional
        Show only this part of each picture, enlarged: x, y, width and height.
    diff : bool
        Show under each picture its difference from the reference.
    reference : path, optional
        A picture file, or ``"none"``; the default is many samples without a prefilter.
    repeats : int
        Renders of each cell, of whose times the median counts.
    device : str or int, optional
        One that :func:`moire.devices` lists.
    **options
        Those of :meth:`Renderer.render`, for all cells.

    Examples
    --------
    >>> sheet = moire.sheet("@quad", {"filter": ["nearest", "linear"]}, size=(32, 24), repeats=1)
    >>> [cell["settings"] for cell in sheet]
    [{'filter': 'nearest'}, {'filter': 'linear'}]
    """
    read = _scene.of(scene)
    if read._path is None or read._textures:
        what = "has arrays as textures" if read._textures else "has none"
        raise OptionsError(f"a sheet reads its scene from a file, and this one {what}", "write it to a file first")
    files = [out] if isinstance(out, (str, os.PathLike)) else list(out or [])
    words = [f"--vary={name}={_list(name, own)}" for name, own in vary.items()]
    words += [f"--set={setting}" for setting in read._settings]
    words += [f"--camera={read._camera}"] if read._camera is not None else []
    words += [f"--zoom={','.join(map(str, zoom))}"] if zoom is not None else []
    words += ["--diff"] if diff else []
    words += [f"--reference={os.fspath(reference)}"] if reference is not None else []
    words += [f"--repeats={repeats}", *([f"--device={device}"] if device is not None else [])]
    for name, value in check(options, RenderOptions).items():
        if value is not None:
            words.append(f"--{name.replace('_', '-')}={_word(name, value)}")
    with tempfile.TemporaryDirectory(prefix="moire-sheet-") as folder:
        shown = os.path.join(folder, "sheet.png")
        for own in [shown, *(os.fspath(file) for file in files)]:
            words.append(f"--output={own}")
        command = [sys.executable, "-m", "moire", "sheet", "--json", *words, "--", read._path]
        ran = subprocess.run(command, capture_output=True, encoding="utf-8", check=False)
        if ran.returncode != 0:
            raise OptionsError(" ".join(ran.stderr.replace("×", "").split()) or "the sheet was interrupted")
        record = json.loads(ran.stdout)
        record["outputs"] = [os.fspath(own) for own in files]
        with open(shown, "rb") as picture:
            return Sheet(record, picture.read())


def _list(name: str, values: Iterable[Any]) -> str:
    if isinstance(values, str):
        return values
    if name not in RenderOptions.__annotations__:
        return ",".join(_toml.value(own, name) for own in values)
    return ",".join(_word(name, own) for own in values)


def _word(name: str, value: Any) -> str:
    return "x".join(map(str, value)) if name == "size" and not isinstance(value, str) else str(value).lower()
