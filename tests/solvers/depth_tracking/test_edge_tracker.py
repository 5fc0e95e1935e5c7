"""Color, edge and prior terms move the body as expected."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_bodies import CAMERA, NATURAL, drawn, observed, recorded, waving
from numpy.testing import assert_allclose, assert_array_equal

from solvers.depth_tracking.body.coordinates import COORDINATES, N_ROOT
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.motion_prior import (
    LAYOUT,
    LocalPca,
    load_motion_prior,
    local_pca,
    motion_prior_from_poses,
)
from solvers.depth_tracking.body.normal_equations import (
    equations_in_coordinates,
    segment_equations,
    solve_step,
)
from solvers.depth_tracking.capturing.capture import CaptureSettings, capture
from solvers.depth_tracking.published.depth_edges import canny, edge_pixels
from solvers.depth_tracking.published.edge_tracker import track_pose_by_edges
from solvers.depth_tracking.published.edges import edge_term
from solvers.depth_tracking.published.registration_tracker import REGISTRATION_TRACKER
from solvers.depth_tracking.published.surface import (
    ColoredFrame,
    PreviousFrame,
    previous_intensities,
    surface_term,
)
from solvers.depth_tracking.terms.hypothesis import render_hypothesis
from solvers.depth_tracking.terms.observation import Observation
from solvers.depth_tracking.terms.tracker_settings import DEFAULT_TRACKER
from solvers.depth_tracking.tracking.track_pose import track_pose
from solvers.errors import InvalidFileError, InvalidMotionError

BODY = default_body()


def test_canny_finds_a_step_as_one_line():
    image = np.zeros((20, 30))
    image[:, 12:] = 1.0

    edges = canny(image, 0.1, 0.05)

    columns = np.flatnonzero(edges[5:15].all(axis=0))
    assert len(columns) == 1 and columns[0] in {11, 12}
    assert edges[5:15].sum() == 10


def test_canny_keeps_weak_edges_next_to_strong_ones_only():
    rows = np.linspace(0.15, 1.0, 40)[:, np.newaxis]
    image = np.where(np.arange(40) >= 20, rows, 0.0)
    lonely = np.where(np.arange(40) >= 30, 0.15, 0.0) * np.ones((40, 1))

    assert canny(image, 0.2, 0.04)[3:-3].any(axis=1).all()
    assert not canny(lonely, 0.2, 0.04).any()
    assert canny(lonely, 0.04, 0.04).any()


def test_edges_of_an_actor_are_its_pixels_near_the_silhouette():
    depth = drawn(NATURAL)
    pixels = edge_pixels(depth)

    assert (depth.ravel()[pixels] > 0.0).all()
    assert len(np.unique(pixels)) == len(pixels) > 100
    assert_array_equal(edge_pixels(np.zeros((10, 10))), [])


def surface_rows(hypothesis, observation):
    no_color = np.full(observation.flat.shape, np.nan)
    return surface_term(hypothesis, ColoredFrame(observation, no_color), None, 1.0)


def edge_rows(hypothesis, observation):
    edges = edge_pixels(observation.depth, observation.nearest_pixel)
    return edge_term(hypothesis, observation, edges, 1.0)


@pytest.mark.parametrize("term", [surface_rows, edge_rows])
def test_step_of_each_term_reduces_the_pose_error(term):
    start = NATURAL.copy()
    start[:2] += (0.03, -0.02)
    hypothesis = render_hypothesis(BODY, start, CAMERA)

    equations = term(hypothesis, observed(NATURAL))
    change = solve_step(
        equations_in_coordinates([segment_equations(equations)], hypothesis.twists),
        np.full(36, 0.5),
    )

    assert change[:2] @ [0.03, -0.02] < 0.0


def test_true_pose_stays_unchanged():
    hypothesis, observation = render_hypothesis(BODY, NATURAL, CAMERA), observed(NATURAL)
    for term in (surface_rows, edge_rows):
        assert_allclose(term(hypothesis, observation).residuals, 0.0, atol=1e-9)


def striped(pose):
    """A body with a texture fixed to its skin: the color is the position along its segment."""
    hypothesis = render_hypothesis(BODY, pose, CAMERA)
    frame = hypothesis.frames[hypothesis.segments]
    local = np.einsum("nji,nj->ni", frame[:, :3, :3], hypothesis.points - frame[:, :3, 3])
    intensities = np.zeros(120 * 160)
    intensities[hypothesis.image.pixels] = 127.0 + 120.0 * np.sin(40.0 * local[:, 1])
    depth = hypothesis.image.depth_image()
    return hypothesis, ColoredFrame(Observation(CAMERA, depth), intensities)


def test_previous_intensities_move_with_the_surface():
    then, before = striped(NATURAL)
    moved = NATURAL.copy()
    moved[:3] += (0.05, 0.02, 0.0)
    now, after = striped(moved)
    chosen = np.arange(len(now.points))

    remembered = previous_intensities(now, chosen, PreviousFrame(then.frames, before))

    actual = after.intensities[now.image.pixels]
    is_remembered = np.isfinite(remembered)
    assert is_remembered.mean() > 0.8
    errors = np.abs(remembered - actual)[is_remembered]
    assert np.median(errors) < 25.0 < np.abs(127.0 - actual).mean()


def test_color_constrains_motion_along_a_limb():
    """Depth hardly changes when a body rises slightly; painted stripes do."""
    then, before = striped(NATURAL)
    risen = NATURAL.copy()
    risen[1] -= 0.03
    _, after = striped(risen)
    change = []
    for memory in (None, PreviousFrame(then.frames, before)):
        requested = segment_equations(surface_term(then, after, memory, 1.0))
        change.append(
            solve_step(equations_in_coordinates([requested], then.twists), np.full(36, 0.5))[1]
        )
    assert abs(change[1] + 0.03) < abs(change[0] + 0.03)


def test_published_tracker_follows_a_slow_actor():
    truth = waving(6)
    prior = motion_prior_from_poses([waving(60)])

    tracked = track_pose_by_edges(recorded(truth), BODY, truth[0], prior)

    assert np.abs(tracked.joints.positions[0] - tracked.joints.positions[-1]).max() > 0.03
    assert tracked.residual.max() < 0.03


def test_local_pca_contains_the_successors():
    """Poses on a line in pose space: one component, which pulls other poses back."""
    line = np.linspace(0.0, 1.0, 200)[:, np.newaxis] * np.eye(36)[10] + 0.1 * np.eye(36)[20]
    prior = motion_prior_from_poses([line])

    plane = local_pca(prior, line[100])
    requested = plane.equations(line[100] + 0.5 * np.eye(36)[15], 2.0)

    assert plane.basis.shape == (30, 1)
    assert plane.mean[10 - N_ROOT] > line[100, 10]
    assert_allclose(requested.vector, -1.0 * np.eye(36)[15], atol=1e-9)
    assert_allclose(requested.cost, 0.25)


def test_local_pca_does_not_cross_clips():
    low, high = np.zeros((60, 36)), np.ones((60, 36))
    low[:, 10] = np.linspace(0.0, 0.1, 60)
    plane = local_pca(motion_prior_from_poses([low, high]), low[-1])
    assert (plane.mean < 0.2).all()


def test_prior_equations_equal_the_dense_ones(rng):
    """Eq. 3.12: || (U U' - I)(q + dq - mean) ||^2 without the root."""
    basis = np.linalg.qr(rng.normal(size=(30, 4)))[0]
    plane, pose = LocalPca(rng.normal(size=30), basis), rng.normal(size=36)
    jacobian = np.zeros((30, 36))
    jacobian[:, N_ROOT:] = basis @ basis.T - np.eye(30)
    residual = jacobian @ pose - jacobian[:, N_ROOT:] @ plane.mean

    found = plane.equations(pose, 3.0)

    assert_allclose(found.matrix, 3.0 * jacobian.T @ jacobian, atol=1e-12)
    assert_allclose(found.vector, -3.0 * jacobian.T @ residual, atol=1e-12)
    assert_allclose(found.cost, 1.5 * residual @ residual)


def test_load_restores_a_saved_prior(tmp_path):
    prior = motion_prior_from_poses([waving(5), waving(3)], "two waves")
    prior.save(tmp_path / "prior.npz")

    loaded = load_motion_prior(tmp_path / "prior.npz")

    assert_allclose(loaded.poses, prior.poses, atol=1e-3)
    assert_array_equal(loaded.clips, [0] * 5 + [1] * 3)
    assert loaded.trained_on == "two waves"
    arrays = LAYOUT.read(tmp_path / "prior.npz")
    LAYOUT.write(tmp_path / "bad.npz", arrays | {"coordinates": np.array(["other parts"] * 30)})
    with pytest.raises(InvalidFileError, match="other body parts"):
        load_motion_prior(tmp_path / "bad.npz")
    with pytest.raises(InvalidMotionError, match="no pose to learn"):
        motion_prior_from_poses([])


def test_shipped_prior_contains_walking_and_names_its_license():
    shipped = load_motion_prior()

    assert "CMU" in shipped.trained_on and "UI-PRMD" in shipped.trained_on
    assert len(shipped.poses) > 3000 and np.isfinite(shipped.poses).all()
    hips = [N_ROOT_OF["leftFemurX"], N_ROOT_OF["rightFemurX"]]
    walk = shipped.poses[shipped.clips == 0][:, hips]
    assert np.corrcoef(walk.T)[0, 1] < -0.5


N_ROOT_OF = {name: index for index, name in enumerate(COORDINATES[N_ROOT:])}


def test_colors_are_read_only_if_a_term_uses_them():
    """A damaged color image must not end a capture that ignores color."""
    truth, requested = waving(4), []

    def read_color(frame):
        requested.append(frame)
        raise InvalidFileError("rgb/4.png is missing or damaged.")

    depth = replace(recorded(truth), read_color=read_color)

    found = capture(depth, BODY, settings=CaptureSettings())
    for settings in (DEFAULT_TRACKER, REGISTRATION_TRACKER):
        track_pose(depth, BODY, truth[0], settings=settings)

    assert (found.motion.n_frames, requested) == (4, [])
    with pytest.raises(InvalidFileError, match=r"rgb/4\.png"):
        track_pose_by_edges(depth, BODY, truth[0])
