"""Entities of others as bytes, told in the frame of a level at `ORIGIN`."""

import numpy as np

from runtime.dis.appearance import Appearance
from runtime.dis.dead_reckoning import MODELS
from runtime.dis.entity_state import make_records
from runtime.dis.enumerations import LifeForm
from runtime.dis.geodesy import LevelFrame, yaw_rotations
from runtime.dis.timestamps import timestamp

ORIGIN = (48.137, 11.575, 520.0)
SENDER = ("127.0.0.1", 3001)
FRAME = LevelFrame(ORIGIN)


def entity(
    place,
    velocity=(0.0, 0.0, 0.0),
    yaw=0.0,
    stamp=0.0,
    number=1,
    form=LifeForm.STANDING,
    model="FPW",
    **fields,
):
    """The bytes of an entity of site 9, application 8; ``fields`` as of `ENTITY_STATE` or `Appearance`."""
    record = make_records(1)
    record["site"], record["application"], record["entity"] = 9, 8, number
    record["type"]["kind"], record["type"]["domain"], record["type"]["category"] = 3, 1, 130
    record["location"] = FRAME.to_geocentric(np.array([place], float))
    record["velocity"] = FRAME.vectors_to_geocentric(np.array([velocity], float))
    record["orientation"] = FRAME.orientations(yaw_rotations(np.array([yaw])))
    record["algorithm"] = MODELS.index(model)
    record["timestamp"] = timestamp(stamp, False)
    looks = {name: fields.pop(name) for name in tuple(fields) if name in Appearance.__dataclass_fields__}
    record["appearance"] = Appearance(form, **looks).bits
    for name, value in fields.items():
        if name == "kind":
            record["type"]["kind"] = value
        else:
            record[name] = value  # a number for all of a vector
    return record[0].tobytes()
