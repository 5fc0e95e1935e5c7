"""The variants that the sidebar lists; a .blend keeps them."""

import bpy

from . import listing


class MOCAP_PG_variant(bpy.types.PropertyGroup):
    """One variant; without an action it was deleted."""

    action: bpy.props.PointerProperty(type=bpy.types.Action)
    picked: bpy.props.BoolProperty(
        name="Picked",
        description="Keep this variant and use it for the buttons below",
        options=set(),
    )


class MOCAP_PG_variants(bpy.types.PropertyGroup):
    """Last variants, and their armature."""

    armature: bpy.props.PointerProperty(type=bpy.types.Object)
    rows: bpy.props.CollectionProperty(type=MOCAP_PG_variant)
    active: bpy.props.IntProperty(
        name="Variant",
        description="Selected variant; the armature plays it",
        update=listing.play_active,
    )


CLASSES = (MOCAP_PG_variant, MOCAP_PG_variants)
