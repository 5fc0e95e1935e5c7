"""Predict a limb that is missing for long from the rest of the body."""

from .body_relation import SHIPPED, BodyRelation, learn_body_relation, load_body_relation
from .predict_limbs import predict_limbs

__all__ = [
    "SHIPPED",
    "BodyRelation",
    "learn_body_relation",
    "load_body_relation",
    "predict_limbs",
]
