"""Translate sentences that already contain names and figures.

Messages come from solvers, which know no languages, and from other processes. So a sentence is
compared with the English texts of the catalogs, where {placeholders} stand for what it
contains.
"""

import re
from collections.abc import Callable, Mapping
from functools import cache, lru_cache
from string import Formatter

import bpy

from .catalog import CONTEXT, LANGUAGES, catalog_path, read_catalog
from .line_breaks import text_width

Translate = Callable[[str], str]

MAX_CACHED = 256
"""Number of sentences that are kept translated. It only bounds memory: a redraw shows about
ten."""
UNKNOWN = "…"
"""What stands for a sentence whose names cannot be recognized."""
SENTENCE_END = re.compile(r"(?<=[.!?]) (?=\S)")
GROUP = r"(?P<{name}>(?:(?!\. [A-Z]).)*?\.?)"
"""What stands for a placeholder: nothing, a name, a figure or one sentence, but not several."""


def translated(text: str) -> str:
    """Return a text in the language of the window; English if it has no translation."""
    language = bpy.app.translations.locale
    if not text or language not in LANGUAGES:
        return text
    return _cached_translation(text, language)


@lru_cache(MAX_CACHED)
def _cached_translation(text: str, language: str) -> str:
    """Return a translation; the language is a key of the cache."""
    look_up = bpy.app.translations.pgettext_iface
    return translate_sentence(text, lambda english: str(look_up(english, CONTEXT)))


def translate_sentence(text: str, translate: Translate) -> str:
    """Translate as many sentences as possible at once, and then those that follow.

    Parameters
    ----------
    text : str
    translate : callable
        Returns the translation of a text of the catalogs, or the text itself.
    """
    sentences = SENTENCE_END.split(text)
    for n_first in range(len(sentences), 0, -1):
        first = _translated_text(" ".join(sentences[:n_first]), translate)
        if first is not None:
            break
    else:
        first, n_first = sentences[0], 1
    rest = " ".join(sentences[n_first:])
    return f"{first} {translate_sentence(rest, translate)}" if rest else first


def _translated_text(text: str, translate: Translate) -> str | None:
    """Return the translation of a text; None if it has none as a whole."""
    translation = translate(text)
    if translation != text:
        return translation
    for pattern in _patterns():
        if (values := pattern.values_in(text)) is not None:
            return translate(pattern.template).format_map(_translated_parts(values, translate))
    if text.endswith("."):  # of a remark, whose text has none
        remark = _translated_text(text[:-1], translate)
        period = "。" if remark and text_width(remark[-1]) > 1 else "."
        return None if remark is None else remark + period
    return None


def template_of(text: str) -> str:
    """Return a message with placeholders for the names and figures in it.

    What the catalogs lack, such as what a solver says of a file, becomes an ellipsis.
    """
    if not text:
        return ""
    sentences = SENTENCE_END.split(text)
    for n_first in range(len(sentences), 0, -1):
        first = _template_of_text(" ".join(sentences[:n_first]))
        if first:
            break
    else:
        first, n_first = UNKNOWN, 1
    return " ".join(filter(None, [first, template_of(" ".join(sentences[n_first:]))]))


def _template_of_text(text: str) -> str:
    if text in _texts():
        return text
    found = (each.template for each in _patterns() if each.values_in(text) is not None)
    return next(found, "")


def placeholders(text: str) -> set[str]:
    """Return the names of the placeholders of a text."""
    return {name for _, name, _, _ in Formatter().parse(text) if name}


def words_of(text: str) -> str:
    """Return a text without placeholders."""
    return "".join(literal for literal, *_ in Formatter().parse(text))


def _translated_parts(values: Mapping[str, str], translate: Translate) -> dict[str, str]:
    """Return what a sentence contains, with sentences, figures and terms in it translated.

    Figures are lists such as "3 spikes, 2 gaps", and a term is "left arm" or "inches". Names of
    bones and files stay as they are.
    """
    return {name: _translated_part(value, translate) for name, value in values.items()}


def _translated_part(value: str, translate: Translate) -> str:
    if value.endswith("."):
        return translate_sentence(value, translate)
    return ", ".join(
        translate_sentence(part, translate) if _is_figure_or_term(part) else part
        for part in value.split(", ")
    )


def _is_figure_or_term(part: str) -> bool:
    return part.islower() or (" " in part and any(letter.isdigit() for letter in part))


class Pattern:
    """Recognizes a text with placeholders once they are filled in."""

    def __init__(self, template: str) -> None:
        self.template = template
        self._longest = max((part for part, *_ in Formatter().parse(template)), key=len)
        self._compiled: re.Pattern[str] | None = None

    def values_in(self, text: str) -> dict[str, str] | None:
        """Return what stands for the placeholders; None if this is another text."""
        if self._longest not in text:
            return None
        if self._compiled is None:
            self._compiled = re.compile(_expression(self.template), re.DOTALL)
        found = self._compiled.fullmatch(text)
        return found and found.groupdict()


def _expression(template: str) -> str:
    """Return a regular expression with a group for each placeholder."""
    return "".join(
        re.escape(part) + (GROUP.format(name=name) if name else "")
        for part, name, _, _ in Formatter().parse(template)
    )


@cache
def _texts() -> frozenset[str]:
    """Return the English texts of the catalogs."""
    return frozenset(read_catalog(catalog_path(next(iter(LANGUAGES)))))


@cache
def _patterns() -> tuple["Pattern", ...]:
    """Return the texts with placeholders, those with the most words first."""
    filled = [text for text in _texts() if placeholders(text)]
    return tuple(map(Pattern, sorted(filled, key=lambda text: -len(words_of(text)))))
