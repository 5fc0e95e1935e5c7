"""The button Import."""

import pytest


@pytest.fixture
def bring(blank):
    """Press Import; return the active object."""

    def press(*paths, **settings):
        files = [{"name": path.name} for path in paths]
        said = blank.ops.mocap_assist.import_recording(
            directory=str(paths[0].parent), files=files, **settings
        )
        assert said == {"FINISHED"}
        return blank.context.object

    return press
