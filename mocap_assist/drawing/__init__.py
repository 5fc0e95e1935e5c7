"""Overlays of the 3D View; they do not change the scene."""
