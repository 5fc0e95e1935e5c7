"""Convert recordings to the channels of a linear model, and back."""

from .channels import CENTIMETERS, Channels
from .encode import decode, encode
from .examples import ExampleChannels, Moments

__all__ = [
    "CENTIMETERS",
    "Channels",
    "ExampleChannels",
    "Moments",
    "decode",
    "encode",
]
