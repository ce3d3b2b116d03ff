"""The pieces of a report, each against what it is made from."""

import base64
import io
import json

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_rgb
from PIL import Image

from burridge_knopoff.claims.ledger import as_json
from burridge_knopoff.figures.branches import COLORS
from burridge_knopoff.provenance.seal import BadFile
from burridge_knopoff.report.basin_maps import basin_maps
from burridge_knopoff.report.numbers import embedded_json, exact, rounded, text, with_error
from burridge_knopoff.report.pictures import THUMBNAIL_WIDTH, read_picture
from burridge_knopoff.report.prose import prose
from burridge_knopoff.report.runs import Commands, embedded_runs
from burridge_knopoff.report.section_points import BINS, section_counts
from burridge_knopoff.report.stages import read_stages
from burridge_knopoff.report.verdicts import SIGNS, read_verdicts
from tests.report.conftest import CLAIMS

HEADER = "s\th:m:s\tmax_rss\tmax_vms\tmax_uss\tmax_pss\tio_in\tio_out\tmean_load\tcpu_time\n"


@pytest.mark.parametrize(
    ("value", "error", "shown"),
    [
        (0.1406405951036813, 9.536125729144747e-06, "0.1406406 ± 9.5e−06"),
        (0.0869729046661, 9.3e-14, "0.0869729046661 ± 9.3e−14"),
        (0.08697290466607812, 9.3e-14, "0.086972904666078 ± 9.3e−14"),
        (0.08625, 0.00125, "0.08625 ± 0.00125"),
        (0.5, 0.0123456, "0.500 ± 0.012"),
        (0.49999711, 8.5e-7, "0.49999711 ± 8.5e−07"),
        (-2.5, 0.25, "−2.50 ± 0.25"),
        (1234.5, 99.63, "1230 ± 100"),
        (1234567.0, 250.0, "1234570 ± 250"),
        (6.86e-15, 2.7e-19, "(6.86000 ± 0.00027)e−15"),
        (0.0, 3e-9, "(0.0 ± 3.0)e−9"),
        (0.0025, None, "0.0025"),
        (0.5, 0.0, "0.5"),
        (float("nan"), 1.0, "–"),
        (None, None, "–"),
        (13, None, "13"),
        ("chaotic", None, "chaotic"),
    ],
)
def test_a_value_has_the_decimals_of_its_error(value, error, shown):
    assert with_error(value, error) == shown


def test_what_is_not_finite_is_no_number_of_json():
    assert rounded(np.array([[1.23456789, np.nan], [np.inf, 0.0]])) == [[1.23457, None], [None, 0.0]]
    assert [exact(value) for value in (-np.inf, np.nan, 0.1)] == ["−∞", None, 0.1]
    assert text(float("-inf")) == "−∞"
    with pytest.raises(ValueError, match="not JSON compliant"):
        embedded_json([float("nan")])


def test_json_cannot_end_its_element():
    data = {"</script><!--": ["&amp;", "\u2028", "a > b", "⟨J⟩"]}
    embedded = embedded_json(data)
    assert not set("<>&\u2028") & set(embedded)
    assert json.loads(embedded) == data


def test_prose_adds_subscripts_and_code_to_escaped_text():
    assert prose("U_1(0) < a_c of `one_sided`, one_sided & a_digits, μ_x <b>") == (
        "U<sub>1</sub>(0) &lt; a<sub>c</sub> of <code>one_sided</code>, one_sided &amp; a_digits, μ<sub>x</sub> "
        "&lt;b&gt;"
    )


def test_verdicts_are_counted_and_put_by_topic():
    verdicts = read_verdicts(CLAIMS)
    assert list(verdicts.counts) == list(SIGNS)
    assert set(verdicts.counts.values()) == {1}
    assert [(topic, len(claims)) for topic, claims in verdicts.topics.items()] == [
        ("synchronization", 2),
        ("friction laws", 1),
        ("motion", 2),
    ]
    assert verdicts.setting["contact"] == "one_sided"


