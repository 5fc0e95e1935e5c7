"""The documents become HTML: every construct that they use, and a search that finds it."""

import json
import shutil
import subprocess

import markdown
import pytest
import write_manual

SEARCH = """
const vm = require("vm"), fs = require("fs"), [file, ...queries] = process.argv.slice(1);
const context = vm.createContext({});
vm.runInContext(fs.readFileSync(file, "utf8") + "; this.search = search;", context);
console.log(JSON.stringify(queries.map(query => context.search(query).map(one => one.entry))));
"""


@pytest.mark.parametrize(
    ("text", "html"),
    [
        ("# A *b* `c`", '<h1 id="a-b-c">A <em>b</em> <code>c</code></h1>'),
        ("a\nb & <c>", "<p>a\nb &amp; &lt;c&gt;</p>"),
        ("- a\n  b\n- `*c*`", "<ul>\n<li>a\nb</li>\n<li><code>*c*</code></li>\n</ul>"),
        (
            "1. a:\n\n   | b |\n   |---|\n\n2. c",
            '<ol start="1">\n<li>a:</li>\n</ol>\n<table>\n<tr><th>b</th></tr>\n</table>\n'
            '<ol start="2">\n<li>c</li>\n</ol>',
        ),
        (
            "| | a |\n|---|---|\n| `b\\|c` | **d** |",
            "<table>\n<tr><th></th><th>a</th></tr>\n"
            "<tr><td><code>b|c</code></td><td><strong>d</strong></td></tr>\n</table>",
        ),
        ("```sh\na *b* <c>\n\n# d\n```", "<pre><code>a *b* &lt;c&gt;\n\n# d</code></pre>"),
        ("[a *b*](c.md#d) 2 * 3 * 4", '<p><a href="-c.md#d">a <em>b</em></a> 2 * 3 * 4</p>'),
        ("[![a](b.png)](c)", '<p><a href="-c"><img src="-b.png" alt="a"></a></p>'),
        ("<!-- a -->\nb\n<!-- c -->", "<p>b</p>"),
    ],
)
def test_markdown_becomes_html(text, html):
    assert markdown.to_html(text, lambda target: f"-{target}") == f"{html}\n"


def test_link_to_a_file_that_the_zip_lacks_shows_its_text():
    assert markdown.to_html("a [b](c)", lambda target: "") == "<p>a b</p>\n"


def test_sections_have_plain_text():
    text = "# A `b`\n\n| c | [d](e) |\n|---|---|\n\n```sh\n# f\n```\n\n## *G*\n\nh **i**\n"

    assert markdown.sections(text) == [("A b", "a-b", "c d # f"), ("G", "g", "h i")]


@pytest.mark.skipif(shutil.which("node") is None, reason="needs node")
def test_search_finds_the_best_section_first(tmp_path):
    write_manual.main(tmp_path)

    script, queries = str(tmp_path / "search.js"), ["exit codes", "plantigrade zebra", ""]
    done = subprocess.run(
        ["node", "-e", SEARCH, script, *queries],
        capture_output=True, text=True, check=True, timeout=500,
    )  # fmt: skip

    codes, nothing, empty = json.loads(done.stdout)
    assert codes[0][:2] == ["technical/farm.html", "On a farm"]
    assert codes[0][2:4] == ["Exit codes", "exit-codes"]
    assert (nothing, empty) == ([], [])
