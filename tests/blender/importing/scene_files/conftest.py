"""Fixtures of files that come in through Blender's importers."""

import pytest


@pytest.fixture
def bring(blank):
    """Import a file; return the armatures and the operator's result."""

    def bring(path):
        try:
            result = blank.ops.mocap_assist.import_recording(filepath=str(path))
        except RuntimeError as error:
            return [], str(error)
        return [each for each in blank.data.objects if each.type == "ARMATURE"], result

    return bring
