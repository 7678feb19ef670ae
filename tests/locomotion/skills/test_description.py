"""Skills of one's own: what a description may say, that one is learned and used, and what is refused."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml

import navmesh
from locomotion import Human, LocomotionError, ObstacleAhead, load_run_skill
from locomotion.skills.description import load_described, load_description
from locomotion.skills.interface import skill_for, skill_ranges
from locomotion.skills.jump.skill import run_digest
from locomotion.skills.leap.kind import LEAP_DESCRIPTION
from locomotion.skills.library import learned_skills, skills_digest
from locomotion.skills.skill_file import SkillFamily
from locomotion.training.skills import jump
from locomotion.training.skills.jump import train_described
from locomotion.training.skills.jump_trial import JumpSimulator
from locomotion.training.training import Training
from runtime import World
from runtime.errors import RuntimeInputError
from runtime.evaluation.courses import make_course, run_course


@pytest.fixture
def own(tmp_path):
    """A folder with a description of one's own: the leap's, over less."""
    values = yaml.safe_load(LEAP_DESCRIPTION.read_text())
    description = load_description(LEAP_DESCRIPTION)
    shutil.copy(description.clip, tmp_path / "clip.yaml")
    shutil.copy(description.learned, tmp_path / "hop.npz")

    def write(**changes):
        said = {**values, "clip": "clip.yaml", "learned": "hop.npz", **changes}
        path = tmp_path / "hop.yaml"
        path.write_text(yaml.safe_dump({key: value for key, value in said.items() if value is not None}))
        return path

    return write


def obstacle(affordance, height, depth=0.0):
    return ObstacleAhead(5.0, affordance, height, np.zeros(3), np.array([-1.0, 0.0, 0.0]), depth)


def test_a_gap_is_measured_by_its_width():
    skill = skill_for(learned_skills(load_run_skill()), obstacle("gap", 0.1, 0.8))
    assert skill is not None and skill.affordance == "gap"
    assert skill_for([skill], obstacle("gap", 0.8, 9.0)) is None
    assert obstacle("jump", 0.4, 9.0).size == 0.4


def test_what_a_description_leaves_out_is_as_of_a_jump(own):
    gone = dict.fromkeys(("least", "entry", "marks", "pace", "share", "objective"))
    description = load_description(own(**gone))
    assert (description.least, description.entry, description.marks) == (None, 3.3, (1.95, 0.95))
    assert description.objective == {} and description.clip.is_file()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"heights": [1.0]}, "heights: unknown key; valid: name, affordance, sizes"),
        ({"name": "Big Leap"}, "name: "),
        ({"affordance": "vault"}, "affordance: .*'jump', 'drop' or 'gap'"),
        ({"sizes": [1.0, 0.8]}, "sizes: .*must increase"),
        ({"sizes": []}, "sizes: "),
        ({"sizes": [float("nan")]}, "sizes"),
        ({"least": 3.0}, "least: 3 m is above the first of the sizes, 1 m"),
        ({"share": 1.5}, "share: "),
        ({"clip": None}, "clip: "),
        ({"learned": "clip.yaml"}, "learned: 'clip.yaml' is the clip"),
        ({"learned": "../{folder}/hop.yaml"}, "learned: '.*hop.yaml' is this file"),
    ],
)
def test_a_bad_description_is_refused_by_key(own, tmp_path, changes, message):
    if "learned" in changes:
        changes = {"learned": changes["learned"].format(folder=tmp_path.name)}
    path = own(**changes)
    with pytest.raises(LocomotionError, match=rf"hop\.yaml:\d+:\d+: .*{message}"):
        load_description(path)


@pytest.mark.parametrize("content", ["- 1", "a: [", "", "\x00"])
def test_what_is_no_description_is_refused(tmp_path, content):
    path = tmp_path / "bad.yaml"
    path.write_text(content)
    with pytest.raises(LocomotionError, match=r"bad\.yaml"):
        load_description(path)


def test_files_that_are_missing_or_of_another_skill_are_named(own, tmp_path):
    run = load_run_skill()
    with pytest.raises(LocomotionError, match=r"no\.npz"):
        load_described(own(learned="no.npz"), run)
    with pytest.raises(LocomotionError, match=r"no\.yaml"):
        load_described(own(clip="no.yaml"), run)
    with pytest.raises(LocomotionError, match="skill"):
        load_described(own(name="hop"), run)  # the file says that it is of the leap
    with pytest.raises(LocomotionError, match=r"missing\.yaml"):
        load_described(tmp_path / "missing.yaml", run)


def test_an_unknown_term_of_the_objective_is_refused_before_learning(own, tmp_path):
    with pytest.raises(LocomotionError, match="objective: 'style': valid terms: time, cleared"):
        train_described(own(objective={"style": 1.0}), Training(), tmp_path / "out.npz")
    assert not (tmp_path / "out.npz").exists()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"learned": "missing/hop.npz"}, "missing/hop.npz: no folder"),
        ({"sizes": [2.3, 2.5], "least": None}, "hop.yaml: sizes: .*nothing is learned from 1.82 to 2.28 m"),
        ({"affordance": "drop"}, "hop.yaml: sizes: .*nothing is learned from"),
        ({"entry": 5.5}, "hop.yaml: entry: 5.5 m/s: the run goes from 1.5 to 5 m/s"),
        ({"clip": "no.yaml"}, "no.yaml:1:1: no such file"),
    ],
)
def test_what_would_be_of_no_use_is_refused_before_learning(own, tmp_path, begun, changes, message):
    if changes.get("affordance") == "drop":
        changes = {**changes, "sizes": [0.5, 0.6]}
    with pytest.raises(ValueError, match=message):
        train_described(own(**changes), Training(checkpoint=tmp_path / "kept"))
    assert not (tmp_path / "kept").exists()


class Begun(Exception):
    """Learning would begin now."""


@pytest.fixture
def begun(monkeypatch):
    def begin(*arguments):
        raise Begun

    monkeypatch.setattr(JumpSimulator, "fit_stride", begin)
    return Begun


def test_the_packages_leap_may_come_to_clear_other_gaps(begun, tmp_path, monkeypatch):
    said = load_description(LEAP_DESCRIPTION).model_copy(update={"sizes": [2.3, 2.5], "least": None})
    monkeypatch.setattr("locomotion.training.skills.jump.load_description", lambda path: said)
    with pytest.raises(begun):
        train_described(LEAP_DESCRIPTION, Training(), tmp_path / "out.npz")


def test_a_checkpoint_is_of_what_the_description_and_its_clip_say(own, begun, tmp_path):
    training = Training(checkpoint=tmp_path / "kept")
    for _ in range(2):
        with pytest.raises(begun):
            train_described(own(), training)
    with pytest.raises(begun):  # where things are, and how far down what is learned first serves, is free
        train_described(own(least=0.5, learned="other.npz"), training)
    changes = {
        "objective": {"pose": 3.5}, "affordance": "jump", "sizes": [0.5], "entry": 3.4, "marks": [1.2, 0.25],
        "pace": [1.0, 0.9, 1.0, 1.0], "share": 0.6, "name": "hop",
    }  # fmt: skip
    for key, value in changes.items():
        named = "skill" if key == "name" else key
        with pytest.raises(LocomotionError, match=f"kept: .* differs in {named}[ ,]"):
            train_described(own(**{"least": 0.4, key: value}), training)
    clip = tmp_path / "clip.yaml"
    clip.write_text(f"# a remark\n{clip.read_text()}")
    with pytest.raises(begun):
        train_described(own(), training)
    values = yaml.safe_load(clip.read_text())
    next(iter(values["channels"].values()))[0][1] += 1.0
    clip.write_text(yaml.safe_dump(values))
    with pytest.raises(LocomotionError, match=r"kept: .* differs in clip .*remove .*kept to start over"):
        train_described(own(), training)


def test_descriptions_of_one_name_in_two_folders_share_no_checkpoint(own, begun, tmp_path):
    training, other = Training(checkpoint=tmp_path / "hop.checkpoint"), tmp_path / "other"
    with pytest.raises(begun):
        train_described(own(), training)
    other.mkdir()
    shutil.copy(tmp_path / "clip.yaml", other)
    shutil.copy(own(share=0.7), other / "hop.yaml")
    with pytest.raises(LocomotionError, match=r"hop\.checkpoint: .* differs in share "):
        train_described(other / "hop.yaml", training)


def shifted(own, tmp_path, heights):
    """One's own leap over other widths, by the same laws."""
    family = load_described(own(), load_run_skill())._family
    SkillFamily(
        "leap skill", np.array(heights), family.table[: len(heights)], family.references[: len(heights)],
        family.stride, family.run,
    ).save(tmp_path / "hop.npz")  # fmt: skip
    return own()


