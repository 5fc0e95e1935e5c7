"""Write into the documents what they quote from the code, so that it cannot go stale.

    make docs

A table of settings stands between `<!-- settings solvers.denoising.DenoiseSettings -->` and
`<!-- end -->`, the table of buttons between `<!-- buttons -->` and `<!-- end -->`, and that of
the presets of a verb after `<!-- presets denoise -->`.
"""

import ast
import inspect
import re
from dataclasses import fields, is_dataclass
from enum import Enum
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from solvers.presets import PRESETS
from solvers.settings import label_of

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
ENDLESS = 1e6
SETTINGS = re.compile(r"(<!-- settings ([\w.]+)\.(\w+) -->\n).*?(<!-- end -->)", re.DOTALL)
PRESET_TABLE = re.compile(r"(<!-- presets (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)
BUTTONS = re.compile(r"(<!-- buttons -->\n).*?(<!-- end -->)", re.DOTALL)
NOT_BUTTONS = {"import_job"}
"""Operators that another operator starts: no user sees them."""
PAGES = {
    "importing": "import_recording load_sample add_workspace change_axes show_depth",
    "fixing": "fix_take fix_takes fix_folder submit_folder accept_fix",
    "tracking": "track_depth choose_live track_live retrack",
    "reconstruction": "reconstruct",
    "cleaning": "denoise learn_patterns plant_feet measure_quality jump_to_issue mark_issues"
    " set_range revert_to_raw show_raw",
    "export": "export_take",
    "physics": "simulate",
    "markers": "solve_skeleton",
    "retargeting": "retarget reduce_keys",
    "library_in_blender": "index_library keep_current find_similar browse_matches load_match"
    " link_match learn_from_matches use_matches mark_asset",
    "performing": "listen record_live",
    "variation": "vary keep_variants stack_variants assign_variants draw_variants"
    " mark_variants",
}
"""By page of docs/manual, the buttons that it describes, in the order of the work."""
NAMES = re.compile(r"(<!-- names of ([\w.]+) -->\n).*?(<!-- end -->)", re.DOTALL)
"""Where the table of what a package exports stands."""


def renewed(text: str) -> str:
    """Return the text of a document with all its tables as the code now says."""
    text = NAMES.sub(lambda found: found[1] + names_table(found[2]) + found[3], text)
    text = SETTINGS.sub(
        lambda found: found[1] + settings_table(found[2], found[3]) + found[4], text
    )
    text = PRESET_TABLE.sub(lambda found: found[1] + preset_table(found[2]) + found[3], text)
    return BUTTONS.sub(lambda found: found[1] + buttons_table() + found[2], text)


def preset_table(verb: str) -> str:
    """Return a Markdown table of the presets of a verb."""
    rows = ["| preset | what it does | what it sets |", "|---|---|---|"]
    for name, preset in PRESETS[verb].items():
        options = ", ".join(_option(*each) for each in preset.values.items())
        rows.append(f"| *{name}* | {preset.help}. | {options or 'nothing'} |")
    return "\n".join(rows) + "\n"


def _option(name: str, value: Any) -> str:
    """Return a setting as on the command line."""
    option = name.replace("_", "-")
    if isinstance(value, bool):
        return f"`--{option}`" if value else f"`--no-{option}`"
    return f"`--{option} {value:g}`" if isinstance(value, float) else f"`--{option} {value}`"


def buttons_table() -> str:
    """Return a Markdown table of all buttons: label, identifier, tooltip and page."""
    texts = buttons()
    rows = ["| button | operator | what it does | page |", "|---|---|---|---|"]
    for page, names in PAGES.items():
        for name in names.split():
            label, tooltip = texts[name]
            rows.append(
                f"| **{label}** | `mocap_assist.{name}` | {tooltip}. | [{page}.md]({page}.md) |"
            )
    return "\n".join(rows) + "\n"


def buttons() -> dict[str, tuple[str, str]]:
    """Label and tooltip of every button, read from the source, since Blender may be absent."""
    found = {}
    for module in sorted((ROOT / "operators").glob("*.py")):
        for node in ast.walk(ast.parse(module.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ClassDef):
                texts = _constants(node)
                name = texts.get("bl_idname", "").removeprefix("mocap_assist.")
                if name and name not in NOT_BUTTONS:
                    found[name] = texts["bl_label"], texts["bl_description"]
    return found


def _constants(node: ast.ClassDef) -> dict[str, str]:
    return {
        statement.targets[0].id: statement.value.value
        for statement in node.body
        if isinstance(statement, ast.Assign)
        and isinstance(statement.targets[0], ast.Name)
        and isinstance(statement.value, ast.Constant)
    }


def settings_table(module: str, name: str) -> str:
    """Return a Markdown table of one settings class."""
    rows = ["| setting | default | allowed | what it does |", "|---|---|---|---|"]
    for item in fields(getattr(import_module(module), name)):
        described = item.metadata["described"]
        folded = " *(advanced)*" if described.advanced else ""
        folded = " *(research)*" if described.research else folded
        allowed = _allowed(item.default, described)
        help_text = described.help.replace("|", "\\|")
        rows.append(
            f"| {label_of(item)}{folded} | {_shown(item.default)}{_unit(described)}"
            f" | {allowed} | {help_text}. |"
        )
    return "\n".join(rows) + "\n"


def names_table(package: str) -> str:
    """Return a Markdown table of the functions and classes that a package exports."""
    exported = _exported(import_module(package))
    rows = ["| name | what it is |", "|---|---|"]
    for is_kind in (inspect.isfunction, inspect.isclass):
        for name, value in exported.items():
            if is_kind(value):
                rows.append(
                    f"| `{name}{_inputs(value)}` | {_first_sentence(value)}{_parts(value)} |"
                )
    return "\n".join(rows) + "\n"


def _exported(module: ModuleType) -> dict[str, Any]:
    """Return what a package exports; of a module that is no package, what it defines."""
    if hasattr(module, "__all__"):
        return {name: getattr(module, name) for name in module.__all__}
    return {
        name: value
        for name, value in sorted(vars(module).items())
        if not name.startswith("_") and getattr(value, "__module__", "") == module.__name__
    }


def _inputs(value: Any) -> str:
    """Return the arguments of a function, with the defaults that fit into a table."""
    if inspect.isclass(value):
        return ""
    shown, is_after_star = [], False
    for name, argument in inspect.signature(value).parameters.items():
        if argument.kind is argument.KEYWORD_ONLY and not is_after_star:
            shown.append("*")
            is_after_star = True
        default = argument.default
        if default is argument.empty:
            shown.append(name)
        elif default is None or type(default) in {str, int, float, bool}:
            shown.append(f"{name}={default!r}")
        else:
            shown.append(f"{name}=...")
    return f"({', '.join(shown)})"


def _first_sentence(value: Any) -> str:
    paragraph = " ".join((inspect.getdoc(value) or "").partition("\n\n")[0].split())
    return paragraph.replace("|", "\\|")


def _parts(value: Any) -> str:
    """Return the fields of a class of values; settings have tables of their own."""
    if not is_dataclass(value) or value.__name__.endswith("Settings"):
        return ""
    return f" Fields: {', '.join(f'`{item.name}`' for item in fields(value))}."


def _allowed(default: Any, described: Any) -> str:
    if isinstance(default, bool):
        return "on, off"
    if isinstance(default, Enum):
        return ", ".join(one.value for one in type(default))
    if isinstance(default, str):
        return "text"
    low, high = described.minimum, described.maximum
    return f"{low:g} to {high:g}" if high < ENDLESS else f"{low:g} or more"


def _shown(value: Any) -> str:
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, Enum):
        return str(value.value)
    return f"{value:.3g}" if isinstance(value, float) else str(value)


def _unit(described: Any) -> str:
    return f" {described.unit}" if described.unit else ""


def main() -> None:
    """Renew the documents."""
    for document in DOCUMENTS:
        document.write_text(renewed(document.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
