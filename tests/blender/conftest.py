"""Install the zip into a throw-away Blender, start that Blender, and test what is installed.

    MOCAP_ASSIST_ZIP=dist/mocap_assist-VERSION-linux_x64.zip \
        timeout 300 .venv-4.5/bin/python -m pytest tests/blender

The zip is installed by one process and used by the next, as an animator's is from the second
start on: only then do the extension's wheels come before the libraries of this Python.
"""

import importlib
import os
import shutil
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

pytest_plugins = (
    "armature_fixtures", "common_fixtures", "panel_fixtures", "renewing_fixtures",
    "rig_fixtures", "rigify_fixtures", "solve_fixtures", "followed_fixtures",
    "tracked_fixtures", "window_fixtures",
)  # fmt: skip

PACKAGE = "bl_ext.user_default.mocap_assist"
CHECKOUT = Path(__file__).resolve().parents[2]
RESOURCES = pytest.StashKey[Path]()
EXIT_STATUS = pytest.StashKey[int]()

WARNED: list[str] = []
NOT_OURS = ("unclosed file:ResourceWarning:.*import_bvh",)
"""Warnings that Blender's own scripts cause, as filters of Python's."""

IN_ONE_BLENDER = {
    "exporting/test_export_take.py": (5, 2),
    "exporting/test_linked_and_nla.py": (4, 5),
    "exporting/test_rigs_and_meshes.py": (4, 5),
    "fixing/test_fix_for_a_rig.py": (5, 2),
    "fixing/test_fix_take.py": (5, 2),
    "fixing/test_many_takes.py": (5, 2),
    "fixing/test_submit_folder.py": (5, 2),
    "importing/test_change_axes.py": (4, 5),
    "importing/test_failing_readers.py": (5, 2),
    "importing/test_import_options.py": (5, 2),
    "importing/test_import_to_retarget.py": (4, 5),
    "importing/test_joint_recordings.py": (5, 2),
    "importing/test_make_skeleton.py": (5, 2),
    "importing/test_marker_cleaning.py": (4, 5),
    "importing/test_marker_look.py": (5, 2),
    "importing/scene_files/test_refused_scene_files.py": (4, 5),
    "importing/scene_files/test_scene_files_in_batches.py": (4, 5),
    "importing/test_several_bodies.py": (5, 2),
    "importing/test_skinned_meshes.py": (5, 2),
    "importing/test_units.py": (5, 2),
    "importing/test_waiting_import.py": (5, 2),
    "library/test_actions_without_rig.py": (4, 5),
    "library/test_auto_update.py": (4, 5),
    "library/test_bad_input.py": (4, 5),
    "library/test_faults_in_files.py": (4, 5),
    "library/test_find.py": (5, 2),
    "library/test_gallery.py": (5, 2),
    "library/test_index_at_once.py": (4, 5),
    "library/test_index_blends.py": (4, 5),
    "library/test_index_button.py": (5, 2),
    "library/test_learn_from_library.py": (4, 5),
    "library/test_library_commands.py": (4, 5),
    "library/test_load.py": (4, 5),
    "library/test_match_uses.py": (5, 2),
    "library/test_performing.py": (4, 5),
    "library/test_use_matches.py": (4, 5),
    "live/test_record_live.py": (5, 2),
    "operators/test_clean_extremes.py": (4, 5),
    "operators/test_clean_guides.py": (5, 2),
    "operators/test_clean_large.py": (5, 2),
    "operators/test_clean_strength.py": (5, 2),
    "operators/test_command.py": (5, 2),
    "operators/test_delta_layer.py": (5, 2),
    "operators/test_each_command.py": (4, 5),
    "operators/test_each_killed.py": (5, 2),
    "operators/test_each_on_many_machines.py": (4, 5),
    "operators/test_other_buttons.py": (4, 5),
    "operators/test_physics.py": (4, 5),
    "operators/test_undo.py": (5, 2),
    "operators/test_waiting.py": (4, 5),
    "reconstruction/test_blend_examples.py": (4, 5),
    "reconstruction/test_bone_lengths.py": (4, 5),
    "reconstruction/test_confidence_colors.py": (4, 5),
    "reconstruction/test_custom_models.py": (4, 5),
    "reconstruction/test_reconstruct.py": (4, 5),
    "reconstruction/test_reconstruct_command.py": (4, 5),
    "reconstruction/test_refusals.py": (4, 5),
    "reconstruction/test_reliability_terms.py": (4, 5),
    "reconstruction/test_source.py": (5, 2),
    "reconstruction/test_then_clean.py": (5, 2),
    "reconstruction/test_waiting_reconstruct.py": (5, 2),
    "retargeting/test_bone_list.py": (4, 5),
    "retargeting/test_many_actions.py": (5, 2),
    "retargeting/test_named_rigs.py": (4, 5),
    "retargeting/test_retarget_command.py": (4, 5),
    "retargeting/test_rigify.py": (5, 2),
    "retargeting/test_rigify_from_file.py": (5, 2),
    "retargeting/test_source_unchanged.py": (4, 5),
    "retargeting/test_unbake.py": (5, 2),
    "scene/test_sample_times.py": (4, 5),
    "test_bad_input.py": (4, 5),
    "test_invalid_scenes.py": (4, 5),
    "test_job_endings.py": (5, 2),
    "test_rigify_rig.py": (4, 5),
    "test_waiting_child.py": (5, 2),
    "tracking/test_body.py": (5, 2),
    "tracking/test_capture_command.py": (5, 2),
    "tracking/test_fix_depth.py": (4, 5),
    "tracking/test_live_preview.py": (5, 2),
    "tracking/test_other_scenes.py": (4, 5),
    "tracking/test_retrack.py": (4, 5),
    "tracking/test_track.py": (5, 2),
    "ui/test_catalogs.py": (4, 5),
    "ui/test_show_raw.py": (4, 5),
    "ui/test_issue_views.py": (4, 5),
    "overlays/test_onion_skin.py": (5, 2),
    "overlays/test_raw_curves.py": (5, 2),
    "overlays/test_strip.py": (5, 2),
    "variation/test_slices.py": (4, 5),
    "variation/test_variants.py": (4, 5),
    "variation/test_vary.py": (5, 2),
    "variation/test_vary_rigify.py": (5, 2),
    "ui/test_label_widths.py": (5, 2),
}
"""Long tests, each file of which runs in one of the two Blenders; the others run in both."""
ONLY_IN = {Path(__file__).parent / name: where for name, where in IN_ONE_BLENDER.items()}
assert all(path.exists() for path in ONLY_IN)

