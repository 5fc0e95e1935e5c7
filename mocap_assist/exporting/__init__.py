"""Export what an armature plays, as a file for other programs."""
