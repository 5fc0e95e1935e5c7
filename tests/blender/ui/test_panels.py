"""What the sidebar shows, and when."""

import dataclasses
import typing
from collections import Counter

import pytest

RESEARCH = {
    "clean": {"method"},
    "reconstruct": {"method", "n_neighbors", "causal"},
    "retarget": set(),
    "physics": set(),
    "library": {"method", "busy", "stance", "n_warped", "warping", "n_neighbors"},
    "vary": {"method"},
    "check": set(),
}
EDITORS = {"": "VIEW_3D", "_graph": "GRAPH_EDITOR", "_dopesheet": "DOPESHEET_EDITOR"}
PANELS = ("import", "fix", "clean", "check", "compare", "feet", "retarget")


@pytest.mark.parametrize("suffix", EDITORS)
@pytest.mark.parametrize("panel", PANELS)
def test_every_panel_is_on_the_mocap_tab(blank, panel, suffix):
    kind = getattr(blank.types, f"MOCAP_PT_{panel}{suffix}")

    assert kind.bl_space_type == EDITORS[suffix]
    assert kind.bl_region_type == "UI"
    assert kind.bl_category == "Mocap"


@pytest.mark.usefixtures("all_panels")
def test_clean_panel_names_what_to_select_without_an_armature(draw):
    shown = draw("MOCAP_PT_clean")

    assert "mocap_assist.denoise" in shown
    assert "Select an animated armature" in " ".join(shown)


def test_clean_panel_shows_every_setting_once(blank, draw, actor, show_research):
    clean = blank.context.scene.mocap_assist.clean
    hidden = {"examples", "learned_file", "unswap"}  # the last one is for markers

    shown = draw("MOCAP_PT_clean")

    assert sorted(set(type(clean).setting_names) - hidden) == sorted(
        name for name in shown if name in type(clean).setting_names
    )
    assert "Select an animated armature" not in " ".join(shown)


def test_research_settings_are_shown_only_on_request(blank, draw, actor, request):
    vary = blank.context.scene.mocap_assist.vary
    shown = {name: draw(f"MOCAP_PT_{name}") for name in RESEARCH}
    vary.method = "PUBLISHED"
    assert "method" in draw("MOCAP_PT_vary")  # since it has an effect
    vary.property_unset("method")

    request.getfixturevalue("show_research")

    for name, settings in RESEARCH.items():
        added = Counter(draw(f"MOCAP_PT_{name}"))
        added.subtract(shown[name])
        assert {each for each, count in added.items() if count} == settings


def test_pattern_source_is_shown_only_when_used(blank, draw, actor):
    clean = blank.context.scene.mocap_assist.clean
    found = {}
    for prior in ("TAKE", "EXAMPLES", "LEARNED"):
        clean.prior = prior
        found[prior] = draw("MOCAP_PT_clean")

    assert [prior for prior in found if "MOCAP_MT_examples" in found[prior]] == ["EXAMPLES"]
    assert [prior for prior in found if "learned_file" in found[prior]] == ["LEARNED"]


def test_examples_are_added_from_a_menu_and_removed(blank, draw, actor):
    clean = blank.context.scene.mocap_assist.clean
    clean.prior = "EXAMPLES"
    run, jump = (blank.data.actions.new(name) for name in ("run", "jump"))
    add = blank.ops.mocap_assist.add_example
    assert draw("MOCAP_MT_examples").count("mocap_assist.add_example") == 2

    for example in (run, jump, run):
        assert add(example=example.name) == {"FINISHED"}
    assert clean.examples == "run; jump"
    assert {"run", "jump", "mocap_assist.learn_patterns"} <= set(draw("MOCAP_PT_clean"))
    assert "mocap_assist.add_example" not in draw("MOCAP_MT_examples")

    assert blank.ops.mocap_assist.remove_example(index=0) == {"FINISHED"}
    assert clean.examples == "jump"


def test_recordings_on_disk_can_be_examples(blank, draw, actor, tmp_path):
    clean = blank.context.scene.mocap_assist.clean
    clean.prior = "EXAMPLES"

    done = blank.ops.mocap_assist.add_example_files(
        directory=str(tmp_path), files=[{"name": "a.bvh"}, {"name": "b.bvh"}]
    )

    assert done == {"FINISHED"}
    assert clean.examples == f"{tmp_path / 'a.bvh'}; {tmp_path / 'b.bvh'}"
    assert {"a.bvh", "b.bvh"} <= set(draw("MOCAP_PT_clean"))


