"""The manual that comes with the extension."""

from pathlib import Path

MANUAL = Path(__file__).parents[1] / "ui" / "manual.html"
"""Location of the manual, which needs no network."""
