"""Overlays of the 3D View, the Timeline and the Graph Editor; they do not change the scene."""
