"""`blender FILE --command mocap_assist VERB ...`: the buttons without a window."""

from .command import register, unregister

__all__ = ["register", "unregister"]