def test_one_reason_for_all_is_said_once(tmp_path):
    content = json.loads(CLAIMS.read_text())
    assert read_verdicts(CLAIMS).one_reason == ""
    content["counts"] = {"not testable": len(content["claims"])}
    for claim in content["claims"]:
        claim.update(verdict="not testable", reason="Not testable here: short runs.", conventions={})
    path = tmp_path / "claims.json"
    path.write_text(as_json(content))
    assert read_verdicts(path).one_reason == "Not testable here: short runs."
    content["claims"][0]["reason"] = "Another."
    path.write_text(as_json(content))
    assert read_verdicts(path).one_reason == ""


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda content: content["claims"][0].update(own="maybe"), "'maybe' is not allowed"),
        (lambda content: content["claims"].pop(), "counts"),
        (lambda content: content["claims"][0].update(verdict="true"), "holds loosely"),
        (lambda content: content["claims"][0].update(conventions={"x": "maybe"}), "'maybe' is not allowed"),
        (lambda content: content["claims"][0].pop("reason"), "reason"),
        (lambda content: content["claims"][0].update(reason=3), "reason: 3 is not allowed: text"),
        (lambda content: content.pop("counts"), "counts"),
    ],
)
def test_a_wrong_file_of_verdicts_is_one_line(tmp_path, change, words):
    content = json.loads(CLAIMS.read_text())
    change(content)
    path = tmp_path / "claims.json"
    path.write_text(as_json(content))
    with pytest.raises(ValueError, match="claims.json: ") as caught:
        read_verdicts(path)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_changed_verdict_is_not_believed(tmp_path):
    """One word that is still allowed, and counts that fit: only the digest tells."""
    path = tmp_path / "claims.json"
    path.write_text(CLAIMS.read_text().replace("0.0", "0.1", 1))
    assert path.read_text() != CLAIMS.read_text()
    with pytest.raises(BadFile, match="has other content than was written; remake it: snakemake -c2 -R "):
        read_verdicts(path)


def test_run_times_are_sums_over_the_files_of_a_stage(tmp_path):
    def write(name, *rows):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(HEADER + "".join(f"{row}\n" for row in rows))

    write("simulate/linearized/minus/a0.1.tsv", "0.18\t0:00:00\t10.5\t1\t1\t1\t0\t0\t0.00\t0.00")
    write("simulate/linearized/minus/a0.2.tsv", "0.5\t0:00:00\tNA\tNA\tNA\tNA\tNA\tNA\tNA\tNA")
    write("simulate/linearized/minus/a0.3.tsv", "2.0\t0:00:02\t80.0\t1\t1\t1\t0\t0\t90\t1.75")
    write("basins/linearized/a0.1/tile0.tsv", "5.0\t0:00:05\t100\t1\t1\t1\t0\t0\t90\t4.5")
    write("basins.tsv", "1.0\t0:00:01\t200\t1\t1\t1\t0\t0\t90\t0.5")
    write("figure_one.tsv", "1.5\t0:00:01\t50\t1\t1\t1\t0\t0\t90\t-")
    write("figure_two.tsv", "0.5\t0:00:01\t60\t1\t1\t1\t0\t0\t90\t-")
    write("report.tsv", "9.0\t0:00:09\t900\t1\t1\t1\t0\t0\t90\t9")
    (tmp_path / "empty.tsv").write_text("")
    (tmp_path / "noise.tsv").write_bytes(b"\xff\xfe\x00")
    rows = [(s.name, s.jobs, s.wall, s.cpu, s.cpu_jobs, s.memory) for s in read_stages(tmp_path)]
    assert rows == [
        ("basins", 2, 6.0, 5.0, 2, 200.0),
        ("simulate", 3, pytest.approx(2.68), 1.75, 1, 80.0),
        ("figures", 2, 2.0, 0.0, 0, 60.0),
    ]
    assert read_stages(tmp_path / "missing") == []


