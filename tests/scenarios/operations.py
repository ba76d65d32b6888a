"""Both servers as an administrator sees them: status, metrics in Prometheus' own parser, reload on SIGHUP, origins of the config,
and a stop that every client can explain.

Usage: operations.py BINARY_FOLDER
"""
import http.client
import json
import os
import pathlib
import re
import signal
import socket
import sys
import time

from harness import Stage
from ports import free_port

try:
    from prometheus_client.parser import text_string_to_metric_families
except ImportError:  # Another Python than Debian's, which has the package.
    sys.path.append("/usr/lib/python3/dist-packages")
    from prometheus_client.parser import text_string_to_metric_families

UNITS = ("seconds", "hertz", "bytes", "ratio", "ticks")
COUNTED = ("footing_sessions", "footing_build_info", "footing_device_live", "process_open_fds", "footing_relay_broker_up",
           "footing_relay_source_up", "footing_relay_serving")
ALERTS = pathlib.Path(__file__).resolve().parents[2] / "systemd/prometheus-alerts.yml"
OF_PROMETHEUS = ("up",)  # What it adds to each target itself.
LABELS_OF_PROMETHEUS = {"job", "instance"}
MOST_STOP_S = 6  # Of which footingd waits 1 s at most for its clients.
PAUSE_S = 0.4  # Beyond the 0.1 s of ticks that are made up for.


class UnixHttp(http.client.HTTPConnection):
    def __init__(self, path):
        super().__init__("footing", timeout=10)
        self.path = path

    def connect(self):
        self.sock = socket.socket(socket.AF_UNIX)
        self.sock.settimeout(10)
        self.sock.connect(self.path)


def metrics_of(address):
    """Samples by name: a list of (labels, value)."""
    kind, _, place = address.partition(":")
    connection = UnixHttp(place) if kind == "unix" else http.client.HTTPConnection(place, timeout=10)
    connection.request("GET", "/metrics")
    response = connection.getresponse()
    text = response.read().decode()
    assert response.status == 200 and "version=0.0.4" in response.headers["Content-Type"], response.headers
    samples = {}
    for family in text_string_to_metric_families(text):
        assert family.documentation, family.name
        assert family.type in ("counter", "gauge"), family
        assert (family.type == "counter") == (f"# TYPE {family.name}_total" in text), family.name
        is_named = family.type == "counter" or family.name.endswith(UNITS) or family.name in COUNTED
        assert is_named, f"{family.name} has no unit"
        for sample in family.samples:
            samples.setdefault(sample.name, []).append((sample.labels, sample.value))
    return samples


def check_alerts(samples, metric_of):
    """The alerts on some of the metrics name metrics, and labels in their texts, that the servers really have."""
    checked = 0
    for rule in ALERTS.read_text().split("- alert: ")[1:]:
        name = rule.split()[0]
        expression = re.search(r"^ +expr: (.+)$", rule, re.M)[1]
        metrics = set(re.findall(r"\b((?:footing|process)_\w+|up)\b", expression)) - set(OF_PROMETHEUS)
        used = {metric for metric in metrics if metric_of(metric)}
        if not used:
            continue
        assert used <= set(samples), f"{name}: no server has {used - set(samples)}"
        labels = set.intersection(*(set(samples[metric][0][0]) for metric in used)) | LABELS_OF_PROMETHEUS
        told = set(re.findall(r"\$labels\.(\w+)", rule)) | set(re.findall(r"[{,](\w+)=", expression))
        assert told <= labels, f"{name}: no label {told - labels}"
        checked += 1
    assert checked, "no alert"
    return checked


def check_metrics_take_no_commands(stage, metrics):
    """Whoever reads the metrics over TCP finds no way to command the server there."""
    done = stage.run("footing-ctl", "--connect", metrics["simulation"], "layout", "--preset", "single")
    assert done.returncode != 0, done.stdout
    assert metrics_of(metrics["simulation"])["footing_uptime_seconds"], "it goes on"


def log_of(stage, name):
    return (stage.folder / f"{name}.log").read_text()


def status_of(stage, address):
    return stage.run_json("footing-ctl", "--connect", address, "status")