def test_ranges_of_skills_for_the_same_join_or_are_refused(own, tmp_path):
    run = load_run_skill()
    most = skill_ranges(learned_skills(run))["gap"][1]
    joined = learned_skills(run, [shifted(own, tmp_path, (most - 0.1, most + 0.4))])
    assert skill_ranges(joined)["gap"][1] == pytest.approx(most + 0.42)
    assert skill_for(joined, obstacle("gap", 0.0, most - 0.05)) is joined[0]  # one's own comes first
    with pytest.raises(LocomotionError, match="skills for 'gap': nothing is learned from"):
        learned_skills(run, [shifted(own, tmp_path, (most + 0.5, most + 0.6))])


@pytest.fixture(scope="module")
def learned(tmp_path_factory):
    """A hop over a narrow gap, learned with hardly any effort: in each stage one generation of six, judged in
    two trials."""
    folder = tmp_path_factory.mktemp("own")
    shutil.copy(load_description(LEAP_DESCRIPTION).clip, folder / "clip.yaml")
    path = folder / "hop.yaml"
    path.write_text(
        "{name: hop, affordance: gap, sizes: [0.6], least: 0.4, entry: 3.5, clip: clip.yaml,"
        " marks: [1.3, 0.25], pace: [1, 0.8, 1, 1], share: 0.5, learned: hop.npz}"
    )

    def small(training, name, count, sigma, feedback, population, options):
        return whole(training, name, count, sigma, feedback, 6, {**options, "states": 2})

    whole = jump._stage
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(jump, "_stage", small)
        train_described(path, Training(workers=1, effort=0.01, on_progress=lambda progress: None))
    return path


