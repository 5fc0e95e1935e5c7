"""Catalogs of texts: one file for each language, in the format of gettext (.po)."""

import re
from collections.abc import Mapping
from pathlib import Path

LANGUAGES = {
    "ja_JP": "Japanese",
    "zh_HANS": "Simplified Chinese",
    "fr_FR": "French",
    "es": "Spanish",
    "de_DE": "German",
}
"""Languages by the names that Blender gives them."""
CONTEXT = "Mocap Assist"
"""Context of our texts. Without one, Blender's own catalogs come first, in which *Feet* are the
unit and *Track* is a noun."""
ENTRY = re.compile(r'^msgid "(.*)"\nmsgstr "(.*)"$', re.MULTILINE)
HEADER = (
    '# {name} texts of Mocap Assist. "make catalogs" sorts, adds and removes entries.\n'
    'msgid ""\nmsgstr "Content-Type: text/plain; charset=UTF-8\\nLanguage: {language}\\n"\n'
)
ESCAPED = re.compile(r"\\(.)")


def catalog_path(language: str) -> Path:
    """Return the file of a language."""
    return Path(__file__).parent / f"{language}.po"


def read_catalog(path: Path) -> dict[str, str]:
    """Return the texts of a file by their English; untranslated ones are empty."""
    entries = ENTRY.findall(path.read_text(encoding="utf-8"))
    return {
        _unescape_text(english): _unescape_text(text) for english, text in entries if english
    }


def write_catalog(path: Path, texts: Mapping[str, str]) -> None:
    """Write the texts, sorted by their English."""
    language = path.stem
    header = HEADER.format(name=LANGUAGES[language], language=language)
    entries = [
        f'msgid "{_quote_text(english)}"\nmsgstr "{_quote_text(text)}"\n'
        for english, text in sorted(texts.items())
    ]
    path.write_text("\n".join([header, *entries]), encoding="utf-8")


def _quote_text(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")


def _unescape_text(text: str) -> str:
    if "\\" not in text:
        return text
    return ESCAPED.sub(lambda found: "\n" if found[1] == "n" else found[1], text)
