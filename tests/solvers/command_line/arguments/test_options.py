"""Settings come out of the command line as they were described."""

from dataclasses import dataclass
from enum import Enum
from math import pi

import pytest

from solvers.command_line.arguments import (
    SentenceParser,
    arguments_from,
    settings_from_arguments,
)
from solvers.errors import InvalidSettingError
from solvers.settings import Settings, setting, with_present_names


class Method(Enum):
    FAST = "fast"
    EXACT = "exact"


@dataclass(frozen=True, kw_only=True)
class BowSettings(Settings):
    string_length: float = setting(0.7, "Longer is lower", unit="m", minimum=0.1, maximum=2.0)
    tilt: float = setting(pi / 2, "Tilts 100 % more", unit="rad", minimum=0.0, maximum=pi)
    n_shots: int = setting(3, "More is louder", minimum=1, maximum=10)
    wet: bool = setting(True, "Whether it rains")
    method: Method = setting(Method.FAST, "How")
    label: str = setting("x", "What to call it", former="tag")
    n_arrows: int = setting(6, "More last longer", minimum=1, maximum=60, former="n_alike")


@dataclass(frozen=True, kw_only=True)
class ArrowSettings(Settings):
    n_shots: int = setting(5, "More is louder", minimum=1, maximum=10)


@pytest.fixture
def parser():
    parser = SentenceParser(prog="bow")
    arguments_from(parser, BowSettings, ArrowSettings)
    return parser


def test_each_kind_of_setting_is_read(parser):
    words = ["--string-length", "1.5", "--tilt", "180", "--n-shots", "7", "--no-wet"]
    words += ["--method", "exact", "--label", "y"]

    settings = settings_from_arguments(parser.parse_args(words), BowSettings)

    assert settings == BowSettings(
        string_length=1.5, tilt=pi, n_shots=7, wet=False, method=Method.EXACT, label="y"
    )


def test_omitted_option_is_the_default_of_each_class(parser):
    arguments = parser.parse_args([])

    assert settings_from_arguments(arguments, BowSettings) == BowSettings()
    assert settings_from_arguments(arguments, ArrowSettings).n_shots == 5


def test_help_has_unit_range_and_default(parser):
    text = " ".join(parser.format_help().split())

    assert "Longer is lower [m, 0.1 to 2, default 0.7]" in text
    assert "Tilts 100 % more [degrees, 0 to 180, default 90]" in text
    assert "--method {fast|exact} How [default fast]" in text
    assert "Whether it rains [default yes]" in text


def test_a_value_out_of_range_is_refused_with_the_range(parser):
    arguments = parser.parse_args(["--string-length", "3"])

    with pytest.raises(InvalidSettingError, match=r"must lie between 0\.1 and 2"):
        settings_from_arguments(arguments, BowSettings)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--method", "slow"], "Argument --method: 'slow' is not one of fast, exact"),
        (["--n-shots", "many"], "Argument --n-shots: invalid int value: 'many'"),
        (["--tilt", "up"], "Argument --tilt: invalid angle value: 'up'"),
        (["--speed", "1"], "Unrecognized arguments: --speed 1"),
    ],
)
def test_invalid_option_gives_one_sentence_on_stderr_and_status_2(
    parser, capsys, words, sentence
):
    with pytest.raises(SystemExit) as stopped:
        parser.parse_args(words)

    error_output = capsys.readouterr().err
    assert stopped.value.code == 2
    assert error_output.startswith(sentence)
    assert error_output.count("\n") == 1


def test_former_name_is_still_an_option_and_not_in_the_help(parser):
    given = parser.parse_args(["--n-alike", "12", "--tag", "y"])

    settings = settings_from_arguments(given, BowSettings)

    assert (settings.n_arrows, settings.label) == (12, "y")
    assert "alike" not in parser.format_help()


def test_stored_values_get_their_present_names():
    stored = {"n_alike": 9, "wet": False, "unknown": 1}

    assert with_present_names(BowSettings, stored) == {
        "n_arrows": 9,
        "wet": False,
        "unknown": 1,
    }
