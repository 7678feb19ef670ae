"""What a motion does wrong is found where it happens."""

import numpy as np
import pytest

from locomotion.body.person import JOINT_NAMES
from locomotion.clips.motion import Motion, lowest_points
from locomotion.clips.motion_check import check_motion


def still(seconds=0.5, rate=60.0):
    qpos = np.zeros((round(seconds * rate) + 1, 46))
    qpos[:, 3] = 1.0
    qpos[:, 2] -= lowest_points(qpos[:1])[0]
    return qpos, rate


def test_a_still_stand_has_no_fault_and_faults_are_found_where_they_are():
    qpos, rate = still()
    assert check_motion(Motion("stand", rate, qpos)) == []
    knee = 7 + JOINT_NAMES.index("left_knee_flexion")
    bent = qpos.copy()
    bent[6:13, knee] = np.radians(-12.0)
    (fault,) = check_motion(Motion("bent", rate, bent))
    assert (fault.kind, fault.joint) == ("joint", "left_knee_flexion")
    assert (fault.begin, fault.end) == (pytest.approx(0.1), pytest.approx(0.2))
    assert fault.worst == pytest.approx(10.0, abs=0.1)
    for lift, kind in ((0.2, "floats"), (-0.2, "sinks")):
        moved = qpos + np.eye(1, 46, 2)[0] * lift
        (fault,) = check_motion(Motion("moved", rate, moved))
        assert fault.kind == kind and fault.worst == pytest.approx(0.2) and kind in str(fault)


def test_a_body_in_free_fall_does_not_float():
    qpos, rate = still(0.6)
    time = np.arange(len(qpos)) / rate
    qpos[:, 2] += 3.0 * time - 0.5 * 9.81 * time**2 + 0.0
    faults = check_motion(Motion("jump", rate, qpos))
    assert [fault for fault in faults if fault.kind == "floats"] == []
