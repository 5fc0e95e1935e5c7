"""The catalogs have every text of the window, in every language, in the terms of Blender."""

import ast
import importlib
import re
import sys
from pathlib import Path

import pytest

CHECKOUT = Path(__file__).resolve().parents[3]
TABLE = CHECKOUT / "docs" / "technical" / "languages.md"
TERM = re.compile(r"^\| (?!term)(\w[\w ]*?) \|(.*)\|$", re.MULTILINE)
MAX_LABEL_WORDS = 4


@pytest.fixture(scope="module")
def languages(load):
    return load("mocap_assist.languages")


@pytest.fixture(scope="module")
def catalogs(languages):
    """Return the installed catalogs by language."""
    return {
        language: languages.read_catalog(languages.catalog_path(language))
        for language in languages.LANGUAGES
    }


@pytest.fixture(scope="module")
def collector():
    """Return the function that imports a module of `make catalogs`."""
    sys.path.insert(0, str(CHECKOUT / ".ci" / "languages"))
    yield importlib.import_module
    sys.path.remove(str(CHECKOUT / ".ci" / "languages"))


@pytest.fixture(scope="module")
def collected(collector):
    """Return the texts that classes and source have now, as `make catalogs` collects them."""
    import bpy

    return collector("catalogs").all_texts(bpy)


def test_names_whose_texts_are_collected_exist(collector):
    source = collector("extract_texts")
    missing = []
    for path, names in {**source.LABELED, **source.TERMS}.items():
        tree = ast.parse((CHECKOUT / path).read_text(encoding="utf-8"))
        stored = [node for node in ast.walk(tree) if isinstance(node, ast.Name)]
        defined = {each.id for each in stored if isinstance(each.ctx, ast.Store)}
        kinds = (ast.FunctionDef, ast.ClassDef)
        defined |= {node.name for node in ast.walk(tree) if isinstance(node, kinds)}
        missing += [f"{path} {name}" for name in names - defined]
    assert not missing


def test_catalogs_have_exactly_the_texts_of_the_window(catalogs, collected):
    for language, texts in catalogs.items():
        missing, stale = sorted(collected - set(texts)), sorted(set(texts) - collected)
        assert not missing, f"{language} lacks {missing}: make catalogs"
        assert not stale, f"{language} has {stale}, which are not shown: make catalogs"


def test_every_text_is_translated(catalogs):
    for language, texts in catalogs.items():
        untranslated = [english for english, text in texts.items() if not text]
        assert not untranslated, f"{language}: make catalogs ARGUMENTS=--untranslated"


def test_translations_have_the_placeholders_of_the_text(languages, catalogs):
    for texts in catalogs.values():
        for english, text in texts.items():
            assert languages.placeholders(text) == languages.placeholders(english), english


def test_labels_have_the_terms_of_the_glossary(languages, catalogs):
    rows = TERM.findall(TABLE.read_text(encoding="utf-8"))
    assert len(rows) > 20
    for term, cells in rows:
        word = re.compile(rf"\b{term}s?\b", re.IGNORECASE)
        for language, cell in zip(languages.LANGUAGES, cells.split("|"), strict=True):
            forms = [form.strip().lower() for form in cell.split("/")]
            for english, text in catalogs[language].items():
                is_label = len(english.split()) <= MAX_LABEL_WORDS and english[-1] != "."
                if is_label and word.search(languages.words_of(english)):
                    assert any(form in text.lower() for form in forms), (language, english)


def test_blender_gets_labels_and_buttons(languages):
    french = languages.dictionary()["fr_FR"]

    assert french["*", "Clean"] == french["Operator", "Clean"] == "Nettoyer"


@pytest.mark.parametrize(
    ("english", "german"),
    [
        ("Accepted walk.clean.", "walk.clean wurde angenommen."),
        (
            "The library has 12 clips: 3 read, 1 unusable.",
            "Die Bibliothek hat 12 Clips: 3 gelesen, 1 unbrauchbar.",
        ),
        ("2 issues found. Worst: a.b is never observed.",
         "2 Probleme gefunden. Schlimmstes: a.b wird nie beobachtet."),
        ("Accepted a. Unknown words. There are no variants yet. Press Vary.",
         "a wurde angenommen. Unknown words. "
         "Es gibt noch keine Varianten. Drücken Sie „Variieren“."),
        ("A sentence of no catalog.", "A sentence of no catalog."),
        # Of readers and solvers.
        ("my. walk.bvh has no frames: nothing follows its Frame Time.",
         "my. walk.bvh hat keine Bilder: Nach Frame Time folgt nichts."),
        ("a: an armature of 22 bones, on the floor, 9 frames at 30 Hz."
         " Z is up (61% confidence), -Y is forward, lengths are in inches."
         " Left out, since never observed: inch.001, x.",
         "a: ein Skelett mit 22 Knochen, auf dem Boden, 9 Bilder bei 30 Hz."
         " Z ist oben (Konfidenz 61%), -Y ist vorne, Längen sind in Zoll."
         " Weggelassen, da nie beobachtet: inch.001, x."),
        ("Spikes 43 → 1, gaps 3 → 0.", "Spitzen 43 → 1, Lücken 3 → 0."),
        ("Frames 1 to 4 of the left arm are separate poses and were kept as recorded.",
         "Bilder 1 bis 4 (linker Arm) sind eigene Posen und blieben wie aufgenommen."),
        ("Feet were not planted. The motion has gaps.",
         "Die Füße wurden nicht fixiert. Die Bewegung hat Lücken."),
        ("The file has no positions, so the body stays in place.",  # a remark, with a period
         "Die Datei hat keine Positionen, daher bleibt der Körper am Ort."),
    ],
)  # fmt: skip
def test_filled_in_sentences_are_recognized(languages, catalogs, english, german):
    translate = catalogs["de_DE"]

    def look_up(text):
        return translate.get(text, text)

    assert languages.translate_sentence(english, look_up) == german


def test_catalogs_keep_quotes_and_backslashes(languages, tmp_path):
    texts = {'a "b" \\n': "c\nd \\", "e": ""}
    path = tmp_path / "es.po"

    languages.write_catalog(path, texts)

    assert languages.read_catalog(path) == texts


def test_lines_of_japanese_are_not_too_wide(languages):
    text = "テイクを「クリーン」でもう一度インポートしてください。終わりです。"

    lines = languages.broken_lines(text, lambda line: len(line) <= 10)

    assert "".join(lines) == text and len(lines) > 2
    assert not any(line[0] in "。」" or line[-1] == "「" for line in lines)
    assert all(len(line) <= 11 for line in lines)  # and a period


def test_lines_of_words_are_broken_at_spaces(languages):
    assert languages.broken_lines("one two three", lambda line: len(line) <= 8) == [
        "one two",
        "three",
    ]
