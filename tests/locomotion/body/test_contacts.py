"""The contacts of a body are MuJoCo's, and never contiguous."""

import mujoco
import numpy as np
import pytest

from locomotion.body.contacts import contacts_of


def resting(balls):
    """So many balls that lie on a floor."""
    bodies = "".join(
        f'<body pos="{i} 0 0.099"><freejoint/><geom type="sphere" size="0.1"/></body>' for i in range(balls)
    )
    floor = '<geom type="plane" size="9 9 1"/>'
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{floor}{bodies}</worldbody></mujoco>")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return data


@pytest.mark.parametrize("balls", [0, 1, 2, 5])
def test_contacts_are_those_of_the_body(balls):
    data = resting(balls)
    pairs, addresses = contacts_of(data)
    assert data.ncon == balls
    assert np.array_equal(pairs[:balls], data.contact.geom)
    assert np.array_equal(addresses[:balls], data.contact.efc_address)
    for array in (pairs, addresses):
        assert array.dtype == np.int32 and not array.flags.c_contiguous and not array.flags.f_contiguous
