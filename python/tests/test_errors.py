"""Errors are exceptions with kinds, and work is cancelled."""

import math
import os
import signal
import subprocess
import sys
import threading
import time

import pytest

import moire

LONG = {"spp": 65536, "pattern": "random", "size": (512, 512)}


@pytest.mark.parametrize(
    "kind, said, work",
    [
        (moire.SceneError, "sampling.spp", lambda: moire.Scene("@lecture", set={"sampling.spp": -1})),
        (moire.SceneError, "scene.toml:1", lambda: moire.Scene.from_toml("[camera")),
        (moire.FileError, "@lecture", lambda: moire.Scene("@lectrue")),
        (moire.FileError, "none.toml", lambda: moire.Scene("none.toml")),
        (moire.FileError, "none.png", lambda: moire.compare("none.png", "none.png")),
        (moire.OptionsError, "KEY=VALUE", lambda: moire.Scene("@lecture", set={"": 1})),
        (moire.OptionsError, 'did you mean "sobol-owen"', lambda: moire.render("@lecture", pattern="sobol-owe")),
        (moire.OptionsError, "size", lambda: moire.render("@lecture", size=(0, 8))),
        (moire.OptionsError, "whole number", lambda: moire.render("@lecture", spp=-1)),
        (moire.OptionsError, "above 0", lambda: moire.render("@lecture", budget=0)),
        (moire.OptionsError, "both", lambda: moire.render("@lecture", budget=1, target_error=1)),
        (moire.OptionsError, "crop", lambda: moire.render("@lecture", crop=(500, 0, 100, 8))),
        (moire.OptionsError, "depth", lambda: moire.aov("@lecture", "dept")),
        (moire.OptionsError, "methods", lambda: moire.study("@lecture", methods="no")),
        (moire.NoDeviceError, "no such device", lambda: moire.Renderer("no such device")),
        (moire.SceneError, "finite", lambda: moire.Scene("@lecture", set={"camera.vertical_fov": math.nan})),
        (moire.SceneError, "one table", lambda: moire.Scene.from_dict({"camera": 5})),
        (moire.FileError, "is a folder", lambda: moire.render("/")),
        (moire.FileError, "NUL", lambda: moire.render("a\0b")),
        (moire.FileError, "none.exr", lambda: moire.study("@lecture", methods="grid", reference="none.exr")),
        (moire.FileError, "folder", lambda: moire.study("@lecture", methods="grid", out="/none/study")),
        (moire.OptionsError, "camera: @lecture", lambda: moire.Scene("@lecture", camera=3)),
        (moire.OptionsError, "crop 0,0,0,0", lambda: moire.render("@lecture", crop=(0, 0, 0, 0))),
        (moire.OptionsError, "spp: spp = 0", lambda: moire.render("@lecture", spp=0)),
        (moire.OptionsError, "whole number", lambda: moire.render("@lecture", spp=10**30)),
        (moire.OptionsError, "whole number", lambda: moire.render("@lecture", spp="4")),
        (moire.OptionsError, "whole number", lambda: moire.render("@lecture", spp=math.nan)),
        (moire.OptionsError, "16384", lambda: moire.render("@lecture", size=(10**6, 10**6))),
        (moire.OptionsError, "width, height", lambda: moire.render("@lecture", size=(-1, 5))),
        (moire.OptionsError, "width, height", lambda: moire.render("@lecture", size="8x8")),
        (moire.OptionsError, "above 0", lambda: moire.render("@lecture", budget=math.nan)),
        (moire.OptionsError, "no unit", lambda: moire.render("@lecture", budget="50 parsecs")),
        (moire.OptionsError, "True or False", lambda: moire.render("@lecture", shared="yes")),
        (moire.OptionsError, "no device", lambda: moire.study("@lecture", device="oracle")),
        (moire.OptionsError, "numbers from 1", lambda: moire.study("@lecture", spp=[0])),
        (TypeError, "a moire.Scene or a path", lambda: moire.render(None)),
        (TypeError, "a moire.Scene or a path", lambda: moire.render(5)),
        (TypeError, "a dictionary", lambda: moire.Scene("@lecture", set="sampling.spp=3")),
        (TypeError, "a dictionary", lambda: moire.Scene("@lecture", textures=[1])),
        (TypeError, "a dictionary", lambda: moire.Scene.from_dict(None)),
        (TypeError, "the text", lambda: moire.Scene.from_toml(None)),
        (TypeError, "a function", lambda: moire.render("@lecture", progress=5)),
        (TypeError, "a name, an index", lambda: moire.Renderer(1.5)),
        (TypeError, "unexpected", lambda: moire.render("@lecture", samples=1)),
        (TypeError, "unexpected", lambda: moire.aov("@lecture", "depth", samples=1)),
        (moire.OptionsError, "height", lambda: moire.compare([[[1.0]]], [[[1.0]]])),
    ],
)
def test_errors_have_kinds(kind, said, work):
    with pytest.raises(kind) as caught:
        work()
    assert said in str(caught.value)
    assert type(caught.value) is kind


