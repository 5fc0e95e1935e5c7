"""The physics engine MuJoCo, loaded when it is needed and without its windows."""

import os
from types import ModuleType

from ..errors import MocapAssistError

DISPLAY = "MUJOCO_GL"


class NoPhysicsError(MocapAssistError):
    """The physics engine cannot be loaded."""


def load_engine() -> ModuleType:
    """Return the module `mujoco`, which then shows nothing and writes no log.

    Its renderer would ask for packages that physics needs not; the engine leaves it out where
    an environment variable says so, which is put back afterwards. Its warnings would go to a
    file in the current folder; `data.warning` tells of them all the same.

    Raises
    ------
    NoPhysicsError
        It is not there, or does not load on this machine.
    """
    before = os.environ.get(DISPLAY)
    os.environ[DISPLAY] = "disable"
    try:
        import mujoco
    except (ImportError, OSError) as error:
        raise NoPhysicsError(
            f"Physics needs MuJoCo, which does not load here ({error}). Install the extension"
            " with its wheels, or the package mujoco."
        ) from error
    finally:
        if before is None:
            del os.environ[DISPLAY]
        else:
            os.environ[DISPLAY] = before
    engine: ModuleType = mujoco
    engine.set_mju_user_warning(_silent)
    return engine


def _silent(message: str) -> None:
    """Take note of no warning; they are counted in the simulation's data."""
