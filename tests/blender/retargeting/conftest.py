"""A rig by Rigify, generated once."""

import os
import subprocess
import sys

import pytest

GENERATE = """
import os, sys
import bpy, addon_utils
status = 1
try:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    addon_utils.enable("rigify", default_set=True)
    bpy.ops.object.armature_human_metarig_add()
    bpy.ops.pose.rigify_generate()
    rig = bpy.context.view_layer.objects.active
    rig.name = "Hero"
    for other in list(bpy.data.objects):
        if other != rig and other.type == "ARMATURE":
            bpy.data.objects.remove(other)
    bpy.ops.wm.save_as_mainfile(filepath=sys.argv[1])
    status = 0
finally:
    os._exit(status)
"""


@pytest.fixture(scope="session")
def rigify_file(tmp_path_factory):
    """A .blend with a generated human, the armature Hero; made in a Blender of its own."""
    path = tmp_path_factory.mktemp("rigify") / "hero.blend"
    settings = tmp_path_factory.mktemp("settings")
    subprocess.run(
        [sys.executable, "-c", GENERATE, str(path)],
        check=True,
        capture_output=True,
        timeout=110,
        env=os.environ | {"BLENDER_USER_RESOURCES": str(settings)},
    )
    return path


@pytest.fixture
def bring(blank, rigify_file):
    """Append the rig, link it, or link and override it: `bring("overridden")`."""

    def brought(how="appended"):
        with blank.data.libraries.load(str(rigify_file), link=how != "appended") as (_, found):
            found.objects = ["Hero"]
        hero = blank.data.objects["Hero"]
        if how == "overridden":
            blank.context.scene.collection.objects.link(hero)
            hero = hero.override_hierarchy_create(blank.context.scene, blank.context.view_layer)
        if hero.name not in blank.context.scene.objects:
            blank.context.scene.collection.objects.link(hero)
        return hero

    return brought


@pytest.fixture
def hero(bring):
    """The rig, appended."""
    return bring()
