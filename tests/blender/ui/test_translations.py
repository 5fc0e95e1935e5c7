"""Translations are complete, and of texts in the panels."""

from string import Formatter

import pytest

PANELS = [
    f"MOCAP_PT_{name}"
    for name in ("import", "clean", "check", "compare", "feet", "reconstruct", "retarget")
]


@pytest.fixture
def translations(load):
    return load("mocap_assist.ui.translations")


def texts_of(blank, draw, actor):
    """Return every label, and the name of every button and property, that panels show."""
    found, clean = set(), blank.context.scene.mocap_assist.clean
    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}
    assert blank.ops.mocap_assist.measure_quality() == {"FINISHED"}
    job = blank.context.window_manager.mocap_assist_job
    job.running, job.owner = True, "clean"
    for prior in ("EXAMPLES", "LEARNED"):
        clean.prior = prior
        for panel in PANELS:
            found |= {getattr(blank.types, panel).bl_label, *draw(panel)}
    job.running = False
    return found


def names_of(blank, drawn):
    """Return what Blender itself writes for the properties and buttons among these."""
    found = blank.context.scene.mocap_assist
    groups = [found.clean, found.check, found.reconstruct, found.retarget, found.unbake]
    groups.append(blank.context.window_manager)
    for group in groups:
        for each in group.bl_rna.properties:
            if each.identifier in drawn:
                yield each.name
                yield from (item.name for item in getattr(each, "enum_items", ()))
    for idname in drawn:
        if idname.startswith("mocap_assist."):
            button = getattr(blank.ops.mocap_assist, idname.partition(".")[2])
            yield button.get_rna_type().name
        if idname.startswith("MOCAP_MT_"):
            yield getattr(blank.types, idname).bl_label


def test_every_translated_text_is_in_a_panel(blank, load, draw, actor, translations):
    drawn = texts_of(blank, draw, actor)
    shown = drawn | set(names_of(blank, drawn))
    # What the recording layout cannot see: texts given to properties, and filled-in ones.
    elsewhere = {"Motion Model", "Left Foot Contact", "Right Foot Contact", "Made from {raw}"}
    elsewhere |= {"Previous", "Next"}
    # An unknown figure, as for feet that never stand, is not shown.
    elsewhere |= {label for label, *_ in load("mocap_assist.panels.figure_rows").FIGURES}

    assert set(translations.TEXTS) - shown - elsewhere == set()


def test_every_text_is_translated_into_every_language(translations):
    for english, texts in translations.TEXTS.items():
        assert len(texts) == len(translations.LANGUAGES), english
        assert all(texts), english


def test_translations_keep_placeholders(translations):
    def fields(text):
        return {name for _, name, _, _ in Formatter().parse(text) if name}

    for english, texts in translations.TEXTS.items():
        assert all(fields(text) == fields(english) for text in texts), english


def test_blender_translates_labels_and_buttons(translations):
    french = translations.dictionary()["fr_FR"]

    assert french["*", "Clean"] == french["Operator", "Clean"] == "Nettoyer"
