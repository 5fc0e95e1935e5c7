"""Commands solve in a process of their own, with the threads that the command line requests."""

import argparse
import os

import pytest


class ProcessAndThreads:
    """A solve that returns its process and how many threads it may have."""

    def __call__(self, *, progress):
        raise AssertionError("It was called in this process.")

    def __reduce__(self):
        text = "lambda progress: (__import__('os').getpid(), dict(__import__('os').environ))"
        return eval, (text,)


@pytest.mark.parametrize(("given", "number"), [({}, "1"), ({"threads": 3}, "3")])
def test_short_solve_has_its_own_process_and_threads_in_a_command(
    load, monkeypatch, given, number
):
    threads = load("solvers.processes.threads")
    for name in threads.VARIABLES:
        monkeypatch.setenv(name, "7")
    short_solve = load("mocap_assist.jobs.job").ShortSolve(ProcessAndThreads())
    solving = load("mocap_assist.batch.solving")

    process, environment = solving.solve_in_subprocess(
        short_solve, argparse.Namespace(**given), lambda *_: None
    )

    assert process != os.getpid()
    assert {environment[name] for name in threads.VARIABLES} == {number}


def test_every_solving_verb_has_the_threads_option(load, capsys):
    command = load("mocap_assist.batch.command")
    verbs = load("mocap_assist.batch.verbs").VERBS
    solving = {name for name, verb in verbs.items() if verb.solves} | {"capture", "index"}

    having = set()
    for name in [*verbs, "capture", "index", "import", "each"]:
        command.run([name, "--help"])
        if "--threads N" in capsys.readouterr().out:
            having.add(name)

    assert having == solving
    assert set(verbs) - solving == {"convert"}
