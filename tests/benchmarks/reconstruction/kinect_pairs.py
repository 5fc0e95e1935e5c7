"""Takes of UI-PRMD, seen by a Kinect and by an optical system, with true joints from markers.

The ten takes of exercise 3 by subject 1 are left out: their markers do not belong to what the
Kinect saw. Laid over each other as rigid bodies they are 26 cm apart, but 8 cm when one is
mirrored: the repetitions that were paired are of the other leg.

Nor do the markers of four more exercises by that subject. In these he stands all the time, and
his ankles are 9 to 20 cm apart as the Kinect has it, 39 to 48 cm as the markers have it, never
less than 20 cm off; of others, who stand so too, some frame is at most 15 cm off. Nobody learns
from these 40 takes; they are still compared, and figures without them are given as well.
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
"""Metres from the marker on top of a shoulder down to the joint."""


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
    """Yield all takes in which any joint is known, but the mispaired ones."""
    for path in sorted(folder.glob("*.npz")):
        if path.stem.startswith(MISPAIRED):
            continue
        kinect, markers = read_ui_prmd_pair(path)
        truth = true_joints(markers)
        if truth.visible.any():
            yield Pair(path.stem, kinect, truth)


def true_joints(markers: Tracks) -> Tracks:
    """Place the joints that UI-PRMD names amid the markers of Plug-in Gait.

    Hips: Harrington et al. 2007. Elbows, knees, ankles and toes are where their markers are; a
    constant offset of a joint is no sensor error; measures without it are given as well.
    """
    spots = {name: markers.positions[:, place] for place, name in enumerate(markers.names)}

    def middle(*names: str) -> Array:
        return np.mean([spots[name] for name in names], axis=0)

    places = {"Waist": middle("LASI", "RASI", "LPSI", "RPSI"), "Spine": middle("T10", "STRN")}
    places["Neck"] = middle("C7", "CLAV")
    places["Chest"] = (places["Neck"] + middle("C7", "CLAV", "T10", "STRN")) / 2.0
    places["HeadTip"] = middle("LFHD", "RFHD", "LBHD", "RBHD")
    places["Head"] = (places["Neck"] + places["HeadTip"]) / 2.0
    places["LUpLeg"], places["RUpLeg"] = _hips(spots)
    for side in ("L", "R"):
        shoulder = spots[f"{side}SHO"] - BELOW_SHOULDER
        places[f"{side}Collar"] = 0.6 * places["Neck"] + 0.4 * shoulder
        places[f"{side}UpArm"] = shoulder
        places[f"{side}ForeArm"] = spots[f"{side}ELB"]
        places[f"{side}Hand"] = middle(f"{side}WRA", f"{side}WRB")
        places[f"{side}LowLeg"] = spots[f"{side}KNE"]
        places[f"{side}Foot"] = spots[f"{side}ANK"]
        places[f"{side}Toes"] = spots[f"{side}TOE"]
    return Tracks(NAMES, np.stack([places[name] for name in NAMES], axis=1), markers.frame_rate)


def _hips(spots: dict[str, Array]) -> tuple[Array, Array]:
    """Left and right hip joint by the regression of Harrington et al. 2007."""
    front = (spots["LASI"] + spots["RASI"]) / 2.0
    across = spots["LASI"] - spots["RASI"]
    along = front - (spots["LPSI"] + spots["RPSI"]) / 2.0
    width, depth = (np.nanmedian(np.linalg.norm(one, axis=-1)) for one in (across, along))
    x = across / np.linalg.norm(across, axis=-1, keepdims=True)
    y = along - (along * x).sum(axis=-1, keepdims=True) * x
    y /= np.linalg.norm(y, axis=-1, keepdims=True)
    z = np.cross(y, x)
    below = front + y * (-0.24 * depth - 0.0099) + z * (-0.30 * width - 0.0109)
    aside = x * (0.33 * width + 0.0073)
    return below + aside, below - aside
