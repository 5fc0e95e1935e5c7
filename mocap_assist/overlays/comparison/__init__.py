"""The recorded take next to its result: stick figures, markers, ghosts and curves."""
