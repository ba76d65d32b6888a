"""footing-eval stats: its JSON, its exit codes, the examples of its help, and the reference tables.

Usage: stats_command_test.py FOOTING_EVAL FOOTING_STREAM
       stats_command_test.py FOOTING_EVAL TEST_DATA --reference   (77, skipped, without data)
"""
import csv
import json
import math
import pathlib
import shlex
import subprocess
import sys
import tempfile

SMALL = "group_index,group,value\n" + "".join(
    f"{index},{name},{value}\n" for index, (name, values) in enumerate(
        (("c", (0, 1, 1, 2)), ("a", (1, 2, 3, 3)), ("b", (2, 3, 3, 4)))) for value in values)
PAIRED = "subject,group,value\n" + "".join(
    f"p{subject},{name},{value}\n" for subject, values in enumerate(((5, 6), (1, 3), (2, 5)))
    for name, value in zip(("control", "arm"), values))


class Runner:
    def __init__(self, program, folder):
        self.program, self.path = program, folder / "data.csv"

    def __call__(self, test, text, *words):
        self.path.write_text(text)
        return subprocess.run(
            [self.program, "stats", "--test", test, "--data", self.path, "--json", *words],
            capture_output=True, text=True, check=False)

    def report(self, test, text, *words):
        done = self(test, text, *words)
        assert done.returncode == 0 and not done.stderr, (words, done)
        return json.loads(done.stdout)


def reports(run):
    out = run.report("steel", SMALL)
    assert out["method"] == "exact" and len(out["rows"]) == 2 and out["note"].endswith("."), out
    row = out["rows"][1]
    assert (row["comparison"], row["group_index"], row["df"]) == ("b - c", 2, None), row
    assert math.isclose(row["p"], 0.0533910533910534, rel_tol=1e-13), row
    assert math.isclose(row["statistic"], 2.20479275922049, rel_tol=1e-13), row
    joint = run.report("steel", SMALL, "--ties", "joint", "--alternative", "greater")["rows"]
    assert math.isclose(joint[0]["p"], 0.105800865800866, rel_tol=1e-12), joint

    out = run.report("steel", SMALL, "--method", "permutation", "--seed", "5", "--permutations", "999")
    again = run.report("steel", SMALL, "--method", "permutation", "--seed", "5", "--permutations", "999")
    other = run.report("steel", SMALL, "--method", "permutation", "--seed", "6", "--permutations", "999")
    assert out == again and out["seed"] == 5 and out["relabellings"] == 999, out
    assert [r["p"] for r in out["rows"]] != [r["p"] for r in other["rows"]], other
    for row in out["rows"]:
        assert math.isclose(row["p_standard_error"], math.sqrt(row["p"] * (1 - row["p"]) / 999)), row

    out = run.report("dunnett", SMALL)
    assert out["method"] == "quadrature" and out["rows"][0]["df"] == 9, out
    # Means 1, 2.25, 3; squares within groups 2 + 2.75 + 2.
    error = math.sqrt(6.75 / 9 / 2)
    assert math.isclose(out["rows"][1]["statistic"], 2 / error, rel_tol=1e-12), out
    assert math.isclose(out["rows"][1]["low"], 2 - out["critical_value"] * error, rel_tol=1e-12), out

    out = run.report("paired", PAIRED)
    row = out["rows"][0]
    assert out["control"] == "control" and out["subjects"] == 3, out
    assert row["estimate"] == 2 and row["p"] == 0.25 and row["smallest_p"] == 0.25, row
    assert "can never be below 0.05" in out["note"], out["note"]
    # Differences 1, 2, 3: mean 2, standard error 1 / sqrt 3.
    assert math.isclose(row["block_t"], 2 * math.sqrt(3)) and row["block_df"] == 2, row
    swapped = run.report("paired", PAIRED, "--control", "arm")["rows"][0]
    assert swapped["comparison"] == "control - arm" and swapped["estimate"] == -2, swapped

    out = run.report("rate", SMALL)
    assert math.isclose(out["rows"][1]["poisson"]["estimate"], 3), out
    assert "footnote 1" in out["note"], out["note"]


