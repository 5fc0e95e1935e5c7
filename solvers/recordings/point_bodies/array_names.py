"""Names of arrays with the positions of joints, and of arrays next to them."""

import re

POINT_MEMBERS = (
    "positions", "joints", "joint_positions", "joints3d", "joints_3d", "keypoints3d",
    "keypoints_3d", "kps3d", "pose3d", "pose_3d", "poses3d", "poses_3d", "points3d",
    "points_3d", "pose_world_landmarks", "world_landmarks", "landmarks", "pred_xyz_jts", "xyz",
    "points", "keypoints", "kpts", "reconstruction", "predictions", "arr_0",
)  # fmt: skip
"""Names of joints in archives, the clear ones first."""
WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+|\d+[a-z]?")
OF_WORLD = frozenset(("world", "global"))
"""Words in the names of positions in the room."""
ELSEWHERE = frozenset((
    "local", "relative", "parent", "pixel", "pixels", "image", "screen", "norm", "normalized",
    "uv", "2d", "cropped",
))  # fmt: skip
"""Words in the names of positions relative to something else, or in a picture."""
OTHERS = frozenset((
    "rest", "bind", "neutral", "calibration", "reference", "tpose", "apose", "offset",
    "confidence", "score", "visibility", "presence", "weight", "error", "std", "parent", "edge",
    "connection", "direction", "normal", "size", "bbox", "box",
))  # fmt: skip
"""Last or first words, without the plural s, of arrays of something else."""
POSE_OF_LETTER = re.compile(r"(?i)(?:^|[\W_])[ta][\W_]?pose(?:$|[\W_]|(?-i:[A-Z]))")
"""The rest pose whose shape a letter has."""


def rank_of_array(name: str) -> tuple[bool, bool, int]:
    """Return the rank of an array of positions by its name; the smallest is the best.

    Those in the room come before others, then those that say so, then `POINT_MEMBERS`.
    """
    words = _words(name)
    is_elsewhere = not ELSEWHERE.isdisjoint(words)
    plain = "".join(words)
    known = [re.sub("_", "", each) for each in POINT_MEMBERS]
    rank = known.index(plain) if plain in known else len(known)
    return is_elsewhere, OF_WORLD.isdisjoint(words), rank


def is_other_array(name: str) -> bool:
    """Return whether an array is the rest pose, the confidence or the like by its name."""
    words = [word.removesuffix("s") for word in _words(name)]
    ends = {*words[:1], *words[-1:]}
    return not OTHERS.isdisjoint(ends) or POSE_OF_LETTER.search(name) is not None


def _words(name: str) -> list[str]:
    return [word.lower() for word in WORD.findall(name)]
