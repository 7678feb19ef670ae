"""A user's character in an animated glTF file: its meshes, materials and skin as they are in its own file,
and for each agent that wears it a tree of nodes of its own, moved by the file's animation.

Only what the figure needs is copied: its cameras, lights and own animations are left out, and so are
extensions other than those of materials and textures. Data compressed with meshopt is written plain.
"""

import copy
import json
import mimetypes
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np

from locomotion import Rig
from navmesh import NavmeshError
from navmesh.meshfiles.gltf_compression import DRACO
from navmesh.meshfiles.gltf_document import Document
from navmesh.meshfiles.gltf_nodes import node_order, shown_nodes
from runtime.errors import RuntimeInputError

__all__ = ["continuous", "dressed", "glb"]

_KEPT = ("KHR_materials_", "KHR_texture_", "EXT_texture_", "EXT_materials_", "KHR_mesh_quantization")
_STILL = 1e-6  # [m, or of a quaternion] channels that change less are left out
_FLOAT = 5126


def dressed(
    content: dict[str, Any], data: bytearray, rig: Rig, worn: Mapping[str, np.ndarray], times: np.ndarray
) -> None:  # fmt: skip
    """Add ``rig``'s character to a glTF file, its JSON ``content`` and binary ``data``, once for each agent
    whose name is in ``worn``, with the places (t, b, 7) of its bones at ``times`` (t,) [s] from 0.

    Raises `RuntimeInputError` for a character that cannot be copied, as one compressed with Draco.
    """
    try:
        source = Document(rig.skeleton.path)
        parts = _Copy(source, content, data)
        for name, poses in worn.items():
            _Wearer(parts, rig, name).animate(rig.local(poses), times)
    except NavmeshError as error:
        raise RuntimeInputError(str(error)) from None


def glb(content: dict[str, Any], data: bytes) -> bytes:
    """A binary glTF file of its JSON and its only buffer."""
    content = content | {"buffers": [{"byteLength": len(data)}]}
    text = json.dumps({key: value for key, value in content.items() if value not in ([], None)}).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    size = 28 + len(text) + len(data)
    chunks = struct.pack("<I", len(text)) + b"JSON" + text + struct.pack("<I", len(data)) + b"BIN\0" + data
    return b"glTF" + struct.pack("<II", 2, size) + chunks


