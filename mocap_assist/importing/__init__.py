"""The button Import: recordings as armatures, empties and points."""
