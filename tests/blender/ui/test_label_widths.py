"""No label left of its value is cut, in any language."""

import pytest

GROUPS = (
    "clean", "reconstruct", "track", "retrack", "retarget", "solve", "simulate", "vary", "find",
    "live", "fix", "export",
)  # fmt: skip
"""Settings that panels draw with the name left of the value, or right of a check box."""
FONT_PX = 11
NAME_PX, BOX_PX = 90, 112
"""Width of names and of check boxes at the sidebar's default width, as pictures of
`make test-gui DRIVERS=languages` show it."""


@pytest.fixture(scope="module")
def width():
    """Return a function that measures a text in the font of the interface."""
    import blf

    blf.size(0, FONT_PX)
    return lambda text: blf.dimensions(0, text)[0]


def labels(settings):
    """Yield the labels of all groups, and the room that each has."""
    for group in GROUPS:
        for each in getattr(settings, group).bl_rna.properties:
            if not each.is_hidden and each.type in {
                "BOOLEAN",
                "FLOAT",
                "INT",
                "ENUM",
                "STRING",
            }:
                yield each.name, BOX_PX if each.type == "BOOLEAN" else NAME_PX


def test_labels_are_not_cut(load, blank, width):
    languages = load("mocap_assist.languages")
    shown = set(labels(blank.context.scene.mocap_assist))
    assert len(shown) > 50

    catalogs = {
        language: languages.read_catalog(languages.catalog_path(language))
        for language in languages.LANGUAGES
    }
    for language, texts in {"en_US": {}, **catalogs}.items():
        cut = [
            f"{english}: {texts.get(english, english)}"
            for english, room in shown
            if width(texts.get(english, english)) > room
        ]
        assert not cut, language


LIST_PX, PADDING_PX = 226, 18
"""Width of a row of the list of issues at the sidebar's default width, and what a column of it
leaves free, as pictures of `make test-gui DRIVERS=clean` show both."""


def test_columns_of_the_issues_are_not_cut(load, blank, width):
    """Arm and leg were cut off of names such as rightUpperArm."""
    panel = load("mocap_assist.check.panel")
    kind = panel.KIND_COLUMN * LIST_PX
    bone = panel.BONE_COLUMN * (LIST_PX - kind)
    columns = {
        kind: ("Foot Slide", "Joint Limit", "Jitter"),
        bone: ("rightUpperArm", "rightLowerLeg", "RightForeArm"),
        LIST_PX - kind - bone: ("1480",),
    }
    for room, texts in columns.items():
        assert max(map(width, texts)) + PADDING_PX <= room, texts
