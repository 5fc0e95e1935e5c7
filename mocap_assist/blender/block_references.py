"""References to data-blocks that stay valid while Blender runs; pointers do not."""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any, NamedTuple

import bpy

from ...solvers.errors import InvalidMotionError
from .compat import Source

COLLECTIONS = {"OBJECT": "objects", "SCENE": "scenes", "ACTION": "actions"}


def changed_during_solve(target: str) -> InvalidMotionError:
    """Return the error for an object that no longer plays what was solved."""
    return InvalidMotionError(
        f"The action, the rig or the frame range of {target} was changed during the solve;"
        " nothing was written. Press the button again."
    )


class BlockReference(NamedTuple):
    """A data-block by its session UID, which undo and renaming keep."""

    kind: str
    number: int
    name: str
    """Name at the time of reference."""

    @classmethod
    def of(cls, block: bpy.types.ID) -> "BlockReference":
        """Return a reference to a data-block."""
        return cls(block.id_type, block.session_uid, block.name)

    def find(self) -> Any:
        """Return the data-block; raise InvalidMotionError if it was deleted meanwhile."""
        blocks = getattr(bpy.data, COLLECTIONS[self.kind])
        block = next((each for each in blocks if each.session_uid == self.number), None)
        if block is None:
            raise InvalidMotionError(
                f"{self.name} was deleted during the solve; nothing was written."
            )
        return block


class SourceReference(NamedTuple):
    """An action and its slot."""

    action: BlockReference
    slot: int

    @classmethod
    def of(cls, source: Source) -> "SourceReference":
        """Return a reference to both."""
        action, slot = source
        return cls(BlockReference.of(action), slot.handle)

    def is_same(self, source: Source) -> bool:
        """Return whether an action and a slot are these, whatever their names are."""
        action, slot = source
        return (action.session_uid, slot.handle) == (self.action.number, self.slot)

    def find(self) -> Source:
        """Return both; raise InvalidMotionError if one was deleted meanwhile."""
        action = self.action.find()
        slot = next((each for each in action.slots if each.handle == self.slot), None)
        if slot is None:
            raise InvalidMotionError(
                f"A slot of {action.name} was deleted during the solve; nothing was written."
            )
        return action, slot


@contextmanager
def kept_when_complete(action: bpy.types.Action) -> Iterator[None]:
    """Give a new action a fake user once it is complete; remove it if that fails.

    Without a user it is left out of a file that is saved between two time slices.
    """
    made = BlockReference.of(action)
    action.use_fake_user = False
    try:
        yield
        made.find().use_fake_user = True
    except BaseException:
        with suppress(InvalidMotionError):
            bpy.data.actions.remove(made.find())
        raise
