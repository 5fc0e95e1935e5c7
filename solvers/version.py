"""Return the version of the extension or of the Python package."""

import tomllib
from functools import cache
from hashlib import sha256
from importlib.metadata import PackageNotFoundError
from importlib.metadata import version as installed_version
from pathlib import Path

DISTRIBUTION = "mocap-assist"
"""What pip calls the Python package."""
N_BUILD_DIGITS = 8
"""Hexadecimal digits that tell builds of one version apart: two have the same with a chance of
1 in 4 billion."""


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


@cache
def build() -> str:
    """Return the version and a digest of the package's code and learned data.

    Checkouts of one version, on two nodes or before and after an update, differ in it. It is
    the same for a checkout, the extension and the Python package, on all systems.
    """
    package = Path(__file__).parent
    digest = sha256()
    files = [each for end in ("py", "npz") for each in package.rglob(f"[!.]*.{end}")]
    for file in sorted(each for each in files if each.is_file()):  # without those of editors
        content = file.read_bytes()
        if file.suffix == ".py":
            content = content.replace(b"\r\n", b"\n")  # as Git has it on Windows
        digest.update(f"{file.relative_to(package).as_posix()} {len(content)}\n".encode())
        digest.update(content)
    return f"{version()}+{digest.hexdigest()[:N_BUILD_DIGITS]}"
