"""`surefoot dis`, and `--dis` of other commands: what they do and refuse."""

import json
import threading

import pytest

from runtime.cli.app import main
from runtime.dis.pcap import Packet, read_pcap, write_pcap
from runtime.dis.udp import Udp
from tests.runtime.dis.entities import entity


def run(*arguments):
    with pytest.raises(SystemExit) as end:
        main(list(map(str, arguments)))
    return end.value.code


@pytest.fixture
def packets(tmp_path):
    made = [Packet(k * 0.01, entity((k, 2.0, 0.0), (1.0, 0, 0), stamp=k, marking=b"ada")) for k in range(5)]
    made += [Packet(0.05, entity((1.0, 2.0, 0.0), number=2) * 2), Packet(0.06, b"junk"), Packet(0.06, b"")]
    write_pcap(tmp_path / "some.pcap", made)
    return tmp_path / "some.pcap"


def test_packets_are_listed(packets, capsys):
    assert run("dis", "show", packets, "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert [each["entity"] for each in found["entities"]] == ["9:8:1", "9:8:2"]
    ada, other = found["entities"]
    assert (ada["marking"], ada["packets"], ada["looks"]) == ("ada", 5, "standing") and other["packets"] == 2
    assert ada["latitude"] == pytest.approx(48.137, abs=1e-3) and found["others"] == {"cut off": 2}
    assert run("dis", "show", packets) == 0 and "9:8:1" in capsys.readouterr().out


def test_packets_are_sent_again_and_recorded(packets, tmp_path, capsys):
    """Recorded by the kernel until the command looks at them."""
    listener = Udp(("127.0.0.1", 0))
    assert run("dis", "replay", packets, "--address", f"127.0.0.1:{listener.port}", "--speed", "100") == 0
    data = [each for each, _ in listener.received()]
    assert data == [each.data for each in read_pcap(packets)]
    port = listener.port
    listener.close()
    sender = Udp(("127.0.0.1", port), listen=("127.0.0.1", 0))
    timer = threading.Timer(0.2, sender.send, [[b"hello"]])
    timer.start()
    new = tmp_path / "new.pcap"
    assert run("dis", "record", new, "--address", f"127.0.0.1:{port}", "--seconds", "0.6") == 0
    timer.join()
    sender.close()
    assert [each.data for each in read_pcap(new)] == [b"hello"]
    assert "1 packet" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("dis", "show", "nowhere.pcap"), "nowhere.pcap: No such file"),
        (("dis", "replay", "some.pcap", "--address", "here"), "expected an IPv4 address and a port"),
        (("dis", "replay", "some.pcap", "--speed", "0"), "speed must be above 0"),
        (("dis", "record", "new.pcap", "--seconds", "nan"), "seconds must be above 0"),
        (("dis", "record", "new.pcap", "--address", "239.1.1.1:3000"), "ask for multicast"),
        (
            ("run", "mission.yaml", "--dis", "127.0.0.1:3000", "--dis-name", "1:1"),
            "expected SITE:APPLICATION",
        ),
        (("run", "mission.yaml", "--dis", "127.0.0.1:3000", "--dis-origin", "91", "0", "0"), "latitude"),
    ],
)
def test_wrong_input_is_refused(folder, packets, monkeypatch, capsys, arguments, says):
    monkeypatch.chdir(folder)
    assert run(*arguments) == 2
    assert says in capsys.readouterr().err
