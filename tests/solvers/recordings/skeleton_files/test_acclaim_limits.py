"""Limits of a skeleton file hold for the motion that is read with it."""

import re
from pathlib import Path

import numpy as np
import pytest
from acclaim_files import LEG
from numpy.testing import assert_allclose

from solvers.denoising.limits.clamp_to_limits import limit_excess
from solvers.errors import InvalidFileError
from solvers.recordings import read_acclaim, read_acclaim_limits

LIMITS = {
    "dof rx ry rz": "limits (-160.0 20.0)\n         (-70.0 70.0)\n         (-inf 10)",
    "dof rx\n": "limits (-10.0 170.0)\n",
}
SKELETON = LEG.replace("axis 0 0 20 XYZ\n  dof rx\n", "axis 0 30 20 XYZ\n  dof rx\n")
for freedom, limits in LIMITS.items():
    SKELETON = SKELETON.replace(freedom, f"{freedom.rstrip()}\n  {limits}")


@pytest.fixture
def leg(tmp_path) -> Path:
    (tmp_path / "leg.asf").write_text(SKELETON)
    frames = [
        (0, 0, 0, 0),
        (25, 0, 0, 0),
        (-20, -73, 5, -12),
        (-20, 30, -170, 171),
        (0, 0, 14, 0),
    ]
    rows = (
        f"{number}\nroot 0 17 0 0 5 0\nthigh {a} {b} {c}\nshank {d}\n"
        for number, (a, b, c, d) in enumerate(frames, start=1)
    )
    path = tmp_path / "leg.amc"
    path.write_text(":FULLY-SPECIFIED\n:DEGREES\n" + "".join(rows))
    return path


def excess(path: Path) -> dict[str, np.ndarray]:
    """Degrees beyond the limits in each frame, by joint."""
    motion = read_acclaim(path)
    beyond = np.degrees(limit_excess(motion, read_acclaim_limits(path)))
    return dict(zip(motion.skeleton.names, beyond.T, strict=True))


def test_angles_count_as_the_file_has_them(leg):
    beyond = excess(leg)

    assert_allclose(beyond["thigh"], [0, 5, 3, 0, 4], atol=1e-6)
    assert_allclose(beyond["shank"], [0, 0, 2, 1, 0], atol=1e-6)
    assert "root" not in read_acclaim_limits(leg.with_suffix(".asf")).names


def test_a_file_without_limits_has_none(leg):
    plain = re.sub(r"\s*(limits)?\s*\([^)]*\)", "", SKELETON)
    leg.with_suffix(".asf").write_text(plain)

    assert read_acclaim_limits(leg) is None
    assert read_acclaim(leg).n_frames == 5


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ("(20 -160)", "thigh has the limits '20 -160'"),
        ("(20)", "thigh has the limits '20'"),
        ("(a b)", "thigh has the limits 'a b'"),
        ("(1 2) (1 2)", "thigh has more limits than degrees of freedom"),
    ],
)
def test_limits_that_cannot_be_are_refused(leg, wrong, sentence):
    leg.with_suffix(".asf").write_text(SKELETON.replace("(-160.0 20.0)", wrong))

    with pytest.raises(InvalidFileError, match=re.escape(sentence)):
        read_acclaim_limits(leg)


def test_dancer_exceeds_the_limits_of_his_file_by_known_angles(recordings):
    """Joints with one angle need no geometry: its excess is a subtraction."""
    path = recordings / "mocap" / "05_13.amc"
    beyond = excess(path)
    bones = re.findall(r"(?s)begin(.*?)\bend\b", path.with_name("05.asf").read_text())
    one_angle = r"(?s)name (\w+).*dof r[xyz]\s*\n\s*limits \((\S+) (\S+)\)\s*$"
    hinges = [found.groups() for bone in bones if (found := re.search(one_angle, bone))]
    assert {"ltibia", "lwrist", "rwrist"} <= {name for name, _, _ in hinges}
    for name, low, high in hinges:
        angles = np.array(re.findall(rf"(?m)^{name} (\S+)$", path.read_text()), dtype=float)
        rotations = angles + np.array([[-360.0], [0.0], [360.0]])  # The same rotation.
        expected = np.maximum(np.maximum(float(low) - rotations, rotations - float(high)), 0.0)
        assert_allclose(beyond[name], expected.min(axis=0), atol=1e-6)
