"""Record Live: a rig follows a made stream over loopback, and the motion becomes an action."""

import socket
import threading
from itertools import count

import kinect_walks
import numpy as np
import pytest

RATE_HZ = 30.0
pytestmark = pytest.mark.timeout(900)


@pytest.fixture
def stream(load, port):
    """An actor who walks, again and again, until the test ends; frames arrive in real time."""
    motion, samples = load("solvers.motion"), load("solvers.samples")
    postures = load("solvers.motion.humanoid.posture_joints")
    live = load("solvers.recordings.live")
    walk = kinect_walks.tracked_walk(motion, kinect_walks.true_positions(samples, postures))
    frames = list(live.frames_from_recording(walk))
    ended = threading.Event()

    def send():
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            for number in count():
                frame = frames[number % len(frames)]
                line = live.encode_frame(
                    live.LiveFrame(
                        number / RATE_HZ, 0, frame.names, frame.positions, frame.confidence,
                        frame.states, frame.sensor,
                    )
                )  # fmt: skip
                sender.sendto(line, ("127.0.0.1", port))
                if ended.wait(1.0 / RATE_HZ):
                    return

    thread = threading.Thread(target=send)
    thread.start()
    yield
    ended.set()
    thread.join()


@pytest.fixture
def on_port(load, port, monkeypatch):
    live = load("mocap_assist.live.live_take")
    original = live.preferred
    monkeypatch.setattr(
        live, "preferred", lambda name: port if name == "live_port" else original(name)
    )


@pytest.fixture
def hero(blank, rigify_file):
    with blank.data.libraries.load(str(rigify_file), link=False) as (_, found):
        found.objects = ["Hero"]
    rig = found.objects[0]
    blank.context.scene.collection.objects.link(rig)
    return rig


@pytest.fixture
def rig(request, make_rig, blank):
    rig = make_rig("Mixamo") if request.param == "Mixamo" else request.getfixturevalue("hero")
    blank.context.view_layer.objects.active = rig
    rig.select_set(True)
    return rig


BONES = {
    "Mixamo": ("Hips", "Head", "LeftUpLeg", "LeftLeg"),
    "Rigify": ("DEF-spine", "DEF-spine.006", "DEF-thigh.L", "DEF-shin.L"),
}


@pytest.mark.parametrize("rig", ["Mixamo", "Rigify"], indirect=True)
def test_a_rig_follows_the_stream_and_gets_an_action(request, rig, blank, stream, on_port):
    found = blank.ops.mocap_assist.record_live(duration=1.0, calibration_s=1.0)
    assert found == {"FINISHED"}
    action = rig.animation_data.action
    assert action.name.startswith(f"{rig.name}.live")
    frames = [round(each) for each in action.frame_range]
    assert 12 < frames[1] - frames[0] < 300  # a busy machine skips frames

    names = BONES[request.node.callspec.params["rig"]]
    heads = []
    for frame in range(frames[0], frames[1] + 1):
        blank.context.scene.frame_set(frame)
        bones = rig.evaluated_get(blank.context.evaluated_depsgraph_get()).pose.bones
        heads.append([rig.matrix_world @ bones[name].head for name in names])
    hips, head, thigh, shin = np.array(heads).swapaxes(0, 1)
    assert ((head - hips)[:, 2] > 0.4).all()
    assert 0.6 < hips[:, 2].mean() < 1.2
    assert np.ptp((shin - thigh)[:, 1]) > 0.1  # the leg swings


@pytest.mark.parametrize("rig", ["Mixamo"], indirect=True)
def test_pose_is_restored_when_the_display_ends(rig, blank, load):
    live, solve = load("mocap_assist.live.live_take"), load("mocap_assist.live.solve_live_take")
    hips = rig.pose.bones["Hips"]
    hips.location = (0.1, 0.2, 0.3)
    before = hips.matrix_basis.copy()
    bones = solve.LiveBones(30.0, 1.0, ("Hips",), ("Hips",), ("Hips",))
    frame = solve.LiveFrameKeys(
        1, 0, np.array([[0.0, 1.0, 0.0, 0.0]]), np.ones((1, 3)), np.ones(1)
    )
    shown = live.LivePoses(rig, {})
    shown.show(blank.context.scene, rig, [bones, frame])
    assert tuple(hips.location) == (1.0, 1.0, 1.0)
    shown.close()
    np.testing.assert_allclose(np.array(hips.matrix_basis), np.array(before), atol=1e-6)


@pytest.mark.parametrize("rig", ["Mixamo"], indirect=True)
def test_without_a_window_a_duration_is_needed(rig, blank):
    with pytest.raises(RuntimeError, match="Set the duration"):
        blank.ops.mocap_assist.record_live()
    assert rig.animation_data is None or rig.animation_data.action is None
