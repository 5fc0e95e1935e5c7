"""What is sent to a Flamenco Manager is the batch, and each failure is one sentence."""

import json
import platform

import pytest
from clusters.flamenco_stub import (
    JOB_ID,
    JOBS,
    SCRIPTS,
    TYPE,
    VERSION,
    Answer,
    FlamencoStub,
    flamenco_stub,
)

from solvers.command_line.farm import flamenco_manager
from solvers.version import version


@pytest.fixture
def manager():
    with flamenco_stub() as stub:
        yield stub


@pytest.fixture
def submit(call, manager, leg_file, tmp_path, monkeypatch):
    """Submit a batch of one take with relative paths; returns exit status, stdout, stderr."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "takes.txt").write_text("leg.bvh\n")

    def command(verb, *words, address=None):
        batch = ["--manifest", "takes.txt", "--output-folder", "clean"]
        return call(verb, *batch, "--flamenco", address or manager.address, *words)

    return command


def sent(manager: FlamencoStub) -> dict:
    ((_, _, body),) = [each for each in manager.requests if each[0] == "POST"]
    return body


def test_job_of_a_verb_has_a_setting_for_each_option(submit, manager, tmp_path):
    status, printed, err = submit(
        "denoise", "--strength", "0.50", "--train", "a.bvh", "b c.bvh", "--no-feet",
        "--joint-limits", "--jobs", "4", "--flamenco-tasks", "20", "--flamenco-priority", "70",
        "--flamenco-command", "mocap-assist",
    )  # fmt: skip

    page = f"{manager.address}/app/jobs/{JOB_ID}"
    assert (status, err) == (0, "")
    assert printed == f"Submitted denoise takes in 20 tasks: {page}\n"
    assert [each[:2] for each in manager.requests] == [
        ("GET", VERSION), ("GET", f"{TYPE}mocap-assist-denoise"), ("POST", JOBS),
    ]  # fmt: skip
    body = sent(manager)
    settings = body.pop("settings")
    assert body == {
        "name": "denoise takes",
        "type": "mocap-assist-denoise",
        "type_etag": "e7a6",
        "priority": 70,
        "submitter_platform": platform.system().lower(),
        "metadata": {"mocap_assist.version": version()},
    }
    given = {name: value for name, value in settings.items() if value != ""}
    assert given == {
        "manifest": str(tmp_path / "takes.txt"),
        "output_folder": str(tmp_path / "clean"),
        "shards": 20,
        "options": "--jobs=4",
        "command": "mocap-assist",
        "strength": "0.50",
        "train": f"{tmp_path / 'a.bvh'} '{tmp_path / 'b c.bvh'}'",
        "feet": "no",
        "joint_limits": "yes",
    }
    assert not (tmp_path / "clean").exists()


def test_job_of_another_verb_has_the_words_of_its_options(submit, manager, tmp_path):
    status, printed, _ = submit("convert", "--scale", "0.5", "--again", "--json")

    assert (status, json.loads(printed)["job"]) == (0, JOB_ID)
    assert sent(manager)["settings"] == {
        "verb": "convert",
        "manifest": str(tmp_path / "takes.txt"),
        "output_folder": str(tmp_path / "clean"),
        "shards": 10,
        "options": "--scale=0.5 --again",
        "command": "python3 -m solvers",
    }


SCRIPT = SCRIPTS / "mocap_assist_fix.js"
HTML = Answer(200, "<html>Router</html>")
OTHER_VERSION = Answer(
    200, {"version": "4.1-beta", "shortversion": "4.1", "name": "", "git": ""}
)
NO_TYPE = Answer(404, {"code": 404, "message": "no such job type known"})
ODD_TYPE = Answer(200, {"settings": [{"key": []}, 3], "etag": []})
ODD_ID = Answer(200, {"id": "\x1b[2J5c5c"})
OLD_TYPE = Answer(200, {"settings": [{"key": "manifest"}], "etag": "0"})
REFUSED = Answer(400, {"code": 400, "message": "shards is 0;\nit must be at least 1."})
OUTDATED = Answer(412, {"code": 412, "message": "rejecting job because it is outdated"})
BUSY = Answer(503, {"code": 503, "message": "the database is busy"})


@pytest.mark.parametrize(
    ("path", "answer", "sentence"),
    [
        (VERSION, HTML, "{} answers, but not as a Flamenco Manager. Correct the address."),
        (
            VERSION,
            Answer(200, '{"version": "3.7", "name": "' + "x" * 1_000_000 + '"}'),
            "{} answers, but not as a Flamenco Manager. Correct the address.",
        ),
        (
            VERSION,
            Answer(404, {"detail": "no such page"}),
            "{} answers, but not as a Flamenco Manager. Correct the address.",
        ),
        (
            VERSION,
            OTHER_VERSION,
            "{} runs Flamenco 4.1, and Mocap Assist needs Flamenco 3. Name another Manager.",
        ),
        (
            VERSION,
            None,
            "The Flamenco Manager at {} did not answer within 0.1 seconds. Try again later.",
        ),
        (
            TYPE,
            NO_TYPE,
            "The Flamenco Manager at {} has no job type mocap-assist-fix. Copy"
            f" {SCRIPT} into the folder scripts next to the Manager.",
        ),
        (
            TYPE,
            OLD_TYPE,
            "The job type mocap-assist-fix of the Flamenco Manager at {} is of another version"
            f" of Mocap Assist. Copy {SCRIPT} into its folder scripts.",
        ),
        (
            TYPE,
            ODD_TYPE,
            "The job type mocap-assist-fix of the Flamenco Manager at {} is of another version"
            f" of Mocap Assist. Copy {SCRIPT} into its folder scripts.",
        ),
        (TYPE, HTML, "{} answers, but not as a Flamenco Manager. Correct the address."),
        (
            JOBS,
            REFUSED,
            "The Flamenco Manager at {} refuses the job: shards is 0; it must be at least 1.",
        ),
        (
            JOBS,
            OUTDATED,
            "The Flamenco Manager at {} cannot take the job now: rejecting job because it is"
            " outdated. Try again.",
        ),
        (
            JOBS,
            BUSY,
            "The Flamenco Manager at {} cannot take the job now: the database is busy. Try"
            " again.",
        ),
        (
            JOBS,
            None,
            "The Flamenco Manager at {} did not answer within 0.1 seconds. Look at its list of"
            " jobs before you try again.",
        ),
        (JOBS, HTML, "{} answers, but not as a Flamenco Manager. Correct the address."),
        (JOBS, ODD_ID, "{} answers, but not as a Flamenco Manager. Correct the address."),
    ],
    ids=range(15),
)
def test_each_failure_is_one_sentence(submit, manager, monkeypatch, path, answer, sentence):
    manager.changed[TYPE] = manager.answer(f"{TYPE}mocap-assist-fix")
    manager.changed[path] = answer
    if answer is None:
        monkeypatch.setattr(flamenco_manager, "TIMEOUT_S", 0.1)

    status, printed, err = submit("fix")

    assert (status, printed, err) == (2, "", f"{sentence.format(manager.address)}\n")


@pytest.mark.parametrize("path", [VERSION, JOBS])
def test_redirect_is_not_followed(submit, manager, path):
    with flamenco_stub() as other:
        manager.changed = {TYPE: manager.answer(f"{TYPE}mocap-assist-fix")}
        manager.changed[path] = Answer(302, "", f"{other.address}{path}")

        status, _, err = submit("fix")

        assert (status, other.requests) == (2, [])
    assert err == (
        f"{manager.address} redirects to {other.address}{path}, where nothing was sent. If that"
        " is your Flamenco Manager, enter its address.\n"
    )


def test_manager_that_is_not_there_is_one_sentence(submit):
    status, _, err = submit("fix", address="127.0.0.1:9")

    assert (status, err) == (
        2,
        "No Flamenco Manager can be reached at http://127.0.0.1:9 (Connection refused). Start"
        " it, or correct the address.\n",
    )


@pytest.mark.parametrize(
    "address",
    [" ", "file:///etc/passwd", "http://", "farm:port", "http://me:pw@farm", "http://a b"],
)
def test_invalid_address_is_one_sentence(submit, manager, address):
    status, _, err = submit("fix", address=address)

    assert (status, err.count("\n"), manager.requests) == (2, 1, [])
    assert "is not the address of a Flamenco Manager. Enter one such as" in err


def test_verb_without_a_manifest_cannot_be_submitted(call, manager, leg_file):
    status, _, err = call("index", "walks.clips", leg_file, "--flamenco", manager.address)

    assert (status, manager.requests) == (2, [])
    assert err.startswith("Unrecognized arguments: --flamenco")


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--manifest", "m", "--shard", "1/2", "--output-folder", "o"], "Leave out --shard"),
        (["--manifest", "m"], "--flamenco needs a folder"),
        (["leg.bvh", "--output-folder", "o"], "a list on shared storage: name it"),
        (["--manifest", "gone", "--output-folder", "o"], "The manifest gone cannot be read"),
        (["--manifest", "m", "--output-folder", "o", "--flamenco-tasks", "0"], "tasks is 0"),
    ],
)  # fmt: skip
def test_batch_that_cannot_be_submitted_is_one_sentence(call, manager, words, sentence):
    status, _, err = call("fix", *words, "--flamenco", manager.address)

    assert (status, err.count("\n"), manager.requests) == (2, 1, [])
    assert sentence in err
