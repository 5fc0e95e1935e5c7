"""The verbs of `python -m solvers`."""

import argparse

from .arguments import OutputKind, Verb, VerbWork


def _fix() -> VerbWork:
    from ..recordings import takes_in
    from .fix_verb import add_fix_options, perform_fix

    return VerbWork(add_fix_options, perform_fix, list_recordings=takes_in)


def _denoise() -> VerbWork:
    from .denoise_verb import add_denoise_options, learn_prior, perform_denoise

    return VerbWork(add_denoise_options, perform_denoise, prepare=learn_prior)


def _learn() -> VerbWork:
    from .learn_verb import add_learn_options, perform_learn

    return VerbWork(add_learn_options, perform_learn)


def _quality() -> VerbWork:
    from .quality_verb import add_quality_options, perform_quality

    return VerbWork(add_quality_options, perform_quality)


def _solve() -> VerbWork:
    from .solve_verb import add_solve_options, perform_solve

    return VerbWork(add_solve_options, perform_solve)


def _capture() -> VerbWork:
    from ..recordings import depth_takes_in
    from .capture_verb import add_capture_options, perform_capture, read_body

    return VerbWork(add_capture_options, perform_capture, depth_takes_in, read_body)


def _reconstruct() -> VerbWork:
    from .reconstruct_verb import add_reconstruct_options, perform_reconstruct, read_guides

    return VerbWork(add_reconstruct_options, perform_reconstruct, prepare=read_guides)


def _residuals() -> VerbWork:
    from .residuals_verb import add_residuals_options, perform_residuals

    return VerbWork(add_residuals_options, perform_residuals)


def _postures() -> VerbWork:
    from .postures_verb import add_postures_options, perform_postures

    return VerbWork(add_postures_options, perform_postures)


def _simulate() -> VerbWork:
    from .simulate_verb import add_simulate_options, perform_simulate

    return VerbWork(add_simulate_options, perform_simulate)


def _index() -> VerbWork:
    from .library_verbs import add_index_options, perform_index

    return VerbWork(add_index_options, perform_index)


def _find() -> VerbWork:
    from .library_verbs import add_find_options, perform_find

    return VerbWork(add_find_options, perform_find)


def _vary() -> VerbWork:
    from .vary_verb import add_vary_options, perform_vary

    return VerbWork(add_vary_options, perform_vary)


def _convert() -> VerbWork:
    from .convert_verb import add_convert_options, perform_convert

    return VerbWork(add_convert_options, perform_convert)


def _retarget() -> VerbWork:
    from .retarget_verbs import add_retarget_options, perform_retarget, read_target

    return VerbWork(add_retarget_options, perform_retarget, prepare=read_target)


def _replay() -> VerbWork:
    from .replay_verb import add_replay_options, perform_replay

    return VerbWork(add_replay_options, perform_replay)


def _report() -> VerbWork:
    from .batches import report_folder

    return VerbWork(_no_options, report_folder)


def _unbake() -> VerbWork:
    from .retarget_verbs import add_unbake_options, perform_unbake

    return VerbWork(add_unbake_options, perform_unbake)


def _no_options(parser: argparse.ArgumentParser) -> None:
    """Add no options."""


VERBS = {
    "fix": Verb(
        "Fix takes of any origin by what suits them: track, clean, solve or reconstruct.",
        _fix,
        writes_motions=True,
    ),
    "denoise": Verb(
        "Remove jitter, spikes and gaps from recordings, and plant standing feet.",
        _denoise,
    ),
    "learn": Verb(
        "Learn filter bases from clean clips, once for many takes.",
        _learn,
        OutputKind.ONE_FILE,
    ),
    "quality": Verb(
        "Measure jitter, spikes, gaps and foot slide.",
        _quality,
        OutputKind.WORDS,
    ),
    "solve": Verb(
        "Solve the motion of a skeleton from the labeled markers of optical takes.",
        _solve,
        writes_motions=True,
    ),
    "capture": Verb(
        "Track the actor of a depth recording: depth images become motion.",
        _capture,
        writes_motions=True,
        writes_joints=True,
    ),
    "reconstruct": Verb(
        "Rebuild clean poses from the joints of a depth camera.",
        _reconstruct,
        writes_motions=True,
        writes_joints=True,
    ),
    "learn-residuals": Verb(
        "Learn the errors of a depth camera from takes with a reference.",
        _residuals,
        OutputKind.ONE_FILE,
    ),
    "learn-postures": Verb(
        "Build a posture library from clean clips, for reconstruct.",
        _postures,
        OutputKind.ONE_FILE,
    ),
    "simulate": Verb(
        "Track motions of a skeleton with a physical body on solid ground.",
        _simulate,
    ),
    "index": Verb(
        "Add recordings to a searchable library, and keep it up to date.",
        _index,
        OutputKind.LIBRARY,
    ),
    "find": Verb(
        "Find the segments of clips in a library that are similar to a recording.",
        _find,
        OutputKind.MATCHES,
    ),
    "vary": Verb(
        "Synthesize variants of a few clips of one behavior.",
        _vary,
        OutputKind.MANY_FILES,
    ),
    "convert": Verb(
        "Write recordings of any known format as BVH, or points as C3D or TRC.",
        _convert,
    ),
    "retarget": Verb(
        "Retarget motions to another skeleton with other names, lengths and rest pose.",
        _retarget,
    ),
    "replay": Verb(
        "Send recordings to this machine as a live stream, like a depth camera's tracker.",
        _replay,
        OutputKind.WORDS,
    ),
    "report": Verb(
        "Collect the records of a batch, from all machines, into one report.",
        _report,
        OutputKind.REPORT,
    ),
    "unbake": Verb(
        "Replace a key on every frame with a few keys with handles.",
        _unbake,
    ),
}
"""A new verb is a new entry here."""
