"""Each panel of the sidebar at its default width, in the languages that Blender has.

    make test-gui DRIVERS=languages

Runs inside a Blender with a window. It needs one that has its languages. The pictures are for
eyes: they show cut and untranslated words.
"""

import bgui
import bpy
from driver_scene import PANELS, empty_scene, settle, until_done

AWAY = (500, 500)
LANGUAGES = ("en_US", "de_DE", "fr_FR", "es", "zh_HANS", "ja_JP")
"""All that the extension speaks."""
PARTS = ("row", "column", "split", "box", "grid_flow")


class Unfolded:
    """A layout whose folds are open."""

    def __init__(self, layout):
        object.__setattr__(self, "layout", layout)

    def __getattr__(self, name):
        value = getattr(self.layout, name)
        return (lambda **named: Unfolded(value(**named))) if name in PARTS else value

    def __setattr__(self, name, value):
        setattr(self.layout, name, value)

    def panel(self, name, default_closed=False):
        return tuple(map(Unfolded, self.layout.panel(f"{name}_unfolded", default_closed=False)))


class Drawn:
    """A panel that draws into another layout."""

    def __init__(self, panel):
        self.panel, self.layout = panel, Unfolded(panel.layout)

    def __getattr__(self, name):
        return getattr(self.panel, name)


def our_panels():
    """Return the panels of the tab, and those inside them."""
    kinds = [getattr(bpy.types, each) for each in dir(bpy.types) if each.startswith(PANELS)]
    return [each for each in kinds if not each.__name__.endswith("_presets")]


def unfold(kinds, is_shown):
    """Show some panels alone, with all that is folded in them."""

    def unfolded(draw):
        return lambda self, context: draw(Drawn(self), context)

    parents_first = sorted(kinds, key=lambda kind: getattr(kind, "bl_parent_id", ""))
    for kind in reversed(parents_first):
        bpy.utils.unregister_class(kind)
    for kind in parents_first:
        kind.poll = classmethod(is_shown)
        kind.bl_options = set()
        kind.draw = unfolded(kind.draw)
        bpy.utils.register_class(kind)


def steps():
    view = bpy.context.preferences.view
    try:
        view.language = LANGUAGES[-1]
    except TypeError:
        print("languages: skipped, since this Blender has English alone.")
        return
    view.language = "en_US"
    empty_scene()
    kinds = our_panels()
    tops = [
        each
        for each in kinds
        if each.bl_space_type == "VIEW_3D" and not getattr(each, "bl_parent_id", "")
    ]
    shown = [tops[0].__name__]

    def is_shown(cls, context):
        return bool({cls.__name__, getattr(cls, "bl_parent_id", "")} & {*shown})

    unfold(kinds, is_shown)
    yield from bgui.open_sidebar("Mocap")
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.load_sample()
        bpy.ops.mocap_assist.measure_quality()
    yield from until_done()
    for language in LANGUAGES:
        view.language = language
        for kind in tops:
            shown[:] = [kind.__name__]
            name = f"{language}-{kind.__name__.removeprefix(PANELS)}"
            yield from settle(2, pointer=AWAY)
            bgui.shot(f"{name}.png")
    view.language = "en_US"


bgui.run(steps, timeout=1500)
