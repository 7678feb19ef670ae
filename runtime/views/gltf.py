"""A run as an animated glTF 2.0 file (binary, .glb), for Blender, Godot, three.js and other engines.

The level is one mesh. Every agent is a tree of nodes, one for each body of its skeleton under its parent,
with its capsules and ellipsoids as rigid meshes, and one animation moves them all. A node above everything
turns our Z up into glTF's Y up. See the Khronos Group's glTF 2.0 specification, sections 3.6 (binary data)
and 3.11 (animations).
"""

import json
import os
from dataclasses import replace
from typing import Any

import numpy as np

from locomotion import Rig
from runtime.bodies.figure import Figure, rotate
from runtime.bodies.pose import Pose
from runtime.traces.trace import AgentTrace, LevelTrace, Trace
from runtime.views.character_gltf import continuous, dressed, glb
from runtime.views.meshes import optional, shape_mesh
from runtime.views.worn import ground_of, only_things, wearers, wears, worn_poses
from surefoot.files.atomic_write import whole_file

__all__ = ["write_gltf"]

_Z_UP_TO_Y_UP = [-float(np.sqrt(0.5)), 0.0, 0.0, float(np.sqrt(0.5))]  # x, y, z, w as glTF orders it
_STONE = (0.80, 0.79, 0.76)
_STILL = 1e-6  # [m, or of a quaternion] channels that change less are left out


def write_gltf(trace: Trace, path: str | os.PathLike[str], character: Rig | None = None) -> None:
    """Write the run to ``path`` (.glb), whole or not at all. People wear the ``character``, if there is one.

    Raises `RuntimeInputError` without pygltflib, and for a character that nobody in the run can wear or that
    cannot be copied.
    """
    writer = _Writer(optional("pygltflib", "gltf", "a glTF file"))
    if character is None:
        content = b"".join(writer.document(trace).save_to_bytes())
    else:
        wearing, ground = wearers(trace.agents), ground_of(trace.level)
        worn = {agent.name: worn_poses(character, agent, trace.times, ground) for agent in wearing}
        things = [only_things(agent, character, worn[agent.name]) for agent in wearing]
        plain = [agent for agent in trace.agents if not wears(agent)]
        plain += [replace(each, name=f"{each.name}'s") for each in things if each is not None]
        made = writer.document(replace(trace, agents=tuple(plain)))
        parts, data = json.loads(made.to_json()), bytearray(made.binary_blob())
        dressed(parts, data, character, worn, trace.times - trace.times[0])
        content = glb(parts, bytes(data))
    with whole_file(path) as temporary:
        temporary.write_bytes(content)


