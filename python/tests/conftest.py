"""The device under test is a CPU driver unless ``MOIRE_DEVICE`` names another."""

import os

import pytest

import moire


@pytest.fixture(scope="session")
def device():
    return os.environ.get("MOIRE_DEVICE", "cpu")


@pytest.fixture(scope="session")
def renderer(device):
    return moire.Renderer(device)


@pytest.fixture(scope="session")
def lecture():
    return moire.Scene("@lecture", set={"image.width": 64, "image.height": 48, "sampling.spp": 4})