# Blender may hang at exit once classes were registered, hence os._exit here and below.
INSTALL = """
import os, sys, traceback
import bpy
try:
    bpy.ops.extensions.package_install_files(
        filepath=sys.argv[1], repo="user_default", enable_on_install=True
    )
except BaseException:
    traceback.print_exc()
    sys.stderr.flush()
    os._exit(1)
os._exit(0)
"""


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("filterwarnings", "always")
    for warning in NOT_OURS:
        config.addinivalue_line("filterwarnings", f"ignore:{warning}")
    zipped = Path(os.environ.get("MOCAP_ASSIST_ZIP", "")).resolve()
    if not zipped.is_file():
        pytest.exit(
            "MOCAP_ASSIST_ZIP must name the extension's zip; see `make test-blender`.", 2
        )
    sys.path[:] = [path for path in sys.path if Path(path).resolve() != CHECKOUT]

    config.stash[RESOURCES] = Path(tempfile.mkdtemp(prefix="mocap-assist-blender-"))
    os.environ["BLENDER_USER_RESOURCES"] = str(config.stash[RESOURCES])
    installed = subprocess.run(
        [sys.executable, "-c", INSTALL, str(zipped)],
        capture_output=True,
        text=True,
        timeout=500,
        check=False,
        cwd=config.stash[RESOURCES],
    )
    if installed.returncode:
        shutil.rmtree(config.stash[RESOURCES])
        pytest.exit(
            f"{zipped.name} was not installed.\n{installed.stdout}{installed.stderr}", 1
        )
    import bpy  # noqa: F401 - starts Blender, and makes its own modules importable
    from addon_utils import enable

    assert enable(PACKAGE, default_set=True), f"{PACKAGE} cannot be switched on"


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Skip what runs in another Blender, unless the file is named."""
    import bpy

    version = bpy.app.version[:2]
    if ONLY_IN.get(collection_path, version) == version:
        return None
    named = [
        (config.invocation_params.dir / arg.split("::")[0]).resolve() for arg in config.args
    ]
    return collection_path not in named or None


def pytest_warning_recorded(
    warning_message: warnings.WarningMessage, nodeid: str, location: object
) -> None:
    """Note what no test may leave behind: at the end each of them is a failure.

    A warning that were an error at once would be raised within Blender's own code, which may
    swallow it or let it through to the next call, as chance will have it.
    """
    name = warning_message.category.__name__
    WARNED.append(f"{nodeid}: {name}: {warning_message.message}")


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    if WARNED:
        terminalreporter.section(f"{len(WARNED)} warnings, each of which is a failure")
        terminalreporter.write_lines(WARNED)


def pytest_report_header(config: pytest.Config) -> str:
    import bpy

    zipped, version = os.environ["MOCAP_ASSIST_ZIP"], bpy.app.version[:2]
    n_elsewhere = sum(where != version for where in ONLY_IN.values())
    return (
        f"Blender {bpy.app.version_string}, numpy {np.__version__}, {zipped};"
        f" {n_elsewhere} files run in another Blender"
    )


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    session.config.stash[EXIT_STATUS] = int(exitstatus) or int(bool(WARNED))


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config: pytest.Config) -> None:
    if RESOURCES not in config.stash:
        return
    shutil.rmtree(config.stash[RESOURCES], ignore_errors=True)
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(config.stash.get(EXIT_STATUS, 1))


@pytest.fixture(scope="session")
def load() -> Callable[[str], ModuleType]:
    """Import a module of the installed extension: `load("solvers.denoising").denoise`."""
    return lambda name: importlib.import_module(f"{PACKAGE}.{name}")


@pytest.fixture(scope="session")
def extension() -> ModuleType:
    """The installed extension's root package."""
    return importlib.import_module(PACKAGE)


@pytest.fixture
def command(
    load: Callable[[str], ModuleType], capsys: pytest.CaptureFixture[str]
) -> Callable[..., tuple[int, str, str]]:
    """Run `blender FILE --command mocap_assist ...`; return status, stdout and stderr."""
    run = load("mocap_assist.batch.command").run

    def call(*words: object) -> tuple[int, str, str]:
        status = run([str(word) for word in words])
        return status, *capsys.readouterr()

    return call


@pytest.fixture
def blank() -> ModuleType:
    """`bpy`, with an empty scene; the extension stays switched on, and has found nothing."""
    import bpy

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    matches = bpy.context.window_manager.mocap_assist_matches  # No file replaces these.
    matches.rows.clear()
    matches.search = matches.active = 0
    return bpy
