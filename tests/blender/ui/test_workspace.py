"""The workspace is added once, in a window; the driver `strip` looks at its areas."""

from types import SimpleNamespace


def test_existing_workspace_is_shown(blank, load):
    workspace, window = load("mocap_assist.ui.workspace"), SimpleNamespace(workspace=None)
    known = blank.data.workspaces[0]
    known.name = workspace.NAME

    message = workspace.add_workspace(SimpleNamespace(window=window))

    assert window.workspace == known
    assert message == "The workspace Mocap is there already."


def test_button_is_gray_without_a_window(blank):
    assert not blank.ops.mocap_assist.add_workspace.poll()


def test_steps_have_a_turn_each_and_waiting_ends(load, monkeypatch):
    workspace = load("mocap_assist.ui.workspace")
    manager = SimpleNamespace(windows=[])
    context = SimpleNamespace(window_manager=manager)
    monkeypatch.setattr(workspace, "bpy", SimpleNamespace(context=context))
    monkeypatch.setattr(workspace, "arranging", lambda window: iter([None, None]))
    waiting, lost = workspace._Arranging("Mocap"), workspace._Arranging("Removed")
    assert waiting() == workspace.WAIT_S

    manager.windows.append(SimpleNamespace(workspace=SimpleNamespace(name="Mocap")))

    assert [waiting() for _ in range(3)] == [workspace.WAIT_S, workspace.WAIT_S, None]
    waits = [lost() for _ in range(workspace.MAX_WAITS)]
    assert waits[-2:] == [workspace.WAIT_S, None]


def test_tab_of_the_sidebar_is_opened_once_it_is_there(load):
    class Sidebar:
        type, tabs = "UI", ()

        def __setattr__(self, name, value):
            if value not in self.tabs:
                raise TypeError(value)
            object.__setattr__(self, name, value)

    show_tab, sidebar = load("mocap_assist.ui.workspace")._show_tab, Sidebar()
    area = SimpleNamespace(regions=[SimpleNamespace(type="WINDOW"), sidebar])
    assert not show_tab(area)

    Sidebar.tabs = ("Item", "Mocap")

    assert show_tab(area)
    assert sidebar.active_panel_category == "Mocap"
