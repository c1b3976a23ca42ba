"""Pictures as files and arrays: records by which the program makes them again, display options, 8 bits."""

import subprocess
import sys

import numpy as np
import pytest

import moire

FORMATS = ["png", "jpg", "exr", "tif", "hdr"]


def moire_render(*words):
    return subprocess.run([sys.executable, "-m", "moire", "render", *words], capture_output=True, text=True)


@pytest.fixture(scope="module")
def picture(renderer, lecture):
    return renderer.render(lecture, seed=5, filter="nearest", crop=(8, 4, 40, 30))


@pytest.mark.parametrize("ending", FORMATS)
def test_the_program_makes_a_saved_picture_again(picture, tmp_path, ending):
    path, again = tmp_path / f"a.{ending}", tmp_path / f"again.{ending}"
    options = {"exposure": 0.5, "white_balance": 5000, "tone_map": "agx", "jpeg_quality": 90}
    if ending in ["exr", "hdr"]:
        with pytest.warns(moire.RenderWarning, match="^exposure, white_balance, tone_map: no effect"):
            picture.save(path, **options)
    else:
        picture.save(path, **options)
    ran = moire_render("--from", str(path), "-o", str(again), "-q")
    assert ran.returncode == 0, ran.stderr
    assert again.read_bytes() == path.read_bytes()


def test_a_record_has_scene_settings_seed_and_version(picture, tmp_path):
    picture.save(tmp_path / "a.png", exposure=0.5)
    record = moire.read_record(tmp_path / "a.png")
    assert record["version"] == moire.__version__ and record["scene"]["path"] == "@lecture"
    assert "[camera]" in record["scene"]["text"] and record["settings"]["seed"] == 5
    assert {"--seed=5", "--set=sampling.spp=4", "--crop=8,4,40,30", "--exposure=0.5"} <= set(record["options"])
    assert {*picture.record["options"], "--exposure=0.5"} == set(record["options"])


def test_records_of_texts_name_cameras_and_goals(tmp_path):
    text = "[camera]\neye=[0,0,3]\nlook_at=[0,0,0]\nvertical_fov=40\n"
    text += "[image]\nwidth=8\nheight=8\n"
    text += '[[material]]\nname="m"\nmodel="unlit"\n[[sphere]]\ncenter=[0,0,0]\nradius=1\nmaterial="m"\n'
    picture = moire.render(moire.Scene.from_toml(text), budget="20ms", device="oracle", shared=False)
    picture.save(tmp_path / "a.png")
    record = moire.read_record(tmp_path / "a.png")
    assert record["scene"]["text"] == text
    assert {"--budget=0.02", "--device=oracle", "--shared=false"} <= set(record["options"])
    assert moire_render("--from", str(tmp_path / "a.png"), "-o", str(tmp_path / "b.png"), "-q").returncode == 0


def test_what_was_not_rendered_so_has_no_record(picture, tmp_path):
    picture.save(tmp_path / "a.png", metadata=False)
    assert moire.read_record(tmp_path / "a.png") is None
    edited = moire.Picture(picture.array.copy())
    edited.save(tmp_path / "a.png")
    assert moire.read_record(tmp_path / "a.png") is None and edited.record is None
    for place in [(0, 0, 0), (29, 39, 2), (13, 7, 1)]:
        kept = picture.array[place]
        picture.array[place] = kept + 0.25
        assert picture.record is None
        picture.save(tmp_path / "a.png")
        assert moire.read_record(tmp_path / "a.png") is None
        picture.array[place] = kept
        assert picture.record is not None


def test_a_picture_of_an_array_is_not_made_again_without_it(renderer, lecture, tmp_path):
    (tmp_path / "scene.toml").write_text(lecture_text(), encoding="utf-8")
    scene = moire.Scene(tmp_path / "scene.toml", textures={"grass": np.zeros((2, 2))})
    renderer.render(scene, size=(8, 6), spp=1).save(tmp_path / "a.png")
    ran = moire_render("--from", str(tmp_path / "a.png"), "-o", str(tmp_path / "b.png"))
    assert ran.returncode == 2 and '"grass" was an array' in ran.stderr
    assert not (tmp_path / "b.png").exists()


def lecture_text():
    return moire.render("@lecture", size=(4, 4), spp=1).record["scene"]["text"]


def test_a_picture_does_not_replace_what_it_is_made_of(renderer, tmp_path):
    moire.Picture(np.full((4, 4), 0.5)).save(tmp_path / "texture.png")
    text = "[camera]\neye=[0,0,3]\nlook_at=[0,0,0]\nvertical_fov=40\n[image]\nwidth=8\nheight=8\n"
    text += '[[texture]]\nname="own"\nfile="texture.png"\ncolor_space="srgb"\n'
    text += '[[material]]\nname="own"\nmodel="unlit"\ntexture="own"\n'
    text += '[[sphere]]\ncenter=[0,0,0]\nradius=1\nmaterial="own"\n'
    (tmp_path / "scene.toml").write_text(text)
    before = (tmp_path / "texture.png").read_bytes()
    with pytest.raises(moire.OptionsError, match='the file of texture "own"'):
        renderer.render(tmp_path / "scene.toml").save(tmp_path / "texture.png")
    assert (tmp_path / "texture.png").read_bytes() == before


def test_files_appear_complete_or_not_at_all(picture, tmp_path):
    for options in [{"jpeg_quality": 0}, {"png_bits": 9}, {"exposure": np.nan}, {"tone_map": "age"}]:
        with pytest.raises(moire.OptionsError):
            picture.save(tmp_path / "a.png", **options)
    with pytest.raises(moire.FileError, match="ending .xyz"):
        picture.save(tmp_path / "a.xyz")
    with pytest.raises(TypeError, match="unexpected"):
        picture.save(tmp_path / "a.png", quality=3)
    assert list(tmp_path.iterdir()) == []


def test_8_bits_are_those_of_a_png_file(picture, tmp_path):
    shown = picture.srgb(exposure=1, tone_map="filmic")
    assert shown.dtype == np.uint8 and shown.shape == picture.array.shape
    picture.save(tmp_path / "a.png", exposure=1, tone_map="filmic")
    np.testing.assert_array_equal(moire.Picture(shown).array, moire.Picture.open(tmp_path / "a.png").array)
    assert moire.Picture([[-1.0, 0.0, 0.5, 1.0, 9.0]]).srgb()[0, :, 1].tolist() == [0, 0, 188, 255, 255]


def test_arrays_are_plain_and_their_own(picture):
    array = picture.array
    assert array.dtype == np.float32 and array.flags.c_contiguous and array.flags.writeable and array.flags.aligned
    for wrong in [None, "a.png", np.zeros((0, 0, 3)), np.zeros((2, 2, 4)), np.zeros((2, 2), complex), [["a"]]]:
        with pytest.raises(moire.OptionsError, match="a picture is an array"):
            moire.Picture(wrong)
    assert np.asarray(moire.Picture([[1, 2]])).shape == (1, 2, 3)
    fortran = np.asfortranarray(array[:, ::-1])
    np.testing.assert_array_equal(moire.Picture(fortran).array, fortran)
