"""Scripts in forks of a process: they start, work and end as in processes of their own."""

import os
import signal
import subprocess
import sys
import threading
import time

import psutil
import pytest

from burridge_knopoff.script_server import ScriptServer

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux forks a process that has loaded libraries")


@pytest.fixture(scope="module")
def shared():
    """A server for tests that do not harm it."""
    return ScriptServer()


@pytest.fixture
def run(shared, tmp_path):
    """A function that runs the text of a script, with some variables, in a fork."""

    def run(text, modules=(), environment=None, **variables):
        script = tmp_path / "script.py"
        script.write_text(text)
        return shared.begin(script, variables, modules, environment or {}).run()

    return run


def wait_for(condition):
    end = time.monotonic() + 60.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


ENDS = [
    "",
    "import sys; sys.exit()",
    "import sys; sys.exit(3)",
    "import sys; sys.exit(256)",
    "import sys; sys.exit('words')",
    "import nothing",
    "raise ValueError('two\\nlines')",
    "raise KeyboardInterrupt",
    "import os; os._exit(7)",
    "import os, signal; os.kill(os.getpid(), signal.SIGKILL)",
    "import os, signal; os.kill(os.getpid(), signal.SIGTERM)",
    "import os; os.abort()",
    "import ctypes; ctypes.string_at(0)",
]


@pytest.mark.parametrize("text", ENDS)
def test_exit_codes_and_last_words_are_those_of_python(run, tmp_path, text):
    log = tmp_path / "log"
    words = f"import sys; sys.stderr = open({str(log)!r}, 'w')\n{text}"
    code, logged = run(words).code, log.read_text()
    python = subprocess.run([sys.executable, str(tmp_path / "script.py")])
    # It ends itself by the signal of Ctrl-C.
    assert code == (1 if python.returncode == -signal.SIGINT else python.returncode)
    assert logged == log.read_text()


def test_variables_and_environment_are_those_of_the_job(run, tmp_path, monkeypatch):
    out = tmp_path / "out"
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    text = """
import os, sys, tempfile, __main__
values = [os.environ["OMP_NUM_THREADS"], tempfile.gettempdir(), *sys.argv, __file__, __name__, number, os.getcwd()]
open(out, "w").write("\\n".join(map(str, values)))
"""
    for threads, folder in (("3", tmp_path), ("5", tmp_path.parent)):
        end = run(text, ["tempfile"], {"OMP_NUM_THREADS": threads, "TMPDIR": str(folder)}, out=str(out), number=0.1)
        script = str(tmp_path / "script.py")
        assert end.code == 0
        assert out.read_text().split("\n") == [threads, str(folder), script, script, "__main__", "0.1", os.getcwd()]
    assert "OMP_NUM_THREADS" not in os.environ


def test_what_is_registered_for_the_exit_is_done(run, tmp_path):
    out = tmp_path / "out"
    text = "import atexit; file = open(out, 'w'); atexit.register(file.write, 'done'); raise ValueError"
    assert run(f"import sys; sys.stderr = open({os.devnull!r}, 'w'); {text}", out=str(out)).code == 1
    assert out.read_text() == "done"


def test_a_temporary_folder_of_matplotlib_is_that_of_all_scripts(tmp_path, monkeypatch):
    """It makes one, and a font cache, where it cannot write; a script that ends must not remove it."""
    monkeypatch.setenv("MPLCONFIGDIR", "/dev/null/none")
    server, script, out = ScriptServer(), tmp_path / "script.py", tmp_path / "out"
    script.write_text(
        "import sys; sys.stderr = open(log, 'w'); import matplotlib as m; open(out, 'w').write(m.get_cachedir())"
    )
    folders = set()
    for log in (tmp_path / "first", tmp_path / "second"):
        process = server.begin(script, {"out": str(out), "log": str(log)}, ["matplotlib"], {})
        assert process.run().code == 0
        assert log.read_text() == ""
        folders.add(out.read_text())
    (folder,) = folders
    assert os.path.isdir(folder)


