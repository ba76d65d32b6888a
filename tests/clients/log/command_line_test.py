"""The command line of footing-log: exit codes and what is said.

Usage: command_line_test.py FOOTING_LOG WRITE_SAMPLE_RECORDING
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile


def main(program, writer):
    def run(*words, env=None):
        return subprocess.run([program, *map(str, words)], capture_output=True, text=True,
                              timeout=30, check=False, stdin=subprocess.DEVNULL, env=env)

    with tempfile.TemporaryDirectory(prefix="footing-log.") as name:
        folder = pathlib.Path(name)
        whole, cut, repaired = (folder / f"{n}.mcap" for n in ("whole", "cut", "repaired"))
        subprocess.run([writer, whole], check=True)
        cut.write_bytes(whole.read_bytes()[:-20])

        info = run("info", whole, "--json")
        assert info.returncode == 0, info
        assert json.loads(info.stdout)["simulated"] is True, info.stdout
        info = run("info", cut, "--json")
        assert info.returncode == 4 and "footing-log repair" in info.stderr, info
        assert json.loads(info.stdout)["complete"] is False, info.stdout
        export = run("export", cut, "--format", "csv", "--out", folder / "csv")
        assert export.returncode == 4 and "footing-log repair" in export.stderr, export

        repair = run("repair", cut, "--out", repaired, "--json")
        assert repair.returncode == 0, repair
        report = json.loads(repair.stdout)
        assert report["messages_kept"] == 307 and not report["was_complete"], report
        assert run("repair", cut, "--out", repaired).returncode == 2
        info = run("info", repaired)
        assert info.returncode == 0 and ".0 Hz  footing.v1." in info.stdout, info
        assert " 1 messages" not in info.stdout and " 0 Hz" not in info.stdout, info
        export = run("export", repaired, "--format", "csv", "--out", folder / "csv", "--json")
        assert export.returncode == 0 and len(json.loads(export.stdout)["files"]) == 3, export

        export = run("export", repaired, "--format", "csv", "--out", f"{folder / 'csv'}/", "--force")
        assert f"path {folder}/csv/footing" in export.stdout, export  # Not two slashes.
        lines = export.stdout.splitlines()  # A line for each file, not one of JSON.
        assert sum(".csv  rows " in line for line in lines) == 3 and "{" not in export.stdout, export

        export = run("export", repaired, "--format", "xdf", "--out", folder / "xdf", "--json")
        streams = {one["name"]: one["samples"] for one in json.loads(export.stdout)["streams"]}
        assert export.returncode == 0 and streams["footingd/motion/1"] == 300, export
        assert run("export", repaired, "--format", "xdf", "--out", folder / "xdf").returncode == 2

        export = run("export", repaired, "--format", "bids", "--out", folder / "bids", "--task", "walk", "--json")
        motion = pathlib.Path(json.loads(export.stdout)["files"][0]["path"])
        assert motion.name.startswith("sub-01_task-walk_tracksys-"), export
        assert len(motion.read_text().splitlines()) == 300, motion
        assert run("export", repaired, "--format", "bids", "--out", folder / "bids", "--subject", "p_1").returncode == 2

        for words, said in ((("export", whole, "--format", "fbx", "--out", folder), "csv, xdf, bids, foxglove, bvh, trc, mot, c3d, gltf"),
                            (("export", whole, "--format", "csv", "--out", folder / "s", "--skeleton", "humanoid"), "needs --format bvh"),
                            (("export", whole, "--format", "xdf", "--out", folder / "s", "--tidy"), "needs --format csv"),
                            (("export", whole, "--format", "csv", "--out", folder / "s", "--subject", "02"), "need --format bids"),
                            (("serve", whole, "--server", "none"), "there are: footingd"),
                            (("record", "--connect", "nowhere", "--out", folder / "x"), "unix:"),
                            (("record", "--connect", "unix:/x", "--out", whole), "--force"),
                            (("shred", whole), "")):
            done = run(*words)
            assert done.returncode == 2 and said in done.stderr, (words, done)
        for format in ("bvh", "trc", "mot", "c3d", "gltf"):
            export = run("export", whole, "--format", format, "--out", folder / format)
            assert export.returncode == 4 and "no reconstructed body" in export.stderr, export
        assert run("info", folder / "none.mcap").returncode == 1
        nobody = run("osc", "--connect", f"unix:{folder}/none.sock", "--to", "127.0.0.1:39539", "--seconds", "0.2")
        assert nobody.returncode == 3 and "none.sock" in nobody.stderr, nobody
        nobody = run("record", "--connect", f"unix:{folder}/none.sock", "--out", folder / "n.mcap",
                     "--seconds", "0.2")
        assert nobody.returncode == 3 and "none.sock" in nobody.stderr and "was not written" in nobody.stderr, nobody
        assert not (folder / "n.mcap").exists()
        (folder / "link.mcap").symlink_to(whole)
        recorded = whole.read_bytes()
        for old in (whole, folder / "link.mcap"):
            nobody = run("record", "--connect", f"unix:{folder}/none.sock", "--out", old, "--force", "--seconds", "0.2")
            assert nobody.returncode == 3 and "was not written" in nobody.stderr, nobody
            assert whole.read_bytes() == recorded and old.exists(), "the old recording stays"
        missing = run("record", "--connect", f"unix:{folder}/none.sock", "--out", whole, "--force", "--attach", folder / "none.json")
        assert missing.returncode == 1 and whole.read_bytes() == recorded, missing
        nobody = run("record", "--out", folder / "d.mcap", "--seconds", "0.2",
                     env=dict(os.environ, XDG_RUNTIME_DIR=str(folder)))
        for server in ("sensor.sock", "simulation.sock"):  # The default of every client.
            assert nobody.returncode == 3 and server in nobody.stderr, nobody


if __name__ == "__main__":
    main(*sys.argv[1:])
