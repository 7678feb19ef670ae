"""A report with one of everything."""

from runtime.playtest.fault import Fault, Sighting
from runtime.playtest.observation import Crossing, Journey
from runtime.playtest.report import Report, Setup

AT = (1.0, 2.0, 0.0)
REPORT = Report(
    setup=Setup("level.obj", "z", 1.0, None, "human", 4, 10.0, 7),
    digest="ab",
    character={"radius": 0.3},
    faults=(Fault("stuck", AT, "a corner", True, "bots", 1.0, (Sighting(1, 2.0, AT),)),),
    crossings=(Crossing("jump@1", "jump", 0.4, AT, 3, 2),),
    journeys=(Journey("west", "east", 2, 1, 3.0, 4.0),),
    coverage=((1.0, 0.5),),
    patches=((*AT, 3),),
    reachable=60.0,
)
