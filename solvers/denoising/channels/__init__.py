"""Recordings as columns of numbers for a linear model, and back."""

from .channels import CENTIMETRES, Channels
from .encode import decode, encode
from .examples import ExampleChannels, Moments

__all__ = [
    "CENTIMETRES",
    "Channels",
    "ExampleChannels",
    "Moments",
    "decode",
    "encode",
]
