"""The code of the guide and of the README runs as it stands."""

import pathlib
import re

import pytest

import moire

ROOT = pathlib.Path(__file__).parent.parent
TEXT = """[camera]
eye = [0, 0, 5]
look_at = [0, 0, 0]
vertical_fov = 40
[image]
width = 64
height = 64
[[sphere]]
center = [0, 0, 0]
radius = 1
"""


@pytest.mark.parametrize("page", ["README.md", "../docs/guide/python.md"])
def test_code_runs(page, tmp_path, monkeypatch):
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), re.DOTALL)
    monkeypatch.chdir(tmp_path)
    pathlib.Path("floor.toml").write_text(TEXT)
    moire.render("@lecture", size=(96, 64), spp=4).save("reference.exr")
    names = {"text": TEXT}
    for block in blocks:
        exec(block, names)
    assert blocks and names["picture"].array.ndim == 3
