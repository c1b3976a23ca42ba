"""Textures from arrays."""

import numpy as np
import pytest

import moire

QUAD = moire.Scene("@quad")


def rendered(renderer, scene):
    return renderer.render(scene, progress=None).array


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
@pytest.mark.parametrize("kind", [np.uint8, np.uint16, np.float32, np.float64, ">u2"])
def test_texels_of_every_type_are_drawn(renderer, kind, channels):
    rng = np.random.default_rng(channels)
    most = 1 if np.dtype(kind).kind == "f" else np.iinfo(np.dtype(kind)).max
    shape = (192, 256) if channels == 1 else (192, 256, channels)
    image = (rng.random(shape) * most).astype(kind)
    image.reshape(192, 256, -1)[..., -1 if channels in (2, 4) else 0 :][..., : 1 if channels in (2, 4) else 0] = most
    array = rendered(renderer, QUAD.with_texture("poster", image))
    # The quad shows each texel once; y of this scene grows upwards in the picture and the texture.
    colors = np.atleast_3d(image)[..., : 3 if channels > 2 else 1]
    expected = colors.astype(np.float32) if most == 1 else moire.Picture(replicated(colors)).array
    np.testing.assert_allclose(array, np.broadcast_to(expected, array.shape), atol=2e-3)


def replicated(colors):
    return np.ascontiguousarray(np.broadcast_to(colors, (*colors.shape[:2], 3))).astype(colors.dtype.newbyteorder("="))


def test_an_array_is_drawn_as_the_file_of_the_same_texels(renderer, tmp_path):
    image = np.random.default_rng(1).integers(0, 256, (192, 256, 3), dtype=np.uint8)
    path = tmp_path / "own.png"
    moire.Picture(image).save(path)
    own = rendered(renderer, QUAD.with_texture("poster", image))
    np.testing.assert_array_equal(own, rendered(renderer, moire.Scene("@quad", set={"texture.poster.file": path})))


def test_a_picture_is_a_texture_and_color_spaces_are_named(renderer):
    picture = renderer.render("@lecture", size=(256, 192), spp=1)
    np.testing.assert_allclose(rendered(renderer, QUAD.with_texture("poster", picture)), picture.array, atol=1e-6)
    grey = np.full((192, 256), 128, np.uint8)
    linear = rendered(renderer, QUAD.with_texture("poster", grey, color_space="linear"))
    np.testing.assert_allclose(linear, 128 / 255, rtol=1e-4)


def test_dictionaries_take_arrays(renderer):
    scene = {
        "image": {"width": 16, "height": 16},
        "camera": {"eye": [0, 0, 5], "look_at": [0, 0, 0], "orthographic_height": 1},
        "texture": [{"name": "own", "file": np.full((2, 2), 0.25)}],
        "material": [{"name": "own", "model": "unlit", "texture": "own"}],
        "sphere": [{"center": [0, 0, 0], "radius": 1, "material": "own"}],
    }
    array = rendered(renderer, moire.Scene.from_dict(scene))
    np.testing.assert_allclose(array[8, 8], 0.25, rtol=1e-6)
    assert isinstance(scene["texture"][0]["file"], np.ndarray)


def test_a_texture_changes_from_render_to_render(renderer):
    levels = [
        rendered(renderer, QUAD.with_texture("poster", np.full((4, 4), level))).mean() for level in (0.25, 0.5, 0.25)
    ]
    np.testing.assert_allclose(levels, [0.25, 0.5, 0.25], rtol=1e-5)


def test_scenes_tell_their_textures():
    assert "poster.png" in QUAD.textures["poster"] and list(QUAD.textures) == ["poster"]
    other = QUAD.with_texture("poster", np.zeros((3, 5)))
    assert "5×3 texels" in other.textures["poster"]
    assert "5×3 texels" in other.set("sampling.spp", 4).textures["poster"]
    with pytest.raises(TypeError, match="with_texture"):
        QUAD.textures["poster"] = np.zeros((3, 5))


@pytest.mark.parametrize(
    "image",
    [
        "a.png",
        None,
        np.zeros((2, 2, 5)),
        np.zeros((0, 2)),
        np.zeros(3),
        np.zeros((2, 2), int),
        np.zeros((2, 2), bool),
        [["a"]],
    ],
)
def test_what_is_no_image_is_refused(image):
    with pytest.raises(moire.SceneError, match="texture 'poster': expected"):
        QUAD.with_texture("poster", image)


def test_wrong_names_dimensions_and_values_are_refused(renderer):
    with pytest.raises(moire.SceneError, match="its textures are: poster"):
        QUAD.with_texture("postr", np.zeros((2, 2)))
    with pytest.raises(moire.SceneError, match="of dimension"):
        moire.Scene("@ramp").with_texture(next(iter(moire.Scene("@ramp").textures)), np.zeros((2, 2)))
    with pytest.raises(moire.OptionsError, match="color_space"):
        QUAD.with_texture("poster", np.zeros((2, 2)), color_space="sRGB")
    bad = QUAD.with_texture("poster", np.full((2, 2), np.nan))
    with pytest.raises(moire.FileError, match="NaN"):
        renderer.render(bad)
    renderer.render(bad, allow_nonfinite=True)
