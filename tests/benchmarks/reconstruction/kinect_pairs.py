"""Takes of UI-PRMD, by a Kinect and by an optical system, with true joints from markers.

The ten takes of exercise 3 by subject 1 are left out: their markers do not belong to what the
Kinect saw. After a rigid fit their distance is 26 cm, but 8 cm when one is
mirrored: the repetitions that were paired are of the other leg.

Nor do the markers of four more exercises by that subject. In these he stands all the time, and
the distance of his ankles is 9 to 20 cm by the Kinect and 39 to 48 cm by the markers, never
less than 20 cm off; of others, who stand so too, some frame is at most 15 cm off. No method
learns from these 40 takes; they are still compared, and figures without them are given as well.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from solvers.arrays import Array
from solvers.motion import JointRecording, Tracks
from solvers.recordings.joint_files.ui_prmd import NAMES, read_ui_prmd_pair

FOLDER = Path(__file__).parents[4] / "shared/data/kinect/ui_prmd"
MISPAIRED = "m03_s01"
OTHER_STANCE = ("m07_s01", "m08_s01", "m09_s01", "m10_s01")
BELOW_SHOULDER = np.array([0.0, 0.0, 0.04])
"""Meters from the marker on top of a shoulder down to the joint."""


@dataclass(frozen=True, eq=False)
class Pair:
    """One take."""

    name: str
    kinect: JointRecording
    truth: Tracks

    @property
    def subject(self) -> str:
        """Who was recorded, s01 to s05."""
        return self.name[4:7]

    @property
    def matched(self) -> bool:
        """Whether the markers are of what the Kinect saw."""
        return not self.name.startswith(OTHER_STANCE)


def read_pairs(folder: Path = FOLDER) -> Iterator[Pair]:
    """Yield all takes with any true joint, except the mispaired ones."""
    for path in sorted(folder.glob("*.npz")):
        if path.stem.startswith(MISPAIRED):
            continue
        kinect, markers = read_ui_prmd_pair(path)
        truth = true_joints(markers)
        if truth.visible.any():
            yield Pair(path.stem, kinect, truth)


def true_joints(markers: Tracks) -> Tracks:
    """Estimate the joints that UI-PRMD names from the markers of Plug-in Gait.

    Hips: Harrington et al. 2007. Elbows, knees, ankles and toes are where their markers are; a
    constant offset of a joint is no sensor error; measures without it are given as well.
    """
    by_name = {name: markers.positions[:, index] for index, name in enumerate(markers.names)}

    def middle(*names: str) -> Array:
        return np.mean([by_name[name] for name in names], axis=0)

    joints = {"Waist": middle("LASI", "RASI", "LPSI", "RPSI"), "Spine": middle("T10", "STRN")}
    joints["Neck"] = middle("C7", "CLAV")
    joints["Chest"] = (joints["Neck"] + middle("C7", "CLAV", "T10", "STRN")) / 2.0
    joints["HeadTip"] = middle("LFHD", "RFHD", "LBHD", "RBHD")
    joints["Head"] = (joints["Neck"] + joints["HeadTip"]) / 2.0
    joints["LUpLeg"], joints["RUpLeg"] = _hips(by_name)
    for side in ("L", "R"):
        shoulder = by_name[f"{side}SHO"] - BELOW_SHOULDER
        joints[f"{side}Collar"] = 0.6 * joints["Neck"] + 0.4 * shoulder
        joints[f"{side}UpArm"] = shoulder
        joints[f"{side}ForeArm"] = by_name[f"{side}ELB"]
        joints[f"{side}Hand"] = middle(f"{side}WRA", f"{side}WRB")
        joints[f"{side}LowLeg"] = by_name[f"{side}KNE"]
        joints[f"{side}Foot"] = by_name[f"{side}ANK"]
        joints[f"{side}Toes"] = by_name[f"{side}TOE"]
    return Tracks(NAMES, np.stack([joints[name] for name in NAMES], axis=1), markers.frame_rate)


def _hips(by_name: dict[str, Array]) -> tuple[Array, Array]:
    """Left and right hip joint by the regression of Harrington et al. 2007."""
    front = (by_name["LASI"] + by_name["RASI"]) / 2.0
    across = by_name["LASI"] - by_name["RASI"]
    along = front - (by_name["LPSI"] + by_name["RPSI"]) / 2.0
    width, depth = (np.nanmedian(np.linalg.norm(one, axis=-1)) for one in (across, along))
    x = across / np.linalg.norm(across, axis=-1, keepdims=True)
    y = along - (along * x).sum(axis=-1, keepdims=True) * x
    y /= np.linalg.norm(y, axis=-1, keepdims=True)
    z = np.cross(y, x)
    below = front + y * (-0.24 * depth - 0.0099) + z * (-0.30 * width - 0.0109)
    aside = x * (0.33 * width + 0.0073)
    return below + aside, below - aside
