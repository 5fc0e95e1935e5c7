"""A layout that notes what a panel draws: Blender has none without a window."""

from types import SimpleNamespace

import pytest


class Noted:
    """Answers like `bpy.types.UILayout`, and refuses what Blender would refuse."""

    def __init__(self, bpy, drawn):
        self.bpy, self.drawn = bpy, drawn

    def prop(self, data, name, **_):
        known = name.startswith("[") or name in data.bl_rna.properties
        assert known, f"{data} has no {name}"
        self.drawn.append(name.strip('["]'))

    def prop_search(self, data, name, pool, pool_name, **_):
        assert pool_name in pool.bl_rna.properties, f"{pool} has no {pool_name}"
        self.prop(data, name)

    def operator(self, idname, **_):
        family, _, name = idname.partition(".")
        button = getattr(getattr(self.bpy.ops, family), name)
        options = button.get_rna_type().properties.keys()
        self.drawn.append(idname)
        return _Options(options)

    def label(self, text="", **_):
        self.drawn.append(text)

    def progress(self, text="", **_):
        self.drawn.append(text)

    def template_list(self, list_type, _, data, name, active_data, active, **__):
        kind = getattr(self.bpy.types, list_type)
        for index, item in enumerate(getattr(data, name)):
            kind.draw_item(None, self.bpy.context, self, data, item, 0, data, active, index)

    def template_icon(self, icon_value, scale=1.0):
        assert icon_value >= 0
        self.drawn.append("icon")

    def menu(self, name, **_):
        self.drawn.append(name)
        assert hasattr(self.bpy.types, name)

    def separator(self):
        pass

    def panel(self, _, default_closed=False):
        return self, self

    def _part(self, *_, **__):
        return self

    row = column = split = box = _part


class _Options:
    def __init__(self, names):
        object.__setattr__(self, "names", names)

    def __setattr__(self, name, value):
        assert name in self.names, f"the button has no {name}"


@pytest.fixture
def draw(blank):
    """Draw a panel, a menu or the preferences; return the texts and names in it."""

    def drawn(kind):
        kind = getattr(blank.types, kind) if isinstance(kind, str) else kind
        shown = []
        if not hasattr(kind, "poll") or kind.poll(blank.context):
            layout = Noted(blank, shown)
            kind.draw(SimpleNamespace(layout=layout, bl_rna=kind.bl_rna), blank.context)
        return shown

    return drawn


@pytest.fixture
def actor(make_armature, animate):
    """A figure with an action."""
    armature = make_armature()
    animate(armature)
    return armature
