"""What the documents say must be so: tables, links, buttons and commands."""

import ast
import os
import re
import subprocess
import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

from solvers.command_line.run import run
from solvers.command_line.verbs import VERBS

ROOT = Path(__file__).parents[1]
DOCUMENTS = [
    *sorted(ROOT.glob("*.md")),
    *sorted((ROOT / "docs").rglob("*.md")),
]
DOORS = [
    ROOT / "README.md",
    *sorted((ROOT / "docs" / "start").glob("*.md")),
    *sorted((ROOT / "docs" / "origins").glob("*.md")),
]
"""What a newcomer reads first: what is bold in them is the label of a button."""
ORIGINS = [page for page in DOORS if page.parent.name == "origins" and page.name != "README.md"]
"""A page for each maker of recordings."""
GUIDES = [ROOT / "CONTRIBUTING.md", ROOT / "docs" / "architecture.md"]
"""What names files of the code: after a move they are renamed here, too."""
PROSE = [
    page
    for page in DOCUMENTS
    if page.parent != ROOT or page.name in {"README.md", "CONTRIBUTING.md"}
]
CODE = re.compile(r"^ *```.*?^ *```$", re.MULTILINE | re.DOTALL)
LINKED = re.compile(r"!?\[[^]]*\]\([^)]*\)")
COMMAND = re.compile(r"^ *python -m solvers ([\w-]+)(.*)$", re.MULTILINE)
LINK = re.compile(r"\]\(([^)#\s]+)[^)]*\)")
ANCHOR = re.compile(r"\]\(([^):#\s]*)#([^)\s]+)\)")
LABEL = re.compile(r"(?<![*\w])\*([A-Z][^*\n]+)\*(?![*\w])")
MESSAGE = re.compile(r'^msgid "(.*)"$', re.MULTILINE)
OTHER_LABELS = {
    "Animation", "Bake Action", "Combine", "Export", "Extreme", "Generated", "Influence", "Key",
    "Limit Rotation", "Motion Capture", "New Preset", "Pose", "Relationship Lines",
    "Heavy", "Light", "Mocap", "Normal", "Optical", "Suit", "Video AI",
    "Best Matches of ...", "Issue", "No good match", "Use Best Matches in",
    "Afterwards", "Before", "Carrying", "Deepest", "Dropped", "During", "Help", "Impossible",
    "Published", "Slide", "Speed",
    "Generic", "Humanoid", "Import Uniform Scale", "Root bone", "Scale Factor",
}  # fmt: skip
"""In italics in the manual, in this order: labels of Blender, presets and the tab, texts with a
name or number in them, columns of tables, and labels of game engines."""
INTERNAL = {
    "command_line", "depth_scene", "feet", "motion_fitting", "pictures", "processes", "signals",
}  # fmt: skip
"""Packages without promises: scripts use verbs, or what is made of these."""
README_LINES = 130
MAX_LINE_CHARACTERS = 160


def name_of(document: Path) -> str:
    return document.relative_to(ROOT).as_posix()


@pytest.fixture(scope="module")
def write_docs():
    spec = spec_from_file_location("write_docs", ROOT / ".ci" / "documents" / "write_docs.py")
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("document", DOCUMENTS, ids=name_of)
def test_tables_of_settings_match_the_code(document, write_docs):
    """After a change: `make docs`."""
    text = document.read_text(encoding="utf-8")

    assert write_docs.renewed(text) == text


@pytest.mark.parametrize("document", DOCUMENTS, ids=name_of)
def test_links_have_targets(document):
    links = LINK.findall(document.read_text(encoding="utf-8"))

    missing = [
        link for link in links if ":" not in link and not (document.parent / link).exists()
    ]
    assert not missing


@pytest.mark.parametrize("document", DOCUMENTS, ids=name_of)
def test_links_into_pages_point_to_a_heading(document):
    for link, anchor in ANCHOR.findall(document.read_text(encoding="utf-8")):
        page = (document.parent / link) if link else document
        headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)

        assert anchor in map(anchor_of, headings), f"{link}#{anchor}"


