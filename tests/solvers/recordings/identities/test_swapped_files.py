"""Every format with several people has the same content however its tracker swapped them."""

import json

import numpy as np
import pytest
from exports.swapped_people import NAMES, RATE_HZ, line, observed, person
from joint_files import azure_json, azure_lines, npy, ntu
from numpy.testing import assert_array_equal

from solvers.motion import SENSOR_JOINTS, Sensor
from solvers.motion.skeletons import NUITRACK, ZED_BODIES
from solvers.progress import collect_remarks, unwatched
from solvers.recordings import open_bodies

N = 80
RIGHT = {"anna": "1", "ben": "2"}
SWAPPED = {"anna": "2", "ben": "1"}
SWITCHES = "Identity switches"


def people(names=NAMES):
    """Return x, y, z of the joints with these names, to 0.1 mm, Y up; hips for others."""
    walkers = {
        "anna": person(line((-0.9, 0.0), (-0.8, 0.8), N), 0.0, 1),
        "ben": person(line((0.9, 0.5), (0.8, 0.0), N), 0.4, 2),
    }
    columns = [NAMES.index(name) if name in NAMES else 0 for name in names]
    return {
        who: (joints[:, columns][..., [0, 2, 1]] * (1, 1, -1) + (0, 0, 3)).round(4)
        for who, joints in walkers.items()
    }


def frames_of(given, names=NAMES):
    return observed(people(names), given)


def with_state(frames, unit=1.0):
    return [
        {
            key: np.pad(unit * joints, ((0, 0), (0, 1)), constant_values=2)
            for key, joints in each.items()
        }
        for each in frames
    ]


def ntu_file(given):
    return ntu(with_state(frames_of(given)))


def azure_json_file(given):
    names = SENSOR_JOINTS[Sensor.AZURE_KINECT]
    frames = [
        {int(key): joints for key, joints in each.items()}
        for each in with_state(frames_of(given, names), 1e3)
    ]
    return azure_json(frames)


def azure_table(given):
    return azure_lines(with_state(frames_of(given, SENSOR_JOINTS[Sensor.AZURE_KINECT]), 1e3))


def irds(given):
    lines = ["Version0.1"]
    for number, frame in enumerate(frames_of(given)):
        for key, joints in frame.items():
            texts = (
                f"({name},Tracked,{x},{y},{z},191.7,205.5)"
                for name, (x, y, z) in zip(NAMES, joints, strict=True)
            )
            lines.append(f"{number},{key},{33 * number}," + ",".join(texts))
    return "\r\n".join(lines)


def zed(given):
    frames = {
        str(int(1e3 + 1e3 * number / RATE_HZ)): {
            "timestamp": int(1e9 + 1e9 * number / RATE_HZ),
            "body_list": [
                {"id": int(key), "keypoint": joints.tolist()} for key, joints in frame.items()
            ],
        }
        for number, frame in enumerate(frames_of(given, ZED_NAMES))
    }
    return json.dumps(frames)


ZED_NAMES = [
    {"Pelvis": "SpineBase"}.get(name, name) for name in next(iter(ZED_BODIES.values()))
]


def nuitrack(given):
    titles = [f"JOINT_{joint}.{axis}" for joint in NUITRACK for axis in "xyz"]
    lines = [",".join(["timestamp", "id", *titles])]
    for number, frame in enumerate(frames_of(given, [*NUITRACK.values()])):
        for key, joints in sorted(frame.items()):
            cells = ",".join(map(str, joints.ravel()))
            lines.append(f"{1000000 + 33333 * number},{key},{cells}")
    return "\n".join(lines)


def json_people(given):
    return json.dumps([
        {"time": number / RATE_HZ,
         "people": [{"id": key, "joints": dict(zip(NAMES, joints.tolist(), strict=True))}
                    for key, joints in sorted(frame.items())]}
        for number, frame in enumerate(frames_of(given))
    ])  # fmt: skip


def json_lists(given):
    return json.dumps([
        {"people": [{"joints": dict(zip(NAMES, joints.tolist(), strict=True))}
                    for _, joints in sorted(frame.items())]}
        for frame in frames_of(given)
    ])  # fmt: skip


