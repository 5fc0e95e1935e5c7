"""The verbs of `python -m solvers`."""

from .arguments import OutputKind, Verb

VERBS = {
    "fix": Verb(
        "Fix takes of any origin by what suits them: track, clean, solve or reconstruct.",
        ".fix_verb:FIX",
        writes_motions=True,
    ),
    "denoise": Verb(
        "Remove jitter, spikes and gaps from recordings, and plant standing feet.",
        ".denoise_verb:DENOISE",
    ),
    "learn": Verb(
        "Learn filter bases from clean clips, once for many takes.",
        ".learn_verb:LEARN",
        OutputKind.ONE_FILE,
    ),
    "quality": Verb(
        "Measure jitter, spikes, gaps and foot slide.",
        ".quality_verb:QUALITY",
        OutputKind.WORDS,
    ),
    "solve": Verb(
        "Solve the motion of a skeleton from the labeled markers of optical takes.",
        ".solve_verb:SOLVE",
        writes_motions=True,
    ),
    "capture": Verb(
        "Track the actor of a depth recording: depth images become motion.",
        ".capture_verb:CAPTURE",
        writes_motions=True,
        writes_joints=True,
    ),
    "reconstruct": Verb(
        "Rebuild clean poses from the joints of a depth camera.",
        ".reconstruct_verb:RECONSTRUCT",
        writes_motions=True,
        writes_joints=True,
    ),
    "learn-residuals": Verb(
        "Learn the errors of a depth camera from takes with a reference.",
        ".residuals_verb:LEARN_RESIDUALS",
        OutputKind.ONE_FILE,
    ),
    "learn-postures": Verb(
        "Build a posture library from clean clips, for reconstruct.",
        ".postures_verb:LEARN_POSTURES",
        OutputKind.ONE_FILE,
    ),
    "simulate": Verb(
        "Track motions of a skeleton with a physical body on solid ground.",
        ".simulate_verb:SIMULATE",
    ),
    "index": Verb(
        "Add recordings to a searchable library, and keep it up to date.",
        ".library_verbs:INDEX",
        OutputKind.LIBRARY,
    ),
    "find": Verb(
        "Find the segments of clips in a library that are similar to a recording.",
        ".library_verbs:FIND",
        OutputKind.MATCHES,
    ),
    "vary": Verb(
        "Synthesize variants of a few clips of one behavior.",
        ".vary_verb:VARY",
        OutputKind.MANY_FILES,
    ),
    "convert": Verb(
        "Write recordings of any known format as BVH, or points as C3D or TRC.",
        ".convert_verb:CONVERT",
    ),
    "retarget": Verb(
        "Retarget motions to another skeleton with other names, lengths and rest pose.",
        ".retarget_verbs:RETARGET",
    ),
    "replay": Verb(
        "Send recordings to this machine as a live stream, like a depth camera's tracker.",
        ".replay_verb:REPLAY",
        OutputKind.WORDS,
    ),
    "report": Verb(
        "Collect the records of a batch, from all machines, into one report.",
        ".report_verb:REPORT",
        OutputKind.REPORT,
    ),
    "unbake": Verb(
        "Replace a key on every frame with a few keys with handles.",
        ".retarget_verbs:UNBAKE",
    ),
}
"""A new verb is a new entry here: where its `VerbWork` is, by module and name."""
