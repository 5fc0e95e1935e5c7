"""Make a static extension repository: what a studio serves to its Blenders from a share.

    python .ci/packages/build_repository.py                       every platform of the manifest
    python .ci/packages/build_repository.py --platform linux-x64  one of them
    python .ci/packages/build_repository.py --zips FOLDER         from zips that are built

Needs an installed `bpy`, because Blender's own tool writes the index.
"""

import argparse
import hashlib
import json
import shutil
import sys
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path

import build_extension

ROOT = Path(__file__).resolve().parents[2]
INDEX = "index.json"
PAGE = "index.html"
CHECKSUMS = "SHA256SUMS"
TEMPLATE = Path(__file__).with_name("repository.html")


def main(arguments: Sequence[str] | None = None) -> None:
    """Make or renew the repository that the command line asks for; its folder is printed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--platform", action="append", help="by default all of the manifest")
    parser.add_argument("--zips", type=Path, help="a folder of zips to take, with no others")
    parser.add_argument("--output", type=Path, default=ROOT / "dist" / "repository")
    options = parser.parse_args(arguments)

    options.output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=options.output, prefix=".new") as folder:
        new = Path(folder)
        if options.zips is None:
            manifest = build_extension.read_manifest()
            platforms = options.platform or manifest["platforms"]
            zips = [*build_extension.build_zips(manifest, platforms, new, per_python=True)]
        else:
            zips = [Path(shutil.copy(each, new)) for each in sorted(options.zips.glob("*.zip"))]
        if not zips:
            sys.exit(f"There are no zips in {options.zips}. Build some: make extension.")
        page = ["--html", "--html-template", str(TEMPLATE)]
        build_extension.run_tool("server-generate", "--repo-dir", folder, *page)
        check_index(new, zips)
        write_checksums(new, zips)
        replace(options.output, new)
    print(options.output)


def check_index(folder: Path, zips: Sequence[Path]) -> None:
    """Stop if the index lacks a zip: Blender's tool leaves damaged ones out."""
    packages = json.loads((folder / INDEX).read_text(encoding="utf-8"))["data"]
    listed = {Path(package["archive_url"]).name for package in packages}
    missing = [path.name for path in zips if path.name not in listed]
    if missing:
        sys.exit(f"Not an extension, or damaged: {', '.join(missing)}. Build it again.")


def write_checksums(folder: Path, files: Sequence[Path]) -> None:
    """Write the SHA-256 of the files, in the form that `sha256sum --check` reads."""
    lines = [f"{checksum(path)}  {path.name}\n" for path in sorted(files)]
    (folder / CHECKSUMS).write_text("".join(lines), encoding="utf-8", newline="\n")


def checksum(path: Path) -> str:
    """Return the SHA-256 of a file in hexadecimal digits."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def replace(repository: Path, new: Path) -> None:
    """Put new files in the place of the old: zips first, then the index that names them.

    A Blender that reads meanwhile finds an index whose zips exist. Zips of earlier versions
    go last, and files of other people stay.
    """
    zips = {path.name for path in new.glob("*.zip")}
    move([new / name for name in (*sorted(zips), PAGE, CHECKSUMS, INDEX)], repository)
    for former in repository.glob("mocap_assist-*.zip"):
        if former.name not in zips:
            former.unlink()


def move(files: Iterable[Path], folder: Path) -> None:
    """Move files into a folder of the same disk, each at once."""
    for path in files:
        path.chmod(0o644)
        path.replace(folder / path.name)


if __name__ == "__main__":
    main()