class _Writer:
    """Collects the parts of the document and their binary data."""

    def __init__(self, library: Any) -> None:
        self._lib = library
        self._gltf = library.GLTF2(asset=library.Asset(version="2.0", generator="surefoot"))
        self._data = bytearray()
        self._materials: dict[tuple[float, ...], int] = {}
        self._meshes: dict[bytes, int] = {}

    def document(self, trace: Trace) -> Any:
        """The `pygltflib.GLTF2` of a run."""
        gltf, lib = self._gltf, self._lib
        top = self._node("surefoot", rotation=_Z_UP_TO_Y_UP)
        gltf.scenes.append(lib.Scene(nodes=[top]))
        gltf.scene = 0
        level = self._level_mesh(trace.level)
        children = [] if level is None else [self._node("level", mesh=level)]
        animated = len(trace.times) > 1
        times = self._accessor(trace.times - trace.times[0], "SCALAR", bounds=True) if animated else -1
        animation = lib.Animation(name="run")
        for agent in trace.agents:
            children.append(self._agent(agent, animation, times))
        gltf.nodes[top].children = children
        if animation.channels:
            gltf.animations.append(animation)
        gltf.buffers.append(lib.Buffer(byteLength=len(self._data)))
        gltf.set_binary_blob(bytes(self._data))
        return gltf

    def _agent(self, agent: AgentTrace, animation: Any, times: int) -> int:
        figure = agent.figure
        poses = agent.poses.astype(np.float64)
        local = np.stack([Pose(figure.bodies, figure.parents, moment).local for moment in poses])
        local[..., 3:] /= np.linalg.norm(local[..., 3:], axis=-1, keepdims=True)
        nodes = []
        for b, name in enumerate(figure.bodies):
            place, turned = local[:, b, :3], continuous(local[:, b, 3:])[:, [1, 2, 3, 0]]
            node = self._node(
                f"{agent.name}/{name}", translation=_plain(place[0]), rotation=_plain(turned[0]),
                mesh=self._body_mesh(figure, b),
            )  # fmt: skip
            nodes.append(node)
            if times >= 0 and np.ptp(place, axis=0).max() > _STILL:
                self._channel(animation, node, "translation", times, self._accessor(place, "VEC3"))
            if times >= 0 and np.ptp(turned, axis=0).max() > _STILL:
                self._channel(animation, node, "rotation", times, self._accessor(turned, "VEC4"))
            if b >= agent.own:  # of no size while it is not held
                shown = np.repeat(agent.held[:, b - agent.own, None], 3, axis=1).astype(np.float64)
                self._gltf.nodes[node].scale = _plain(shown[0])
                if times >= 0 and np.ptp(shown) > 0.0:
                    self._channel(animation, node, "scale", times, self._accessor(shown, "VEC3"), "STEP")
        for b, node in enumerate(nodes):
            below = [nodes[c] for c in np.flatnonzero(figure.parents == b)]
            self._gltf.nodes[node].children = below
        roots = [nodes[b] for b in np.flatnonzero(figure.parents < 0)]
        top = self._node(agent.name)
        self._gltf.nodes[top].children = roots
        return top

    def _level_mesh(self, level: LevelTrace) -> int | None:
        import trimesh

        mesh = trimesh.Trimesh(level.vertices, level.faces, process=False)
        mesh.update_faces(mesh.nondegenerate_faces())
        if len(mesh.faces) == 0:
            return None
        points = mesh.vertices[mesh.faces].reshape(-1, 3)  # each face has corners of its own: flat shading
        normals = np.repeat(mesh.face_normals, 3, axis=0)
        return self._mesh("level", [self._primitive(points, normals, None, _STONE)])

    def _body_mesh(self, figure: Figure, body: int) -> int | None:
        """The shapes on a body, one primitive each; equal shapes of several agents share a mesh."""
        own = np.flatnonzero(figure.owner == body)
        if len(own) == 0:
            return None
        shapes = figure.shapes
        key = b"".join(
            np.ascontiguousarray(array[own]).tobytes()
            for array in (shapes.place, shapes.size, shapes.round, shapes.colour)
        )
        if key not in self._meshes:
            primitives = []
            for k in own:
                mesh, place = shape_mesh(shapes, int(k)), shapes.place[k]
                points = rotate(place[3:], np.asarray(mesh.vertices)) + place[:3]
                normals = rotate(place[3:], np.asarray(mesh.vertex_normals))
                primitives.append(self._primitive(points, normals, mesh.faces, tuple(shapes.colour[k])))
            self._meshes[key] = self._mesh(figure.bodies[body], primitives)
        return self._meshes[key]

    def _primitive(
        self, points: np.ndarray, normals: np.ndarray, faces: np.ndarray | None, colour: tuple[float, ...]
    ) -> Any:
        lib = self._lib
        attributes = lib.Attributes(
            POSITION=self._accessor(points, "VEC3", lib.ARRAY_BUFFER, bounds=True),
            NORMAL=self._accessor(normals, "VEC3", lib.ARRAY_BUFFER),
        )
        indices = None
        if faces is not None:
            indices = self._accessor(np.asarray(faces).reshape(-1), "SCALAR", lib.ELEMENT_ARRAY_BUFFER)
        return lib.Primitive(attributes=attributes, indices=indices, material=self._material(colour))

    def _material(self, colour: tuple[float, ...]) -> int:
        if colour not in self._materials:
            linear = [float(part) ** 2.2 for part in colour]  # glTF's factors are linear, ours are sRGB
            surface = self._lib.PbrMetallicRoughness(
                baseColorFactor=[*linear, 1.0], metallicFactor=0.0, roughnessFactor=0.9
            )
            self._materials[colour] = len(self._gltf.materials)
            self._gltf.materials.append(self._lib.Material(pbrMetallicRoughness=surface, alphaCutoff=None))
        return self._materials[colour]

    def _mesh(self, name: str, primitives: list[Any]) -> int:
        self._gltf.meshes.append(self._lib.Mesh(name=name, primitives=primitives))
        return len(self._gltf.meshes) - 1

    def _node(self, name: str, **parts: Any) -> int:
        self._gltf.nodes.append(self._lib.Node(name=name, **parts))
        return len(self._gltf.nodes) - 1

    def _channel(
        self, animation: Any, node: int, path: str, times: int, values: int, between: str = "LINEAR"
    ) -> None:
        lib = self._lib
        animation.samplers.append(lib.AnimationSampler(input=times, output=values, interpolation=between))
        target = lib.AnimationChannelTarget(node=node, path=path)
        animation.channels.append(lib.AnimationChannel(sampler=len(animation.samplers) - 1, target=target))

    def _accessor(
        self, values: np.ndarray, kind: str, target: int | None = None, bounds: bool = False
    ) -> int:
        """Append ``values`` (n,) or (n, k) to the binary data: indices as uint32, all else as float32."""
        lib = self._lib
        whole = np.issubdtype(values.dtype, np.integer)
        packed = np.ascontiguousarray(values, dtype=np.uint32 if whole else np.float32)
        self._gltf.bufferViews.append(
            lib.BufferView(buffer=0, byteOffset=len(self._data), byteLength=packed.nbytes, target=target)
        )
        self._data += packed.tobytes()
        accessor = lib.Accessor(
            bufferView=len(self._gltf.bufferViews) - 1, count=len(packed), type=kind,
            componentType=lib.UNSIGNED_INT if whole else lib.FLOAT,
        )  # fmt: skip
        if bounds:
            rows = packed.reshape(len(packed), -1)
            accessor.min, accessor.max = rows.min(axis=0).tolist(), rows.max(axis=0).tolist()
        self._gltf.accessors.append(accessor)
        return len(self._gltf.accessors) - 1


def _plain(values: np.ndarray) -> list[float]:
    return [float(value) for value in values]
