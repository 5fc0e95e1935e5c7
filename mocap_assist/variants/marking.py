"""Mark variants as assets, with tags, a catalog and previews."""

import bpy

from ..find_similar.marking import catalog_number, clip_tags, mark_as_asset
from . import listing

TAG = "variant"


def mark_variants(scene: bpy.types.Scene, tags: str, catalog: str) -> str:
    """Let the picked variants, or all, be assets; return a sentence.

    Raises InvalidFileError where a catalog was named, and there is no place for it.
    """
    number = catalog_number(catalog)
    actions = listing.chosen_variants(scene)
    for action in actions:
        mark_as_asset(action, [TAG, *clip_tags(action), *tags.split(",")], number)
    return f"Marked {len(actions)} variants as assets."
