import pytest

from runtime.cli.app import main


@pytest.fixture
def surefoot(capsys):
    """Runs the command in this process; returns exit code, standard output, standard error."""

    def call(*arguments):
        with pytest.raises(SystemExit) as left:
            main([str(each) for each in arguments])
        output = capsys.readouterr()
        return left.value.code, output.out, output.err

    return call