class _Copy:
    """Copies parts of a file into another one, each once; methods take a part's number and give the new
    one."""

    def __init__(self, source: Document, content: dict[str, Any], data: bytearray) -> None:
        self.source, self.content, self.data = source, content, data
        self._known: dict[tuple[str, int], int] = {}

    def new(self, name: str, part: dict[str, Any]) -> int:
        """Append a part to the list called ``name``."""
        self.content.setdefault(name, []).append(part)
        return len(self.content[name]) - 1

    def array(self, values: np.ndarray, kind: str, bounds: bool = False) -> int:
        """An accessor of ``values`` (n, k) as float32."""
        packed = np.ascontiguousarray(values, dtype=np.float32)
        accessor = {"bufferView": self._bytes(packed.tobytes(), {}), "count": len(packed), "type": kind,
                    "componentType": _FLOAT}  # fmt: skip
        if bounds:
            rows = packed.reshape(len(packed), -1)
            accessor |= {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        return self.new("accessors", accessor)

    def _bytes(self, content: bytes, more: dict[str, Any]) -> int:
        self.data.extend(b"\0" * (-len(self.data) % 4))
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(content)} | more
        self.data.extend(content)
        return self.new("bufferViews", view)

    def _once(self, name: str, index: Any, make: Any) -> int:
        part = self.source.item(name, index, "the character")
        key = (name, index)
        if key not in self._known:
            self._known[key] = make(part, index)
        return self._known[key]

    def view(self, index: Any) -> int:
        def make(view: dict[str, Any], index: int) -> int:
            more = {key: view[key] for key in ("byteStride", "target") if key in view}
            return self._bytes(self.source.view(index, "the character"), more)

        return self._once("bufferViews", index, make)

    def accessor(self, index: Any) -> int:
        def make(accessor: dict[str, Any], _: int) -> int:
            made = {key: copy.deepcopy(value) for key, value in accessor.items() if key not in _NOT_COPIED}
            if "bufferView" in made:
                made["bufferView"] = self.view(made["bufferView"])
            for part in ("indices", "values") if isinstance(made.get("sparse"), dict) else ():
                inner = made["sparse"].get(part)
                if isinstance(inner, dict):
                    inner["bufferView"] = self.view(inner.get("bufferView"))
            return self.new("accessors", made)

        return self._once("accessors", index, make)

    def image(self, index: Any) -> int:
        def make(image: dict[str, Any], index: int) -> int:
            made = {key: image[key] for key in ("name", "mimeType", "uri") if key in image}
            if "bufferView" in image:
                made["bufferView"] = self.view(image["bufferView"])
            elif not str(made.get("uri", "")).startswith("data:"):
                uri = made.pop("uri", None)
                made["bufferView"] = self._bytes(self.source.fetched(uri, f"images[{index}]"), {})
                made.setdefault("mimeType", mimetypes.guess_type(str(uri))[0] or "image/png")
            return self.new("images", made)

        return self._once("images", index, make)

    def texture(self, index: Any) -> int:
        def make(texture: dict[str, Any], _: int) -> int:
            made = {key: texture[key] for key in ("name",) if key in texture}
            if "source" in texture:
                made["source"] = self.image(texture["source"])
            if "sampler" in texture:
                made["sampler"] = self._once(
                    "samplers", texture["sampler"], lambda part, _: self.new("samplers", copy.deepcopy(part))
                )
            for name, extension in self._extensions(texture, "source" not in texture).items():
                if "source" in extension:
                    extension["source"] = self.image(extension["source"])
                made.setdefault("extensions", {})[name] = extension
            return self.new("textures", made)

        return self._once("textures", index, make)

    def material(self, index: Any) -> int:
        def make(material: dict[str, Any], _: int) -> int:
            return self.new("materials", self._with_textures(material))

        return self._once("materials", index, make)

    def _with_textures(self, part: dict[str, Any]) -> dict[str, Any]:
        """A material, or a part of it, with the textures that it names."""
        made: dict[str, Any] = {}
        for key, value in part.items():
            if key == "extensions":
                kept = self._extensions(part, False)
                if kept:
                    made[key] = {name: self._with_textures(each) for name, each in kept.items()}
            elif isinstance(value, dict) and key != "extras":
                made[key] = self._with_textures(value)
                if key.endswith("Texture") and "index" in value:
                    made[key]["index"] = self.texture(value["index"])
            elif key != "extras":
                made[key] = copy.deepcopy(value)
        return made

    def _extensions(self, part: dict[str, Any], needed: bool) -> dict[str, Any]:
        """The extensions of a part that are kept; the file is told that it uses them."""
        found = part.get("extensions")
        kept = {
            name: copy.deepcopy(value)
            for name, value in (found if isinstance(found, dict) else {}).items()
            if name.startswith(_KEPT) and isinstance(value, dict)
        }
        for name in kept:
            self.uses(name, needed)
        return kept

    def uses(self, name: str, needed: bool) -> None:
        """The file uses an extension, and cannot be read without it if ``needed``."""
        for key in ("extensionsUsed", "extensionsRequired")[: 1 + needed]:
            listed = self.content.setdefault(key, [])
            if name not in listed:
                listed.append(name)

    def mesh(self, index: Any) -> int:
        def make(mesh: dict[str, Any], index: int) -> int:
            made = {key: mesh[key] for key in ("name", "weights") if key in mesh}
            made["primitives"] = [
                self._primitive(each, f"meshes[{index}]") for each in self.source.items("primitives", mesh)
            ]
            if "KHR_mesh_quantization" in self.source.required:
                self.uses("KHR_mesh_quantization", True)
            return self.new("meshes", made)

        return self._once("meshes", index, make)

    def _primitive(self, primitive: dict[str, Any], where: str) -> dict[str, Any]:
        if self.source.extension(primitive, DRACO) is not None and DRACO in self.source.required:
            raise self.source.error(where, f"is compressed with {DRACO}; export the character without it")
        attributes = primitive.get("attributes")
        if not isinstance(attributes, dict):
            raise self.source.error(where, "has no attributes")
        made: dict[str, Any] = {
            "attributes": {name: self.accessor(each) for name, each in attributes.items()}
        }
        if "indices" in primitive:
            made["indices"] = self.accessor(primitive["indices"])
        if "material" in primitive:
            made["material"] = self.material(primitive["material"])
        if "mode" in primitive:
            made["mode"] = primitive["mode"]
        targets = self.source.items("targets", primitive)
        if targets:
            made["targets"] = [{name: self.accessor(each) for name, each in one.items()} for one in targets]
        return made


_NOT_COPIED = ("extensions", "extras")


