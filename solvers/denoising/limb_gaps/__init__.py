"""Predict a limb that is missing for long from the rest of the body."""

from .body_relation import SHIPPED, BodyRelation, learn_body_relation, load_body_relation
from .predict_limbs import predict_limbs
from .standing_legs import keep_standing_feet

__all__ = [
    "SHIPPED",
    "BodyRelation",
    "keep_standing_feet",
    "learn_body_relation",
    "load_body_relation",
    "predict_limbs",
]
