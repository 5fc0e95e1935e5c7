"""Collect the texts of the window into the catalogs of languages.

    make catalogs                                       renew the files; translations are kept
    make catalogs ARGUMENTS=--untranslated              print what is untranslated, as JSON
    make catalogs ARGUMENTS="--translate texts.json"    take translations from such a file

Labels and tooltips are those of the registered classes. Sentences, and the texts that panels
draw, are read from the source: `extract_texts.py`.
"""

import argparse
import importlib
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

from extract_texts import source_texts

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = "bl_ext.user_default.mocap_assist"
INSTALL = """
import os, sys
import bpy
bpy.ops.extensions.package_install_files(
    filepath=sys.argv[1], repo="user_default", enable_on_install=True
)
sys.stdout.flush()
os._exit(0)
"""
BASES = ("Operator", "Panel", "Menu", "PropertyGroup", "AddonPreferences", "FileHandler")
HOLDERS = ("Scene", "WindowManager", "Object", "PoseBone")
"""Blender's own classes that have properties of the extension."""


def main() -> None:
    """Do what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--zip", type=Path, required=True)
    parser.add_argument("--untranslated", action="store_true")
    parser.add_argument("--translate", type=Path)
    options = parser.parse_args()

    languages = installed(options.zip, "mocap_assist.languages")
    texts = all_texts(importlib.import_module("bpy"))
    given = json.loads(options.translate.read_text("utf-8")) if options.translate else {}
    if not options.untranslated:
        renew(languages, texts, given)
    missing = untranslated(languages, texts)
    if options.untranslated:
        print(json.dumps(missing, ensure_ascii=False, indent=1))
    else:
        print(f"{len(texts)} texts; {len(missing)} are not translated into every language.")
    sys.stdout.flush()
    os._exit(0)  # Blender may hang at exit once classes were registered.


def installed(archive: Path, name: str) -> ModuleType:
    """Install the extension where nothing else is; return one of its modules."""
    resources = tempfile.TemporaryDirectory(prefix="mocap-assist-catalogs-")
    os.environ["BLENDER_USER_RESOURCES"] = resources.name
    command = [sys.executable, "-c", INSTALL, str(archive.resolve())]
    subprocess.run(command, check=True, cwd=resources.name, stdout=subprocess.DEVNULL)
    importlib.import_module("bpy")
    assert importlib.import_module("addon_utils").enable(PACKAGE, default_set=True)
    return importlib.import_module(f"{PACKAGE}.{name}")


def all_texts(bpy: ModuleType) -> set[str]:
    """Return every text of the window."""
    return set(class_texts(bpy)) | source_texts(ROOT) | set(preset_texts())


def preset_texts() -> Iterator[str]:
    """Yield names and tooltips of the shipped presets."""
    shipped = importlib.import_module(f"{PACKAGE}.solvers.presets").PRESETS
    for presets in shipped.values():
        for name, preset in presets.items():
            yield from (name, preset.help)


def class_texts(bpy: ModuleType) -> Iterator[str]:
    """Yield labels and tooltips of all classes, properties and items of the extension."""
    for base in (getattr(bpy.types, name) for name in BASES):
        inherited = set(base.bl_rna.properties.keys())
        for kind in _registered(base):
            yield from filter(None, (getattr(kind, name, "") for name in
                                     ("bl_label", "bl_description")))  # fmt: skip
            for each in _described(bpy, kind).properties:
                if each.identifier not in inherited:
                    yield from _property_texts(each)
    for holder in HOLDERS:
        for each in getattr(bpy.types, holder).bl_rna.properties:
            if each.identifier.startswith("mocap_assist"):
                yield from _property_texts(each)


def _registered(base: type) -> Iterator[type]:
    for kind in base.__subclasses__():
        if kind.__module__.startswith(PACKAGE) and getattr(kind, "is_registered", False):
            yield kind
        yield from _registered(kind)


def _described(bpy: ModuleType, kind: Any) -> Any:
    """Return what has the properties: for an operator not its class."""
    if not issubclass(kind, bpy.types.Operator):
        return kind.bl_rna
    family, _, name = kind.bl_idname.replace("_OT_", ".").lower().partition(".")
    return getattr(getattr(bpy.ops, family), name).get_rna_type()


def _property_texts(item: Any) -> Iterator[str]:
    """Yield name and tooltip, unless the name is none: then Blender repeats the identifier."""
    if item.is_hidden or item.name == item.identifier:
        return
    yield from filter(None, (item.name, item.description))
    for choice in item.enum_items_static if item.type == "ENUM" else ():
        yield from filter(None, (choice.name, choice.description))


def renew(languages: ModuleType, texts: set[str], given: Mapping[str, Any]) -> None:
    """Write the files with exactly these texts, and with translations that are known."""
    for language in languages.LANGUAGES:
        path = ROOT / "mocap_assist" / "languages" / f"{language}.po"
        known = languages.read_catalog(path) if path.exists() else {}
        new = {english: each.get(language, "") for english, each in given.items()}
        known |= {english: text for english, text in new.items() if text}
        languages.write_catalog(path, {english: known.get(english, "") for english in texts})


def untranslated(languages: ModuleType, texts: set[str]) -> dict[str, dict[str, str]]:
    """Return the texts that lack a translation, with room for it in each such language."""
    missing: dict[str, dict[str, str]] = {}
    for language in languages.LANGUAGES:
        known = languages.read_catalog(ROOT / "mocap_assist" / "languages" / f"{language}.po")
        for english in sorted(texts):
            if not known.get(english):
                missing.setdefault(english, {})[language] = ""
    return missing


if __name__ == "__main__":
    main()
