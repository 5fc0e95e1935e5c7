"""Texts of the window in other languages: Blender's own settings choose the language."""

import bpy

from .catalog import CONTEXT, LANGUAGES, catalog_path, read_catalog, write_catalog
from .line_breaks import broken_lines
from .sentences import placeholders, template_of, translate_sentence, translated, words_of

__all__ = [
    "CONTEXT",
    "LANGUAGES",
    "broken_lines",
    "catalog_path",
    "placeholders",
    "read_catalog",
    "register",
    "template_of",
    "translate_sentence",
    "translated",
    "unregister",
    "words_of",
    "write_catalog",
]

CONTEXTS = (CONTEXT, "*", "Operator")
"""Where Blender looks up texts: ours, and those that it uses without one, for buttons too."""


def dictionary() -> dict[str, dict[tuple[str, str], str]]:
    """Return the texts as Blender needs them: by language, then by context and English text."""
    return {
        language: {
            (context, english): text
            for english, text in read_catalog(catalog_path(language)).items()
            if text
            for context in CONTEXTS
        }
        for language in LANGUAGES
    }


def register() -> None:
    """Give Blender the texts."""
    bpy.app.translations.register(__package__, dictionary())


def unregister() -> None:
    """Remove the texts."""
    bpy.app.translations.unregister(__package__)
