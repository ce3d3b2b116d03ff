"""How a study runs: targets, reruns, the same bytes, kill and resume, damaged files."""

import os
import re
import signal
import subprocess
import time

import pytest

from tests.workflow.conftest import TINY


def jobs(output):
    """Return {rule: count} from Snakemake's job statistics of a dry run."""
    table = re.search(r"count\n[- ]+\n(.*?)\ntotal", output, re.DOTALL)
    return {rule: int(count) for rule, count in (line.split() for line in table[1].splitlines())} if table else {}


def test_nothing_to_do(finished):
    assert "Nothing to be done" in finished.ok("-n")


def test_the_same_bytes_on_one_core_and_in_another_folder(finished, study):
    study.ok(cores=1)
    mine, other = (each.files("points", "summary", "figures") for each in (study, finished))
    assert len(mine) == 16 + 18 + 30
    assert mine.keys() == other.keys()
    assert [name for name in mine if mine[name] != other[name]] == []


def test_one_point_by_its_path_and_by_hand(finished, study):
    target = "results/tiny/points/linearized/plus/a0.0800.nc"
    output = study.ok(target, "-p")
    assert list(study.files("points")) == ["points/linearized/plus/a0.0800.nc"]
    made = (study.folder / target).read_bytes()
    assert made == (finished.folder / target).read_bytes()
    command = re.search(r"bk simulate .*", output)[0].split(" 2> ")[0].split()
    (study.folder / target).unlink()
    command[0] = os.path.join(os.path.dirname(study.command()[0]), "bk")
    subprocess.run(command, check=True, cwd=study.folder)
    assert (study.folder / target).read_bytes() == made


def test_stage_targets(study):
    assert set(jobs(study.ok("points", "-n"))) == {"simulate", "points"}
    assert {"simulate", "mean_distance", "bifurcation", "agreement"} < set(jobs(study.ok("summary", "-n")))
    assert "figure_agreement" in jobs(study.ok("figures", "-n"))


def test_one_rule_again(copy):
    planned = jobs(copy.ok("-n", "-R", "agreement"))
    assert "simulate" not in planned
    assert planned["agreement"] == planned["figure_agreement"] == 1


def test_a_key_of_the_summaries_reruns_no_simulation(copy):
    copy.config.write_text(TINY + "synchronization_threshold: 0.01\n")
    planned = jobs(copy.ok("-n"))
    assert "simulate" not in planned
    assert "bifurcation" not in planned
    assert {"mean_distance", "agreement", "figure_mean_distance", "figure_agreement"} <= set(planned)


def test_a_key_of_the_simulations_reruns_them(copy):
    copy.config.write_text(TINY + "sampling: 2\n")
    assert jobs(copy.ok("-n"))["simulate"] == 16


def test_a_wider_grid_keeps_the_points_that_are_there(copy):
    copy.config.write_text(TINY.replace("[0.05,", "[0.05, 0.06,"))
    assert jobs(copy.ok("-n"))["simulate"] == 4


@pytest.mark.parametrize("delay", [0.0, 0.7, 3.0])
def test_killed_and_resumed(finished, study, delay):
    """After SIGKILL of the whole process group the next run ends with the bytes of an undisturbed one."""
    process = subprocess.Popen(
        study.command(), cwd=study.folder, start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    points = study.folder / "results" / "tiny" / "points"
    while process.poll() is None and not list(points.rglob("a*.nc")):
        time.sleep(0.01)
    time.sleep(delay)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    before = study.files("points") if points.exists() else {}
    assert all(content == finished.files("points").get(name) for name, content in before.items() if "/a" in name)
    study.ok("--unlock")
    study.ok()
    mine, other = (each.files("points", "summary", "figures") for each in (study, finished))
    assert {name: content for name, content in mine.items() if "/." not in name} == other


@pytest.mark.parametrize("damage", ["truncated", "empty", "noise", "other"])
def test_a_damaged_point_stops_its_summaries(copy, damage):
    path = copy.folder / "results" / "tiny" / "points" / "nonlinear" / "minus" / "a0.0500.nc"
    content = path.read_bytes()
    other = path.with_name("a0.0800.nc").read_bytes()
    path.write_bytes(
        {"truncated": content[: len(content) // 2], "empty": b"", "noise": os.urandom(5000), "other": other}[damage]
    )
    run = copy.run("-R", "mean_distance", "--rerun-triggers", "params", "--until", "mean_distance")
    assert run.returncode != 0
    assert not (copy.folder / "results" / "tiny" / "summary" / "mean_distance.nc").exists()
    log = (copy.folder / "results" / "tiny" / "logs" / "mean_distance.log").read_text().strip().splitlines()[-1]
    assert "points/nonlinear/minus/a0.0500.nc" in log
    assert "delete it and run snakemake again" in log
    path.unlink()
    copy.ok()
    assert path.read_bytes() == content


def test_the_default_config_is_not_merged_into_another(study):
    """Only the given file counts: no value of config/paper.yaml may leak into a study that leaves a key out."""
    assert jobs(study.ok("-n"))["simulate"] == 16
