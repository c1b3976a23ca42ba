"""Comparisons and studies."""

import json
import math

import numpy as np
import pytest

import moire


def test_planted_differences_are_measured():
    a, b = np.zeros((4, 5, 3), np.float32), np.zeros((4, 5, 3), np.float32)
    assert moire.compare(a, b).psnr == math.inf
    a[2, 3, 1] = 0.5
    found = moire.compare(a, b)
    assert (found.max, found.max_at, found.over_1_255_pixels) == (0.5, (3, 2), 1)
    assert found.rmse == pytest.approx(math.sqrt(0.25 / 60))
    assert found.psnr == pytest.approx(-10 * math.log10(0.25 / 60))
    assert 0 < found.flip < 1
    a[0, 0, 0] = np.nan
    found = moire.compare(a, b)
    assert found.nan_pixels == 1 and math.isnan(found.flip)
    a[0, 0, 0] = np.inf
    assert (moire.compare(a, b).max, moire.compare(a, b).rmse) == (math.inf, math.inf)


def test_pictures_arrays_and_files_are_compared(tmp_path):
    values = np.linspace(0, 1, 60, dtype=np.float32).reshape(4, 5, 3)
    picture = moire.Picture(values)
    picture.save(tmp_path / "a.exr")
    for other in [values, picture, tmp_path / "a.exr", values.tolist()]:
        assert moire.compare(picture, other).rmse == 0
    assert moire.compare(tmp_path / "a.exr", tmp_path / "a.exr").rmse == 0
    encoded = np.array([[[0, 128, 255]]], np.uint8)
    assert moire.compare(encoded, [[[0, 0.2158605, 1]]]).max < 1e-6
    with pytest.raises(moire.Error, match="differ in size"):
        moire.compare(values, values[1:])


def test_a_study_is_a_list_of_records(lecture, device, tmp_path):
    options = dict(methods="grid,stratified", spp=[1, 4], repeats=1, size=(32, 24), device=device, seconds=60)
    study = moire.study(lecture, out=tmp_path / "study", **options)
    found = {(point["method"], point["spp"]) for point in study}
    assert found == {(method, count) for method in ["grid", "stratified"] for count in [1, 4]}
    assert all(point["errors"]["rmse"] >= 0 and point["seconds"] for point in study)
    assert study.recommendation and study.recommendation in repr(study)
    assert {"device", "reference", "methods", "points", "analysis", "notes"} <= set(study.record)
    assert study.record == json.loads((tmp_path / "study/study.json").read_text())
    assert (tmp_path / "study" / "index.html").exists()
    # A question may take more counts than were asked for.
    answered = moire.study(lecture, budget=0.5, **options)
    assert found <= {(point["method"], point["spp"]) for point in answered}
    assert answered.record["question"] == {"budget": 0.5} and answered.folder is None


def test_a_sheet_shows_settings_side_by_side(lecture, device, tmp_path):
    options = {"size": (24, 16), "repeats": 1, "device": device}
    vary = {"filter": ["nearest", "linear"], "light.0.position": [[0, 1, 0], [0, 2, 0]]}
    sheet = moire.sheet(lecture, vary, out=tmp_path / "a.html", zoom=(0, 0, 8, 8), **options)
    assert [cell["settings"]["filter"] for cell in sheet] == ["nearest", "linear"] * 2
    assert all(cell["rmse"] >= 0 and cell["seconds"] for cell in sheet)
    assert sheet._repr_png_().startswith(b"\x89PNG") and "light.0.position" in repr(sheet)
    assert [path.name for path in tmp_path.iterdir()] == ["a.html"]
    with pytest.raises(moire.OptionsError, match="possible values"):
        moire.sheet(lecture, {"filter": ["bilinear"]}, **options)
    with pytest.raises(moire.OptionsError, match="arrays"):
        moire.sheet(lecture.with_texture("grass", np.zeros((2, 2))), vary, **options)
