"""Scenes: from files, texts and dictionaries, with other values."""

import numpy as np
import pytest

import moire

SPHERE = {
    "image": {"width": 32, "height": 24},
    "camera": {"eye": [0.0, 0.0, 5.0], "look_at": np.zeros(3), "vertical_fov": 40},
    "material": [{"name": "red", "model": "unlit", "color": [1.0, 0.25, 0.0]}],
    "sphere": [{"center": [0.0, 0.0, 0.0], "radius": 1.0, "material": "red"}],
}


def test_values_replace_those_of_the_file():
    scene = moire.Scene("@lecture", set={"sampling.spp": np.int64(9), "sampling.pattern": "grid"})
    assert (scene.size, scene.spp, scene.pattern) == ((512, 512), 9, "grid")
    other = scene.set("sampling.spp", 25).with_(**{"image.size": (20, 10)})
    assert (other.spp, other.pattern, other.size) == (25, "grid", (20, 10))
    assert scene.spp == 9


def test_a_scene_is_built_from_a_dictionary(renderer):
    array = renderer.render(moire.Scene.from_dict(SPHERE), spp=1).array
    assert array.shape == (24, 32, 3)
    np.testing.assert_array_equal(array[12, 16], np.float32([1.0, 0.25, 0.0]))
    np.testing.assert_array_equal(array[0, 0], np.zeros(3))


def test_a_text_is_a_scene():
    camera = "[camera]\neye = [0, 0, 1]\nlook_at = [0, 0, 0]\nvertical_fov = 40\n"
    text = f"{camera}[image]\nwidth = 8\nheight = 8\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 0.5\n"
    assert moire.Scene.from_toml(text, set={"image.width": 16}).size == (16, 8)


def test_scenes_of_the_program_are_listed():
    scenes = moire.scenes()
    assert "lecture" in scenes["@lecture"].lower()
    assert len(scenes) > 10


def test_strings_with_quotes_and_values_without_a_type_are_handled():
    with pytest.raises(moire.SceneError, match='a \\\\?"b'):
        moire.Scene("@lecture", set={"sampler.*.filter": 'a "b'})
    with pytest.raises(moire.OptionsError, match="type object"):
        moire.Scene("@lecture", set={"sampling.spp": object()})
