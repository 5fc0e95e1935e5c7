"""Blender properties from settings classes, so that each setting is described once."""

from collections.abc import Callable
from dataclasses import Field, fields
from enum import Enum
from inspect import get_annotations
from math import isfinite, isnan
from typing import Any, NamedTuple, TypeVar, get_type_hints

import bpy
import numpy as np

from ...solvers.settings import Choice, Described, Settings, former_names, label_of
from ..languages import CONTEXT
from .path_properties import path_property

Class = TypeVar("Class", bound=type)
Bundle = TypeVar("Bundle", bound=NamedTuple)
SUBTYPES = {"rad": "ANGLE", "m": "DISTANCE", "s": "TIME_ABSOLUTE", "%": "PERCENTAGE"}


def settings_from(bundle: type[Bundle]) -> Callable[[Class], Class]:
    """Decorate an operator or property group with a property for each setting of a bundle.

    A bundle is a NamedTuple of settings classes. The decorated class gets `settings()`, which
    returns the bundle with the checked values of the properties, `setting_names`, and
    `former_names`, from the names of older versions to the present ones. Settings of the same
    name in two classes become one property.
    """
    classes = get_type_hints(bundle)
    described = {item.name: item for each in classes.values() for item in fields(each)}

    def settings(self: Any) -> Bundle:
        return bundle._make(_settings_of(self, each) for each in classes.values())

    def set_properties(self: Any, *values: Settings) -> None:
        for each in values:
            for item in fields(each):
                value = getattr(each, item.name)
                setattr(self, item.name, value.name if isinstance(value, Enum) else value)

    def decorate(cls: Class) -> Class:
        # Otherwise Blender restores the values of the last press, and they look as if the
        # caller had set them.
        options = {"SKIP_SAVE"} if issubclass(cls, bpy.types.Operator) else set()
        properties = {name: _property(item, options) for name, item in described.items()}
        cls.__annotations__ = properties | get_annotations(cls)
        decorated: Any = cls
        decorated.settings = settings
        decorated.set_properties = set_properties
        decorated.setting_names = tuple(described)
        decorated.former_names = {
            old: new for each in classes.values() for old, new in former_names(each).items()
        }
        return cls

    return decorate


def _settings_of(properties: Any, settings_class: type[Settings]) -> Settings:
    return settings_class(**{
        item.name: _value(getattr(properties, item.name), item)
        for item in fields(settings_class)
    })


def _property(item: "Field[Any]", options: set[str]) -> Any:
    described: Described = item.metadata["described"]
    default: Any = item.default
    kind = type(default)
    shown: dict[str, Any] = {
        "name": label_of(item),
        "description": described.help,
        "default": default,
        "options": {"ANIMATABLE"} | options,
        "translation_context": CONTEXT,
    }
    if issubclass(kind, Choice):
        choices = [(each.name, each.label, each.help, index)
                   for index, each in enumerate(kind)]  # fmt: skip
        return bpy.props.EnumProperty(**shown | {"items": choices, "default": default.name})
    if kind is bool:
        return bpy.props.BoolProperty(**shown)
    if kind is str:
        is_path = item.name.endswith("_file")
        return (path_property if is_path else bpy.props.StringProperty)(**shown)
    limits = {
        name: limit
        for name, limit in (("min", described.minimum), ("max", described.maximum))
        if isfinite(limit)
    }
    if kind is int:
        return bpy.props.IntProperty(**shown, **limits)
    return bpy.props.FloatProperty(**shown | _unit(described), **limits, precision=3)


def _unit(described: Described) -> dict[str, str]:
    """Return the subtype of a unit that Blender knows, or a tooltip with the unit."""
    if described.unit in SUBTYPES:
        return {"subtype": SUBTYPES[described.unit]}
    if (described.minimum, described.maximum, described.unit) == (0.0, 1.0, ""):
        return {"subtype": "FACTOR"}
    unit = f" ({described.unit})" if described.unit else ""
    return {"description": described.help + unit}


def _value(value: Any, item: "Field[Any]") -> Any:
    """Convert a property to a setting: Blender stores enums as names and floats in 32 bits.

    A file of another version may hold an invalid value: the nearest valid one is returned, or
    the default.
    """
    default, described = item.default, item.metadata["described"]
    if isinstance(default, Enum):
        return type(default).__members__.get(value, default)
    if isinstance(default, bool | str):
        return value
    if isinstance(default, float):
        if np.float32(default) == np.float32(value) or isnan(value):
            return default
        value = float(f"{value:.7g}")  # 0.1 is stored as 0.10000000149
    return type(default)(min(max(value, described.minimum), described.maximum))
