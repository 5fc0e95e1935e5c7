"""Record Live: a rig follows a made stream over loopback, and the motion becomes an action."""

import socket
import threading
from types import SimpleNamespace

import kinect_walks
import numpy as np
import pytest

RATE_HZ = 30.0
pytestmark = pytest.mark.timeout(900)


@pytest.fixture
def sent(load):
    """What is sent: joints of a Kinect as JSON."""
    motion, samples = load("solvers.motion"), load("solvers.samples")
    postures = load("solvers.motion.humanoid.posture_joints")
    positions = kinect_walks.true_positions(samples, postures)
    return kinect_walks.tracked_walk(motion, positions), "JSON"


@pytest.fixture
def stream(load, port, sent):
    """An actor who walks, again and again, until the test ends; frames arrive in real time."""
    streams, (recording, protocol) = load("solvers.recordings.streams"), sent
    packets = streams.encode_recording(
        recording, streams.StreamProtocol[protocol], is_repeated=True
    )
    ended = threading.Event()

    def send():
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            for frame in packets:
                for datagram in frame.datagrams:
                    sender.sendto(datagram, ("127.0.0.1", port))
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
    monkeypatch.setattr(live, "live_port", lambda: port)


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
def test_a_rig_follows_the_stream_and_gets_an_action(
    request, rig, blank, load, stream, on_port
):
    found = blank.ops.mocap_assist.record_live(duration=1.5, calibration_s=1.0)
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
    check_contacts(load, rig, frames)


def check_contacts(load, rig, frames):
    """The feet of a walk come down and lift off, as detected: Plant Feet may detect again."""
    keys, data = load("mocap_assist.actions.contact_keys"), rig.animation_data
    channels = keys.contact_keys(data.action, data.action_slot)
    channels, others = channels[:2], channels[2:]  # of feet; of other parts
    assert len(others) == 5 and not any(map(len, others))
    for channel in channels:
        assert channel[[0, -1], 0] == pytest.approx(frames, abs=0.5)
    assert {value for channel in channels for value in channel[:, 1]} == {0.0, 1.0}
    assert keys.animators_contacts((data.action, data.action_slot), np.array(frames)) is None


@pytest.fixture
def walk(load):
    samples = load("solvers.samples")
    return samples.walking_gait(samples.GaitSettings(duration=2.0, frame_rate=RATE_HZ))


class TestBones:
    """A stream of bones is recorded as it is."""

    @pytest.fixture(params=["VMC", "XSENS"])
    def sent(self, request, walk):
        return walk, request.param

    @pytest.mark.parametrize("rig", ["Mixamo"], indirect=True)
    def test_knees_are_those_of_the_stream(self, rig, blank, load, walk, stream, on_port):
        found = blank.ops.mocap_assist.record_live(
            duration=1.5, calibration_s=1.0, hold_feet=False
        )

        assert found == {"FINISHED"}
        first, last = map(round, rig.animation_data.action.frame_range)
        heads = []
        for frame in range(first, last + 1):
            blank.context.scene.frame_set(frame)
            bones = rig.evaluated_get(blank.context.evaluated_depsgraph_get()).pose.bones
            names = ("LeftUpLeg", "LeftLeg", "LeftFoot")
            heads.append([rig.matrix_world @ bones[name].head for name in names])
        motion = load("solvers.motion")
        joints = motion.find_humanoid_map(walk.skeleton).indices(walk.skeleton)
        legs = [joints[role] for role in ("leftUpperLeg", "leftLowerLeg", "leftFoot")]
        true = knee_angles(motion.forward_kinematics(walk).positions[:, legs])
        recorded = knee_angles(np.array(heads))
        assert recorded.max() == pytest.approx(true.max(), abs=2.0)
        assert recorded.min() == pytest.approx(true.min(), abs=2.0)

    @pytest.mark.parametrize("rig", ["Mixamo"], indirect=True)
    @pytest.mark.parametrize("sent", ["VMC"], indirect=True)
    def test_knees_stay_within_their_constraints(self, rig, blank, stream, on_port):
        knee = rig.pose.bones["LeftLeg"]
        limit = knee.constraints.new("LIMIT_ROTATION")
        limit.owner_space, limit.use_limit_x = "LOCAL", True
        limit.min_x, limit.max_x = np.radians([-10.0, 10.0])

        blank.ops.mocap_assist.record_live(duration=1.5, calibration_s=1.0)

        bends = []
        first, last = map(round, rig.animation_data.action.frame_range)
        for frame in range(first, last + 1):
            blank.context.scene.frame_set(frame)
            bends.append(abs(knee.matrix_basis.to_euler().x))
        assert np.radians(10.0) < max(bends) < np.radians(15.1)


@pytest.mark.parametrize("rig", ["Mixamo"], indirect=True)
def test_feet_begin_again_with_another_actor(rig, blank, load, walk):
    """The first pose of another body is as captured, as nothing of it is held yet."""
    solve, target_read = (
        load("mocap_assist.live.solve_live_rig"),
        load("mocap_assist.rigs.target_read"),
    )
    workflows = load("solvers.workflows.live.live_motion")
    limbs = load("mocap_assist.rigs.control_plan").Limbs
    roles = target_read.find_roles(rig)
    target, _ = target_read.read_target(blank.context.scene, rig, roles, limbs.FK, False)

    def recorded(last_body, **choices):
        live = solve.LiveRig(
            target, solve.LiveRigChoices(**choices), walk.slice(0, 30), (), 1.0
        )
        for frame in range(30, 41):
            body = last_body if frame == 40 else 3
            motion = walk.slice(frame, frame + 1)
            keys = live.keys(workflows.LiveMotion(frame - 29, motion, None, body), 0)
        return keys.rotations

    captured = recorded(3, hold_feet=False)
    assert np.abs(recorded(3) - captured).max() > 1e-3
    np.testing.assert_array_equal(recorded(4), captured)


def knee_angles(legs):
    """Degrees between thigh and shin, for hip, knee and ankle in each frame."""
    thigh, shin = np.diff(legs, axis=1).swapaxes(0, 1)
    cosines = (thigh * shin).sum(axis=1)
    lengths = np.linalg.norm(thigh, axis=1) * np.linalg.norm(shin, axis=1)
    return np.degrees(np.arccos(cosines / lengths))


@pytest.mark.parametrize("rig", ["Mixamo"], indirect=True)
def test_pose_is_restored_when_the_display_ends(rig, blank, load):
    live, solve = load("mocap_assist.live.live_take"), load("mocap_assist.live.solve_live_rig")
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


@pytest.mark.parametrize(("duration_s", "fraction"), [(2.0, 0.25), (0.5, 1.0), (0.0, 1.0)])
def test_progress_is_the_recorded_fraction_of_the_duration(load, duration_s, fraction):
    solve = load("mocap_assist.live.solve_live_take")
    recorder = solve._Recorder(SimpleNamespace(duration_s=duration_s), print)
    recorder._rig, recorder._n_frames = SimpleNamespace(frame_rate=RATE_HZ), 15

    assert recorder.recorded_fraction == fraction
    assert recorder.is_done is (duration_s == 0.5)


@pytest.mark.parametrize("rig", ["Mixamo"], indirect=True)
def test_without_a_window_a_duration_is_needed(rig, blank, load):
    with pytest.raises(RuntimeError, match="Set the duration"):
        blank.ops.mocap_assist.record_live()
    press = load("mocap_assist.blender.last_press").last_press()
    assert "Set the duration" in press.sentence
    assert rig.animation_data is None or rig.animation_data.action is None