def test_all_cpu_time_is_measured(run, tmp_path):
    """Also that of processes which end early, and of those that they have waited for."""
    out = tmp_path / "out"
    text = """
import os, time
def burn(seconds):
    while time.process_time() < seconds:
        pass
for _ in range(3):
    if not os.fork():
        if not os.fork():
            burn(0.1)
            os._exit(0)
        os.wait()
        os._exit(0)
    os.wait()
block = bytearray(300 << 20)
open(out, "w").write(str(sum(os.times()[:4])))
"""
    end = run(text, out=str(out))
    assert end.code == 0
    assert 0.25 < float(out.read_text()) - 0.02 <= end.seconds < float(out.read_text()) + 0.5
    assert 300 < end.memory < 600


@pytest.mark.parametrize("count", [40, pytest.param(400, marks=pytest.mark.slow)])
def test_hundreds_of_scripts_at_a_time(shared, tmp_path, count):
    script = tmp_path / "script.py"
    script.write_text("import sys; open(f'{folder}/{number}', 'w').write(words); sys.exit(number % 7)")
    # More than the buffer of a socket holds.
    words, ends = "x" * 500_000, {}

    def work(first):
        for number in range(first, count, 8):
            variables = {"folder": str(tmp_path), "number": number, "words": words if number % 40 == 0 else f"{number}"}
            ends[number] = shared.begin(script, variables, ["burridge_knopoff.job"], {}).run().code

    threads = [threading.Thread(target=work, args=[first]) for first in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert ends == {number: number % 7 for number in range(count)}
    assert all((tmp_path / f"{number}").read_text() in (words, f"{number}") for number in range(count))
    server = psutil.Process(shared.pid)
    wait_for(lambda: not server.children())
    assert server.num_threads() == 1
    assert server.num_fds() < 20


def test_a_killed_server_fails_no_script(tmp_path):
    """Those that run end as ever, and the next one has another server."""
    server, script = ScriptServer(), tmp_path / "script.py"
    script.write_text("import os, time; open(begun, 'w'); time.sleep(0.3); os._exit(code)")
    numbers = set()
    for code in (0, 3):
        begun = tmp_path / f"begun{code}"
        process = server.begin(script, {"begun": str(begun), "code": code}, [], {})
        ends = []
        thread = threading.Thread(target=lambda process=process, ends=ends: ends.append(process.run().code))
        thread.start()
        wait_for(begun.exists)
        os.kill(server.pid, signal.SIGKILL)
        thread.join()
        assert ends == [code]
        numbers.add(server.pid)
    assert len(numbers) == 2


def test_a_script_without_its_waiting_process_has_failed(run, tmp_path):
    """It is not known how it ended."""
    assert run("import os, signal; os.kill(os.getppid(), signal.SIGKILL)").code == -signal.SIGKILL


def test_ctrl_c_ends_scripts_and_the_server_stays(tmp_path):
    """Also those that were asked for before it and begin after it."""
    server, script = ScriptServer(), tmp_path / "script.py"
    script.write_text("import sys, time; sys.stderr = open(log, 'w'); open(begun, 'w'); time.sleep(60)")
    log, begun = tmp_path / "log", tmp_path / "begun"
    variables = {"log": str(log), "begun": str(begun)}
    process = server.begin(script, variables, [], {})
    threading.Thread(target=lambda: (wait_for(begun.exists), os.kill(process.pid, signal.SIGINT))).start()
    assert process.run().code == 1
    assert log.read_text().endswith("KeyboardInterrupt\n")
    log.unlink()
    os.kill(server.pid, signal.SIGINT)
    assert server.begin(script, variables, [], {}).run().code == 1
    assert not log.exists()
    assert psutil.pid_exists(server.pid)


@pytest.mark.slow
def test_the_server_ends_with_its_parent(tmp_path):
    """Also if that is killed."""
    text = """
import os, signal, sys
from pathlib import Path
from burridge_knopoff.script_server import ScriptServer
server = ScriptServer()
assert server.begin(Path(sys.argv[1]), {}, [], {}).run().code == 0
print(server.pid, flush=True)
if sys.argv[2] == "killed":
    os.kill(os.getpid(), signal.SIGKILL)
"""
    (tmp_path / "script.py").write_text("")
    for end in ("killed", "regular"):
        command = [sys.executable, "-c", text, str(tmp_path / "script.py"), end]
        number = int(subprocess.run(command, stdout=subprocess.PIPE, text=True).stdout)
        wait_for(lambda number=number: not psutil.pid_exists(number))
