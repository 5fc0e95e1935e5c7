"""Commands that the documents show are understood, word by word."""

import re
import shlex
from html import unescape
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
PAGES = [
    ROOT / "README.md",
    ROOT / "mocap_assist/ui/manual.html",
    *(ROOT / "docs").rglob("*.md"),
]
SHOWN = re.compile(r"^[ >]*(?:<pre>)?(blender .*--command mocap_assist .*?)(?:</pre>)?$", re.M)


def commands():
    for page in PAGES:
        for line in SHOWN.findall(unescape(page.read_text(encoding="utf-8"))):
            yield pytest.param(line, id=f"{page.name}-{line[:60]}")


@pytest.mark.parametrize("line", list(commands()))
def test_documented_command_is_parsed(load, line):
    module = load("mocap_assist.batch.command")
    words = shlex.split(line, comments=True)
    own, after = module._split_words(words[words.index("mocap_assist") + 1 :])

    module._parser().parse_args(own)
    module._check_words(after)
