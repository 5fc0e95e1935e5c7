"""Tags of variants in a custom property of their actions."""

import re

import bpy

from ..blender.stored_json import load_json, store_json

VARIANT = "mocap_assist_variant"
"""Custom property of variants: their source actions, number and seed."""
BETWEEN = ".variant "
NUMBER = re.compile(re.escape(BETWEEN) + r"(\d+)(\.\d{3,})?$")
MIN_DIGITS = 2


def tag_variant(action: bpy.types.Action, examples: list[str], number: int, seed: int) -> None:
    """Store in an action the examples of the variant."""
    store_json(action, VARIANT, {"examples": examples, "number": number, "seed": seed})


def is_variant(action: bpy.types.Action) -> bool:
    """Whether Vary made it."""
    return VARIANT in action


def examples_of(action: bpy.types.Action) -> list[str]:
    """Return the names of the actions that it is a variant of; nothing for others."""
    names = load_json(action, VARIANT, dict).get("examples", [])
    return [str(name) for name in names] if isinstance(names, list) else []


def short_name(action: bpy.types.Action) -> str:
    """Return the suffix of a variant: variant 01."""
    _, between, number = action.name.rpartition(BETWEEN)
    return f"{between}{number}".removeprefix(".")


def names_for(example: bpy.types.Action, n_variants: int) -> list[str]:
    """Return names for new variants of an action: their numbers follow those there are."""
    stem = NUMBER.sub("", example.name).removesuffix(".clean")
    there = [
        int(found[1])
        for action in bpy.data.actions
        if action.name.startswith(stem + BETWEEN) and (found := NUMBER.search(action.name))
    ]
    first = max(there, default=0) + 1
    digits = max(len(str(first + n_variants - 1)), MIN_DIGITS)
    numbers = range(first, first + n_variants)
    return [f"{stem}{BETWEEN}{number:0{digits}}" for number in numbers]
