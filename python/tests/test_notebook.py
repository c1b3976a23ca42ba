"""The notebook of the lecture runs, from its first cell to its last; what it claims it asserts itself."""

import os
import pathlib
import subprocess
import sys

FOLDER = pathlib.Path(__file__).parent.parent / "notebooks"


def test_the_lecture_runs(tmp_path, device):
    environment = {**os.environ, "MOIRE_DEVICE": device, "MPLBACKEND": "Agg"}
    command = [sys.executable, str(FOLDER / "run.py"), str(FOLDER / "lecture.ipynb")]
    ran = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    assert "cells ran" in ran.stdout
