"""What the documents say must be so: tables, links, buttons and commands."""

import ast
import re
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

from solvers.command_line.run import run
from solvers.command_line.verbs import VERBS

ROOT = Path(__file__).parents[1]
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
LINK = re.compile(r"\]\(([^)#\s]+)[^)]*\)")


@pytest.fixture(scope="module")
def write_docs():
    spec = spec_from_file_location("write_docs", ROOT / ".ci" / "write_docs.py")
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_tables_of_settings_say_what_the_code_says(document, write_docs):
    """After a change: `python .ci/write_docs.py`."""
    text = document.read_text(encoding="utf-8")

    assert write_docs.renewed(text) == text


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_links_lead_somewhere(document):
    links = LINK.findall(document.read_text(encoding="utf-8"))

    lost = [link for link in links if ":" not in link and not (document.parent / link).exists()]
    assert not lost


def test_the_readme_describes_every_button_and_no_other():
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    described = set(re.findall(r"`mocap_assist\.(\w+)`", readme))

    assert described == set(buttons())
    for label in buttons().values():
        assert f"**{label}**" in readme, label


def test_commands_in_the_documents_exist_and_the_readme_shows_all():
    shown = {"solvers": set(), "blender": set()}
    for document in DOCUMENTS:
        text = document.read_text(encoding="utf-8")
        shown["solvers"] |= set(re.findall(r"python -m solvers ([\w-]+)", text))
        shown["blender"] |= set(re.findall(r"--command mocap_assist (\w+)", text))

    assert shown["solvers"] == set(VERBS)
    assert shown["blender"] == blender_verbs() | {"import", "capture", "index", "each"}


def blender_verbs() -> set[str]:
    """The verbs of `blender --command`, read from the source, since Blender may be absent."""
    source = (ROOT / "mocap_assist" / "batch" / "verbs.py").read_text(encoding="utf-8")
    table = next(
        statement.value
        for statement in ast.parse(source).body
        if isinstance(statement, ast.Assign) and statement.targets[0].id == "VERBS"
    )
    return {key.value for key in table.keys}


def test_options_in_the_readme_exist(capsys):
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    for verb, words in re.findall(r"^python -m solvers ([\w-]+)(.*)$", readme, re.MULTILINE):
        with pytest.raises(SystemExit):
            run(VERBS, [verb, "--help"], "solvers")
        text = capsys.readouterr().out
        assert set(re.findall(r"--[a-z-]+", words)) <= set(re.findall(r"--[a-z-]+", text))


def buttons() -> dict[str, str]:
    """Name and label of every button, read from the source, since Blender may be absent.

    What a button has done for it is no button: `import_job`.
    """
    found = {}
    for module in sorted((ROOT / "operators").glob("*.py")):
        for node in ast.walk(ast.parse(module.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ClassDef):
                constants = {
                    statement.targets[0].id: statement.value.value
                    for statement in node.body
                    if isinstance(statement, ast.Assign)
                    and isinstance(statement.value, ast.Constant)
                }
                if "bl_idname" in constants and node.name != "MOCAP_OT_import_job":
                    name = constants["bl_idname"].removeprefix("mocap_assist.")
                    found[name] = constants["bl_label"]
    return found
