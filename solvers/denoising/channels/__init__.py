"""Convert recordings to the channels of a linear model, and back."""

from .channels import CENTIMETERS, Channels
from .encode import decode, encode
from .estimate import Estimate, Smoothed
from .examples import ExampleChannels, Moments
from .motion_channels import BODY_POSITION

__all__ = [
    "BODY_POSITION",
    "CENTIMETERS",
    "Channels",
    "Estimate",
    "ExampleChannels",
    "Moments",
    "Smoothed",
    "decode",
    "encode",
]
