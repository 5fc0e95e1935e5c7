"""The button Track: the actor of a depth recording as an armature."""
