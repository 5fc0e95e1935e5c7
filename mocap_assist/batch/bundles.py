"""The settings of a button as options of its verb."""

import argparse
from typing import NamedTuple, TypeVar, get_type_hints

from ...solvers.command_line.arguments import arguments_from, settings_from_arguments

Bundle = TypeVar("Bundle", bound=NamedTuple)


def add_bundle_options(parser: argparse.ArgumentParser, bundle: type[Bundle]) -> None:
    """Add an option for each setting of a button."""
    arguments_from(parser, *get_type_hints(bundle).values())


def bundle_from_arguments(arguments: argparse.Namespace, bundle: type[Bundle]) -> Bundle:
    """Return the settings of a button from the command line."""
    classes = get_type_hints(bundle).values()
    return bundle._make(settings_from_arguments(arguments, each) for each in classes)
