"""The demo must say in a sentence why it cannot start; `make demo` shows that it can."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

DEMO = Path(__file__).parents[1] / ".ci" / "demo.py"


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ([], "Usage: python .ci/demo.py OUTPUT_FOLDER [CLIP.bvh]"),
        (["out", "lost.bvh"], "Give CLIP the path of a BVH file."),
        (["out"], "MOCAP_ASSIST_ZIP must name the extension's zip; see `make demo`."),
    ],
)
def test_demo_reports_why_it_cannot_start(arguments, sentence, tmp_path):
    environment = {**os.environ, "MOCAP_ASSIST_ZIP": str(tmp_path / "none.zip")}
    command = [sys.executable, str(DEMO), *arguments]

    done = subprocess.run(
        command, capture_output=True, text=True, cwd=tmp_path, env=environment, check=False
    )

    assert done.returncode == 1
    assert sentence in done.stderr
    assert "Traceback" not in done.stderr
