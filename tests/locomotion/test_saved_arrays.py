"""What a saved array may hold, slot by slot."""

import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.saved_arrays import COUNT, FARTHEST, FLAG, SIDE, Slots, check_array, check_number

STEPS, SHARE, FOOT, HELD, TIMES, FREE = 0, 1, 2, 3, slice(4, 6), 6
SLOTS = Slots(
    "the memory of a walk", 7,
    ranges=((STEPS, COUNT), (SHARE, (0.25, 0.75)), (FOOT, SIDE), (HELD, FLAG), (TIMES, (0.0, 10.0))),
    whole=(STEPS, FOOT, HELD), open_ended=(TIMES,),
)  # fmt: skip
RIGHT = np.array([12.0, 0.5, -1.0, 1.0, 3.0, 4.0, -7.5])


def changed(slot, value):
    values = RIGHT.copy()
    values[slot] = value
    return values


@pytest.mark.parametrize(
    ("slot", "value"),
    [(STEPS, 0.0), (SHARE, 0.25), (SHARE, 0.75), (FOOT, 1.0), (TIMES, np.inf), (TIMES, np.nan),
     (FREE, FARTHEST)],
)  # fmt: skip
def test_ends_of_a_range_belong_to_it_and_open_ended_slots_take_anything(slot, value):
    SLOTS.check(changed(slot, value))


@pytest.mark.parametrize(
    ("slot", "value", "says"),
    [
        (STEPS, -1.0, "number 0 is -1, expected a whole number from 0 to 1e+09"),
        (STEPS, 2.5, "number 0 is 2.5, expected a whole number"),
        (SHARE, 0.8, "number 1 is 0.8, expected a number from 0.25 to 0.75"),
        (SHARE, np.nan, "number 1 is nan, expected a number from 0.25 to 0.75"),
        (FOOT, 0.5, "number 2 is 0.5, expected a whole number from -1 to 1"),
        (HELD, 2.0, "number 3 is 2, expected a whole number from 0 to 1"),
        (FREE, np.inf, "number 6 is inf, expected a number from -1e+09 to 1e+09"),
        (FREE, np.nan, "number 6 is nan"),
    ],
)
def test_a_number_out_of_its_range_is_named_by_its_place(slot, value, says):
    with pytest.raises(LocomotionError) as told:
        SLOTS.check(changed(slot, value))
    assert str(told.value).startswith(f"the memory of a walk: {says}")


@pytest.mark.parametrize("values", [RIGHT[:-1], RIGHT[None], RIGHT.astype(np.float32)])
def test_an_array_of_another_shape_or_type_is_refused(values):
    with pytest.raises(LocomotionError, match=r"a walk is an array of shape .*, expected \(7,\) float64"):
        SLOTS.check(values)


def test_a_number_is_checked_with_its_name():
    check_number("time", 0.0, 0.0, 5.0)
    check_number("time", -FARTHEST)
    for value in (-0.1, 5.1, np.nan):
        with pytest.raises(LocomotionError, match=r"time is .*, expected 0 to 5"):
            check_number("time", value, 0.0, 5.0)


def test_arrays_of_any_length_have_finite_rows_of_one_shape():
    check_array("path", np.zeros((4, 3)), None, 3)
    check_array("path", np.zeros((0, 3)), None, 3)
    check_array("goal", np.full(3, FARTHEST), 3)
    for values in (np.zeros((4, 2)), np.zeros(3)):
        with pytest.raises(LocomotionError, match=r"path is .* shape .*, expected \(n, 3\) float64$"):
            check_array("path", values, None, 3)
    with pytest.raises(LocomotionError, match=r"type float32, expected \(n, 3\) float64"):
        check_array("path", np.zeros((4, 3), np.float32), None, 3)
    with pytest.raises(LocomotionError, match=r"expected \(n, 3\) float64 with n from 2 on"):
        check_array("path", np.zeros((1, 3)), None, 3, least=2)
    for bad in (np.nan, np.inf, -2.0 * FARTHEST):
        with pytest.raises(LocomotionError, match="path holds numbers that are not finite, or too great"):
            check_array("path", np.array([[0.0, bad, 0.0]]), None, 3)
