"""The cache of one kernel: compiled code in the user's cache folder, named after everything it depends on."""

import hashlib
import io
import pickle
import platform
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import llvmlite
import numba
from numba.core.compiler import CompileResult
from numba.core.dispatcher import Dispatcher
from numba.core.serialize import dumps

from surefoot.kernels import linking
from surefoot.kernels.dependencies import digest_of_code, digest_of_type
from surefoot.kernels.folder import cache_folder, note_use, write_whole
from surefoot.kernels.turns import Turns

__all__ = ["KernelCache", "used"]

_FORMAT = 1
"""Version of the cache files; a new number recompiles everything."""
_SUFFIX = ".kernel"
_turns = Turns()
_used: set[str] = set()


@cache
def _versions() -> str:
    tag = f"{_FORMAT} {sys.implementation.cache_tag} {platform.system()}"
    return f"{tag} {numba.__version__} {llvmlite.__version__}"


def used() -> set[str]:
    """Names of the files that this process has loaded or written."""
    return set(_used)


class KernelCache:
    """Numba's interface for saving and loading compiled code. Numba's own cache is per file, and does not
    notice changes in kernels of other files."""

    def __init__(self, function: Callable, options: dict[str, Any], kernel: Dispatcher | None = None) -> None:
        self._function, self._options, self._kernel = function, options, kernel
        self._name = f"{function.__module__}.{function.__qualname__}".replace("<", "").replace(">", "")

    @property
    def cache_path(self) -> str:
        """The folder, for Numba's statistics."""
        return str(cache_folder())

    def load_overload(self, signature: Any, target: Any) -> CompileResult | None:
        """Cached code for a signature. None if there is none: this process then holds the turn to compile it,
        until `save_overload` or failure."""
        target.refresh()
        file = self._file(signature, target.codegen())
        if file is None:
            return None
        found = self._load(file, target)
        if found is None:
            _turns.take(file, self._kernel)
            found = self._load(file, target)  # another process compiled it meanwhile
            if found is not None:
                _turns.give_back(file)
        return found

    def save_overload(self, signature: Any, compiled: CompileResult) -> None:
        """Save the compiled code of a signature."""
        if self._kernel is not None:
            linking.keep_apart(compiled, self._kernel, signature)
        file = self._file(signature, compiled.codegen)
        if file is None:
            return
        try:
            if not compiled.library.has_dynamic_globals and not any(
                not each.can_cache for each in compiled.lifted
            ):
                write_whole(file, dumps(signature) + dumps(linking.reduce(compiled)))
                _used.add(file.name)
        finally:
            _turns.give_back(file)

    def enable(self) -> None:
        """Numba may ask for it; always on."""

    disable = flush = enable

    def kept_signatures(self, target: Any) -> Iterator[Any]:
        """Signatures with cached code."""
        for _, signature in self.kept(target):
            yield signature

    def kept(self, target: Any) -> Iterator[tuple[Path, Any]]:
        """Files of cached code and their signatures."""
        folder = cache_folder()
        for file in folder.glob(f"{self._stem(target.codegen())}-*{_SUFFIX}") if folder is not None else ():
            with suppress(Exception):
                with file.open("rb") as opened:
                    signature = pickle.load(opened)
                yield file, signature

    def _file(self, signature: Any, codegen: Any) -> Path | None:
        folder = cache_folder()
        if folder is None:
            return None
        kinds = signature if isinstance(signature, tuple) else (*signature.args, signature.return_type)
        types = _short("\0".join(digest_of_type(kind) for kind in kinds))
        return folder / f"{self._stem(codegen)}-{types}{_SUFFIX}"

    def _stem(self, codegen: Any) -> str:
        """Prefix of this kernel's file names: the kernel, the machine."""
        options = repr(sorted(self._options.items()))
        parts = _versions(), repr(codegen.magic_tuple()), options, digest_of_code(self._function)
        return f"{self._name}-{_short(chr(0).join(parts))}"

    def _load(self, file: Path, target: Any) -> CompileResult | None:
        try:
            data = file.read_bytes()
        except OSError:
            return None
        try:
            stream = io.BytesIO(data)
            pickle.load(stream)  # the signature
            compiled = linking.rebuild(target, pickle.load(stream))
        except Exception:  # another version, cut off, or a kernel that it calls is missing
            return None
        note_use(file)
        _used.add(file.name)
        return compiled


def _short(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]
