"""What each gene of a run changes."""

import numpy as np

from locomotion.gaits.run.layout import parameter_slices
from locomotion.training.gaits.run_genes import (
    BLOCKS,
    SIZE,
    first_state_reference,
    genes_scale,
    inner_scale,
    rows_scale,
    skill_of,
)


def test_rows_of_their_own_begin_as_their_neighbours_and_are_learned_without_slopes() -> None:
    genes = np.random.default_rng(0).normal(size=len(BLOCKS) * SIZE)
    genes[3 * SIZE :] = 0.0
    before = skill_of(genes, first_state_reference())
    rows = dict(zip(before.knots, before.table, strict=True))
    for row, neighbour in ((1.2, 2.5), (2.0, 2.5), (4.5, 4.0), (5.0, 4.0)):
        np.testing.assert_array_equal(rows[row], rows[neighbour])
    part = parameter_slices()
    beyond: dict[str, list[float]] = {
        "slow": [1.2, 2.0],
        "slowest": [1.2],
        "faster": [4.5, 5.0],
        "fastest": [5.0],
        "fast": [4.0],
    }
    for name, moved in beyond.items():
        after = skill_of(genes + rows_scale(**{name: 1.0}), first_state_reference()).table
        changed = (after[:, part["m_ap"]] != before.table[:, part["m_ap"]]).all(axis=1)
        assert list(before.knots[changed]) == moved
        np.testing.assert_array_equal(after[~changed], before.table[~changed])
        np.testing.assert_array_equal(after[:, part["climb"]], before.table[:, part["climb"]])


def test_rows_in_the_middle_change_alike_and_leave_the_others_as_they_are() -> None:
    genes = np.random.default_rng(0).normal(size=len(BLOCKS) * SIZE)
    before = skill_of(genes, first_state_reference())
    after = skill_of(genes + inner_scale("m_ap"), first_state_reference()).table
    moved = np.zeros_like(after)
    moved[:, parameter_slices()["m_ap"]] = np.reshape([0, 0, 0.4, 1, 1, 1, 0.4, 0], (-1, 1))
    np.testing.assert_allclose(after, before.table + moved, atol=1e-12)


def test_what_a_stage_does_not_feel_stays_as_it_is() -> None:
    """Genes that make no difference would wander off."""
    free = genes_scale(1.0, 0.5, 2.0, "posture", "turn").reshape(len(BLOCKS), SIZE) > 0.0
    part = parameter_slices()
    for block, names in ((0, ("posture", "turn")), (1, ("posture", "turn")), (2, ("turn",))):
        assert free[block].sum() == sum(free[block, part[name]].sum() for name in names)
        assert all(free[block, part[name]].all() for name in names)
    assert not free[3:].any()
