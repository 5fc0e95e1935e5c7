"""The button Import, and a window in which it waits."""

import tempfile
from types import SimpleNamespace

import pytest

WALK = "07_01.bvh"


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


@pytest.fixture
def own_temporary_folder(tmp_path, monkeypatch):
    """Others that solve on this machine at the same time leave their folders elsewhere."""
    (tmp_path / "jobs").mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "jobs"))


@pytest.fixture
def walks(recordings, tmp_path):
    """Three files of a folder of their own: two walks, and between them one that is cut."""
    content = (recordings / "mocap" / "cmu_walk" / WALK).read_bytes()
    for name in ("first.bvh", "second.bvh"):
        (tmp_path / name).write_bytes(content)
    (tmp_path / "cut.bvh").write_bytes(content[:9000])
    return tmp_path


@pytest.fixture
def window(blank, own_temporary_folder):
    """The context that an operator gets in one, and what it does to it."""
    seen = SimpleNamespace(timers=[], status=[], reports=[])
    seen.job = blank.context.window_manager.mocap_assist_job
    seen.context = SimpleNamespace(
        scene=blank.context.scene,
        view_layer=blank.context.view_layer,
        window=None,
        window_manager=SimpleNamespace(
            event_timer_add=lambda *_, **__: seen.timers.append("timer") or "timer",
            event_timer_remove=seen.timers.remove,
            modal_handler_add=lambda _: None,
            mocap_assist_job=seen.job,
            windows=[],
        ),
        workspace=SimpleNamespace(status_text_set=seen.status.append),
    )
    return seen


@pytest.fixture
def press(load, window, walks):
    """Import files of the folder; return the operator, which waits."""
    choices = load("mocap_assist.import_choices")
    module = load("mocap_assist.import_operator")

    def start(*names, **chosen):
        class Operator(module.WaitingImport):
            directory, filepath = str(walks), ""
            files = tuple(SimpleNamespace(name=name) for name in names)
            poll_message_set = window.reports.append

            def settings(self):
                return choices.ImportSettings(choices.ImportChoices(**chosen))

            def report(self, kind, message):
                window.reports.append((kind, message))

        operator = Operator()
        assert operator.invoke(window.context, None) == {"RUNNING_MODAL"}
        return operator

    return start
