"""The pages of the documentation: links lead somewhere, code runs, commands exist, files are as described."""

import re
import shlex
from dataclasses import fields
from functools import cache
from pathlib import Path
from pkgutil import resolve_name

import pytest
import typer
import typer.testing
import yaml

import navmesh
import runtime
from locomotion.human.state import BUSY, CLEARING
from locomotion.skills.description import load_description
from runtime.cli.app import app, main
from runtime.planning.rules import person_walk_rules
from runtime.playtest.plan import LoadedPlan
from runtime.playtest.suite.plan import cells_of, read_suite
from tests.docs import pages
from tests.docs.pages import PAGES, ROOT, Block, name

CODE = [block for page in PAGES for block in pages.blocks(page, "python")]
DATA = [block for page in PAGES for block in pages.blocks(page, "yaml")]
FOLDERS = ("navmesh", "pathsmooth", "locomotion", "runtime", "surefoot", "benchmarks", "examples", "tests")
MENTIONED = r"\bdocs/[\w/.-]+\.(?:md|json)\b"
every_page = pytest.mark.parametrize("page", PAGES, ids=name)


@pytest.mark.parametrize("page", [*PAGES, ROOT / "CHANGELOG.md"], ids=name)
def test_links_lead_somewhere(page: Path) -> None:
    for link in pages.links(page):
        target, _, anchor = link.partition("#")
        if "://" in target:
            continue
        found = (page.parent / target).resolve() if target else page
        assert found.exists(), f"{name(page)} links to {target}"
        if anchor:
            known = sorted(pages.anchors(found))
            assert anchor in known, f"{name(page)} links to {link}; headings there: {', '.join(known)}"


def test_every_page_has_its_place_in_the_order() -> None:
    order = yaml.safe_load((ROOT / "docs" / "_toc.yml").read_text())
    listed = [order["root"], *(entry["file"] for part in order["subtrees"] for entry in part["entries"])]
    written = [name(page) for page in PAGES if page.is_relative_to(ROOT / "docs")]
    assert sorted(f"docs/{each}.md" for each in listed if "/generated/" not in each) == sorted(written)


def test_every_page_is_linked_from_the_index() -> None:
    index = ROOT / "docs" / "index.md"
    linked = {(index.parent / link.partition("#")[0]).resolve() for link in pages.links(index)}
    assert {page for page in PAGES if page.is_relative_to(ROOT / "docs")} - {index} <= linked


@every_page
def test_what_is_named_exists(page: Path) -> None:
    for span in pages.spans(page):
        if re.fullmatch(r"[\w/]+\.py", span):
            assert any(file.endswith(f"/{span}") for file in _code()), f"{name(page)} names {span}"
        elif re.fullmatch(rf"({'|'.join(FOLDERS)})/[\w/.]+", span):
            assert (ROOT / span).exists(), f"{name(page)} names {span}"
        elif re.fullmatch(rf"({'|'.join(FOLDERS)})(\.\w+)+", span):
            resolve_name(span)


@cache
def _code() -> list[str]:
    return [f"/{name(file)}" for folder in FOLDERS for file in (ROOT / folder).rglob("*.py")]


def test_pages_that_code_and_changelog_name_exist() -> None:
    for mentioned in re.findall(MENTIONED, (ROOT / "CHANGELOG.md").read_text()):
        assert (ROOT / mentioned).exists(), f"CHANGELOG.md names {mentioned}"
    for folder in FOLDERS:
        for file in (*(ROOT / folder).rglob("*.py"), *(ROOT / folder).rglob("*.yaml")):
            for mentioned in re.findall(MENTIONED, file.read_text()):
                assert (ROOT / mentioned).exists(), f"{name(file)} names {mentioned}"


@every_page
def test_code_says_what_language_it_is_in(page: Path) -> None:
    for text in pages.without_language(page):
        with pytest.raises(SyntaxError):  # a drawing, a message or an order of data, but no Python
            compile(text, str(page), "exec")