def check_status_and_metrics(stage, metrics):
    def settled():
        stats = status_of(stage, stage.sensor)["stats"]
        live = [device for device in stats["devices"] if device["report_rate_hz"] > 50]
        clocks = [session for session in stats["sessions"]
                  if session["client"] == "footing-sim" and session["clock_offset_s"] is not None]
        return stats if stats["ticks"]["rate_hz"] > 0 and len(live) == 2 and clocks else None

    stats = stage.wait_for(settled, "two devices and footing-sim's clock in the stats")
    assert stats["ticks"]["ticks"] > 0 and stats["uptime_s"] > 0, stats
    clients = {session["client"]: session for session in stats["sessions"]}
    sim = clients["footing-sim"]
    assert sim["role"] in ("view", "control", "log") and sim["ticks_sent"] > 0, sim
    assert abs(sim["clock_offset_s"]) <= sim["clock_uncertainty_s"] + 1e-4, f"one clock on one host: {sim}"
    simulation = stage.wait_for(lambda: (found := status_of(stage, stage.simulation)["stats"])["ticks"]["ticks"] > 0 and found,
                                "the stats of footing-sim")
    assert simulation["devices"] == [], simulation
    assert "ticks per second" in stage.run("footing-ctl", "--connect", stage.sensor, "status").stdout

    samples = metrics_of(metrics["sensor"])
    assert samples["footing_build_info"][0][0]["program"] == "footingd", samples["footing_build_info"]
    assert samples["footing_ticks_total"][0][1] >= stats["ticks"]["ticks"], samples["footing_ticks_total"]
    serials = {labels["serial"] for labels, _ in samples["footing_device_report_rate_hertz"]}
    assert serials == {device["serial"] for device in stats["devices"]}, serials
    assert all(0 <= ratio <= 1 for _, ratio in samples["footing_device_battery_ratio"]), samples
    assert {"footing-sim"} <= {labels["client"] for labels, _ in samples["footing_session_lag_seconds"]}, samples
    assert 1e6 < samples["process_resident_memory_bytes"][0][1] < 1e9, samples
    of_simulation = metrics_of(metrics["simulation"])
    assert "footing_ticks_total" in of_simulation
    rules = check_alerts(samples, lambda metric: not metric.startswith("footing_relay_"))
    print(f"{rules} alerts name metrics of footingd")


def check_metrics_limits(metrics):
    """Idle connections hold no more than their places, and not for long."""
    idle = []
    for _ in range(20):
        connection = socket.socket(socket.AF_UNIX)
        connection.settimeout(30)
        connection.connect(metrics["sensor"].removeprefix("unix:"))
        idle.append(connection)
    for connection in idle:
        assert connection.recv(1) == b"", "an idle connection is closed"  # After its 5 s.
        connection.close()
    assert metrics_of(metrics["sensor"])


def check_reload(stage, config):
    daemon = stage.processes["footingd"]

    def reload(values, until):
        config.write_text(json.dumps(values))
        daemon.send_signal(signal.SIGHUP)
        stage.wait_for(lambda: until in log_of(stage, "footingd"), f'"{until}" in the log')

    reload({"stale_after_s": 2.5, "max_sessions": 3, "max_sessions_per_user": 3, "tick_rate_hz": 50},
           "takes effect after a restart: tick_rate_hz 100.0 -> 50.0")
    assert re.search(r"config reloaded: stale_after_s 0.5 -> 2.5, max_sessions 256 -> 3", log_of(stage, "footingd"))
    reload({"stale_after_s": 99}, "config not reloaded: the one in force stays: config: stale_after_s = 99")
    config.unlink()
    os.mkfifo(config)  # Nobody writes to it: the daemon must not wait.
    daemon.send_signal(signal.SIGHUP)
    stage.wait_for(lambda: "it is a pipe, not a regular file" in log_of(stage, "footingd"), "the pipe in the log")
    config.unlink()
    assert "error:" not in log_of(stage, "footingd"), "each in one line of the log"
    reload({"stale_after_s": 2.5, "max_sessions": 3, "max_sessions_per_user": 3}, "nothing has changed")
    stage.processes["footing-sim"].send_signal(signal.SIGHUP)
    stage.wait_for(lambda: "nothing has changed" in log_of(stage, "footing-sim"), "footing-sim to reload")
    stage.wait_for(lambda: 80 < status_of(stage, stage.sensor)["stats"]["ticks"]["rate_hz"] < 120, "100 ticks a second")


