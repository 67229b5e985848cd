"""Who may talk to the lab's server, how much, and what becomes of what is wrong. It listens, as it does for a user."""

import http.client
import json
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from contextlib import ExitStack, closing
from importlib import resources
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from bounce_env.commands import BAD_USAGE, main
from bounce_env.lab.guard import POLICY
from bounce_env.lab.server import FILES, LARGEST_MESSAGE, MOST_SESSIONS, PAGES
from tests.lab.serving import serving
from tests.vendored import check_vendored

pytestmark = pytest.mark.fast

REFLECT = {
    "do": "reflect", "movement": [[0, 1], [1, -1]], "wall": [[-1, 0], [2, 0]], "movement_b": 1, "movement_f": 1,
    "wall_b": 1, "wall_f": 1, "radius": 0,
}  # fmt: skip


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    with serving(tmp_path_factory.mktemp("scenes")) as running:
        yield running


def get(server, path, **headers):
    """Status, headers and text of an answer; the Host is the server's own unless another is given."""
    with closing(http.client.HTTPConnection("127.0.0.1", server.port, timeout=10)) as connection:
        connection.putrequest("GET", path, skip_host=True)
        for name, value in {"Host": f"localhost:{server.port}", **headers}.items():
            connection.putheader(name, value)
        connection.endheaders()
        answer = connection.getresponse()
        return answer.status, answer.headers, answer.read().decode()


def cookie_of(server):
    address = urlsplit(server.address())
    status, headers, _ = get(server, f"{address.path}?{address.query}")
    assert status == 303
    assert headers["Location"] == "/"
    assert re.fullmatch(r"bounce_lab_\d+=[\w-]+; HttpOnly; Path=/; SameSite=strict", headers["Set-Cookie"])
    return headers["Set-Cookie"].partition(";")[0]


def talk(server, cookie, room="reflection", origin=None):
    host = f"127.0.0.1:{server.port}"
    return connect(
        f"ws://127.0.0.1:{server.port}/{room}/socket", max_size=None, open_timeout=10, close_timeout=1,
        additional_headers={"Cookie": cookie} if cookie else {},
        origin=f"http://{host}" if origin is None else origin or None,
        compression=None,
    )  # fmt: skip


def test_the_first_address_is_swapped_for_a_cookie_and_pages_are_served(server):
    cookie = cookie_of(server)
    for path in PAGES:
        status, headers, text = get(server, path, Cookie=cookie)
        assert status == 200
        assert headers["Content-Security-Policy"] == POLICY
        assert headers["Cache-Control"] == "no-store"
        assert not re.search(r"<script(?![^>]*src=)|<style|\sstyle=|\son\w+=|https?://", text)
        for reference in re.findall(r'(?:src|href)="(/[^"]*)"', text):
            assert get(server, reference, Cookie=cookie)[0] == 200


def test_every_file_is_served_and_nothing_else(server):
    cookie = cookie_of(server)
    for path, file in FILES.items():
        if not file.name.endswith(".html"):
            assert get(server, path, Cookie=cookie)[2] == file.read_text(encoding="utf-8")
    for path in ("/../server.py", "/pages/stage.js", "/%2e%2e/guard.py", "/vendored.toml", "/..%2f..%2fpyproject.toml"):
        assert get(server, path, Cookie=cookie)[0] == 404


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:{port}", "localhost.evil.example:{port}", "", "10.0.0.1"]
)
def test_a_foreign_host_is_refused(server, host):
    host = host.format(port=server.port)
    status, _, text = get(server, "/", Host=host, Cookie=cookie_of(server))
    assert status == 403
    assert text.startswith(f"refused: Host {host!r}: must be one of localhost")


@pytest.mark.parametrize("host", ["localhost:{port}", "127.0.0.1:{port}", "[::1]:{port}", "localhost:1", "localhost"])
def test_the_names_of_this_machine_are_let_in_with_any_port(server, host):
    assert get(server, "/", Host=host.format(port=server.port), Cookie=cookie_of(server))[0] == 200


