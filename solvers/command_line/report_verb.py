"""`report`: collect the records of a batch into one report."""

import argparse

from .arguments import VerbWork
from .batches import report_folder


def add_report_options(parser: argparse.ArgumentParser) -> None:
    """Add no options: the folder is all that the verb needs."""


REPORT = VerbWork(add_report_options, report_folder)
