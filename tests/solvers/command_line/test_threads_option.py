"""The same bytes come out whatever the environment says of threads, and however many jobs."""

import json

import pytest
from kinect_walks import tracked_walk, true_positions

from solvers import motion, samples
from solvers.motion.humanoid import posture_joints
from solvers.processes.threads import VARIABLES
from solvers.recordings import write_bvh, write_joints


@pytest.fixture
def takes(tmp_path):
    """Two takes for each verb."""
    folder = tmp_path / "takes"
    for seed in range(2):
        gait = samples.GaitSettings(duration=4.0, frame_rate=60.0)
        noise = samples.CorruptionSettings(jitter=3.0, seed=seed)
        walk = samples.corrupt(samples.walking_gait(gait), noise)
        kinect = tracked_walk(motion, true_positions(samples, posture_joints), seed=seed)
        for position in ("denoise", "reconstruct"):
            (folder / position).mkdir(parents=True, exist_ok=True)
        write_bvh(walk, folder / "denoise" / f"take{seed}.bvh")
        write_joints(kinect, folder / "reconstruct" / f"take{seed}.csv")
    return folder


@pytest.fixture
def solved(start, takes, tmp_path, monkeypatch):
    """Solve the first take, or both in workers; return bytes and figures of the first."""

    def solve(verb, n_threads, *options):
        for name in VARIABLES:
            monkeypatch.setenv(name, str(n_threads))
        (source, *_) = sorted((takes / verb).iterdir())
        target = tmp_path / f"made {n_threads} {len(options)}" / "take0.bvh"
        target.parent.mkdir()
        positions = (source, target)
        if "--jobs" in options:
            positions = (takes / verb, "--output-folder", target.parent)
        done = start(verb, *positions, "--json", *options)
        assert (done.returncode, done.stderr) == (0, "")
        lines = [json.loads(line) for line in done.stdout.splitlines()]
        (figures,) = [line for line in lines if line["input"] == str(source)]
        return target.read_bytes(), {**figures, "output": ""}

    return solve


@pytest.mark.parametrize("verb", ["denoise", "reconstruct"])
def test_output_does_not_depend_on_thread_variables(verb, solved):
    """Figures too: they show differences that are too small for the digits of a file."""
    alone = solved(verb, 1)

    assert solved(verb, 2) == alone
    assert solved(verb, 2, "--jobs", "2") == alone
