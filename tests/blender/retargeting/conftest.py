"""A rig by Rigify, brought into the scene."""

import pytest


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
