"""A take learns from what a library has that is like it, and from nothing else."""

import sys

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from solvers.denoising import denoise
from solvers.errors import InvalidFileError, InvalidMotionError, SolveCancelled
from solvers.motion import Motion, Tracks, resample
from solvers.recordings import read_acclaim, write_bvh
from solvers.retrieval import Clip, Origin, build_clip_library, load_clip_library
from solvers.rotations.representations import (
    angle_between,
    multiply,
    quaternion_from_rotation_vector,
)
from solvers.samples import GaitSettings, walking_gait
from solvers.workflows import bases_from_library, clean_from_library, index_files
from solvers.workflows.library_clips import read_origin


def walk(cadence: float, speed: float = 1.0, duration: float = 3.0) -> Motion:
    return walking_gait(
        GaitSettings(cadence=cadence, speed=speed, duration=duration, frame_rate=30.0)
    )


WALKS = {f"walk {cadence}": walk(cadence) for cadence in (100, 110, 120, 130)}


@pytest.fixture(scope="module")
def library():
    return build_clip_library(Clip(name, motion) for name, motion in WALKS.items())


def fetched(entry):
    return WALKS[entry.name]


def without_a_leg(motion: Motion, frames=slice(30, 60)) -> Motion:
    rotations = motion.rotations.copy()
    top = next(joint for joint, name in enumerate(motion.skeleton.names) if name == "LeftUpLeg")
    leg = [top, *motion.skeleton.subtree(top)]
    rotations[frames, leg] = np.nan
    return motion.with_poses(rotations)


def error(found: Motion, truth: Motion, frames=slice(30, 60)) -> float:
    distance = angle_between(found.rotations, truth.rotations)
    return float(np.degrees(distance[frames]).mean())


def test_missing_leg_is_filled_from_similar_clips(library):
    truth = walk(115)
    dirty = without_a_leg(truth)
    before, messages = dirty.rotations.copy(), []

    cleaned = clean_from_library(
        dirty, library, fetch=fetched,
        progress=lambda fraction, message="": messages.append(fraction),
    )  # fmt: skip

    assert "Learned from 4 clips of the library: walk 1" in cleaned.prior_used
    assert error(cleaned.recording, truth) < 0.5 * error(denoise(dirty).recording, truth)
    assert np.isfinite(cleaned.recording.rotations).all()
    assert_array_equal(dirty.rotations, before)
    assert messages == sorted(messages)
    assert messages[-1] == 1.0


def test_learned_prior_equals_that_of_the_clips(library):
    learned = bases_from_library(walk(115), library, fetch=fetched)

    assert set(learned.clips) == set(WALKS)
    assert int(learned.bases.n_clips) == 4
    assert learned.message.startswith("Learned from 4 clips of the library: ")


def test_more_similar_clips_have_more_weight(monkeypatch, library):
    messages = []
    here = sys.modules["solvers.workflows.clean_from_library"]
    learn = here.learn_filter_bases

    def learned(clips, *, weights, **options):
        messages.extend(weights)
        return learn(clips, weights=weights, **options)

    monkeypatch.setattr(here, "learn_filter_bases", learned)
    found = bases_from_library(walk(111), library, fetch=fetched)

    assert found.clips[0] == "walk 110"
    assert messages == sorted(messages, reverse=True)
    assert messages[0] > 1.5 * messages[-1]


@pytest.mark.parametrize(("score", "n_validations"), [(0.0, 0), (1.1, 1)])
def test_clips_with_a_low_score_are_validated(monkeypatch, library, score, n_validations):
    here, validated = sys.modules["solvers.workflows.clean_from_library"], []
    monkeypatch.setattr(here, "MIN_CONFIDENT_SCORE", score)
    monkeypatch.setattr(here, "prior_fills_gaps", lambda take, *_: validated.append(take))
    learned = bases_from_library(without_a_leg(walk(115)), library, fetch=fetched)
    assert len(validated) == n_validations
    assert (learned.bases is None) == bool(n_validations)
    assert ("not used: they predict" in learned.message) == bool(n_validations)


def test_ignored_clips_are_not_learned_from(library):
    away = ["walk 110", "walk 120"]
    learned = bases_from_library(walk(115), library, ignore=away, fetch=fetched)
    assert set(learned.clips) == {"walk 100", "walk 130"}


def test_only_matching_frames_are_learned_from(monkeypatch, library):
    learned_of = []
    monkeypatch.setattr(
        sys.modules["solvers.workflows.clean_from_library"],
        "learn_filter_bases",
        lambda clips, **options: learned_of.extend(clips),
    )
    long = walk(115, duration=30.0)
    of_one = build_clip_library([Clip("long", long)])

    bases_from_library(walk(115).slice(0, 90), of_one, fetch=lambda entry: long)

    assert 90 <= learned_of[0].n_frames <= 90 + 2 * 15 + 45


