"""What the package declares is what there is: types, names of options, signatures, documentation."""

import doctest
import importlib
import inspect
import pathlib
import pkgutil
import subprocess
import sys
import typing

import numpy as np
import pytest

import moire
from moire import _moire, _options

USE = """
from pathlib import Path
import moire
import numpy as np

scene = moire.Scene(Path("a.toml"), set={"sampling.spp": 4}).with_texture("floor", np.zeros((2, 2)))
with moire.Renderer(["cpu", 0]) as renderer:
    picture = renderer.render(scene, filter="ewa", size=(8, 8), budget="50ms", progress=lambda done: done < 0.5)
picture.array += 1
picture.save(Path("a.png"), tone_map="agx", png_bits=16)
means: list[float] = [float(layer.mean()) for layer in moire.aov(scene, "depth,normal", spp=1).values()]
found: float = moire.compare(picture, np.zeros((8, 8, 3))).rmse
points = [point["errors"]["rmse"] for point in moire.study(scene, spp=[1, 4], budget=0.1)]
"""
WRONG = """
import moire
moire.render("@lecture", filter="bilinear")
moire.render("@lecture", samples=3)
moire.render("@lecture", size=3)
moire.render("@lecture").save("a.png", tone_map=3)
moire.Scene("@lecture").textures["floor"] = 3
moire.Scene("@lecture").spp = 3
"""


def mypy(tmp_path, text):
    (tmp_path / "use.py").write_text(text)
    cache = pathlib.Path(__file__).parent.parent.parent / ".mypy_cache"
    command = [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", "--cache-dir", str(cache), "use.py"]
    return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True).stdout


def test_right_use_passes_a_strict_check_and_each_wrong_line_does_not(tmp_path):
    told = mypy(tmp_path, USE + WRONG).splitlines()
    first = USE.count("\n") + 2
    lines = {int(line.split(":")[1]) for line in told if ": error:" in line}
    assert lines == set(range(first + 1, first + WRONG.count("\n") - 1)), told


def test_names_are_those_of_the_renderer():
    kinds = {
        "algorithm": _options.Algorithm,
        "color_space": _options.ColorSpace,
        "filter": _options.Filter,
        "footprint": _options.Footprint,
        "gamut": _options.Gamut,
        "method": _options.Method,
        "mip": _options.Mip,
        "pattern": _options.Pattern,
        "pixel_filter": _options.PixelFilter,
        "precision": _options.Precision,
        "tone_map": _options.ToneMap,
    }
    for name, words in _moire.vocabulary():
        if name != "aov":
            assert typing.get_args(kinds.pop(name)) == tuple(words)
    assert not kinds


@pytest.mark.parametrize("function", [moire.render, moire.Renderer.render, moire.aov, moire.Renderer.aov])
def test_signatures_list_all_options(function, lecture):
    listed = inspect.signature(function).parameters
    assert set(moire.RenderOptions.__annotations__) <= set(listed)
    assert not any(one.kind is one.VAR_KEYWORD for one in listed.values())


def test_every_option_is_taken(renderer, lecture):
    values = {
        "spp": 4, "pattern": "grid", "filter": "linear", "size": (8, 6), "crop": (0, 0, 4, 4), "seed": 1,
        "algorithm": "samples", "method": "shader", "mip": "none", "footprint": "none", "precision": "single",
        "pixel_filter": "tent", "pixel_filter_radius": 1.0, "shared": False, "allow_nonfinite": True,
    }  # fmt: skip
    assert set(values) | {"budget", "target_error"} == set(moire.RenderOptions.__annotations__)
    record = renderer.render(lecture, **values).record
    words = {word.split("=")[0].lstrip("-").replace("-", "_") for word in record["options"]}
    assert set(values) <= words


def test_all_names_are_documented_and_shown():
    for name in moire.__all__:
        value = getattr(moire, name)
        assert name == "__version__" or inspect.getdoc(value), name
        if inspect.isclass(value):
            for own, method in vars(value).items():
                assert own.startswith("_") or not callable(method) or inspect.getdoc(method), f"{name}.{own}"
    assert "moire.render" in moire.__doc__


def test_examples_in_the_documentation_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    tried = 0
    for found in [
        moire,
        *(importlib.import_module(f"moire.{own.name}") for own in pkgutil.iter_modules(moire.__path__)),
    ]:
        if found.__name__ != "moire.__main__":
            result = doctest.testmod(found, extraglobs={"moire": moire, "np": np})
            assert result.failed == 0
            tried += result.attempted
    assert tried > 15