@pytest.mark.parametrize("block", CODE, ids=str)
def test_code_runs(block: Block, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> None:
    code = compile(block.text, str(block), "exec")
    if block.note == "fragment":
        return
    monkeypatch.chdir(ROOT)
    names: dict[str, object] = {}
    exec(code, names)
    for word, value in tuple(names.items()):
        if word.startswith("test_") and callable(value):
            monkeypatch.chdir(ROOT / "examples")
            value(request.getfixturevalue("playtest"))


@pytest.mark.parametrize("block", DATA, ids=str)
def test_yaml_is_what_it_is_said_to_be(
    block: Block, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    content = yaml.safe_load(block.text)
    if block.note == "fragment":
        return
    (tmp_path / "levels").symlink_to(ROOT / "examples" / "levels")
    file = tmp_path / "missions" / "page.yaml"
    file.parent.mkdir()
    file.write_text(block.text)
    if "agents" in content:
        with pytest.raises(SystemExit) as left:
            main(["check", str(file)])
        assert left.value.code == 0, capsys.readouterr().err
    elif "spawns" in content:
        assert len(LoadedPlan.read(file).plan.spawns) == len(content["spawns"])
    elif "seeds" in content:
        assert len(cells_of(read_suite(file), file)) > 1
    elif "affordance" in content:
        assert load_description(file).name == content["name"]
    else:  # the author's tags of the courtyard
        courtyard = navmesh.Terrain.load(tmp_path / "levels" / "courtyard.obj", up="z")
        navmesh.NodeGraph.build(courtyard, person_walk_rules(), tags=navmesh.load_tags(file))


@every_page
def test_commands_exist(page: Path) -> None:
    for line in pages.typed(page):
        if line.startswith("surefoot "):
            _parse(line, whole=True)
    for span in (*pages.spans(page), *pages.typed(page)):
        if span.startswith("surefoot ") and "COMMAND" not in span:
            _parse(span, whole=False)
        elif span.startswith("python -m benchmarks."):
            _exists(span)
        elif span.startswith("python examples/"):
            assert (ROOT / span.split()[1]).exists(), span


def _parse(line: str, whole: bool) -> None:
    """Refuse a command that there is not, an option that it does not have and, of a ``whole`` line, a value
    that it would not take."""
    words = shlex.split(line)[1:]
    commands = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    if words[0].startswith("--"):
        assert words[0] in ("--help", "--version"), line
        return
    assert words[0] in commands, line
    command = commands[words[0]]
    known = {option for parameter in command.params for option in parameter.opts} | {"--help"}
    for word in words:
        assert not re.match(r"--?[a-z]", word) or word in known, f"{word} of: {line}"
    for word in words:
        assert not word.startswith("examples/") or (ROOT / word).exists(), line
    if whole:
        command.make_context(words[0], words[1:])


def _exists(line: str) -> None:
    """Refuse a benchmark that there is not, and an option that does not stand in it."""
    words = shlex.split(line)
    file = ROOT / (words[2].replace(".", "/") + ".py")
    assert file.exists(), line
    text = file.read_text()
    if "add_place(parser)" in text:
        text += (ROOT / "benchmarks" / "workers.py").read_text()
    for word in words[3:]:
        assert not word.startswith("--") or f'"{word}"' in text, f"{word} of: {line}"


def test_the_page_of_events_has_all_of_them_with_their_fields() -> None:
    rows = _rows(ROOT / "docs" / "reference" / "events.md")
    kinds = [getattr(runtime, word) for word in runtime.__all__ if _is_event(getattr(runtime, word))]
    assert len(kinds) >= 11
    common = {field.name for field in fields(runtime.Event)}
    for kind in kinds:
        own = {field.name for field in fields(kind)} - common
        assert set(re.findall(r"`(\w+)`", rows[kind.__name__][0])) == own, kind.__name__


def test_the_page_of_events_has_all_statuses() -> None:
    page = (ROOT / "docs" / "reference" / "events.md").read_text().partition("## Statuses")[2]
    first_cells = " ".join(line.split("|")[1] for line in page.splitlines() if line.startswith("| `"))
    assert set(re.findall(r"`([a-z ]+)`", first_cells)) == {*BUSY, *CLEARING.values(), "blocked", "waiting"}


def _is_event(value: object) -> bool:
    return isinstance(value, type) and issubclass(value, runtime.Event) and value is not runtime.Event


def _rows(page: Path) -> dict[str, list[str]]:
    """The rows of the page's tables: the other cells by the code in the first."""
    rows = [line.strip("| ").split(" | ") for line in page.read_text().splitlines() if line.startswith("| `")]
    return {first.strip("`"): rest for first, *rest in rows}
