"""Which constants the solvers have, read from their source without importing it.

A constant is a module-level name in capitals whose value is written with numbers alone: an
int, a float, or a tuple of them, also inside `np.radians` or `np.sqrt`. What is computed from
another constant is no constant of its own.
"""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
FAMILIES: dict[str, tuple[str, ...]] = {
    "denoising": (
        "solvers/denoising/denoise.py",
        "solvers/denoising/denoise_settings.py",
        "solvers/denoising/edge_poses.py",
        "solvers/denoising/held_samples",
        "solvers/denoising/noise_sections.py",
        "solvers/denoising/default_method.py",
        "solvers/denoising/observed_samples.py",
        "solvers/denoising/channels",
        "solvers/denoising/limb_gaps",
        "solvers/denoising/motion_model",
        "solvers/denoising/averaging",
        "solvers/denoising/outliers",
        "solvers/denoising/window_estimates",
        "solvers/denoising/window_priors",
        "solvers/denoising/published.py",
        "solvers/signals/noise.py",
    ),
    "limits": ("solvers/denoising/limits",),
    "quality": ("solvers/denoising/quality", "solvers/signals/spikes.py"),
    "feet": ("solvers/feet", "solvers/motion_fitting"),
    "marker_gaps": ("solvers/denoising/marker_gaps",),
    "reconstruction": ("solvers/reconstruction", "solvers/signals/gaussian_smoothing.py"),
    "motion": ("solvers/motion",),
    "retargeting": ("solvers/retargeting",),
    "markers": (
        "solvers/markers/body_tables.py",
        "solvers/markers/build_body.py",
        "solvers/markers/determined_joints.py",
        "solvers/markers/fit_body.py",
        "solvers/markers/fit_poses.py",
        "solvers/markers/initial_poses.py",
        "solvers/markers/joint_centers.py",
        "solvers/markers/solve_skeleton.py",
        "solvers/markers/stick_sets.py",
    ),
    "marker_labels": (
        "solvers/markers/constrain_clusters.py",
        "solvers/markers/distances.py",
        "solvers/markers/mistaken_labels.py",
        "solvers/markers/pair_swaps.py",
        "solvers/markers/rigid_clusters.py",
        "solvers/markers/rigid_transform.py",
        "solvers/markers/unswap.py",
    ),
    "physics": ("solvers/physics",),
    "retrieval": ("solvers/retrieval",),
    "gestures": ("solvers/gestures",),
    "variation": ("solvers/variation",),
    "stepwise_variation": ("solvers/variation",),
    "depth_scene": ("solvers/depth_scene",),
    "depth_tracking": ("solvers/depth_tracking",),
    "depth_bodies": (
        "solvers/depth_tracking/body/pose_from_joints.py",
        "solvers/depth_tracking/capturing/calibrate_body.py",
        "solvers/depth_tracking/capturing/find_body.py",
        "solvers/depth_tracking/capturing/refine_body.py",
        "solvers/depth_tracking/capturing/retracked_path.py",
        "solvers/depth_tracking/capturing/sample_cylinders.py",
    ),
}
"""The modules whose constants each metric varies. Left out as a whole: recordings,
command_line, pictures, processes, samples and rotations (formats, limits against hostile files,
display, synthetic data, exact formulas), and workflows, which have no metric yet."""
UNMEASURED: dict[str, tuple[str, ...]] = {
    "workflows": ("solvers/workflows",),
    "recordings": tuple(
        f"solvers/recordings/{folder}"
        for folder in (
            "conventions", "depth_files", "joint_files", "marker_files", "skeleton_files"
        )
    ),
    "mocap_assist": tuple(
        f"mocap_assist/{folder}"
        for folder in ("actions", "clean", "overlays", "retarget", "rigs", "scene", "track")
    ),
}  # fmt: skip
"""Modules without a metric, whose tuned constants have a unit and a source nevertheless."""
UNITS_BY_SUFFIX = {
    "_M_S": "m/s", "_RAD_S": "rad/s", "_PER_M2": "1/m", "_M2": "m2", "_DB": "dB",
    "_COSINE": "cosine", "_SINE": "sine", "_RELIABILITY": "0 to 1", "_CONFIDENCE": "0 to 1",
    "_S": "s", "_M": "m", "_CM": "cm", "_MM": "mm", "_DEG": "deg", "_RAD": "rad",
    "_HZ": "Hz", "_PX": "px", "_KG": "kg", "_FRAMES": "frames", "_FRACTION": "fraction",
    "_SHARE": "fraction", "_RATIO": "ratio", "_FACTOR": "factor", "_SIGMAS": "std. dev.",
    "_NM": "N m", "_KG_M3": "kg/m3", "_DENSITY": "1/deg",
}  # fmt: skip
UNITS_BY_WORDS = {
    r"meters per second": "m/s", r"radians per second": "rad/s", r"\bframes?\b": "frames",
    r"degrees or centimeters": "deg or cm", r"square degrees": "deg2",
    r"square meters": "m2", r"\bmeters?\b": "m",
    r"\bseconds?\b": "s", r"\bdegrees?\b": "deg", r"hertz": "Hz", r"\bpixels?\b": "px",
    r"radians": "rad", r"(arm|leg) lengths?": "ratio", r"decibels": "dB",
    r"cosine": "cosine", r"\bsine\b": "sine",
    r"percentiles?\b": "%", r"probability": "probability",
    r"severity": "severity", r"time constants": "time const.", r"fraction": "fraction",
    r"standard deviations": "std. dev.", r"relative|ratio": "ratio",
    r"\bfactors?\b": "factor", r"logarithm": "log",
    r"number of|a count|iterations|rounds": "count", r"weight": "weight",
}  # fmt: skip