def test_every_kind_is_an_error_with_help():
    with pytest.raises(moire.Error) as caught:
        moire.Scene("@lectrue")
    assert "moire new --list" in caught.value.help
    assert not caught.value.is_transient
    assert moire.DeviceLostError("lost").is_transient


def test_kinds_are_those_of_python_too():
    with pytest.raises(ValueError, match="size"):
        moire.render("@lecture", size=(0, 0))
    with pytest.raises(ValueError, match="spp"):
        moire.Scene("@lecture", set={"sampling.spp": -1})
    assert issubclass(moire.OutOfHostMemoryError, MemoryError)


def test_progress_rises_to_the_end(renderer, lecture):
    told = []
    renderer.render(lecture, spp=64, size=(256, 256), progress=told.append)
    assert told == sorted(told) and told[-1] == 1.0


def test_a_callback_cancels(renderer, lecture):
    with pytest.raises(moire.Interrupted):
        renderer.render(lecture, progress=lambda done: False, **LONG)

    def fails(done):
        raise LookupError("planted")

    with pytest.raises(LookupError, match="planted"):
        renderer.render(lecture, progress=fails, **LONG)
    assert renderer.render(lecture).size == (64, 48)


def test_ctrl_c_is_a_keyboard_interrupt(renderer, lecture):
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        renderer.render(lecture, **LONG)
    assert time.monotonic() - begun < 20


def test_other_threads_run_meanwhile(renderer, lecture):
    counted = []
    ended = threading.Event()

    def count():
        while not ended.wait(0.005):
            counted.append(1)

    thread = threading.Thread(target=count)
    thread.start()
    renderer.render(lecture, spp=64, size=(512, 512))
    ended.set()
    thread.join()
    assert len(counted) > 3


def test_the_program_is_there_with_its_exit_codes(tmp_path):
    run = lambda *words: subprocess.run([sys.executable, "-m", "moire", *words], capture_output=True, text=True)
    assert moire.__version__ in run("--version").stdout
    failed = run("render", "none.toml")
    assert failed.returncode == 2 and "none.toml" in failed.stderr
    assert "lecture" in run("new", "--list").stdout


def test_ctrl_c_ends_the_program_with_130(device, tmp_path):
    words = ["render", "@lecture", "--spp", "65536", "--pattern", "random", "--device", device, "-o", "a.png"]
    running = subprocess.Popen([sys.executable, "-m", "moire", *words], cwd=tmp_path)
    time.sleep(2)
    running.send_signal(signal.SIGINT)
    assert running.wait(timeout=60) == 130
    assert list(tmp_path.iterdir()) == []


def test_warnings_name_the_line_that_renders(renderer, lecture):
    options = {"filter": "ewa", "footprint": "none", "size": (8, 6)}
    for render in [renderer.render, moire.render]:
        with pytest.warns(moire.RenderWarning, match="has no effect") as caught:
            render(lecture, **options)
        assert caught[0].filename == __file__
