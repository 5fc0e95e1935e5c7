"""Vary: many new actions of a few."""

import json
import numpy as np
import pytest


def test_try(vary, walker, blank):
    print([a.name for a in vary()])
    assert 0