def test_without_the_cookie_nothing_is_served_and_a_wrong_token_gives_none(server):
    for path in ("/", "/stage.js", "/?token=", "/?token=wrong"):
        status, headers, text = get(server, path)
        assert status == 403
        assert "no cookie of this lab" in text
        assert "Set-Cookie" not in headers
    with pytest.raises(InvalidStatus):
        talk(server, None)


@pytest.mark.parametrize("origin", ["http://evil.example", "", "null", "http://localhost:1"])
def test_a_foreign_origin_is_refused(server, origin):
    cookie = cookie_of(server)
    with pytest.raises(InvalidStatus):
        talk(server, cookie, origin=origin)
    if origin:
        assert get(server, "/", Cookie=cookie, Origin=origin)[0] == 403
    assert get(server, "/", Cookie=cookie, Origin=f"http://localhost:{server.port}")[0] == 200


def test_other_cookies_of_this_host_hide_nothing(server):
    cookie = cookie_of(server)
    for others in ('foo={"a":1}; {}', "{}; a b=c", "word; {}", 'g_state={"i_l":0}; {}; x'):
        assert get(server, "/", Cookie=others.replace("{}", cookie))[0] == 200


def test_the_token_leads_nowhere_else_and_every_answer_has_the_headers(server):
    token = urlsplit(server.address()).query
    assert get(server, f"//evil.example/x?{token}")[1]["Location"] == "/evil.example/x"
    cookie = cookie_of(server)
    for path in ("/", "/nothing", "/stage/", "/stage.js"):
        assert get(server, path, Cookie=cookie)[1]["Content-Security-Policy"] == POLICY
    assert get(server, "/")[1]["Content-Security-Policy"] == POLICY


def test_whoever_listens_everywhere_is_reached_by_name_and_address(tmp_path):
    with serving(tmp_path, host="0.0.0.0") as server:
        assert urlsplit(server.address()).hostname == socket.gethostname().lower()
        cookie = cookie_of(server)
        for host, status in (
            (f"192.0.2.2:{server.port}", 200),
            ("[2001:db8::1]:80", 200),
            (socket.gethostname().upper(), 200),
            ("evil.example", 403),
        ):
            assert get(server, "/", Host=host, Cookie=cookie)[0] == status


def test_a_tab_that_waits_for_kernels_keeps_nobody_else_and_ends_when_it_is_closed(tmp_path):
    free = threading.Event()
    with serving(tmp_path, ready=lambda wanted: free.wait()) as server:
        cookie = cookie_of(server)
        for _ in range(MOST_SESSIONS + 4):
            with talk(server, cookie, "stage") as tab:
                tab.send('{"do": "open"}')
                time.sleep(0.05)
        assert answered_once(server, cookie)["dp1"] == 1.0
        with talk(server, cookie, "stage") as tab:
            tab.send('{"do": "open"}')
            time.sleep(0.1)
            began = time.monotonic()
            server.stop()
            with pytest.raises(ConnectionClosed):
                tab.recv(timeout=20)
            assert time.monotonic() - began < 10.0
    free.set()


