"""Damaged files for `benchmarks.file_fuzz`.

Archives are changed as bytes, as zip files, in their arrays and in their headers; text as bytes, as lines and
in single words. All randomness comes from the generator that the caller seeds.
"""

import io
import json
import re
import zipfile
from collections.abc import Callable
from typing import Any

import numpy as np

from surefoot.files.archive import seal_of

__all__ = ["SEALS", "mutated_archive", "mutated_glb", "mutated_text"]

SEALS = ("kept", "removed", "made right")
"""What becomes of the seal of a changed archive."""
_ODD_NUMBERS = (
    np.nan, np.inf, -np.inf, -1.0, 0.0, 1e-300, 0.5, 2.0, 17.0, 1e3, 1e6, 1e9, 1e30, 1e300, 2.0**31,
    -(2.0**31), 2.0**53,
)  # fmt: skip
_ODD_VALUES: tuple[Any, ...] = (
    None, True, False, 0, -1, 1, 2, 7, 2**31, -(2**63), 10**40, 0.5, 1e300, -1e9, "", "x", "\u0000",
    "é" * 300,
    "../..", [], {}, [[]], [1], [None, None], {"x": 1}, [1, 2, 3], "1e9", float("nan"), float("inf"),
)  # fmt: skip
_DTYPES = (
    "f4",
    "f8",
    "i1",
    "i4",
    "i8",
    "u1",
    "u8",
    "?",
    "c16",
    "S8",
    "U3",
    ">f8",
    ">i4",
    "f2",
    "M8[s]",
    "V8",
)


# --- as bytes
def _flip(data: bytes, rng: np.random.Generator) -> bytes:
    out = bytearray(data)
    for at in rng.integers(0, len(out), int(rng.integers(1, 9))):
        out[at] ^= 1 << int(rng.integers(8))
    return bytes(out)


def _cut(data: bytes, rng: np.random.Generator) -> bytes:
    return data[: int(rng.integers(len(data)))]


def _overwrite(data: bytes, rng: np.random.Generator) -> bytes:
    at, count = int(rng.integers(len(data))), int(rng.integers(1, 200))
    return data[:at] + rng.bytes(min(count, len(data) - at)) + data[at + count :]


def _splice(data: bytes, rng: np.random.Generator) -> bytes:
    a, b = sorted(rng.integers(0, len(data), 2).tolist())
    other = int(rng.integers(len(data)))
    return rng.choice(np.array([data[:a] + data[b:], data[:b] + data[a:], data[:a] + data[other:]], object))


_BYTES = (_flip, _flip, _cut, _overwrite, _splice)


