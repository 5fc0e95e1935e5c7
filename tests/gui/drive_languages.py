"""The tab in other languages, at the width that Blender gives the sidebar.

    make test-gui DRIVERS=languages

It needs a Blender with its own translations, for the fonts and for the list of languages. The
pictures are for eyes: they show words that are cut.
"""

import bgui
import bpy
from driver_scene import WHEEL_DOWN, WHEEL_UP, empty_scene, scroll, settle, until_done

AWAY = (500, 500)
LANGUAGES = {"ja_JP": "クリーン", "de_DE": "Bereinigen"}
"""Wide characters and long words: by language the word for Clean."""


def steps():
    view = bpy.context.preferences.view
    yield from bgui.open_sidebar("Mocap")
    empty_scene()
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.load_sample()
    yield from settle(pointer=AWAY)
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.measure_quality("INVOKE_DEFAULT")
    yield from until_done()
    bpy.context.window_manager.mocap_assist_all_panels = True
    for language, clean in LANGUAGES.items():
        view.language = language
        assert bpy.app.translations.pgettext_iface("Clean") == clean
        yield from scroll(WHEEL_UP)
        bgui.shot(f"{language}-1.png")
        for page in range(2, 6):
            for _ in range(14):
                bgui.x("click", WHEEL_DOWN)
                yield 0.05
            yield from settle()
            bgui.shot(f"{language}-{page}.png")
    view.language = "en_US"


bgui.run(steps, timeout=600)