PANELS = {
    "import": "import", "clean": "clean", "reconstruct": "reconstruct", "check": "check",
    "simulate": "physics", "solve": "markers", "retarget": "retarget", "unbake": "retarget",
}  # fmt: skip


@pytest.mark.parametrize("owner", PANELS)
def test_running_solve_shows_its_progress_in_its_panel(blank, draw, actor, owner):
    if owner == "solve":
        blank.ops.object.empty_add()  # the panel is there for markers
        holder = blank.context.object
        blank.ops.object.empty_add()
        blank.context.object.parent = holder
        blank.context.object.keyframe_insert("location")
    job = blank.context.window_manager.mocap_assist_job
    job.running, job.fraction, job.message, job.owner = True, 0.4, "Working", owner
    try:
        shown = {panel: draw(f"MOCAP_PT_{panel}") for panel in PANELS.values()}
    finally:
        job.running = False

    working = {panel for panel, texts in shown.items() if {"Working", "40%"} <= set(texts)}
    assert working == {PANELS[owner]}
    assert "Esc cancels" in shown[PANELS[owner]]


def test_settings_of_unbake_have_a_heading(draw, actor):
    shown = draw("MOCAP_PT_retarget")

    assert shown.index("Reduce Keys") < shown.index("tolerance")


def test_work_that_esc_ends_has_no_bar(blank, draw, actor):
    job = blank.context.window_manager.mocap_assist_job
    job.running, job.fraction, job.message, job.owner = True, 1.0, "Working", "clean"
    try:
        shown = draw("MOCAP_PT_clean")
    finally:
        job.running = False

    assert "Working" in shown
    assert "100%" not in shown


def test_checked_take_lists_its_issues_with_buttons(blank, draw, actor):
    assert "mocap_assist.jump_to_issue" not in draw("MOCAP_PT_check")
    found = blank.context.scene.mocap_assist
    issue = found.issues.add()
    issue.name, issue.start, issue.stop, issue.kind = "LeftLeg", 12.0, 15.0, "spike"
    issue.sentence = "LeftLeg jumps at frame 12."

    shown = draw("MOCAP_PT_check")

    assert shown.count("mocap_assist.jump_to_issue") == 3 + 2  # kind, bone and frame
    assert "LeftLeg jumps at frame 12." in " ".join(shown)


def test_issues_of_another_action_are_labeled(blank, draw, actor):
    action = actor.animation_data.action
    for curve in action.layers[0].strips[0].channelbag(action.slots[0]).fcurves:
        curve.keyframe_points[30].co.y += 1.0
    assert blank.ops.mocap_assist.measure_quality() == {"FINISHED"}
    assert blank.context.scene.mocap_assist.issues
    stale = 'Results are for "walk".'
    assert stale not in " ".join(draw("MOCAP_PT_check"))

    assert blank.ops.mocap_assist.denoise(plant_feet=False) == {"FINISHED"}

    assert stale in " ".join(draw("MOCAP_PT_check"))


def test_result_shows_figures_source_and_contacts(blank, draw, actor):
    assert draw("MOCAP_PT_feet") == ["mocap_assist.plant_feet"]
    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}

    assert {"Before", "After", "Spikes"} <= set(draw("MOCAP_PT_check"))
    assert {"walk.clean", "Made from walk"} <= set(draw("MOCAP_PT_compare"))
    assert {"mocap_contact_left", "mocap_contact_right"} <= set(draw("MOCAP_PT_feet"))


def test_menu_has_the_buttons(draw):
    shown = draw("MOCAP_MT_clean")

    assert shown[:3] == [
        "mocap_assist.import_recording", "mocap_assist.load_sample", "mocap_assist.fix_take",
    ]  # fmt: skip
    assert {"mocap_assist.denoise", "mocap_assist.index_library"} <= set(shown)


