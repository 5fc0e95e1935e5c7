"""Read and write humanoid maps as JSON files."""

import json
from pathlib import Path
from typing import Any

from ...errors import InvalidFileError, InvalidMotionError
from ...files import open_regular, write_atomically
from ...json_text import parse_json
from ..skeletons import Skeleton
from .roles import HumanoidMap

KIND = "mocap_assist humanoid map"
VERSION = 1
MAX_FILE_BYTES = 1_000_000
"""A longer file is not a map."""


def write_humanoid_map(humanoid: HumanoidMap, path: Path | str) -> None:
    """Write a map as JSON, atomically.

    Raises
    ------
    InvalidFileError
        The file cannot be written.
    """
    content = {"kind": KIND, "version": VERSION, "joints": dict(humanoid.joints)}
    with write_atomically(path) as part:
        part.write_text(
            json.dumps(content, indent=1, ensure_ascii=False) + "\n", encoding="utf-8"
        )


def read_humanoid_map(path: Path | str, skeleton: Skeleton | None = None) -> HumanoidMap:
    """Read a map that `write_humanoid_map` wrote.

    Parameters
    ----------
    path : Path or str
    skeleton : Skeleton, optional
        Must have all joints of the map.

    Returns
    -------
    HumanoidMap
        With score 1, since a user confirmed it.

    Raises
    ------
    InvalidFileError
        The file is missing, is not a map, comes from a later version, or names unknown roles,
        a role or a joint twice, or a joint that the skeleton lacks.
    """
    try:
        with open_regular(path) as file:
            text = file.read(MAX_FILE_BYTES).decode("utf-8-sig")
        content = parse_json(text, object_pairs_hook=_unique_keys)
    except FileNotFoundError:
        raise InvalidFileError(f"There is no file {path}.") from None
    except (OSError, ValueError) as error:
        raise InvalidFileError(f"{path} is not a readable humanoid map ({error}).") from None
    joints = _joints(content, path)
    try:
        humanoid = HumanoidMap(joints)
    except InvalidMotionError as error:
        raise InvalidFileError(f"{path}: {error}") from None
    if skeleton is not None:
        missing = [name for name in joints.values() if name not in skeleton.names]
        if missing:
            raise InvalidFileError(
                f"{path} names joints that the skeleton lacks: {', '.join(missing)}. Choose the"
                " map of this rig."
            )
    return humanoid


def _unique_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Refuse JSON with duplicate keys; the last one would silently win."""
    names = [name for name, _ in pairs]
    if duplicates := sorted({name for name in names if names.count(name) > 1}):
        raise ValueError(f"it contains {', '.join(duplicates)} more than once")
    return dict(pairs)


def _joints(content: Any, path: Path | str) -> dict[str, str]:
    if not isinstance(content, dict) or content.get("kind") != KIND:
        raise InvalidFileError(f'{path} is not a humanoid map: it lacks "kind": "{KIND}".')
    if content.get("version") != VERSION:
        raise InvalidFileError(
            f"{path} is of version {content.get('version')!r}; this Mocap Assist reads version"
            f" {VERSION}."
        )
    joints = content.get("joints")
    if not isinstance(joints, dict) or not all(
        isinstance(name, str) and name for name in joints.values()
    ):
        raise InvalidFileError(f'{path}: "joints" must name a joint for each role.')
    return joints