def test_a_message_is_answered_and_a_malformed_one_told_its_place(server):
    with talk(server, cookie_of(server)) as tab:
        for message, words in (
            (json.dumps(REFLECT), None),
            (json.dumps({**REFLECT, "radius": -1}), "radius = -1"),
            ("{", "Invalid JSON"),
            (b"\x00", "Invalid JSON"),
            ("[" * 100_000, "message"),
            (json.dumps(REFLECT) + " " * (LARGEST_MESSAGE // 2), None),
        ):
            tab.send(message)
            answer = json.loads(tab.recv(timeout=10))
            assert (words is None) == ("error" not in answer)
            assert words is None or words in answer["error"]


def test_a_message_of_ten_megabytes_ends_the_session_and_no_other(server):
    cookie = cookie_of(server)
    with talk(server, cookie) as other, talk(server, cookie) as tab:
        assert ends_by(tab, " " * (10 * LARGEST_MESSAGE))
        other.send(json.dumps(REFLECT))
        assert "error" not in json.loads(other.recv(timeout=10))


def ends_by(tab, message):
    """Whether a session ends while a message is sent, or when it has been."""
    try:
        tab.send(message)
        tab.recv(timeout=10)
    except ConnectionClosed:
        return True
    return False


def test_there_are_so_many_sessions_and_a_closed_tab_makes_room(server):
    cookie = cookie_of(server)
    with ExitStack() as tabs:
        for _ in range(MOST_SESSIONS - 1):
            tabs.enter_context(talk(server, cookie))
        with talk(server, cookie):
            with talk(server, cookie) as one_more, pytest.raises(ConnectionClosed) as closed:
                one_more.recv(timeout=10)
            assert closed.value.rcvd.code == 1013
            assert "8 tabs are open" in closed.value.rcvd.reason
        deadline = time.monotonic() + 10.0
        while (answer := answered_once(server, cookie)) is None:
            assert time.monotonic() < deadline
        assert answer["dp1"] == 1.0


def answered_once(server, cookie):
    """What a new tab is answered; None where there is no room for it."""
    with talk(server, cookie) as tab:
        try:
            tab.send(json.dumps(REFLECT))
            return json.loads(tab.recv(timeout=10))
        except ConnectionClosed:
            return None


def test_a_malformed_scene_is_told_its_line(tmp_path):
    (tmp_path / "wrong.toml").write_text('[[elements]]\ntype = "wall"\nstart = [0, 0]\nend = [0, "x"]\n')
    with serving(tmp_path) as server, talk(server, cookie_of(server), "stage") as tab:
        tab.send(json.dumps({"do": "load", "name": "wrong", "builtin": False}))
        assert re.search(r"wrong\.toml:4: elements\[0\] \(wall\): end", json.loads(tab.recv(timeout=60))["error"])
        tab.send(json.dumps({"do": "load", "name": "../wrong", "builtin": False}))
        assert "load.name = '../wrong'" in json.loads(tab.recv(timeout=60))["error"]


def test_what_others_have_made_is_there_unchanged_with_its_licence():
    check_vendored(Path(str(resources.files("bounce_env.lab") / "vendor")))


def test_the_command_refuses_what_it_cannot_do(tmp_path, capsys, server):
    for words, message in (
        (["lab", "--folder", str(tmp_path / "none")], "none: must be a folder that is there"),
        (["lab", "--port", "70000"], "--port 70000: must be from 0 to 65535"),
        (["lab", "stage", "nothing"], "scene 'nothing': must be one of"),
        (["lab", "--port", str(server.port), "--no-open"], f"--port {server.port}: cannot be listened to"),
    ):
        assert main(words) == BAD_USAGE
        assert message in capsys.readouterr().err


@pytest.mark.skipif(sys.platform == "win32", reason="Ctrl-C is another thing there")
def test_ctrl_c_ends_the_server_with_a_tab_open(tmp_path):
    command = [sys.executable, "-m", "bounce_env", "lab", "--no-open", "--port", "0", "--folder", str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as lab:
        address = urlsplit(lab.stdout.readline().strip())
        port = address.port
        with closing(http.client.HTTPConnection("127.0.0.1", port, timeout=30)) as connection:
            connection.request("GET", f"/?{address.query}")  # it listens before it prints its address
            cookie = connection.getresponse().headers["Set-Cookie"].partition(";")[0]
        headers = {"Cookie": cookie}
        with connect(
            f"ws://127.0.0.1:{port}/reflection/socket", origin=f"http://127.0.0.1:{port}", additional_headers=headers
        ) as tab:
            tab.send(json.dumps(REFLECT))
            tab.recv(timeout=10)
            lab.send_signal(signal.SIGINT)
            out, err = lab.communicate(timeout=30)
    assert lab.returncode in (0, 130), err
    assert "Traceback" not in out + err