def anchor_of(heading: str) -> str:
    """Return what GitHub makes of a heading."""
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


@pytest.mark.parametrize("document", PROSE, ids=name_of)
def test_lines_of_prose_are_short(document):
    """Tables, code, headings, and lines of nothing but links or a picture may be longer."""
    text = CODE.sub("", document.read_text(encoding="utf-8"))
    lines = [line for line in text.splitlines() if not line.lstrip().startswith(("|", "#"))]

    assert not [
        line
        for line in lines
        if len(line) > MAX_LINE_CHARACTERS and re.search(r"\w", LINKED.sub("", line))
    ]


def test_every_picture_is_on_a_page():
    shown = {
        (document.parent / link).resolve()
        for document in DOCUMENTS
        for link in LINK.findall(document.read_text(encoding="utf-8"))
    }
    pictures = [path for path in (ROOT / "docs" / "pictures").rglob("*") if path.is_file()]

    assert pictures
    assert not [name_of(path) for path in pictures if path not in shown]


@pytest.mark.parametrize("document", GUIDES, ids=name_of)
def test_files_named_in_guides_exist(document):
    text = document.read_text(encoding="utf-8")
    paths = re.findall(r"`((?:\.ci|docs|mocap_assist|operators|solvers|tests)/[\w./]+)`", text)

    assert paths
    assert not [path for path in paths if not (ROOT / path).exists()]


def test_page_of_public_names_has_every_package_but_the_internal_ones():
    page = (ROOT / "docs" / "technical" / "api.md").read_text(encoding="utf-8")
    packages = {file.parent.name for file in (ROOT / "solvers").glob("*/__init__.py")}

    listed = set(re.findall(r"<!-- names of solvers\.(\w+) -->", page))

    assert listed == packages - INTERNAL | {"settings", "errors", "progress"}
    assert "`clean_from_library(" in page and "`InvalidFileError`" in page


def test_every_button_has_a_row_on_the_page_of_buttons(write_docs):
    """A new button and its page are named in `PAGES` of `.ci/documents/write_docs.py`."""
    named = [name for names in write_docs.PAGES.values() for name in names.split()]
    page = (ROOT / "docs" / "manual" / "buttons.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| \*\*.+?\*\* \| `mocap_assist\.(\w+)`", page, re.MULTILINE)

    assert sorted(named) == sorted(write_docs.buttons())
    assert rows == named


def test_buttons_are_read_from_their_source(write_docs):
    label, tooltip = write_docs.buttons()["denoise"]

    assert label == "Clean"
    assert "new action" in tooltip
    assert "import_job" not in write_docs.buttons()


@pytest.mark.parametrize("document", DOORS, ids=name_of)
def test_buttons_in_bold_exist(document, write_docs):
    text = document.read_text(encoding="utf-8")
    labels = {label for label, _ in write_docs.buttons().values()}

    assert set(re.findall(r"\*\*(.+?)\*\*", text)) <= labels


def test_labels_in_italics_exist():
    """A label that was renamed in the window is renamed in the manual, too."""
    catalog = ROOT / "mocap_assist" / "languages" / "de_DE.po"
    labels = OTHER_LABELS | set(MESSAGE.findall(catalog.read_text(encoding="utf-8")))
    named = {
        (document.name, part)
        for document in sorted((ROOT / "docs" / "manual").glob("*.md"))
        for text in LABEL.findall(CODE.sub("", document.read_text(encoding="utf-8")))
        for part in re.split(r" > |: ?|, ", text)
        if part
    }

    assert len(named) > 100
    assert not [(page, part) for page, part in sorted(named) if part not in labels]


def test_links_lead_from_the_index_to_every_page():
    found, open_pages = set(), [ROOT / "docs" / "README.md"]
    while open_pages:
        page = open_pages.pop()
        found.add(page)
        text = page.read_text(encoding="utf-8")
        linked = {(page.parent / link).resolve() for link in LINK.findall(text)}
        open_pages += [
            each for each in linked - found if each.suffix == ".md" and each.exists()
        ]

    assert not [name_of(page) for page in PROSE if page not in found]