def long_lines(given):
    lines = ["frame,person,joint,x,y,z"]
    for number, frame in enumerate(frames_of(given)):
        for key, joints in sorted(frame.items()):
            lines += [
                f"{number},{key},{name},{x},{y},{z}"
                for name, (x, y, z) in zip(NAMES, joints, strict=True)
            ]
    return "\n".join(lines)


def wide_table(given):
    titles = [f"p{key}:{name}_{axis}" for key in "12" for name in NAMES for axis in "xyz"]
    lines = [",".join(titles)]
    lines += [
        ",".join(str(each) for key in "12" for each in frame[key].ravel())
        for frame in frames_of(given)
    ]
    return "\n".join(lines)


def array(given):
    names = SENSOR_JOINTS[Sensor.KINECT_V2]
    frames = frames_of(given, names)
    return npy(np.array([[frame[key] for frame in frames] for key in "12"]))


def own_json(given):
    header = {
        "format": "mocap-assist-joints", "version": 1, "frame_rate": 30.0, "units": "m",
        "up": "z", "sensor": "other", "joints": [f"p{key}:{n}" for key in "12" for n in NAMES],
    }  # fmt: skip
    frames = [
        {"positions": [position for key in "12" for position in frame[key].tolist()]}
        for frame in frames_of(given)
    ]
    return json.dumps(header | {"frames": frames})


WRITERS = [
    ntu_file, azure_json_file, azure_table, irds, zed, nuitrack, json_people, json_lists,
    long_lines, wide_table, array, own_json,
]  # fmt: skip


def read_all(path, content):
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    remarks = []
    progress = collect_remarks(unwatched, remarks)
    bodies = open_bodies(path, progress=progress)
    recordings = [bodies.read(index, progress) for index in range(len(bodies.listed))]
    return bodies, recordings, remarks


@pytest.mark.parametrize("write", WRITERS)
def test_swaps_change_nothing(tmp_path, write):
    suffix = ".npy" if write is array else ".txt"
    swapped = [RIGHT] * 30 + [SWAPPED] * 20 + [RIGHT] * 10 + [SWAPPED] * 20

    right, expected, quiet = read_all(tmp_path / f"right{suffix}", write([RIGHT] * N))
    bodies, found, remarks = read_all(tmp_path / f"swapped{suffix}", write(swapped))

    assert len(expected) == 2 and bodies.listed == right.listed
    for one, other in zip(expected, found, strict=True):
        assert one.tracks.names == other.tracks.names
        assert_array_equal(one.tracks.positions, other.tracks.positions)
    assert not [each for each in quiet if SWITCHES in each]
    (sentence,) = [each for each in remarks if SWITCHES in each]
    assert ": 3 (" in sentence


def test_the_report_states_when(tmp_path):
    _, _, remarks = read_all(tmp_path / "take.json", json_people([RIGHT] * 30 + [SWAPPED] * 50))

    assert "Identity switches of the tracker, undone: 1 (1.00 s)" in remarks


def test_the_report_lists_the_first_of_many_swaps(tmp_path):
    given = [(RIGHT, SWAPPED)[frame // 10 % 2] for frame in range(N)]

    _, _, remarks = read_all(tmp_path / "take.json", json_people(given))

    (sentence,) = [each for each in remarks if SWITCHES in each]
    assert sentence.endswith(": 7 (0.33 s, 0.67 s, 1.00 s, 1.33 s, 1.67 s, ...)")


def test_a_person_found_again_is_one_body(tmp_path):
    given = [RIGHT] * 30 + [{"ben": "2"}] * 5 + [{"anna": "7", "ben": "2"}] * 45

    bodies, (anna, _), remarks = read_all(tmp_path / "take.skeleton", ntu_file(given))

    assert [body.n_frames for body in bodies.listed] == [75, 80]
    assert np.isfinite(anna.tracks.positions).all(axis=(1, 2)).sum() == 75
    assert "People who were lost and have a new identity: 7 = 1 (1.17 s)" in remarks


def test_swapped_joints_keep_their_states(tmp_path):
    head = NAMES.index("Head")
    frames = with_state(frames_of([RIGHT] * 30 + [SWAPPED] * 50))
    for number, frame in enumerate(frames):
        frame["1" if number < 30 else "2"][head, 3] = 1  # inferred, of Anna

    _, (anna, ben), _ = read_all(tmp_path / "take.skeleton", ntu(frames))

    assert (anna.tracking_state[:, head] == 1).all() and (ben.tracking_state == 2).all()
