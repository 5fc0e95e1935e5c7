"""Return the version of the extension or of the Python package."""

import tomllib
from functools import cache
from importlib.metadata import PackageNotFoundError
from importlib.metadata import version as installed_version
from pathlib import Path

DISTRIBUTION = "mocap-assist"
"""What pip calls the Python package."""


@cache
def version() -> str:
    """Return the version in the extension's manifest, or else of the installed package.

    It is empty for modules that are neither in an extension, a checkout nor a package.
    """
    manifest = Path(__file__).parents[1] / "blender_manifest.toml"
    if manifest.is_file():
        return str(tomllib.loads(manifest.read_text(encoding="utf-8"))["version"])
    try:
        return installed_version(DISTRIBUTION)
    except PackageNotFoundError:
        return ""
