"""Tables with words in some columns, and with times of any clock, come in as a body."""

import numpy as np
import pytest

F = 60
JOINTS = {
    f"{part}{side.title()}": side + role
    for side in ("left", "right")
    for part, role in {
        "Shoulder": "UpperArm", "Elbow": "LowerArm", "Wrist": "Hand", "Hip": "UpperLeg",
        "Knee": "LowerLeg", "Ankle": "Foot",
    }.items()
}  # fmt: skip


@pytest.fixture(scope="module")
def walk(walker):
    """Positions of joints, shape (F, 12, 3), meters, Z up."""
    return np.stack([walker[role][:F] for role in JOINTS.values()], axis=1)


@pytest.mark.parametrize(("unit", "step"), [
    ("milliseconds", 16.6667), ("microseconds", 16_666.7), ("ticks of 100 ns", 166_667.0),
    ("nanoseconds", 16_666_667.0),
])  # fmt: skip
def test_times_of_any_clock_give_the_rate(read_any, collected_messages, walk, unit, step):
    """Read as seconds, ticks of Windows are 0.006 frames per second, which is refused."""
    messages, progress = collected_messages
    titles = [f"{name}_{axis}" for name in JOINTS for axis in "xyz"]
    rows = [",".join([str(step * k), *map(str, walk[k].flat)]) for k in range(F)]

    recording = read_any("\n".join([",".join(["time", *titles]), *rows]), progress=progress)

    assert recording.tracks.frame_rate == pytest.approx(60.0, rel=1e-3)
    assert any(f"interpreted as {unit}" in message for message in messages)


@pytest.mark.parametrize("is_long", [False, True])
def test_words_in_other_columns_are_left_out(read_any, walk, is_long):
    """A Kinect's tables state whether each joint is tracked."""
    if is_long:
        lines = ["Timestamp,TrackingId,JointType,TrackingState,X,Y,Z"] + [
            f"{k / 30},7205759,{name},{'Inferred' if k % 7 else 'Tracked'}"
            + ",{},{},{}".format(*walk[k, joint])
            for k in range(F) for joint, name in enumerate(JOINTS)
        ]  # fmt: skip
    else:
        titles = [f"{name}_{part}" for name in JOINTS for part in ("X", "Y", "Z", "State")]
        lines = [",".join(["Time", *titles])] + [
            ",".join([str(k / 30)] + ["{},{},{},Tracked".format(*p) for p in walk[k]])
            for k in range(F)
        ]

    recording = read_any("\n".join(lines))

    assert recording.tracks.n_frames == F
    assert not np.isnan(recording.tracks.positions).any()