@dataclass(frozen=True)
class Constant:
    """One constant, and where it stands."""

    path: str
    """Of its module, relative to the checkout."""
    name: str
    value: Any
    text: str
    """Docstring or comment next to it."""
    line: int

    @property
    def key(self) -> str:
        """Module and name, unique in the project."""
        return f"{self.path.removeprefix('solvers/').removesuffix('.py')}.{self.name}"

    @property
    def module(self) -> str:
        """Importable name of the module."""
        return self.path.removesuffix(".py").replace("/", ".")

    @property
    def is_count(self) -> bool:
        """Whether it is a whole number of something, by its name."""
        of_what = self.name.removeprefix("_").startswith("N_")
        return of_what and isinstance(self.value, int) and not self.name.endswith("_FRAMES")

    @property
    def unit(self) -> str:
        """Unit, from the end of the name or the first word of the text that is one."""
        if self.is_count:
            return "count"
        for suffix, unit in UNITS_BY_SUFFIX.items():
            if self.name.endswith(suffix):
                return unit
        found = [
            (match.start(), order, unit)
            for order, (words, unit) in enumerate(UNITS_BY_WORDS.items())
            if (match := re.search(words, self.text, re.IGNORECASE))
        ]
        return min(found)[2] if found else "count" if isinstance(self.value, int) else "-"


@cache
def constants_of(family: str) -> tuple[Constant, ...]:
    """Return all constants of a family, in the order of its modules."""
    return tuple(
        each
        for path in (FAMILIES | UNMEASURED)[family]
        for each in _below(ROOT / path)
        if _belongs(Path(each.path), family)
    )


def _belongs(path: Path, family: str) -> bool:
    """Whether a module is of the family; two of variation and two of depth share a folder."""
    if family == "depth_tracking":
        return path.as_posix() not in FAMILIES["depth_bodies"]
    if "variation" not in family:
        return True
    return ("published" in path.parts) == family.startswith("stepwise")


def _below(path: Path) -> Iterator[Constant]:
    for module in sorted(path.rglob("*.py")) if path.is_dir() else [path]:
        yield from constants_in(module)


def constants_in(module: Path) -> Iterator[Constant]:
    """Yield the constants of one module."""
    source = module.read_text(encoding="utf-8")
    lines = source.splitlines()
    body = ast.parse(source).body
    for node, after in zip_longest(body, body[1:]):
        for name, value in _numbers(node):
            path = str(module.relative_to(ROOT))
            yield Constant(path, name, value, text_of(node, after, lines), node.lineno)


def assigned_values(node: ast.stmt) -> dict[str, ast.expr]:
    """Return the expression assigned to each name in capitals by a statement."""
    if isinstance(node, ast.AnnAssign) and node.value is not None:
        pairs = [(node.target, node.value)]
    elif isinstance(node, ast.Assign) and len(node.targets) == 1:
        pairs = [(node.targets[0], node.value)]
        if isinstance(node.targets[0], ast.Tuple) and isinstance(node.value, ast.Tuple):
            pairs = list(zip(node.targets[0].elts, node.value.elts, strict=True))
    else:
        return {}
    return {
        target.id: value
        for target, value in pairs
        if isinstance(target, ast.Name) and target.id.isupper()
    }


def scaled(value: Any, factor: float) -> Any:
    """Scale a value: a whole number stays one of at least 1; tuples item by item.

    What became equal in a tuple of different items is kept once. What lies between 0.9 and 1
    is a fraction of a whole: its distance from 1 is scaled.
    """
    if isinstance(value, tuple):
        items = tuple(_scaled_item(item, factor) for item in value)
        return tuple(dict.fromkeys(items)) if len(set(value)) == len(value) else items
    if isinstance(value, int):
        return max(1, round(value * factor))
    if 0.9 <= value < 1.0:
        return 1.0 - (1.0 - value) * factor
    return value * factor


def _scaled_item(item: Any, factor: float) -> Any:
    if isinstance(item, tuple):
        return tuple(_scaled_item(each, factor) for each in item)
    return scaled(item, factor)


def _numbers(node: ast.stmt) -> Iterator[tuple[str, Any]]:
    for name, expression in assigned_values(node).items():
        if any(isinstance(each, ast.Name) and each.id != "np" for each in ast.walk(expression)):
            continue
        try:
            code = compile(ast.Expression(expression), "", "eval")
            value = eval(code, {"np": np, "__builtins__": {}})
        except (TypeError, AttributeError, NameError):
            continue
        value = float(value) if isinstance(value, np.floating) else value
        if _is_number(value):
            yield name, value


def _is_number(value: Any) -> bool:
    if isinstance(value, tuple):
        return bool(value) and all(_is_number(item) for item in value)
    return isinstance(value, int | float) and not isinstance(value, bool) and value != 0


def text_of(node: ast.stmt, after: ast.stmt | None, lines: list[str]) -> str:
    """Return the docstring below, or the comment above or at the end of the line."""
    if isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant):
        return " ".join(str(after.value.value).split())
    at_end = lines[(node.end_lineno or node.lineno) - 1].partition("#")[2]
    above = []
    for line in reversed(lines[: node.lineno - 1]):
        if not line.startswith("#"):
            break
        above.insert(0, line.strip("# "))
    return " ".join([*above, at_end.strip()]).strip()
