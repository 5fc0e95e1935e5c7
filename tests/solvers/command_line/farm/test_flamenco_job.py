"""The job type for Flamenco makes tasks that run a batch in parts."""

import argparse
import json
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import write_flamenco

from solvers.command_line.farm.job_types import (
    JOB_TYPE,
    OF_ONE_VERB,
    job_type_of,
    options_of,
    script_of,
    texts_of,
    words_of,
)
from solvers.command_line.verbs import VERBS
from solvers.recordings import Axis

ROOT = Path(__file__).parents[4]
MANAGER = """
const vm = require("vm"), fs = require("fs");
const [file, settings] = process.argv.slice(1), tasks = [];
const globals = {
  print() {},
  shellSplit: text => JSON.parse(settings).words[text],
  author: {
    Task(name, type) {
      const commands = [];
      return {name, type, commands, addCommand: one => commands.push(one)};
    },
    Command: (name, parameters) => ({name, parameters}),
  },
};
vm.createContext(globals);
vm.runInContext(fs.readFileSync(file, "utf8") + "; this.JOB_TYPE = JOB_TYPE;", globals);
try {
  globals.compileJob({settings: JSON.parse(settings), addTask: one => tasks.push(one)});
} catch (error) {
  tasks.push(String(error));
}
console.log(JSON.stringify({settings: globals.JOB_TYPE.settings, tasks}));
"""
"""The documented names that a Flamenco Manager gives to a job type."""

pytestmark = pytest.mark.skipif(shutil.which("node") is None, reason="needs node")


@pytest.fixture
def compiled():
    """Compile a job with these settings; returns the settings' definitions and the tasks."""

    def compile_job(job_type=JOB_TYPE, **settings):
        texts = [text for text in settings.values() if isinstance(text, str)]
        words = {text: shlex.split(text) for text in texts}
        given = json.dumps(settings | {"words": words})
        done = subprocess.run(
            ["node", "-e", MANAGER, str(script_of(job_type)), given],
            capture_output=True, text=True, check=True, timeout=500,
        )  # fmt: skip
        return json.loads(done.stdout)

    return compile_job


def test_tasks_run_all_parts(compiled, small_batch, tmp_path, records_in):
    manifest, out = small_batch / "takes.txt", tmp_path / "out"
    manifest.write_text("take00.bvh\ntake01.bvh\ntake02.bvh\n")
    job = compiled(
        verb="convert", manifest=str(manifest), output_folder=str(out), shards=2,
        options="--scale 0.5", command=f"{sys.executable} -m solvers",
    )  # fmt: skip

    for task in job["tasks"]:
        (command,) = task["commands"]
        words = [command["parameters"]["exe"], *command["parameters"]["args"]]
        subprocess.run(words, cwd=ROOT, check=True, capture_output=True, timeout=500)

    assert [(task["name"], task["type"]) for task in job["tasks"]] == [
        ("part 1/2", "misc"), ("part 2/2", "misc"),
    ]  # fmt: skip
    assert words == [
        sys.executable, "-m", "solvers", "convert", "--manifest", str(manifest),
        "--output-folder", str(out), "--shard", "2/2", "--report", "--wait", "--scale", "0.5",
    ]  # fmt: skip
    assert set(records_in(out)) == {"take00.bvh", "take01.bvh", "take02.bvh"}


def test_settings_are_complete_and_checked(compiled):
    given = {
        "verb": "fix",
        "manifest": "m",
        "output_folder": "o",
        "options": "",
        "command": "c",
    }

    job = compiled(**given, shards=0)

    assert {setting["key"] for setting in job["settings"]} == {*given, "shards"}
    assert job["tasks"] == ["shards is 0; it must be at least 1."]


@pytest.mark.parametrize("verb", OF_ONE_VERB)
def test_job_types_of_one_verb_have_its_options(verb):
    """After a change: `make docs`."""
    written = script_of(job_type_of(verb)).read_text(encoding="utf-8")

    assert written == write_flamenco.job_type(verb)


def test_options_of_one_verb_are_words_of_its_command(compiled):
    job = compiled(
        job_type_of("denoise"), manifest="m", output_folder="o", shards=1, options="",
        command="c", strength="0.5", feet="no", train="a.bvh 'b c.bvh'", preset="",
        forward="-y",
    )  # fmt: skip

    (command,) = job["tasks"][0]["commands"]
    words = command["parameters"]["args"]
    assert words[:8] == [
        "denoise", "--manifest", "m", "--output-folder", "o", "--shard", "1/1", "--report",
    ]  # fmt: skip
    parser = argparse.ArgumentParser()
    VERBS["denoise"].work().add_options(parser)
    parsed = parser.parse_args(words[9:])
    assert parsed.train == [Path("a.bvh"), Path("b c.bvh")]
    assert (parsed.strength, parsed.feet) == (0.5, False)
    assert parsed.forward == Axis.MINUS_Y
    assert not any(word.startswith("--preset") for word in words)


def test_words_of_a_submitted_job_are_those_of_the_script(compiled):
    """`words_of` serves verbs without a job type of their own, and the scripts the others."""
    add_options = VERBS["denoise"].work().add_options
    options = options_of(add_options)
    words = ["--train", "/a.bvh", "/b #'c.bvh", "--body=two words", "--no-feet", "--unswap"]

    texts = texts_of(options, add_options, words)

    job = compiled(
        job_type_of("denoise"), manifest="m", output_folder="o", shards=1, options="",
        command="c", **texts,
    )  # fmt: skip
    made = job["tasks"][0]["commands"][0]["parameters"]["args"][9:]
    assert made == words_of(options, texts)
    parser = argparse.ArgumentParser()
    add_options(parser)
    assert vars(parser.parse_args(made)) == vars(parser.parse_args(words))
