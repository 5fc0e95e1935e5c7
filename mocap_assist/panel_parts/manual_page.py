"""The manual that comes with the extension."""

from pathlib import Path

MANUAL = Path(__file__).parents[1] / "ui" / "manual.html"
"""Location of the manual, which needs no network."""
PAGES = MANUAL.with_name("pages") / "README.html"
"""Location of all documents with a search; a checkout lacks them, because `make zip` writes
them."""


def start_page() -> Path:
    """Return the page that the button opens: all documents, or else the manual of F1."""
    return PAGES if PAGES.is_file() else MANUAL