@pytest.mark.parametrize("group", ["clean", "check"])
def test_sidebar_has_the_defaults_of_the_solvers(blank, load, group):
    shown = getattr(blank.context.scene.mocap_assist, group)
    bundle = {
        "clean": load("mocap_assist.clean.button_settings").CleanBundle,
        "check": load("mocap_assist.check.button_settings").CheckBundle,
    }[group]

    for name, kind in typing.get_type_hints(bundle).items():
        for item in dataclasses.fields(kind):
            value = getattr(getattr(shown.settings(), name), item.name)
            assert value == pytest.approx(item.default) or value is item.default, item.name


def test_figures_compare_the_raw_take_with_the_last_result(load):
    rows = load("mocap_assist.panel_parts.figure_rows").figure_rows([
        {"before": {"spikes": 7, "missing_share": 0.013}, "after": {"spikes": 2}},
        {"operation": "other"},
        {"before": {"spikes": 2}, "after": {"spikes": 0, "missing_share": 0.0}},
    ])

    assert rows == [("Spikes", "7", "0"), ("Missing (%)", "1.3", "0.0")]


def test_unknown_figure_is_a_dash(load):
    rows = load("mocap_assist.panel_parts.figure_rows").figure_rows([
        {"before": {"longest_foot_slide_cm": None}, "after": {"longest_foot_slide_cm": 1.25}}
    ])

    assert rows == [("Longest Slide (cm)", "–", "1.2")]


@pytest.mark.parametrize(("degrees", "unit"), [(2.5, "°"), (None, "mm")])
def test_jitter_of_joints_is_in_degrees_and_that_of_markers_in_millimeters(load, degrees, unit):
    figures = {"mean_rotation_noise_deg": degrees, "mean_position_noise_mm": 4.25}
    rows = load("mocap_assist.panel_parts.figure_rows").figure_rows([
        {"before": figures, "after": figures}
    ])

    assert [row.label for row in rows] == [f"Jitter ({unit})"]


def test_frame_ranges_are_formatted_as_text(load):
    frames_text = load("mocap_assist.panel_parts.figure_rows").frames_text

    assert frames_text(12.0, 12.0) == "12"
    assert frames_text(12.0, 15.5) == "12 – 15.5"


@pytest.mark.parametrize(("frame", "text"), [(-100.3, "-100"), (-0.3, "0"), (12345.6, "12346")])
def test_frames_of_a_narrow_sidebar_have_no_decimals(load, frame, text):
    assert load("mocap_assist.panel_parts.figure_rows").frame_text(frame) == text


def test_long_sentence_is_wrapped_to_the_sidebar(load):
    lines = load("mocap_assist.panel_parts.panel_layout").column_lines
    sentence = "Select an animated armature."

    assert len(lines(sentence, 140, 11.0)) > len(lines(sentence, 160, 11.0)) == 1
    assert " ".join(lines(sentence, 0, 11.0)) == sentence


def test_lines_of_sentences_use_their_width(load):
    """Seen in the import dialog: 250 of its 400 pixels were used."""
    import blf

    lines = load("mocap_assist.panel_parts.panel_layout").column_lines
    words = "i" * 6

    found = lines(" ".join([words] * 40), 300, 11.0)

    blf.size(0, 11)
    used = [blf.dimensions(0, line)[0] for line in found]
    assert max(used) <= 300 and used[0] > 300 - blf.dimensions(0, f" {words}")[0]


def test_reconstruct_panel_shows_settings_and_colors(blank, draw, actor):
    shown = draw("MOCAP_PT_reconstruct")

    assert {
        "postures",
        "plant_feet",
        "mocap_assist.reconstruct",
        "mocap_assist_confidence",
    } <= set(shown)


def test_posture_clips_have_a_separate_list(blank, draw, actor):
    settings = blank.context.scene.mocap_assist
    settings.reconstruct.postures = "EXAMPLES"
    assert "MOCAP_MT_posture_examples" in draw("MOCAP_PT_reconstruct")

    blank.ops.mocap_assist.add_example(example="run", group="reconstruct")
    blank.ops.mocap_assist.add_example_folder(directory="/clips/", group="reconstruct")

    assert settings.reconstruct.examples == "run; /clips"
    assert settings.clean.examples == ""
    blank.ops.mocap_assist.remove_example(index=0, group="reconstruct")
    assert settings.reconstruct.examples == "/clips"
