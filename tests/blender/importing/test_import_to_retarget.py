"""From a file of any kind to the production rig: Import, Clean, Retarget."""

import numpy as np
import pytest

FRAMES = (10, 20, 30, 40)
N_LINES = {"mocap/05_13.amc": 7203, "kinect/kimore/JointPositionExercise1.csv": 114}
"""Lines of the first 240 frames at 120 Hz, and of the first 90 at 30 Hz, of long takes."""


@pytest.fixture
def c3d(recordings, load, tmp_path):
    """Two seconds of a dancer with the CMU set, at 30 Hz."""
    files = load("solvers.recordings")
    take = files.read_recording(recordings / "mocap" / "05_13.c3d")
    few = load("solvers.motion").Tracks(
        take.names[:41], take.positions[:240:4, :41], take.frame_rate / 4
    )
    files.write_c3d(few, tmp_path / "dance.c3d")
    files.write_trc(few, tmp_path / "dance.trc")
    return tmp_path / "dance.c3d"


def beginning(path, n_lines, folder):
    """Write the first lines of a file, and give it the skeleton next to it."""
    for skeleton in path.parent.glob("*.asf"):
        (folder / skeleton.name).write_bytes(skeleton.read_bytes())
    lines = path.read_bytes().splitlines(keepends=True)
    (folder / path.name).write_bytes(b"".join(lines[:n_lines]))
    return folder / path.name


@pytest.mark.parametrize(
    "file",
    [
        "mocap/cmu_walk/07_01.bvh",
        "mocap/05_13.amc",
        "kinect/msr_action3d/a01_s01_e01_skeleton3D.txt",
        "kinect/irds/215_18_1_4_2_stand.txt",
        "kinect/kimore/JointPositionExercise1.csv",
        "kinect/azure/joints_sync_1.csv",
        "dance.c3d",
        "dance.trc",
    ],
)
def test_a_dropped_file_ends_on_the_rig(
    file, recordings, c3d, bring, make_rig, blank, tmp_path
):
    path = recordings / file if "/" in file else c3d.with_name(file)
    if file in N_LINES:
        path = beginning(path, N_LINES[file], tmp_path)
    made = bring(path, frame_rate="UPDATE")
    if made.type == "EMPTY":
        blank.ops.mocap_assist.solve_skeleton()
        made = blank.context.object
    rig = make_rig("Mixamo", scale=0.01, prefix="mixamorig:")
    blank.context.view_layer.objects.active = made

    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}
    assert blank.ops.mocap_assist.retarget(target=rig.name) == {"FINISHED"}

    assert made.animation_data.action.name.endswith(".clean")
    lifted = []
    for frame in FRAMES:
        blank.context.scene.frame_set(frame)
        pose = rig.evaluated_get(blank.context.evaluated_depsgraph_get()).pose.bones
        head, hips = (
            rig.matrix_world @ pose[f"mixamorig:{name}"].head for name in ("Head", "Hips")
        )
        lifted.append(np.array(head - hips))
    assert np.isfinite(lifted).all()
    assert (np.array(lifted)[:, 2] > 0.3).all()  # upright, as all of these actors are