# --- as a zip file
def _zip(members: list[tuple[str, bytes]], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", method) as archive:
        for name, content in members:
            archive.writestr(zipfile.ZipInfo(name), content, compress_type=method)
    return out.getvalue()


def _members(data: bytes) -> list[tuple[str, bytes]]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return [(name, archive.read(name)) for name in archive.namelist()]


def _zip_trick(data: bytes, rng: np.random.Generator) -> bytes:
    members = _members(data)
    at, other = (int(k) for k in rng.integers(0, len(members), 2))
    name, content = members[at]
    trick = int(rng.integers(12))
    if trick == 0:
        members.append(members[at])
    elif trick == 1:
        members[at], members[other] = (name, members[other][1]), (members[other][0], content)
    elif trick == 2:
        del members[at]
    elif trick == 3:
        members.append(("more.npy", content))
    elif trick == 4:
        members[at] = (name.replace(".npy", ""), content)
    elif trick == 5:
        method = int(rng.choice([zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA, zipfile.ZIP_STORED]))
        return _zip(members, method)
    elif trick == 6:  # the array says more than it holds, or less
        members[at] = (name, content[: int(rng.integers(len(content)))])
    elif trick == 7:
        members[at] = (name, content + rng.bytes(int(rng.integers(1, 5000))))
    elif trick == 8:  # something pickled
        stream = io.BytesIO()
        np.lib.format.write_array(stream, np.array([{"x": 1}], object), allow_pickle=True)
        members[at] = (name, stream.getvalue())
    elif trick == 9:  # the type and shape of the array
        size = int.from_bytes(content[8:10], "little")
        head = bytearray(content[10 : 10 + size])
        for k in rng.integers(0, len(head), 3):
            head[k] = int(rng.choice(list(b"0123456789'(),:<>|fiuUSOTrue{}[]-")))
        members[at] = (name, content[:10] + bytes(head) + content[10 + size :])
    elif trick == 10:  # a field of the listing
        out = bytearray(_zip(members))
        entry = out.rindex(b"PK\x01\x02") if rng.random() < 0.5 else out.index(b"PK\x01\x02")
        out[entry + int(rng.integers(4, 46))] ^= 1 << int(rng.integers(8))
        return bytes(out)
    else:  # the end of the listing
        out = bytearray(_zip(members))
        end = out.rindex(b"PK\x05\x06")
        out[end + int(rng.integers(4, 22))] ^= 1 << int(rng.integers(8))
        return bytes(out)
    return _zip(members)


# --- in its arrays
def _odd_element(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    out, flat = values.copy(), int(rng.integers(values.size))
    count = int(rng.choice([1, 1, 1, 3, values.size]))
    where = (flat + np.arange(count)) % values.size
    kind = out.dtype.kind
    if kind in "iu":
        limits = np.iinfo(out.dtype)
        odd = [
            -1,
            0,
            1,
            values.size,
            limits.max,
            limits.min,
            int(rng.integers(0, max(values.size, 2))),
            2**24,
        ]
        out.reshape(-1)[where] = np.clip(int(rng.choice(odd)), limits.min, limits.max)
    elif kind == "f":
        with np.errstate(over="ignore"):
            out.reshape(-1)[where] = rng.choice(_ODD_NUMBERS)
    elif kind == "b":
        raw = out.reshape(-1).view(np.uint8)
        raw[where] = rng.integers(0, 256)
    elif kind == "U" and out.dtype.itemsize:
        codes = out.reshape(-1).view(np.uint32)
        codes[int(rng.integers(codes.size))] = rng.choice([0x110000, 0xD800, 0, 65, 0xFFFFFFFF])
    return out


def _odd_array(values: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    trick = int(rng.integers(14))
    if trick < 5 and values.size:
        return _odd_element(values, rng)
    if trick == 5:
        dtype = np.dtype(str(rng.choice(_DTYPES)))
        return np.zeros(values.shape, dtype) if dtype.kind in "VM" else _cast(values, dtype)
    if trick == 6:
        return values[..., :-1] if values.ndim else np.zeros(2)
    if trick == 7:
        return values[: int(rng.integers(len(values) + 1))] if values.ndim else values[None]
    if trick == 8:
        return np.concatenate([values, values]) if values.ndim else values
    if trick == 9:
        return values[None]
    if trick == 10:
        return np.zeros((0, *values.shape[1:]), values.dtype)
    if trick == 11 and values.ndim and len(values):
        return values[rng.permutation(len(values))]
    if trick == 12 and values.size and values.dtype.kind == "f":
        return values * rng.choice([-1.0, 1.0001, 1e-9, 1e9]) + rng.choice([0.0, 1.0, 1e-3])
    return (
        values.ravel() if values.ndim > 1 else np.asfortranarray(np.zeros((3, *values.shape), values.dtype))
    )


def _cast(values: np.ndarray, dtype: np.dtype) -> np.ndarray:
    try:
        with np.errstate(all="ignore"):
            return values.astype(dtype)
    except (TypeError, ValueError):
        return np.zeros(values.shape, dtype)


def _swollen(arrays: dict[str, np.ndarray], rng: np.random.Generator) -> dict[str, np.ndarray]:
    """All arrays that are as long as one of them become much longer: little that unpacks to hundreds of
    megabytes, with sizes that fit each other."""
    name = str(rng.choice([name for name, array in arrays.items() if array.ndim] or list(arrays)))
    length = len(arrays[name]) if arrays[name].ndim else 0
    swell = {key: array for key, array in arrays.items() if array.ndim and len(array) == length}
    bytes_each = sum(int(np.prod(array.shape[1:])) * array.dtype.itemsize for array in swell.values())
    more = int(float(rng.choice([4e6, 3e7, 2e8])) / max(bytes_each, 1))
    return arrays | {key: np.zeros((more, *array.shape[1:]), array.dtype) for key, array in swell.items()}


# --- in its header
def _odd_tree(value: Any, rng: np.random.Generator) -> Any:
    """``value`` with one place of it changed, deep inside as often as not."""
    if isinstance(value, dict | list) and value and rng.random() < 0.85:
        keys = list(value) if isinstance(value, dict) else list(range(len(value)))
        key = keys[int(rng.integers(len(keys)))]
        out: Any = dict(value) if isinstance(value, dict) else list(value)
        trick = int(rng.integers(10))
        if trick == 0:
            del out[key]
        elif trick == 1 and isinstance(out, dict):
            out["more"] = _ODD_VALUES[int(rng.integers(len(_ODD_VALUES)))]
        elif trick == 1:
            out.insert(key, out[key])
        else:
            out[key] = _odd_tree(out[key], rng)
        return out
    if isinstance(value, int | float) and not isinstance(value, bool) and rng.random() < 0.5:
        return value + float(rng.choice([-1, 1, 0.5, 1e6]))
    if isinstance(value, str) and value and rng.random() < 0.3:
        return value[:-1]
    return _ODD_VALUES[int(rng.integers(len(_ODD_VALUES)))]


def _odd_text(text: bytes, rng: np.random.Generator) -> bytes:
    trick = int(rng.integers(6))
    if trick == 0:
        return b"[" * 100_000
    if trick == 1:
        return b'{"kind": ' * 50_000
    if trick == 2:
        return text.replace(b": 1", b": 1" + b"0" * 5000, 1)
    if trick == 3:
        return text[:-1] + b', "x": NaN}'
    if trick == 4:
        return rng.bytes(len(text))
    return text.replace(b'"', b"'", 1)


def _rewritten(
    data: bytes, rng: np.random.Generator, seal: str, change: Callable[[dict[str, np.ndarray], Any], Any]
) -> bytes:
    """The archive after ``change`` to its arrays and header; gives the header, or its text."""
    held = dict(_members(data))
    arrays = {name.removesuffix(".npy"): _array(content) for name, content in held.items()}
    header = json.loads(arrays.pop("header").tobytes())
    header = change(arrays, header)
    members = [(f"{name}.npy", _npy(array)) for name, array in arrays.items()]
    if isinstance(header, dict):
        if seal == "removed":
            header.pop("seal", None)
        elif seal == "made right":
            with zipfile.ZipFile(io.BytesIO(_zip(members))) as listed:
                header["seal"] = seal_of(header, listed.infolist())
    if not isinstance(header, bytes):
        header = json.dumps(header).encode()
    return _zip([*members, ("header.npy", _npy(np.frombuffer(header, np.uint8)))])


def _array(content: bytes) -> np.ndarray:
    return np.lib.format.read_array(io.BytesIO(content), allow_pickle=False)


def _npy(array: np.ndarray) -> bytes:
    out = io.BytesIO()
    np.lib.format.write_array(out, array, allow_pickle=False)
    return out.getvalue()


def mutated_archive(data: bytes, rng: np.random.Generator) -> tuple[bytes, str]:
    """A good archive with something wrong in it, and what becomes of its seal."""

    def arrays_changed(arrays: dict[str, np.ndarray], header: Any) -> Any:
        names = [name for name, array in arrays.items() if array.size or rng.random() < 0.1]
        for _ in range(int(rng.choice([1, 1, 1, 2, 4]))):
            name = str(rng.choice(names))
            arrays[name] = _odd_array(arrays[name], rng)
        return header

    def exchanged(arrays: dict[str, np.ndarray], header: Any) -> Any:
        name = str(rng.choice(list(arrays)))
        like = [key for key, each in arrays.items() if each.shape == arrays[name].shape]
        other = str(rng.choice(like))
        arrays[name], arrays[other] = arrays[other], arrays[name]
        return header

    def swollen(arrays: dict[str, np.ndarray], header: Any) -> Any:
        arrays.update(_swollen(arrays, rng))
        return header

    def header_changed(arrays: dict[str, np.ndarray], header: Any) -> Any:
        return _odd_tree(header, rng)

    def header_spoiled(arrays: dict[str, np.ndarray], header: Any) -> Any:
        return _odd_text(json.dumps(header).encode(), rng)

    seal = SEALS[int(rng.integers(3))]
    trick = rng.random()
    if trick < 0.15:
        return _BYTES[int(rng.integers(len(_BYTES)))](data, rng), "kept"
    if trick < 0.25:
        return _zip_trick(data, rng), "kept"
    if trick < 0.27:
        return _rewritten(data, rng, seal, swollen), seal
    if trick < 0.33:
        return _rewritten(data, rng, seal, exchanged), seal
    if trick < 0.35:
        return _rewritten(data, rng, seal, header_spoiled), seal
    if trick < 0.65:
        return _rewritten(data, rng, seal, header_changed), seal
    return _rewritten(data, rng, seal, arrays_changed), seal


# --- text
_WORDS = (
    "", "null", "~", "true", "-1", "0", "1e999", ".inf", ".nan", "nan", "1e9", "-1e9",
    "99999999999999999999", "[]", "{}", "[[[]]]", "'", '"', "*a", "&a x", "!!python/name:os.system",
    "<<", "? x", "2024-01-01",
    "0x10", "1:30", "\u0000", "\ufeff", "é", "\ud7ff", "..", "/etc/passwd", "%", "@", "`", "|", ">", "- ",
    ": ",
    "#", "\t", "9" * 400, "[" * 300,
)  # fmt: skip
_BOMBS = (
    "\na: &a [x,x,x,x,x,x,x,x,x]\n"
    + "".join(f"{chr(98 + k)}: &{chr(98 + k)} [{','.join(['*' + chr(97 + k)] * 9)}]\n" for k in range(9)),
    "[" * 20_000,
    "{a: " * 20_000,
    "- " * 20_000,
    "\nx: " + "1:" * 40_000 + "1",
    "\nx: " + "9" * 100_000,
    "x" * 1_100_000,
)


def mutated_text(data: bytes, rng: np.random.Generator) -> tuple[bytes, str]:
    """A good text file with something wrong in it; text has no seal."""
    trick = rng.random()
    if trick < 0.25:
        return _BYTES[int(rng.integers(len(_BYTES)))](data, rng), "none"
    text = data.decode()
    if trick < 0.27:
        bomb = _BOMBS[int(rng.integers(len(_BOMBS)))]
        return (bomb if rng.random() < 0.5 else text + bomb).encode(), "none"
    if trick < 0.45:
        lines = text.splitlines(keepends=True)
        a, b = (int(k) for k in rng.integers(0, len(lines), 2))
        way = int(rng.integers(4))
        if way == 0:
            del lines[a]
        elif way == 1:
            lines.insert(a, lines[b])
        elif way == 2:
            lines[a], lines[b] = lines[b], lines[a]
        else:
            lines[a] = " " * int(rng.integers(1, 9)) + lines[a].lstrip()
        return "".join(lines).encode(), "none"
    for _ in range(int(rng.choice([1, 1, 2, 5]))):
        found = list(re.finditer(r"[\w.+-]+|[\[\]{}:,]", text))
        if not found:
            break
        word = found[int(rng.integers(len(found)))]
        other = found[int(rng.integers(len(found)))].group()
        new = other if rng.random() < 0.3 else _WORDS[int(rng.integers(len(_WORDS)))]
        text = text[: word.start()] + new + text[word.end() :]
    return text.encode("utf-8", "surrogatepass"), "none"


def mutated_glb(data: bytes, rng: np.random.Generator) -> tuple[bytes, str]:
    """A good GLB file with something wrong in its bytes, its numbers or its JSON; it has no seal."""
    size = int.from_bytes(data[12:16], "little")
    text, rest = data[20 : 20 + size], data[20 + size :]
    trick = rng.random()
    if trick < 0.3:
        return _BYTES[int(rng.integers(len(_BYTES)))](data, rng), "none"
    if trick < 0.5:
        rest = rest[:8] + _BYTES[int(rng.integers(len(_BYTES)))](rest[8:], rng)
        rest = len(rest[8:]).to_bytes(4, "little") + rest[4:]
    else:
        text = mutated_text(text, rng)[0]
        text += b" " * (-len(text) % 4)
    whole = len(text).to_bytes(4, "little") + b"JSON" + text + rest
    return b"glTF" + (2).to_bytes(4, "little") + (12 + len(whole)).to_bytes(4, "little") + whole, "none"
