"""Write the job types of Flamenco that have the options of one verb, from its command line.

`make docs` runs it. solvers/command_line/farm/scripts/mocap_assist.js, written by hand, serves
all verbs: these are made of it, with a setting for each option.
"""

import argparse
import json
import re
from pathlib import Path
from typing import Any

from solvers.command_line.farm.job_types import (
    JOB_TYPE,
    NO_TEXT,
    OF_ONE_VERB,
    job_type_of,
    kind_of,
    options_of,
    script_of,
)
from solvers.command_line.verbs import VERBS

SOURCE = script_of(JOB_TYPE)
HEAD = "// Made of mocap_assist.js and the options of the verb: make docs.\n"
OPTION_WORDS = """\
const OPTIONS = {
ROWS};

function optionWords(settings) {
  let words = [];
  for (const key in OPTIONS) {
    const [kind, name, opposite] = OPTIONS[key], value = settings[key];
    if (!value) {
      continue;
    }
    if (kind === "switch") {
      words = words.concat(value === "no" ? opposite || [] : name);
    } else if (kind === "many") {
      words = words.concat(name, shellSplit(value));
    } else {
      words = words.concat(name + "=" + value);
    }
  }
  return words;
}
"""
"""What a job type of one verb has in addition: its options, and their words."""
CUT = re.compile(r'    \{ key: "verb".*?\},\n', re.DOTALL)
"""The setting that a job type of one verb lacks."""


def main() -> None:
    """Write all job types of one verb."""
    for verb in OF_ONE_VERB:
        script_of(job_type_of(verb)).write_text(job_type(verb), encoding="utf-8", newline="\n")


def job_type(verb: str) -> str:
    """Return the job type of a verb."""
    text = SOURCE.read_text(encoding="utf-8")
    options = options_of(VERBS[verb].work().add_options)
    added = "".join(f"    {setting(option)},\n" for option in options)
    rows = "".join(f"  {option.dest}: {json.dumps(kind_of(option))},\n" for option in options)
    changes = (
        ('  label: "Mocap Assist",', f'  label: "Mocap Assist: {verb}",'),
        ("  ],\n};\n", f"{added}  ],\n}};\n\n{OPTION_WORDS.replace('ROWS', rows)}"),
        ("[settings.verb,", f'["{verb}",'),
        ("        shellSplit(settings.options", "        optionWords(settings),\n\\g<0>"),
    )
    for old, new in changes:
        if text.count(old) != 1:
            raise ValueError(f"{SOURCE.name} has {text.count(old)} times {old!r}")
        text = text.replace(old, new.replace("\\g<0>", old))
    return HEAD + CUT.sub("", text, count=1)


def setting(option: argparse.Action) -> str:
    """Return the setting of an option; left empty, the command has its default."""
    described: dict[str, Any] = {"key": option.dest, "type": "string"}
    if option.nargs == 0:
        described["choices"] = ["", "yes", *(["no"] if kind_of(option)[2] else [])]
    elif option.type is Path and not option.nargs:
        described["subtype"] = "file_path"
    described |= {
        "default": NO_TEXT, "required": False,
        "description": (option.help or "").replace("%%", "%"),
    }  # fmt: skip
    return json.dumps(described, ensure_ascii=False)


if __name__ == "__main__":
    main()