@pytest.mark.parametrize("page", ORIGINS, ids=name_of)
def test_pages_of_origins_have_three_steps_and_are_listed(page):
    text = page.read_text(encoding="utf-8")
    steps = re.findall(r"^(\d)\. ", text, re.MULTILINE)
    lists = [ROOT / "docs" / "origins" / "README.md", ROOT / "docs" / "README.md"]

    assert steps == ["1", "2", "3"]
    assert "Known faults:" in text
    assert all(f"{page.name})" in each.read_text(encoding="utf-8") for each in lists)


def test_the_readme_is_short():
    readme = (ROOT / "README.md").read_text(encoding="utf-8")

    assert len(readme.splitlines()) <= README_LINES


def test_commands_in_the_documents_exist_and_all_are_shown():
    shown = {"solvers": set(), "blender": set()}
    for document in DOCUMENTS:
        text = document.read_text(encoding="utf-8")
        shown["solvers"] |= set(re.findall(r"python -m solvers ([\w-]+)", text))
        shown["blender"] |= set(re.findall(r"--command mocap_assist ([a-z]\w*)", text))

    assert shown["solvers"] == set(VERBS)
    assert shown["blender"] == blender_verbs() | {
        "import",
        "capture",
        "index",
        "each",
        "report",
    }


def blender_verbs() -> set[str]:
    """The verbs of `blender --command`, read from the source, since Blender may be absent."""
    source = (ROOT / "mocap_assist" / "batch" / "verbs.py").read_text(encoding="utf-8")
    table = next(
        statement.value
        for statement in ast.parse(source).body
        if isinstance(statement, ast.Assign) and statement.targets[0].id == "VERBS"
    )
    return {key.value for key in table.keys}


def test_options_in_the_documents_exist(capsys):
    for document in DOCUMENTS:
        text = document.read_text(encoding="utf-8")
        for verb, words in COMMAND.findall(text):
            with pytest.raises(SystemExit):
                run(VERBS, [verb, "--help"], "solvers")
            options = set(re.findall(r"--[a-z-]+", capsys.readouterr().out))
            shown = set(re.findall(r"--[a-z-]+", words.partition("#")[0]))
            assert shown <= options, f"{name_of(document)}: {verb} {words}"


def test_benchmarks_start_as_the_documents_write_it():
    texts = (document.read_text(encoding="utf-8") for document in DOCUMENTS)
    named = {name for text in texts for name in re.findall(r"-m (tests\.[\w.]+)", text)}
    code = "import importlib, sys; [*map(importlib.import_module, sys.argv[1:])]"
    environment = {name: text for name, text in os.environ.items() if name != "PYTHONPATH"}

    started = subprocess.run(
        [sys.executable, "-c", code, *sorted(named)], cwd=ROOT, env=environment,
        capture_output=True, text=True, check=False, timeout=500,
    )  # fmt: skip

    assert "tests.benchmarks.farm.bench_farm" in named
    assert started.returncode == 0, started.stderr


def test_messages_do_not_point_to_pages_that_the_zip_lacks():
    """Docstrings may name a page of docs: who reads them has the repository."""
    named = [
        f"{path.relative_to(ROOT)}:{node.lineno}"
        for folder in ("mocap_assist", "operators", "solvers")
        for path in sorted((ROOT / folder).rglob("*.py"))
        for node in messages_of(ast.parse(path.read_text(encoding="utf-8")))
        if "docs/" in node.value
    ]

    assert not named


def messages_of(tree: ast.Module) -> list[ast.Constant]:
    """Return all strings of a module that are values, not statements such as docstrings."""
    nodes = list(ast.walk(tree))
    docstrings = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    return [
        node
        for node in nodes
        if isinstance(node, ast.Constant)
        and isinstance(node.value, str)
        and id(node) not in docstrings
    ]