def test_library_of_other_movements_does_not_degrade_the_result(recordings):
    hdm05 = recordings / "mocap" / "hdm05"
    files = {kind: sorted(hdm05.glob(f"HDM_d*_{kind}*_120.amc"))[:3]
             for kind in ("squat1Reps", "lieDownFloor", "kickLFront1Reps")}  # fmt: skip
    clips = {path.stem: resample(read_acclaim(path), 30.0)
             for paths in files.values() for path in paths}  # fmt: skip
    of_others = build_clip_library(Clip(name, motion) for name, motion in clips.items())
    own = clips[files["squat1Reps"][0].stem]
    squats = [path.stem for path in files["squat1Reps"]]

    def fetch(entry):
        return clips[entry.name]

    harmless = clean_from_library(own, of_others, ignore=squats, fetch=fetch)
    helped = bases_from_library(own, of_others, ignore=squats[:1], fetch=fetch)

    assert harmless.prior_used.startswith("No clip of the library is similar to this take. ")
    assert_array_equal(harmless.recording.rotations, denoise(own).recording.rotations)
    assert set(helped.clips[:2]) == set(squats[1:])


def test_clips_are_read_from_their_files_and_missing_files_reported(tmp_path):
    for name, motion in WALKS.items():
        write_bvh(motion, tmp_path / f"{name}.bvh")
    index_files(tmp_path / "library.clips", [tmp_path])
    (tmp_path / "walk 110.bvh").unlink()

    with load_clip_library(tmp_path / "library.clips") as library:
        learned = bases_from_library(walk(115), library)
        assert set(learned.clips) == set(WALKS) - {"walk 110"}
        assert "walk 110 was left out: There is no file" in learned.message
        for path in tmp_path.glob("*.bvh"):
            path.unlink()
        cleaned = clean_from_library(walk(115), library)

    assert cleaned.prior_used.count("was left out") == 4
    assert_array_equal(cleaned.recording.rotations, denoise(walk(115)).recording.rotations)


def test_clips_without_a_file_are_reported(library):
    learned = bases_from_library(walk(115), library)
    assert learned.bases is None
    assert "walk 110 was left out: The source file of walk 110" in learned.message


def test_clip_of_an_action_is_not_read_from_its_file():
    origin = Origin("/somewhere/rig.blend", "Walk")
    library = build_clip_library([Clip("Walk", walk(110), origin=origin)])
    assert bases_from_library(walk(115), library).bases is None
    messages = bases_from_library(walk(115), library, fetch=lambda entry: walk(110))
    assert messages.clips == ("Walk",)


def test_sensor_recordings_are_no_examples(library):
    joints = Tracks(("a",), np.zeros((9, 1, 3)), 30.0)
    assert bases_from_library(walk(115), library, fetch=lambda entry: joints).bases is None


def test_too_short_clips_are_reported():
    short = {name: motion.slice(0, 5) for name, motion in WALKS.items()}
    library = build_clip_library(Clip(name, motion) for name, motion in short.items())
    learned = bases_from_library(
        walk(110).slice(0, 5), library, fetch=lambda entry: short[entry.name]
    )
    assert learned.bases is None
    assert "They cannot be used: No example is as long as the window" in learned.message


def test_an_empty_library_changes_nothing():
    cleaned = clean_from_library(walk(115), build_clip_library([]))
    assert cleaned.prior_used.startswith("No clip of the library is similar to this take. ")


def test_points_are_refused(library):
    markers = Tracks(("a", "b"), np.zeros((9, 2, 3)), 30.0)
    with pytest.raises(InvalidMotionError, match="Solve a skeleton from them first"):
        clean_from_library(markers, library)


def test_reading_clips_can_be_cancelled(library):
    def cancel(fraction, message=""):
        if message.startswith("Reading walk"):
            raise SolveCancelled

    with pytest.raises(SolveCancelled):
        clean_from_library(walk(115), library, fetch=fetched, progress=cancel)


def test_search_with_noise_finds_the_same_clips(library, rng):
    truth = walk(115)
    shape = (*truth.rotations.shape[:2], 3)
    noise = quaternion_from_rotation_vector(np.radians(3.0) * rng.normal(size=shape))
    noisy = truth.with_poses(multiply(truth.rotations, noise))

    cleaned = clean_from_library(noisy, library, fetch=fetched)

    everywhere = slice(0, None)
    assert "Learned from 4 clips" in cleaned.prior_used
    assert error(cleaned.recording, truth, everywhere) < 0.5 * error(noisy, truth, everywhere)


def test_missing_clip_file_is_refused(tmp_path):
    with pytest.raises(InvalidFileError, match="There is no file"):
        read_origin(
            build_clip_library([
                Clip("a", walk(110), origin=Origin(str(tmp_path / "gone.bvh")))
            ]).entries[0]
        )
