#!/bin/sh
# Makes the virtual environment FOLDER with this package and the given extras: environment.sh FOLDER [EXTRAS]
# Needs Python 3.11 or later, and nothing else: on a Debian without python3-venv it installs that first.
set -eu

folder=$1
extras=${2:-}
python=${PYTHON:-python3}
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)

if ! "$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
    echo "surefoot: $python is not a Python 3.11 or later; say which one to use: make PYTHON=/path/to/python3" >&2
    exit 2
fi

can() {
    "$python" -c "import $1" 2>/dev/null
}

# Debian's Python comes without ensurepip, so that "python3 -m venv" fails until python3-venv is there.
install_venv() {
    command -v apt-get >/dev/null || return 1
    as_root=
    if [ "$(id -u)" != 0 ]; then
        as_root='sudo -n'
        $as_root true 2>/dev/null || return 1
    fi
    version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    echo "== installing Debian's python$version-venv"
    $as_root apt-get update -qq && $as_root apt-get install -qq -y "python$version-venv" >/dev/null
}

if [ ! -x "$folder/bin/python" ]; then
    echo "== making the environment $folder"
    rm -rf "$folder"
    if can 'ensurepip, venv'; then
        "$python" -m venv "$folder"
    elif can virtualenv; then
        "$python" -m virtualenv --quiet "$folder"
    elif can 'venv, pip'; then
        "$python" -m venv --without-pip "$folder"
    elif install_venv && can 'ensurepip, venv'; then
        "$python" -m venv "$folder"
    else
        echo "surefoot: $python has neither venv (ensurepip) nor virtualenv nor pip to make an environment with." >&2
        echo "          On Debian: apt install python3-venv. Or name another Python: make PYTHON=/path/to/python3" >&2
        exit 2
    fi
fi

# --no-compile: Python compiles what is imported, which is a fraction of what is installed
echo "== installing Surefoot and what it needs into $folder (some minutes)"
if "$folder/bin/python" -c 'import pip' 2>/dev/null; then
    "$folder/bin/python" -m pip install --quiet --no-compile --disable-pip-version-check -e "$root$extras"
else
    "$python" -m pip --python "$folder/bin/python" install --quiet --no-compile --disable-pip-version-check -e "$root$extras"
fi
