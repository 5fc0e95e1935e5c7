"""Takes of very many bones or frames are read a little at a time, however slow the machine.

Of 2,000 bones the solve, which has a process of its own, takes minutes: it is left out.
"""

import itertools
import pickle

import numpy as np
import pytest

N_TIME_CHECKS = 400
"""How often the work checks the time in one time slice."""


def bones(n_bones):
    """Hips, and all others as their children."""
    others = {
        f"Bone{number}": ("Hips", (0.001 * number, 0, 1.1), (0.001 * number, 0, 1.2), False)
        for number in range(1, n_bones)
    }
    return {"Hips": (None, (0, 0, 1.0), (0, 0, 1.1), False)} | others


@pytest.fixture
def work_of(load, monkeypatch):
    """Count the bones and curves read, or frames evaluated, in each time slice."""
    counted = {"bone": 0, "keys": 0, "frames": 0}

    def count(owner, name, kind, size=lambda *_: 1):
        works = getattr(owner, name)

        def work(*given, **named):
            counted[kind] += size(*given)
            return works(*given, **named)

        monkeypatch.setattr(owner, name, work)

    channel = load("mocap_assist.actions.curves").Channel
    count(load("mocap_assist.actions.armature_read"), "read_bone", "bone")
    count(channel, "read_keys", "keys")
    count(channel, "_evaluate_curve", "frames", lambda _, frames: len(frames))

    def time_slice():
        done = dict(counted)
        counted.update(dict.fromkeys(counted, 0))
        return done

    return time_slice


@pytest.fixture
def read_in_slices(load, monkeypatch, blank, work_of):
    """Read as Clean does; return the problem, and the work of each time slice."""
    time_slices = load("mocap_assist.blender.time_slices")
    clock = itertools.count()
    monkeypatch.setattr(time_slices, "monotonic", lambda: next(clock))  # each look is a second

    def read(armature):
        button_settings, denoising = (
            load("mocap_assist.clean.button_settings"),
            load("solvers.denoising"),
        )
        settings = button_settings.CleanBundle(
            button_settings.CleanChoices(plant_feet=False),
            denoising.DenoiseSettings(),
            denoising.PlantSettings(),
        )
        reading = load("mocap_assist.clean.scene_cleaning").read_cleaning
        work, done = time_slices.Work(reading, blank.context.scene, armature, settings), []
        while not work.run_slice(N_TIME_CHECKS):
            done.append(work_of())
        return work.result.args[0], [*done, work_of()]

    return read


@pytest.mark.parametrize(("n_bones", "n_frames"), [(2000, 6), (2, 100_000)])
def test_each_time_slice_does_part_of_the_work(
    make_armature, animate, read_in_slices, n_bones, n_frames
):
    armature = make_armature(bones(n_bones))
    animate(armature, frames=range(1, n_frames + 1))

    problem, time_slices = read_in_slices(armature)

    (body,) = problem.recordings
    assert body.n_frames == n_frames and set(bones(n_bones)) <= set(body.skeleton.names)
    assert np.isfinite(body.rotations).all()
    assert (
        len(time_slices) >= 6 * n_bones // N_TIME_CHECKS
    )  # 4 curves of each bone, and twice itself
    for kind, total in (("bone", n_bones), ("keys", 4 * n_bones + 3)):
        assert sum(time_slice[kind] for time_slice in time_slices) == total
        assert max(time_slice[kind] for time_slice in time_slices) <= N_TIME_CHECKS
    assert not any(
        time_slice["frames"] for time_slice in time_slices
    )  # keys lie on all of them


def test_clean_finishes_on_a_long_take(make_armature, animate, blank):
    armature = make_armature(bones(2))
    raw = animate(armature, frames=range(1, 20_001))

    assert blank.ops.mocap_assist.denoise(plant_feet=False) == {"FINISHED"}

    assert armature.animation_data.action != raw


@pytest.fixture
def writing(load, make_armature, animate, blank, monkeypatch):
    """Work that writes back what an armature plays, and the looks at the clock."""
    load("mocap_assist.actions.armature_read")
    armature = make_armature(bones(60))
    source = (animate(armature, frames=range(1, 7)), armature.animation_data.action_slot)
    take = load("mocap_assist.actions.armature_read").read_take(armature, blank.context.scene)
    time_slices = load("mocap_assist.blender.time_slices")
    clock = itertools.count()
    monkeypatch.setattr(time_slices, "monotonic", lambda: next(clock))
    write = load("mocap_assist.actions.armature_write").write_take
    return time_slices.Work(write, armature, source, take, take.rig.bones, {}), source[0]


def test_bones_are_written_a_few_at_a_time(blank, writing):
    work, raw = writing
    n_slices = 1
    while not work.run_slice(10):
        n_slices += 1

    assert n_slices >= 60 // 10
    result, _ = work.result
    assert result != raw and len(result.layers[0].strips[0].channelbags[0].fcurves) == 243


def test_cancelled_writing_leaves_no_action(blank, writing):
    work, raw = writing
    while not len(blank.data.actions) > 1:  # until the copy is made
        assert not work.run_slice(3)

    work.stop()

    assert list(blank.data.actions) == [raw]


def test_file_saved_during_writing_lacks_the_result(blank, writing, tmp_path):
    work, raw = writing
    while not len(blank.data.actions) > 1:  # until the copy is made
        assert not work.run_slice(3)

    blank.ops.wm.save_as_mainfile(filepath=str(tmp_path / "during.blend"), copy=True)
    while not work.run_slice(10):
        pass
    blank.ops.wm.save_as_mainfile(filepath=str(tmp_path / "after.blend"), copy=True)

    assert actions_in(blank, tmp_path / "during.blend") == [raw.name]
    assert actions_in(blank, tmp_path / "after.blend") == [raw.name, f"{raw.name}.clean"]


def actions_in(bpy, path):
    with bpy.data.libraries.load(str(path)) as (content, _):
        return sorted(content.actions)


def test_answer_of_clean_holds_each_motion_once(load):
    samples, denoising = load("solvers.samples"), load("solvers.denoising")
    solving = load("mocap_assist.clean.solve_cleaning")
    walk = samples.noisy_walk()
    problem = solving.Problem(recordings=(walk,), settings=denoising.DenoiseSettings())
    finish = solving.Finish(
        strengths=dict.fromkeys(
            ["strength", *denoising.PART_STRENGTHS.values()], np.ones(walk.n_frames)
        ),
        keyed=(),
        ease=np.ones(walk.n_frames),
        chosen=frozenset(walk.skeleton.names),
        planting=denoising.PlantSettings(),
    )

    cleaned = solving.clean(problem, finish)

    size = len(pickle.dumps(cleaned)) / len(pickle.dumps(problem))
    assert size < 3.5  # the estimate, the result, and what the report measures