class _Wearer:
    """The nodes of a character that one agent wears."""

    def __init__(self, parts: _Copy, rig: Rig, name: str) -> None:
        self._parts, self._rig, self._name = parts, rig, name
        self._nodes: dict[int, int] = {}
        source = parts.source
        nodes = source.items("nodes")
        scene = source.item("scenes", source.json.get("scene", 0), "scene") if source.items("scenes") else {}
        order = node_order(source, nodes)
        shown = shown_nodes(source, nodes, order)
        roots = source.items("nodes", scene, int) or [k for k, parent in order if parent < 0]
        for index, _ in reversed(order):  # children first
            if index in shown and ("skin" not in nodes[index] or nodes[index].get("children")):
                self._add_node(index)
        top: dict[str, Any] = {"name": name, "children": [self._nodes[k] for k in roots if k in self._nodes]}
        if rig.skeleton.scale != 1.0:
            top["scale"] = [rig.skeleton.scale] * 3
        scene = parts.content["scenes"][0]["nodes"]
        scene.append(parts.new("nodes", top))
        skins: dict[int, int] = {}
        for index, _ in order:
            if (
                index in shown and "skin" in nodes[index] and "mesh" in nodes[index]
            ):  # its node's place does not matter: on top
                skin = nodes[index]["skin"]
                if skin not in skins:
                    skins[skin] = self._skin(skin)
                worn = {"name": self._called(index), "mesh": parts.mesh(nodes[index]["mesh"]),
                        "skin": skins[skin]}  # fmt: skip
                if "weights" in nodes[index]:
                    worn["weights"] = nodes[index]["weights"]
                scene.append(parts.new("nodes", worn))

    def _called(self, index: int) -> str:
        name = self._parts.source.items("nodes")[index].get("name")
        return f"{self._name}/{name if isinstance(name, str) and name else index}"

    def _add_node(self, index: int) -> None:
        source = self._parts.source
        node = source.items("nodes")[index]
        made: dict[str, Any] = {"name": self._called(index)}
        made |= {key: node[key] for key in ("translation", "rotation", "scale", "matrix") if key in node}
        if "mesh" in node and "skin" not in node:
            made["mesh"] = self._parts.mesh(node["mesh"])
        children = [self._nodes[k] for k in source.items("children", node, int) if k in self._nodes]
        if children:
            made["children"] = children
        self._nodes[index] = self._parts.new("nodes", made)

    def _skin(self, index: int) -> int:
        skin = self._parts.source.item("skins", index, "the character")
        made: dict[str, Any] = {"joints": [self._nodes[joint] for joint in skin["joints"]]}
        if "inverseBindMatrices" in skin:
            made["inverseBindMatrices"] = self._parts.accessor(skin["inverseBindMatrices"])
        return self._parts.new("skins", made)

    def animate(self, local: np.ndarray, times: np.ndarray) -> None:
        """Move the bones: ``local`` (t, b, 7) at ``times`` (t,)."""
        content, skeleton = self._parts.content, self._rig.skeleton
        moving = len(times) > 1
        clock = self._parts.array(times, "SCALAR", bounds=True) if moving else -1
        animations = content.setdefault("animations", [])
        if moving and not animations:
            animations.append({"name": "run", "channels": [], "samplers": []})
        for b, index in enumerate(skeleton.nodes):
            node = content["nodes"][self._nodes[int(index)]]
            node.pop("matrix", None)
            size = float(skeleton.scales[b] / skeleton.above_scales[b])
            node["scale"] = [size] * 3
            turns = continuous(local[:, b, 3:])[:, [1, 2, 3, 0]]
            turns = turns / np.linalg.norm(turns, axis=1, keepdims=True)
            for path, values, kind in (
                ("translation", local[:, b, :3], "VEC3"), ("rotation", turns, "VEC4"),
            ):  # fmt: skip
                node[path] = values[0].tolist()
                if moving and np.ptp(values, axis=0).max() > _STILL:
                    animation = animations[0]
                    animation["samplers"].append({"input": clock, "output": self._parts.array(values, kind)})
                    animation["channels"].append(
                        {"sampler": len(animation["samplers"]) - 1,
                         "target": {"node": self._nodes[int(index)], "path": path}}
                    )  # fmt: skip


def continuous(quaternions: np.ndarray) -> np.ndarray:
    """The same turns (t, 4), with signs that keep neighbours close."""
    flips = np.sum(quaternions[1:] * quaternions[:-1], axis=1) < 0.0
    sign = np.where(np.concatenate([[0], np.cumsum(flips)]) % 2 == 1, -1.0, 1.0)
    return quaternions * sign[:, None]
