"""Convert recordings to the channels of a linear model, and back."""

from .channels import CENTIMETERS, Channels
from .encode import decode, encode
from .examples import ExampleChannels, Moments
from .motion_channels import BODY_POSITION

__all__ = [
    "BODY_POSITION",
    "CENTIMETERS",
    "Channels",
    "ExampleChannels",
    "Moments",
    "decode",
    "encode",
]
