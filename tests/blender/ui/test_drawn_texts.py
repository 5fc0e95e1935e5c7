"""What panels draw in the languages of the window."""

from pathlib import Path

import pytest


@pytest.mark.usefixtures("all_panels", "show_research")
def test_texts_that_blender_translates_are_in_the_catalogs(blank, draw, actor, load):
    languages, queue = load("mocap_assist.languages"), load("mocap_assist.fix.queue")
    takes = [queue.TakeOfFile(Path(f"{each.name}.bvh")) for each in queue.Status]
    queue.show_takes(takes)
    for index, status in enumerate(queue.Status):
        queue.show_status(index, status)
    shown = blank.context.scene.mocap_assist
    shown.library.asset_libraries = True

    for name in dir(blank.types):
        if name.startswith(("MOCAP_PT_", "MOCAP_MT_")):
            draw(name)

    french = languages.read_catalog(languages.catalog_path("fr_FR"))
    texts = draw.translated_by_blender
    assert {"Fixed", "Depth Camera"} <= texts and len(texts) > 20
    assert not texts - set(french)
