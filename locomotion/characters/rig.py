"""The user's own rigged character, showing the motion of our persons."""

import os
import weakref
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from locomotion.body.person import BODY_NAMES
from locomotion.characters.bone_names import bones_of_parts
from locomotion.characters.character_file import Skeleton, read_character
from locomotion.characters.contacts import contacts_with, no_contacts
from locomotion.characters.driven_bones import rig_arrays
from locomotion.characters.footing import Footing, FootingArrays, no_footing
from locomotion.characters.local_poses import local_poses
from locomotion.characters.person_measures import person_arrays
from locomotion.characters.posing import pose_characters
from locomotion.characters.rest_pose import hand_points, rest_pose
from locomotion.characters.whole_person import whole_person
from locomotion.errors import LocomotionError
from locomotion.ground.ground import Ground
from locomotion.postures.held_objects import STOWED

__all__ = ["Rig"]


class Rig:
    """A rigged figure of any proportions that shows what our persons do; made by `Rig.load`.

    Every part of it turns as the person's does; the pelvis stays over the same point of the ground, so that
    the character is where the world says that it is, at a height that fits its legs; feet that carry weight
    are where the person's are, on the same ground. It is as large as its file says.

    Attributes:
        names: of its b bones, parents first: the joints of its skin.
        parents: (b,) int64, -1 for a bone that hangs on none.
        parts: the bone's name for each part of the person.
        rest: (b, 7) float64: its rest pose in the world, at the origin of its file: position [m] and
            quaternion wxyz, Z up.
        hand_points: (2, 3) float64 [m]: the point of the right and of the left hand that touches and holds,
            from the hand's bone, in the axes of the bone.
        skeleton: everything read of it, with its mesh.
    """

    def __init__(self, skeleton: Skeleton, parts: dict[str, int]) -> None:
        self.skeleton = skeleton
        self.names, self.parents, self.rest = skeleton.names, skeleton.parents, skeleton.places
        self.parts = {part: skeleton.names[bone] for part, bone in parts.items()}
        measured = rest_pose(skeleton, parts)
        self._arrays = rig_arrays(skeleton, parts, measured)
        self.hand_points = hand_points(skeleton, parts, measured)
        self._footings: weakref.WeakKeyDictionary[Any, Footing] = weakref.WeakKeyDictionary()

    @classmethod
    def load(
        cls,
        path: str | os.PathLike[str],
        mapping: str | os.PathLike[str] | None = None,
        scale: float = 1.0,
    ) -> "Rig":
        """Read the skinned figure of a glTF 2.0 file (.glb, .gltf). Load-time.

        mapping: which bone shows which part: a YAML file, "mixamo", "vrm", "unreal" or "surefoot", or None to
        go by VRM's own table or by the bones' names. scale: metres per unit of the file, above 0.

        Raises `LocomotionError` for a file that is damaged or has no skin, for parts without a bone, listed
        with the names that were looked for, and for a figure that does not stand upright at rest.
        """
        if not isinstance(scale, int | float) or isinstance(scale, bool) or not 0.0 < scale < 1e9:
            raise LocomotionError(f"scale = {scale!r}: give the metres per unit of the file, such as 0.01")
        skeleton = read_character(path, float(scale))
        return cls(skeleton, bones_of_parts(skeleton, mapping))

    def __repr__(self) -> str:
        return f"<Rig of {len(self.names)} bones from {self.skeleton.path}>"

    def pose(self, agent: Any) -> NDArray[np.float64]:
        """Where the bones are for a person: (b, 7) float64, position [m] and quaternion wxyz in the world,
        Z up.

        A bone has the axes that it has in the file once that is turned Z up: at rest the pose is `rest`. So a
        point p of the mesh, bound to a bone, is at position + turned(scale · inverse bind matrix · p), with
        the bone's ``skeleton.scales``.

        agent: a `runtime.Agent` that is a person, at any level of detail, or whatever has a ``pose`` with
        ``names`` and ``transforms``. Its ``ground``, a `locomotion.Ground` or None, is what its feet stand on
        and its hands touch; its ``held``, such as ("rifle", "deployed"), what both hands hold. If it has a
        ``time`` [s], feet that stand stay where this rig put them for this agent before, as `pose_motion`
        says, unless that is more than 0.25 s ago. Constant-time. Raises `LocomotionError` for other bodies.
        """
        found = agent.pose
        thing, state = getattr(agent, "held", ("", STOWED))
        held, ground = float(thing != "" and state != STOWED), getattr(agent, "ground", None)
        time = getattr(agent, "time", None)
        if time is None:
            return self.pose_from(found.transforms, found.names, ground, grip=held)
        footing = self._footings.setdefault(agent, Footing())
        return self.pose_motion(found.transforms[None], [time], found.names, ground, held, footing)[0]

    def local_pose(self, agent: Any) -> NDArray[np.float64]:
        """The same relative to the bones' parents, as engines take it: (b, 7) float64, the translation in the
        file's own units and the rotation wxyz of each bone's node, in the file's axes.

        Of a bone that hangs on none it is relative to the node above it at rest. With these, the scene of the
        file shows the character where it is in the world turned Y up, (x, z, -y). The scales of nodes stay as
        they are in the file.
        """
        return self.local(self.pose(agent))

    def pose_from(
        self,
        places: ArrayLike,
        bodies: Sequence[str] = BODY_NAMES,
        ground: Ground | None = None,
        hands: ArrayLike = (0.0, 0.0),
        grip: ArrayLike = 0.0,
    ) -> NDArray[np.float64]:
        """Where the bones are for persons whose ``bodies`` are at ``places``: (..., b, 7) as `pose` says.

        places: (..., k, 7), position [m] and unit quaternion wxyz of each body in the world. bodies: their k
        names; those of `locomotion.body.person.BODY_NAMES` that a simpler figure lacks keep their neutral
        place on the body that they hang on. ground: the level; hands that touch it stay where the person's
        are, and feet that have sunk into it, as simulated ones do under load, are put on it. None: nothing
        is known. hands: (..., 2), 0 to 1: how much else the right and the left hand have to be where the
        person's are. grip: (...), 0 to 1: how much both hands hold one thing, so that they stay apart as the
        person's are. Each pose is made by itself; feet that stand slide less in those of `pose_motion`.
        Raises `LocomotionError` for other shapes, and bodies without pelvis and thighs.
        """
        given = np.asarray(places, dtype=np.float64)
        count = int(np.prod(given.shape[:-2]))
        return self._posed(given, bodies, ground, hands, grip, no_footing(count))

    def pose_motion(
        self,
        places: ArrayLike,
        times: ArrayLike,
        bodies: Sequence[str] = BODY_NAMES,
        ground: Ground | None = None,
        grip: ArrayLike = 0.0,
        footing: Footing | None = None,
    ) -> NDArray[np.float64]:
        """Where the bones are for one person in motion: (t, b, 7), arguments as of `pose_from`.

        What of a foot touches the ground stays there while the person's foot stands, up to 15 cm (of legs as
        long as the person's) from where `pose_from` puts it; in the air the foot goes back. This needs a
        ``ground``. places: (t, k, 7) at the ``times`` (t,) [s], in order. grip: one for all, or (t,).
        footing: what the calls before for the same person left; it is changed. Raises `LocomotionError` as
        `pose_from`, and for other times.
        """
        given, moments = np.asarray(places, np.float64), np.asarray(times, np.float64)
        if given.ndim != 3 or moments.shape != given.shape[:1]:
            raise LocomotionError(
                f"places have the shape {given.shape}, times {moments.shape}; "
                f"give (t, {len(bodies)}, 7) and (t,)"
            )
        if not np.isfinite(moments).all() or np.any(np.diff(moments) < 0.0):
            raise LocomotionError("times have to be finite numbers [s] that do not decrease")
        arrays = (footing or Footing()).at(moments)
        return self._posed(given, bodies, ground, (0.0, 0.0), grip, arrays)

    def _posed(
        self,
        given: NDArray[np.float64],
        bodies: Sequence[str],
        ground: Ground | None,
        hands: ArrayLike,
        grip: ArrayLike,
        footing: FootingArrays,
    ) -> NDArray[np.float64]:
        if given.ndim < 2 or given.shape[-2:] != (len(bodies), 7):
            raise LocomotionError(
                f"places have the shape {given.shape}; give (..., {len(bodies)}, 7) for {len(bodies)} bodies"
            )
        each = whole_person(given.reshape(-1, len(bodies), 7), bodies)
        contacts = no_contacts(len(each)) if ground is None else contacts_with(ground, each)
        try:
            held = np.broadcast_to(np.asarray(hands, np.float64), (*given.shape[:-2], 2)).reshape(-1, 2)
        except (ValueError, TypeError):
            raise LocomotionError(
                f"hands = {hands!r}: give 0 to 1 for the right and the left hand, (2,) or (..., 2)"
            ) from None
        try:
            contacts.grips[:] = np.broadcast_to(np.asarray(grip, np.float64), given.shape[:-2]).reshape(-1)
        except (ValueError, TypeError):
            raise LocomotionError(f"grip = {grip!r}: give 0 to 1 for each person") from None
        np.maximum(contacts.hands, np.clip(held, 0.0, 1.0), out=contacts.hands)
        out = np.empty((len(each), len(self.names), 7))
        pose_characters(self._arrays, person_arrays(), np.ascontiguousarray(each), contacts, footing, out)
        return out.reshape(*given.shape[:-2], len(self.names), 7)

    def local(self, pose: ArrayLike) -> NDArray[np.float64]:
        """A ``pose`` (..., b, 7) in the world relative to the bones' parents, as `local_pose` says."""
        given = np.asarray(pose, dtype=np.float64)
        if given.ndim < 2 or given.shape[-2:] != (len(self.names), 7):
            raise LocomotionError(f"the pose has the shape {given.shape}; give (..., {len(self.names)}, 7)")
        each = np.ascontiguousarray(given.reshape(-1, len(self.names), 7))
        out = np.empty_like(each)
        skeleton = self.skeleton
        local_poses(skeleton.parents, skeleton.above, skeleton.above_scales, each, out)
        return out.reshape(given.shape)