def check_origins(stage, config):
    config.write_text('{\n  "stale_after_s": 2,\n  "camera": true\n}\n')
    done = stage.run("footingd", "--config", config, "--set", "camera=false", "--listen", "unix:/tmp/x",
                     "--print-config", "--origin")
    shown = json.loads(done.stdout)
    assert shown["stale_after_s"] == {"value": 2.0, "origin": f"{config}:2"}, shown
    assert shown["camera"] == {"value": False, "origin": "--set"}, shown
    assert shown["listen"] == {"value": ["unix:/tmp/x"], "origin": "--listen"}, shown
    assert shown["tick_rate_hz"] == {"value": 100.0, "origin": "default"}, shown
    shown = json.loads(stage.run("footing-sim", "--interface", "leg", "--print-config", "--origin").stdout)
    assert shown["interface"] == {"value": "leg", "origin": "--interface"}, shown


def check_overload(stage, metrics):
    """A server that stood still says to all how many ticks it left out: at most once in 10 s."""
    daemon = stage.processes["footingd"]

    def noticed():
        daemon.send_signal(signal.SIGSTOP)
        time.sleep(PAUSE_S)
        daemon.send_signal(signal.SIGCONT)
        time.sleep(PAUSE_S)
        return "is overloaded" in log_of(stage, "footing-log")

    stage.wait_for(noticed, "a notice")
    for client, words in (("footing-log", "notice: footingd is overloaded"), ("footing-ctl", "NOTICE: footingd is overloaded"),
                          ("footing-sim", "sensor stream: footingd is overloaded")):
        stage.wait_for(lambda: words in log_of(stage, client), f"the notice in {client}")
    stage.wait_for(lambda: metrics_of(metrics["sensor"])["footing_ticks_left_out_total"][0][1] > 0, "the count")


def start_clients(stage):
    stage.start("footing-log", "record", "--connect", stage.sensor, "--out", stage.folder / "a.mcap")
    stage.start("footing-ctl", "--connect", stage.sensor, "watch")
    stage.wait_for(lambda: "connected to footingd" in log_of(stage, "footing-log"), "the recorder")
    stage.wait_for(lambda: "live" in log_of(stage, "footing-ctl"), "footing-ctl watch")


def check_stop(stage):
    began_s = time.monotonic()
    assert stage.stop("footingd") == 0, "an orderly end"
    took_s = time.monotonic() - began_s
    assert took_s < MOST_STOP_S, took_s
    assert "footingd info: stopped by SIGTERM" in log_of(stage, "footingd"), log_of(stage, "footingd")
    for client in ("footing-log", "footing-sim", "footing-ctl"):
        stage.wait_for(lambda: "footingd is being stopped" in log_of(stage, client), f"the reason in {client}")
    stage.stop("footing-ctl", signal.SIGINT)
    stage.stop("footing-log", signal.SIGINT)
    info = stage.run_json("footing-log", "info", stage.folder / "a.mcap")
    notices = [record["values"] for record in info["metadata"] if record["name"] == "notice"]
    assert notices and notices[0]["kind"] == "KIND_TICKS_LATE", info["metadata"]
    print(f"stopped in {took_s:.2f} s")


def main(binaries):
    with Stage(binaries) as stage:
        config = stage.folder / "footingd.json"
        check_origins(stage, config)
        config.write_text("{}")
        metrics = {"sensor": f"unix:{stage.folder}/sensor-metrics.sock", "simulation": f"tcp:127.0.0.1:{free_port()}"}
        stage.start("footingd", "--config", config, "--listen", stage.sensor, "--source", f"stream:{stage.devices}",
                    "--metrics", metrics["sensor"])
        stage.wait_for_socket(stage.devices)
        stage.start("footing-sim", "--sensor", stage.sensor, "--listen", stage.simulation, "--metrics",
                    metrics["simulation"])
        stage.wait_for(lambda: "metrics on tcp:127.0.0.1:" in log_of(stage, "footing-sim"), "the metrics of footing-sim")
        stage.start_user("walk", "--seconds", 120)
        check_status_and_metrics(stage, metrics)
        check_metrics_limits(metrics)
        check_metrics_take_no_commands(stage, metrics)
        check_reload(stage, config)
        start_clients(stage)
        check_overload(stage, metrics)
        check_stop(stage)


if __name__ == "__main__":
    main(sys.argv[1])
