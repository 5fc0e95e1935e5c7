"""Keep humanoid maps in files, so that a rig is mapped once."""

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
LONGEST = 1_000_000
"""Bytes; a file that is longer is not a map."""


def write_humanoid_map(humanoid: HumanoidMap, path: Path | str) -> None:
    """Write a map as JSON, whole or not at all.

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
    """Read what `write_humanoid_map` wrote.

    Parameters
    ----------
    path : Path or str
    skeleton : Skeleton, optional
        Its joints must include all that the map names.

    Returns
    -------
    HumanoidMap
        With score 1: an animator has approved of it.

    Raises
    ------
    InvalidFileError
        The file is missing, is no such map, comes from a later version, or names unknown roles,
        a role or a joint twice, or a joint that the skeleton lacks.
    """
    try:
        with open_regular(path) as file:
            text = file.read(LONGEST).decode("utf-8-sig")
        content = parse_json(text, object_pairs_hook=_each_once)
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
        lost = [name for name in joints.values() if name not in skeleton.names]
        if lost:
            raise InvalidFileError(
                f"{path} names joints that the skeleton lacks: {', '.join(lost)}. Choose the"
                " map of this rig."
            )
    return humanoid


def _each_once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Refuse JSON that says a key twice, of which the last one would win unseen."""
    names = [name for name, _ in pairs]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise ValueError(f"it says {', '.join(twice)} more than once")
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
