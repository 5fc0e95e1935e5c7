"""How the joints of a body move together: learned from both sides, kept in a file."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising.channels import BODY_POSITION
from solvers.denoising.limb_gaps import (
    BodyRelation,
    learn_body_relation,
    load_body_relation,
)
from solvers.denoising.limb_gaps.body_relation import KEYS
from solvers.errors import InvalidFileError, InvalidMotionError
from solvers.samples import walking_gait


def test_regression_is_the_conditional_mean_of_the_moments(rng):
    """The same as a least-squares fit to rows whose moments they are, with a ridge."""
    keys, n_rows, ridge = ("a", "b", "c", BODY_POSITION), 400, 2.0
    rows = rng.normal(size=(n_rows, 72)) @ rng.normal(size=(72, 72))
    relation = BodyRelation(keys, rows.T @ rows / n_rows)

    found = relation.regress(["b", "new"], ["c", "a"], ridge)

    features = rows.reshape(n_rows, 2, 3, 4, 3)
    x = np.concatenate(
        [features[:, 0, :, 1].reshape(n_rows, 9)]
        + [features[:, 1, kind, part] for kind in range(3) for part in (2, 0)],
        axis=1,
    )
    x = np.concatenate([x, np.sqrt(n_rows * ridge) * np.eye(27)])
    y = np.concatenate([features[:, 1, 0, 1], np.zeros((27, 3))])
    expected = np.linalg.lstsq(x, y, rcond=None)[0]
    by_kind = found[:18].reshape(3, 2, 3, 6)
    assert_allclose(by_kind[:, 0, :, :3].reshape(9, 3), expected[:9], atol=1e-9)
    assert_allclose(found[18:, :3], expected[9:], atol=1e-9)
    assert not by_kind[:, 1].any()
    assert not found[:, 3:].any()
    left = features[:, 1, 0, 1] - x[:n_rows] @ np.concatenate([
        by_kind[:, 0, :, :3].reshape(9, 3),
        found[18:, :3],
    ])
    mean = (features[:, 1, 0, :3] ** 2).mean()  # of joints: the position is in centimeters
    assert_allclose(
        relation.error_variance(["b", "new"], ["c", "a"], found),
        [*(left**2).mean(axis=0), mean, mean, mean],
    )


def test_learned_relation_comes_back_from_its_file(tmp_path):
    learned = learn_body_relation([walking_gait()], trained_on="a sample")
    learned.save(tmp_path / "relation.npz")

    loaded = load_body_relation(tmp_path / "relation.npz")

    assert (loaded.keys, loaded.trained_on) == (KEYS, "a sample")
    assert_allclose(loaded.moments, learned.moments, rtol=1e-5, atol=1e-4)


def test_learned_relation_is_the_same_for_both_sides():
    """It is learned from mirror images, too."""
    relation = learn_body_relation([walking_gait()])
    other = {"left": "right", "right": "left"}
    limb = ["leftUpperArm", "leftLowerArm", "leftHand"]
    body = ["hips", "rightUpperArm", "leftUpperLeg"]

    def mirrored(keys: list[str]) -> list[str]:
        return [
            next(
                (other[side] + key[len(side) :] for side in other if key.startswith(side)), key
            )
            for key in keys
        ]

    left = relation.regress(limb, body)
    right = relation.regress(mirrored(limb), mirrored(body))

    signs = np.tile([1.0, -1.0, -1.0], len(left) // 3)
    assert_allclose(right, left * signs[:, None] * signs[:9], atol=1e-8)


def test_too_little_to_learn_from():
    with pytest.raises(InvalidMotionError, match="too short"):
        learn_body_relation([walking_gait().slice(0, 40)])


def test_damaged_file_is_refused(tmp_path):
    BodyRelation(("hips",), np.eye(5)).save(tmp_path / "bad.npz")

    with pytest.raises(InvalidFileError, match="not those of the keys"):
        load_body_relation(tmp_path / "bad.npz")


def test_shipped_relation_names_its_training_data():
    assert "CMU" in load_body_relation().trained_on
