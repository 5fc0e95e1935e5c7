"""Presets name settings that exist, with values that are allowed."""

import pytest

from solvers.command_line.arguments import (
    SentenceParser,
    add_preset_option,
    arguments_from,
    settings_from_arguments,
)
from solvers.denoising import DenoiseSettings, PlantSettings
from solvers.physics import Ground, SimulateSettings
from solvers.presets import PRESETS, mentioned_settings
from solvers.reconstruction import ReconstructSettings
from solvers.retargeting import RetargetSettings
from solvers.variation import VarySettings

SETTINGS = {
    "denoise": (DenoiseSettings, PlantSettings),
    "reconstruct": (ReconstructSettings,),
    "retarget": (RetargetSettings,),
    "simulate": (SimulateSettings,),
    "vary": (VarySettings,),
}


def parsed(verb, *words):
    parser = SentenceParser()
    add_preset_option(parser, verb)
    arguments_from(parser, *SETTINGS[verb])
    parser.set_defaults(verb=verb)
    return parser.parse_args(words)


@pytest.mark.parametrize(
    ("verb", "name"), [(verb, name) for verb in PRESETS for name in PRESETS[verb]]
)
def test_command_line_takes_the_values_of_a_preset(verb, name):
    arguments = parsed(verb, "--preset", name.lower().replace(" ", "-"))

    found = {}
    for each in SETTINGS[verb]:
        found |= vars(settings_from_arguments(arguments, each))

    defaults = {key: value for each in SETTINGS[verb] for key, value in vars(each()).items()}
    values = {
        key: value.value if isinstance(value, Ground) else value
        for key, value in found.items()
        if value != defaults[key]
    }
    assert values == PRESETS[verb][name].values


def test_options_replace_the_values_of_a_preset():
    arguments = parsed("simulate", "--preset", "Video AI", "--smoothing", "0.1")

    settings = settings_from_arguments(arguments, SimulateSettings)

    assert settings == SimulateSettings(ground=Ground.FEET, smoothing=0.1)


def test_unknown_preset_is_refused_with_the_names(capsys):
    with pytest.raises(SystemExit):
        parsed("vary", "--preset", "optical")

    assert "Choose one of: light, normal, heavy" in capsys.readouterr().err


def test_preset_gives_all_mentioned_settings_a_value():
    assert mentioned_settings("vary") == ("amount", "timing")
