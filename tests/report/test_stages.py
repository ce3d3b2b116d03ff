"""Run times of a report: sums over the benchmark files of a stage."""

import pytest

from burridge_knopoff.report.stages import read_stages

HEADER = "s\th:m:s\tmax_rss\tmax_vms\tmax_uss\tmax_pss\tio_in\tio_out\tmean_load\tcpu_time\n"


def test_run_times_are_sums_over_the_files_of_a_stage(tmp_path):
    def write(name, *rows):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(HEADER + "".join(f"{row}\n" for row in rows))

    write("simulate/linearized/minus/a0.1.tsv", "0.18\t0:00:00\t10.5\t1\t1\t10.25\t0\t0\t0.00\t0.00")
    write("simulate/linearized/minus/a0.2.tsv", "0.5\t0:00:00\tNA\tNA\tNA\tNA\tNA\tNA\tNA\tNA")
    write("simulate/linearized/minus/a0.3.tsv", "2.0\t0:00:02\t160.0\t1\t1\t80.0\t0\t0\t90\t1.75")
    write("basins/linearized/a0.1/tile0.tsv", "5.0\t0:00:05\t100\t1\t1\t100\t0\t0\t90\t4.5")
    write("basins.tsv", "1.0\t0:00:01\t250\t1\t1\t200\t0\t0\t90\t0.5")
    write("figure_one.tsv", "1.5\t0:00:01\t50\t1\t1\tNA\t0\t0\t90\t-")
    write("figure_two.tsv", "0.5\t0:00:01\t60\t1\t1\t0.0\t0\t0\t90\t-")
    write("report.tsv", "9.0\t0:00:09\t900\t1\t1\t1\t0\t0\t90\t9")
    (tmp_path / "empty.tsv").write_text("")
    (tmp_path / "noise.tsv").write_bytes(b"\xff\xfe\x00")
    rows = [(s.name, s.jobs, s.wall, s.cpu, s.cpu_jobs, round(s.memory, 6)) for s in read_stages(tmp_path)]
    assert rows == [
        ("basins", 2, 6.0, 5.0, 2, 209.7152),
        ("simulate", 3, pytest.approx(2.68), 1.75, 1, 83.88608),
        ("figures", 2, 2.0, 0.0, 0, 62.91456),
    ]
    assert read_stages(tmp_path / "missing") == []
