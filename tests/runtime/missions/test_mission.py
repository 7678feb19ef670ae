"""Mission files: what is accepted, and how the rest is refused."""

import re

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from runtime.missions.mission import load_mission
from surefoot.files.yamlfile import FileError
from tests.small_level import MISSION

PLACE = re.compile(r"^[^\n]*mission\.yaml:\d+:\d+: [^\n]+$")


def refused(folder, text):
    """The message with which a mission is refused."""
    (folder / "mission.yaml").write_text(text)
    with pytest.raises(FileError) as caught:
        load_mission(folder / "mission.yaml")
    assert PLACE.match(str(caught.value))
    return str(caught.value)


def test_reads_a_mission(folder):
    loaded = load_mission(folder / "mission.yaml")
    assert loaded.level_path == folder / "level.obj"
    (agent,) = loaded.mission.agents
    assert (agent.name, agent.speed, agent.goto) == ("ada", 3.0, [[9, 3, 0]])
    assert agent.expect.uses_skills is None


@pytest.mark.parametrize(
    ("old", "new", "line", "column", "says"),
    [
        ("seed: 3", "sede: 3", 4, 1, "did you mean 'seed'? valid: level, rules, seed"),
        ("speed: 3.0", "speed: fast", 11, 12, "agents[0].speed: Input should be a valid number, not 'fast'"),
        ("speed: 3.0", "speed: 99", 11, 12, "less than or equal to 6"),
        ("speed: 3.0", "speed: true", 11, 12, "valid number"),
        ("body: human", "body: goose", 8, 11, "'cat' or 'horse', not 'goose'"),
        ("up: z", "up: w", 3, 7, "'x', 'y' or 'z', not 'w'"),
        ("file: level.obj", "file: gone.obj", 2, 9, "no such level"),
        ("  file: level.obj\n", "", 2, 3, "level.file: missing"),
        ("[2, 3, 0]", "[2, 3]", 9, 12, "at least 3 items"),
        ("[2, 3, 0]", "[2, .nan, 0]", 9, 16, "finite"),
        ("[9, 3, 0]", "[9, 3, 1.0e+9]", 13, 16, "within ±1e+06 m"),
        ("seed: 3", "seed: 3\nseed: 4", 5, 1, "'seed' appears twice here"),
        ("seed: 3", "seed: -1", 4, 7, "greater than or equal to 0"),
        ("seed: 3", "seed: 2020-01-01", 4, 7, "timestamp"),
        ("seed: 3", "seed: [", 6, 7, "not YAML"),
    ],
)
def test_names_line_and_column(folder, old, new, line, column, says):
    assert old in MISSION
    message = refused(folder, MISSION.replace(old, new, 1))
    assert f"mission.yaml:{line}:{column}: " in message
    assert says in message


def test_rules_that_contradict_each_other(folder):
    (folder / "mission.yaml").write_text(MISSION.replace("seed: 3", "rules: {max_step: 3.0}"))
    with pytest.raises(FileError, match=r"mission\.yaml:4:8: rules: max_step = 3"):
        load_mission(folder / "mission.yaml").rules()


def test_names_are_unique(folder):
    agents = MISSION[MISSION.index("  - name") :]
    assert "'ada' is taken" in refused(folder, MISSION + agents)


@pytest.mark.parametrize("text", ["", "- 1", "&a [*a]", "[" * 3000, "a: \x00", "? [1]\n: 2", "%", "\t"])
def test_refuses_what_is_no_mission(folder, text):
    refused(folder, text)


def test_missing_mission(folder):
    with pytest.raises(FileError, match="no such file; expected a mission"):
        load_mission(folder / "nowhere.yaml")


def test_aliases_do_not_grow(folder):
    bomb = "a: &a [1,1,1,1,1,1,1,1,1]\n" + "\n".join(
        f"{b}: &{b} [{','.join(['*' + a] * 9)}]" for a, b in zip("abcdefgh", "bcdefghi", strict=True)
    )
    assert "more than 100000 values, counting those repeated by aliases" in refused(folder, bomb)


@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_a_mutated_mission_is_read_or_refused(folder, data):
    text = MISSION
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(text)))
        until = at + data.draw(st.integers(0, 12))
        fill = data.draw(
            st.text("abz[]{}:,-&*!|>'\"#%@`?. \n\t01", max_size=6)
            | st.sampled_from(
                ["null", "~", ".inf", "!!int", "<<: ", "1e999", "0x", "2001-01-01", "*a", "&a "]
            )
            | st.text(max_size=3)
        )
        text = text[:at] + fill + text[until:]
    (folder / "mission.yaml").write_bytes(text.encode("utf-8", "surrogatepass"))
    try:
        load_mission(folder / "mission.yaml").rules()
    except FileError as error:
        assert PLACE.match(str(error))