def test_a_skill_of_ones_own_is_learned_and_used(learned):
    run = load_run_skill()
    skill = load_described(learned, run)
    assert skill.affordance == "gap" and skill.heights == (0.4, 0.6)
    held = 0
    for distance in (11.0, 13.0, 15.5, 18.0):
        course = make_course([("gap", 0.5, 0.0)], [distance])
        held += run_course(course, [skill]).ended == "arrived"
    assert held >= 3


def test_what_was_learned_is_of_what_the_description_and_its_clip_said(learned, tmp_path):
    run = load_run_skill()
    for each in ("hop.yaml", "hop.npz", "clip.yaml"):
        shutil.copy(learned.parent / each, tmp_path)
    path, clip = tmp_path / "hop.yaml", tmp_path / "clip.yaml"
    said, played = path.read_text(), clip.read_text()
    path.write_text(said.replace("share: 0.5", "share: 50.0e-2"))
    clip.write_text(f"# a remark\n{played}")
    assert load_described(path, run).heights == (0.4, 0.6)
    path.write_text(said.replace("share: 0.5", "share: 0.6").replace("entry: 3.5", "entry: 3.4"))
    with pytest.raises(LocomotionError, match=r"hop\.npz: learned when .*hop\.yaml said .*\(entry, share\)"):
        load_described(path, run)
    path.write_text(said)
    values = yaml.safe_load(played)
    next(iter(values["channels"].values()))[0][1] += 1.0
    clip.write_text(yaml.safe_dump(values))
    with pytest.raises(LocomotionError, match=r"\(clip\); learn it anew \(surefoot train .*hop\.yaml\)"):
        load_described(path, run)


def test_what_was_learned_on_another_run_is_refused(own):
    run = load_run_skill()
    table = run.table.copy()
    table[:, 0] += 1e-3
    with pytest.raises(
        LocomotionError, match=r"hop\.npz: learned on another run .*surefoot train .*hop\.yaml"
    ):
        load_described(own(), replace(run, table=table))


def test_what_processors_round_differently_is_no_other_run():
    run = load_run_skill()
    noise = np.random.default_rng(0).uniform(-1e-12, 1e-12, run.table.shape)
    assert run_digest(replace(run, table=run.table + noise)) == run_digest(run)


def test_a_world_gives_its_people_the_skills(learned):
    course = make_course([("gap", 0.5, 0.0)], [10.0])
    terrain = navmesh.Terrain.from_arrays(course.vertices, course.faces)
    world = World(terrain, skills=[learned])
    agent = world.spawn("human", (0.0, 0.0, 0.0))
    hop = agent.driver.human.clearing[0]
    assert (hop.affordance, hop.heights) == ("gap", (0.4, 0.6))
    with pytest.raises(
        RuntimeInputError, match=r"with other skills of their own, who .* in a world of the same skills="
    ):
        World(terrain).restore(world.save())
    twin = World(terrain, skills=[learned])
    twin.restore(world.save())
    assert twin.state_hash() == world.state_hash()
    with pytest.raises(RuntimeInputError, match=r"nowhere\.yaml"):
        World(terrain, skills=[Path("nowhere.yaml")])


def test_a_world_counts_what_ones_own_skills_clear_among_the_obstacles(own, tmp_path):
    most = skill_ranges(learned_skills(load_run_skill()))["gap"][1]
    course = make_course([("gap", 2.8, 0.0)], [12.0])
    terrain = navmesh.Terrain.from_arrays(course.vertices, course.faces)
    end = course.path[-1]
    for skills, found in (((), "blocked"), ((shifted(own, tmp_path, (most - 0.1, 3.0)),), "walking")):
        agent = World(terrain, skills=skills).spawn("human", course.path[0])
        assert agent.go_to(end) == found


def test_the_digest_tells_skills_of_ones_own(learned):
    assert skills_digest((learned,)) != skills_digest()


def test_the_package_leaps_over_gaps():
    low, high = skill_ranges(Human().clearing)["gap"]
    arrived = 0
    starts = (low + 0.02, 11.3), (high - 0.02, 18.2)
    for width, distance in starts:
        run = run_course(make_course([("gap", width, 0.0)], [distance]))
        arrived += run.ended == "arrived" and run.reports[0].cleared
    assert arrived == len(starts)


def test_the_digest_is_that_of_the_files_as_they_are_now(own):
    path = own()
    before = skills_digest((path,))
    assert skills_digest((path,)) == before
    learned = path.parent / "hop.npz"
    learned.write_bytes(learned.read_bytes() + b"learned anew")
    assert skills_digest((path,)) != before