def sections(velocity, count):
    laws = {"flag_values": [0, 1], "flag_meanings": "linearized nonlinear"}
    states = {"flag_values": [0], "flag_meanings": "plus"}
    velocity = np.asarray(velocity)
    return xr.Dataset(
        {
            "crossing_velocity": ("crossing", velocity),
            "crossing_direction": ("crossing", np.where(velocity >= 0.0, 1, -1).astype("i1")),
            "crossing_count": ("point", np.asarray(count, dtype="i4")),
        },
        {
            "law": ("point", np.repeat([0, 1], len(count) // 2), laws),
            "initial": ("point", np.zeros(len(count), dtype="i2"), states),
        },
    )


@pytest.mark.parametrize("lowest", [-0.3, -1e-9, 0.2])
def test_section_counts_lose_no_crossing(lowest):
    rng = np.random.default_rng(1)
    velocity = np.concatenate([rng.uniform(lowest, 0.4, 900), [lowest, 0.4], np.full(600, 0.25)])
    counts = section_counts(sections(velocity, [502, 0, 400, 600]))
    low, high = counts["edges"]
    runs = [counts["runs"][law][0] for law in (0, 1)]
    for run, own in zip(runs, (velocity[:502], velocity[502:]), strict=True):
        assert sum(count for count in run["count"] if count > 0) == (own >= 0.0).sum()
        assert -sum(count for count in run["count"] if count < 0) == (own < 0.0).sum()
    # 600 crossings in one bin: more than the stored type of the direction could count.
    a, bin_number = divmod(np.cumsum(runs[1]["index"]), BINS)
    fullest = int(np.argmax(runs[1]["count"]))
    assert low + (high - low) * (bin_number[fullest] + np.array([0, 1])) / BINS == pytest.approx(0.25, abs=0.01)
    assert set(a.tolist()) == {0, 1}
    assert runs[1]["count"][fullest] >= 600


def test_section_counts_without_crossings():
    assert section_counts(sections([], [0, 0]))["runs"] == [[{"index": [], "count": []}]] * 2


def test_basin_maps_hold_label_and_time_of_every_pixel():
    branch = np.array([[0, 3, 3], [-1, 0, 7]])
    side = np.array([[0, 1, -1], [0, 0, 1]])
    time = np.array([[10.4, 200.6, 0.2], [np.nan, 70000.0, 5.0]], dtype="f4")
    plane = ("map", "last_position", "first_position")
    basins = xr.Dataset(
        {
            "branch": (plane, branch[None]),
            "side": (plane, side[None]),
            "decision_time": (plane, time[None]),
            "uncertainty_exponent": ("map", [0.5]),
            "uncertainty_exponent_error": ("map", [np.nan]),
        },
        {
            "law": ("map", [1], {"flag_meanings": "linearized nonlinear"}),
            "a": ("map", [0.08]),
            "first_position": [-1.0, 0.0, 1.0],
            "last_position": [0.0, 1.0],
        },
    )
    known = xr.Dataset({"branch": (("law", "a", "attractor"), [[[0, 3, 7]]])})
    one = basin_maps(basins, known, {"plus": (0.9, -0.9)})["maps"][0]
    label = np.frombuffer(base64.b64decode(one["label"]), dtype="u1").reshape(2, 3)
    names = np.array([item["name"] for item in one["classes"]])[label]
    assert names.tolist() == [
        ["synchronized", "branch 3 (+)", "branch 3 (−)"],
        ["undetermined", "synchronized", "branch 7 (+)"],
    ]
    assert np.frombuffer(base64.b64decode(one["time"]), dtype="<u2").tolist() == [10, 201, 1, 0, 65535, 5]
    assert sum(item["percent"] for item in one["classes"]) == pytest.approx(100.0, abs=1e-3)
    assert (one["law"], one["a"], one["exponent_error"]) == ("nonlinear", 0.08, None)


def test_the_commands_of_every_run_are_those_of_the_workflow(poor):
    commands = Commands(poor.study, "config/two words.yaml")
    opened = {name: xr.load_dataset(path) for name, path in poor.sources.summaries.items()}
    runs = embedded_runs(commands, *(opened[name] for name in ("mean_distance", "lyapunov", "agreement")))
    for i, law in enumerate(runs["laws"]):
        for k, name in enumerate(runs["names"]):
            before, after = runs["simulate"][i][0]
            typed = f"{before} --a {runs['texts'][k]} {after}{name}.nc"
            assert typed == f"{poor.study.command(law, 'pair', name)} --out {law}_pair_a{name}.nc"
    assert commands.snakemake("linearized", "pair", "0.1000") == (
        "snakemake -c1 --force results/poor/points/linearized/pair/a0.1000.nc --configfile 'config/two words.yaml'"
    )
    assert commands.snakemake("linearized", "pair", "0.1000").endswith(runs["configfile"])
    assert runs["mean_distance"][0][0] == [opened["mean_distance"]["mean_distance"].values[0, 0, 0], None]
    assert runs["exponents"][0][0][1] == [None, None, None]


def test_pictures_keep_every_pixel(tmp_path):
    """Colours tell curves apart: none may change."""
    pixels = np.full((900, 2100, 3), 255, dtype="u1")
    pixels[:300] = np.arange(2100, dtype="u1")[:, None]
    for n, color in enumerate(COLORS):
        pixels[400 + 20 * n, 100:1400] = np.round(255 * np.array(to_rgb(color)))
    path = tmp_path / "bifurcation.png"
    Image.fromarray(pixels).convert("RGBA").save(path)
    picture = read_picture(path)
    content = base64.b64decode(picture.data.split(",")[1])
    assert (np.asarray(Image.open(io.BytesIO(content)).convert("RGB")) == pixels).all()
    assert (picture.width, picture.height) == (2100, 900)
    assert (picture.thumbnail_width, picture.thumbnail_height) == (THUMBNAIL_WIDTH, 171)
    assert len(picture.thumbnail) < 30_000
    assert "W'" in picture.alternative


def test_a_picture_that_cannot_be_read_is_named(tmp_path):
    (tmp_path / "noise.png").write_bytes(b"no picture")
    with pytest.raises(ValueError, match=r"noise\.png: is not a readable picture"):
        read_picture(tmp_path / "noise.png")
