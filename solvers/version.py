"""Return the version of the extension."""

import tomllib
from functools import cache
from pathlib import Path


@cache
def version() -> str:
    """Return the version in the extension's manifest; empty without a manifest."""
    manifest = Path(__file__).parents[1] / "blender_manifest.toml"
    if not manifest.is_file():
        return ""
    return str(tomllib.loads(manifest.read_text(encoding="utf-8"))["version"])
