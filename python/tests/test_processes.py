"""Threads, processes, copies."""

import copy
import multiprocessing
import os
import pickle
import subprocess
import sys
import threading

import numpy as np
import pytest

import moire

FORK = """
import multiprocessing, sys, moire
def work(queue):
    try:
        queue.put(float(moire.render("@quad", size=(8, 8)).array.sum()))
    except moire.UnsupportedError as error:
        queue.put(error)
    del globals()["renderer"]
renderer = moire.Renderer("cpu") if sys.argv[1] == "used" else None
context = multiprocessing.get_context("fork")
queue = context.Queue()
process = context.Process(target=work, args=(queue,))
process.start()
found = queue.get(timeout=30)
process.join(30)
print(process.exitcode, found, getattr(found, "help", ""))
"""


def forked(how):
    ran = subprocess.run([sys.executable, "-c", FORK, how], capture_output=True, text=True, timeout=60)
    assert ran.returncode == 0, ran.stderr
    return ran.stdout


def test_a_forked_process_renders_if_its_parent_has_not():
    assert forked("unused").startswith("0 ")


def test_a_process_forked_from_one_that_rendered_says_so_and_ends():
    said = forked("used")
    assert said.startswith("0 this process was forked") and "spawn" in said


def total(scene):
    return float(moire.render(scene, size=(8, 6), spp=1).array.sum())


def test_spawned_processes_render_scenes_that_are_sent(lecture):
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        scene = lecture.with_texture("grass", np.full((2, 2), 0.5))
        assert pool.map(total, [lecture, scene]) == [total(lecture), total(scene)]


def test_threads_share_a_renderer_or_have_their_own(renderer, lecture, device):
    expected = renderer.render(lecture, spp=16).array
    for renderers in [[renderer, renderer, renderer], [moire.Renderer(device), moire.Renderer(device)]]:
        found = [None] * len(renderers)

        def work(at, one, found=found):
            found[at] = one.render(lecture, spp=16).array

        threads = [threading.Thread(target=work, args=pair) for pair in enumerate(renderers)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for array in found:
            np.testing.assert_array_equal(array, expected)


def test_who_waits_for_another_thread_is_stopped_too(renderer, lecture):
    ended, begun = threading.Event(), threading.Event()

    def long():
        def progress(done):
            begun.set()
            return not ended.is_set()

        with pytest.raises(moire.Interrupted):
            renderer.render(lecture, spp=65536, size=(512, 512), pattern="random", progress=progress)

    thread = threading.Thread(target=long)
    thread.start()
    try:
        assert begun.wait(30)
        threading.Timer(0.1, os.kill, (os.getpid(), 2)).start()
        with pytest.raises(KeyboardInterrupt):
            renderer.render(lecture)
            threading.Event().wait(5)
        assert thread.is_alive()
    finally:
        ended.set()
        thread.join()


def test_a_closed_renderer_says_so(lecture, device):
    with moire.Renderer(device) as renderer:
        assert renderer.render(lecture).size == (64, 48)
    with pytest.raises(moire.OptionsError, match="closed"):
        renderer.render(lecture)
    renderer.close()
    with pytest.raises(TypeError, match="holds a device"):
        pickle.dumps(renderer)
    with pytest.raises(TypeError, match="holds a device"):
        copy.copy(renderer)


def test_scenes_pictures_and_errors_are_copied_and_pickled(renderer, lecture):
    scene = lecture.with_texture("grass", np.eye(3))
    for other in [copy.copy(scene), copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))]:
        assert repr(other) == repr(scene) and dict(other.textures) == dict(scene.textures)
    picture = renderer.render(scene, spp=1)
    other = pickle.loads(pickle.dumps(picture))
    np.testing.assert_array_equal(other.array, picture.array)
    assert other.record == picture.record and other.report == picture.report
    separate = copy.deepcopy(picture)
    separate.array[:] = 0
    assert picture.record is not None and separate.record is None
    error = pickle.loads(pickle.dumps(moire.FileError("what", "next step")))
    assert (type(error), str(error), error.help) == (moire.FileError, "what", "next step")
