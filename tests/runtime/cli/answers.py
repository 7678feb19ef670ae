"""What a command leaves and says."""


def names(folder):
    return sorted(each.name for each in folder.iterdir())


def one_line(message):
    """Whether one line, the last, says what is wrong; those before it tell how far the command was."""
    *before, last = message.splitlines()
    told = any("surefoot: " in line or "Traceback" in line for line in before)
    return last.startswith("surefoot: ") and message.endswith("\n") and not told
