"""Renders: arrays of linear light, as the program writes them; options, reports, layers."""

import os
import subprocess
import sys

import numpy as np
import pytest

import moire


def test_an_array_is_what_the_program_writes(renderer, lecture, device, tmp_path):
    path = tmp_path / "a.exr"
    options = ["--size", "64x48", "--spp", "4", "--device", device, "-o", str(path), "-q"]
    subprocess.run([sys.executable, "-m", "moire", "render", "@lecture", *options], check=True)
    array = renderer.render(lecture).array
    assert (array.shape, array.dtype) == ((48, 64, 3), np.float32)
    np.testing.assert_array_equal(array, moire.Picture.open(path).array)


def test_values_are_linear_light(renderer):
    scene = moire.Scene("@lecture")
    # The sky is far from everything else; the scene's file gives its colour in linear RGB.
    corner = renderer.render(scene, crop=(0, 0, 4, 4), spp=4).array
    np.testing.assert_allclose(corner, np.broadcast_to(np.float32([0.1, 0.3, 0.6]), (4, 4, 3)), rtol=1e-6)


def test_options_are_those_of_the_program(renderer, lecture):
    picture = renderer.render(lecture, spp=16, pattern="sobol-owen", filter="nearest", size=(40, 30), seed=3)
    assert (picture.size, picture.report["samples"], picture.report["pattern"]) == ((40, 30), 16, "sobol-owen")
    again = renderer.render(
        lecture.set("sampler.*.filter", "nearest"), spp=16, pattern="sobol-owen", size=(40, 30), seed=3
    )
    np.testing.assert_array_equal(picture.array, again.array)
    other = renderer.render(lecture, spp=16, pattern="sobol-owen", filter="nearest", size=(40, 30), seed=4)
    assert not np.array_equal(picture.array, other.array)


def test_a_render_ends_at_a_goal(renderer, lecture):
    report = renderer.render(lecture, target_error=0.05).report
    assert report["reached"] and report["estimated_rmse"] <= 0.05
    assert renderer.render(lecture, budget=0.05).report["samples"] > 0
    assert renderer.render(lecture, budget="20ms").report["options"]["size"] == [64, 48]


def test_warnings_are_in_the_words_of_python(renderer, lecture):
    with pytest.warns(moire.RenderWarning, match="^spp has no effect with budget or target_error"):
        renderer.render(lecture, budget="10ms", spp=4)


def test_a_function_renders_once(lecture):
    picture = moire.render(lecture, device="oracle", size=(8, 6), spp=1)
    assert picture.report["device"] == "oracle"
    assert np.asarray(picture).shape == (6, 8, 3)
    assert np.array(picture, dtype=np.float64).dtype == np.float64


def test_pictures_are_written_and_shown(renderer, lecture, tmp_path):
    picture = renderer.render(lecture)
    for name in ["a.png", "a.jpg", "a.tif", "a.hdr"]:
        picture.save(tmp_path / name)
        assert moire.Picture.open(tmp_path / name).size == (64, 48)
    picture.save(tmp_path / "b.png", exposure=-2, tone_map="agx", png_bits=16)
    assert moire.Picture.open(tmp_path / "b.png").array.mean() < picture.array.mean()
    assert picture._repr_png_().startswith(b"\x89PNG")


def test_layers_are_arrays(renderer, lecture):
    layers = moire.aov(lecture, "depth, normal,material", device=renderer.device)
    assert list(layers) == ["depth", "normal", "material"]
    depth, normal, material = layers.values()
    assert (depth.shape, normal.shape, material.dtype) == ((48, 64), (48, 64, 3), np.uint32)
    ground = ~np.isnan(depth)
    assert not ground[0, 0] and ground[-1, 0] and np.array_equal(ground, material > 0)
    np.testing.assert_allclose(normal[-1, 0], [0, 1, 0], atol=1e-6)
    assert renderer.aov(lecture, ["instance"], size=(8, 6))["instance"].max() >= 1


def test_devices_are_listed(renderer):
    devices = moire.devices()
    assert sum(device["default"] for device in devices) <= 1
    assert renderer.device in [device["name"] for device in devices]
    assert moire.__version__.count(".") == 2


def test_times_are_those_of_the_render(renderer, lecture):
    seconds = renderer.render(lecture).report["seconds"]
    assert set(seconds) == {"startup", "load", "compile", "upload", "render", "readback"}
    assert all(value >= 0 for value in seconds.values()) and seconds["render"] > 0


def test_drivers_get_a_folder_where_their_own_cannot_be_written(tmp_path):
    code = "import os, moire; moire.devices(); print(os.environ.get('MESA_SHADER_CACHE_DIR'))"
    environment = {**os.environ, "XDG_CACHE_HOME": "/proc/none/none", "TMPDIR": str(tmp_path)}
    environment.pop("MESA_SHADER_CACHE_DIR", None)
    ran = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    assert ran.stdout.strip().startswith(str(tmp_path / "moire-"))