def errors(run):
    def expect(code, message, done):
        lines = done.stderr.splitlines()
        assert done.returncode == code and not done.stdout and len(lines) == 1, done
        assert lines[0].startswith("error: ") and message in lines[0], done

    for text, message in (
            ("", "line 1: the file is empty"),
            ("group_index,group\n0,a\n", "line 1: no column value"),
            ("group_index,group,value\n0,a,1\n1,b,x\n", "line 3: the value 'x' is not a number"),
            ("group_index,group,value\n1,a,1\n2,b,2\n", "line 3: the file ends and no row has group_index 0"),
            ("group_index,group,value\n0,a,1\n0,a,2\n", "line 3: the file ends and all rows are of"),
            ("group_index,group,value\n0,a,1\n2,b,2\n", "line 3: the file ends and group_index 1 has no row"),
    ):
        for test in ("dunnett", "steel", "rate"):
            expect(4, "data.csv, " + message, run(test, text))
    expect(4, "needs a group with two values", run("dunnett", "group_index,group,value\n0,a,1\n1,b,2\n"))
    expect(4, "line 8: subject 'p3' has no value for group 'arm'", run("paired", PAIRED + "p3,control,2\n"))
    expect(4, "not a count", run("rate", SMALL + "2,b,1.5\n"))

    expect(2, "--ties applies to --test steel", run("dunnett", SMALL, "--ties", "joint"))
    expect(2, "--method does not apply", run("dunnett", SMALL, "--method", "exact"))
    expect(2, "--test rate has", run("rate", SMALL, "--method", "permutation"))
    expect(2, "--alternative", run("steel", SMALL, "--alternative", "bigger"))
    expect(2, "--test", run("anova", SMALL))
    expect(2, "--confidence", run("steel", SMALL, "--confidence", "95"))
    many = "group_index,group,value\n" + "".join(
        f"{index},g{index},{index + k * 0.37}\n" for index in range(4) for k in range(15))
    expect(2, "needs more than", run("steel", many, "--method", "exact"))
    missing = subprocess.run([run.program, "stats", "--test", "steel", "--data", "/nonexistent.csv"],
                             capture_output=True, text=True, check=False)
    expect(1, "/nonexistent.csv", missing)


def examples(program, stream, folder):
    """Every example of the help runs as it stands, with and without --json."""
    subprocess.run([stream, "sample", folder], check=True, capture_output=True)
    text = subprocess.run([program, "stats", "--help"], capture_output=True, text=True, check=True).stdout
    commands = [line.split() for line in text.splitlines() if line.startswith("  footing-eval stats ")]
    assert len(commands) >= 4, text
    for words in commands:
        done = subprocess.run([program, *words[1:]], cwd=folder, capture_output=True, text=True,
                              check=False)
        assert done.returncode == 0 and not done.stderr, (shlex.join(words), done)
        if "--json" in words:
            rows = json.loads(done.stdout)["rows"]
            assert [row["group"] for row in rows] == ["wrist", "arm", "leg"], rows
        else:
            assert "wrist - joystick" in done.stdout and "Believe" in done.stdout, done.stdout
    ratings = subprocess.run([program, "stats", "--test", "steel", "--data", "ratings.csv", "--json"],
                             cwd=folder, capture_output=True, text=True, check=True)
    assert all("paired_p" in row for row in json.loads(ratings.stdout)["rows"])


def reference(run, data):
    folder = pathlib.Path(data or "/nonexistent") / "stats"
    if not (folder / "datasets.csv").exists():
        print("skipped: no reference tables; set FOOTING_TEST_DATA")
        sys.exit(77)

    def read(name):
        with open(folder / name, newline="") as file:
            return list(csv.DictReader(file))

    datasets = {}
    for row in read("datasets.csv"):
        text = datasets.setdefault(row["dataset"], ["group_index,group,value"])
        text.append(f"{row['group_index']},{row['group']},{row['value']}")
    cache = {}

    def rows_of(test, dataset, *words):
        key = (test, dataset, *words)
        if key not in cache:
            cache[key] = run.report(test, "\n".join(datasets[dataset]) + "\n", *words)["rows"]
        return cache[key]

    compared = 0
    for row in read("dunnett_boost_quadrature.csv"):
        ours = rows_of("dunnett", row["dataset"], "--alternative", row["alternative"])[int(row["comparison"]) - 1]
        for name, column in (("p", "p"), ("statistic", "t"), ("estimate", "estimate"), ("df", "df")):
            assert abs(ours[name] - float(row[column])) <= 1e-10, (row, ours)
        compared += 1
    for row in read("steel_boost_quadrature.csv"):
        for ties, names in (("pairwise", (("p", "p_pairwise_df_inf_steel"), ("p_finite_sample", "p_pairwise_finite_corr"))),
                            ("joint", (("p", "p_joint"), ("p_continuity", "p_joint_cc")))):
            ours = rows_of("steel", row["dataset"], "--alternative", row["alternative"], "--method", "asymptotic",
                           "--ties", ties)[int(row["comparison"]) - 1]
            for name, column in names:
                assert abs(ours[name] - float(row[column])) <= 1e-10, (row, ours)
        compared += 1
    for row in read("steel_permutation_cpp.csv"):
        if row["method"] != "exact":
            continue
        for alternative, ending in (("two.sided", "two"), ("greater", "greater"), ("less", "less")):
            for ties in ("pairwise", "joint"):
                ours = rows_of("steel", row["dataset"], "--alternative", alternative, "--ties", ties,
                               "--method", "exact")[int(row["comparison"]) - 1]
                assert abs(ours["p"] - float(row[f"p_{ties}_{ending}"])) <= 1e-12, (row, ours)
        compared += 1
    assert compared >= 90, compared


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="footing-stats.") as name:
        place = pathlib.Path(name)
        runner = Runner(sys.argv[1], place)
        if "--reference" in sys.argv:
            reference(runner, sys.argv[2])
        else:
            reports(runner)
            errors(runner)
            examples(sys.argv[1], sys.argv[2], place)
