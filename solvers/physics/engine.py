"""Load the physics engine MuJoCo when it is needed, without its windows."""

import os
from types import ModuleType

from ..errors import MocapAssistError

RENDERER_VARIABLE = "MUJOCO_GL"


class NoPhysicsError(MocapAssistError):
    """The physics engine cannot be loaded."""


def load_engine() -> ModuleType:
    """Return the module `mujoco`, without a renderer and without a log file.

    Its renderer would need packages that physics does not. An environment variable disables it
    during the import and is restored afterwards. Engine warnings do not go to a file in the
    current folder; `data.warning` still counts them.

    Raises
    ------
    NoPhysicsError
        The engine is not installed, or does not load on this machine.
    """
    previous = os.environ.get(RENDERER_VARIABLE)
    os.environ[RENDERER_VARIABLE] = "disable"
    try:
        import mujoco
    except (ImportError, OSError) as error:
        raise NoPhysicsError(
            f"Simulate needs MuJoCo, which cannot be loaded ({error}). Install the extension"
            " with its wheels, or the package mujoco."
        ) from error
    finally:
        if previous is None:
            del os.environ[RENDERER_VARIABLE]
        else:
            os.environ[RENDERER_VARIABLE] = previous
    engine: ModuleType = mujoco
    engine.set_mju_user_warning(_ignore_warning)
    return engine


def _ignore_warning(message: str) -> None:
    """Ignore a warning; the simulation's data counts them."""
