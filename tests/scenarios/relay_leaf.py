"""footing-relay over two nats-servers, a lab's own one as a leaf node of a hub: a viewer at the hub's edge gets footingd's ticks,
the leaf sends them only while somebody at the hub subscribes, and after the hub was away they come again.

Usage: relay_leaf.py BINARY_FOLDER
"""
import json
import signal
import sys
import time
import urllib.request

import brokers
from harness import Stage
from ports import free_port
from relay import Viewer, check_numbers, missing, returned_after, start_footingd

SITE, LOGIN = "lab1", "lab1:right-password"
# A leaf node tries to connect again every second.
MOST_RETURN_S = 4
TRIES = 3


class Site:
    """A nats-server of its own, whose monitoring says what goes through it."""

    def __init__(self, folder, name, config):
        self.monitoring = free_port()
        path = folder / f"{name}.conf"
        path.write_text(f"server_name: {name}\nhttp: 127.0.0.1:{self.monitoring}\n{config}\n")
        self.broker = brokers.nats(folder, "-c", str(path))

    def leaf(self):
        """Of its one leaf connection, or nothing."""
        with urllib.request.urlopen(f"http://127.0.0.1:{self.monitoring}/leafz", timeout=5) as page:
            leaves = json.load(page).get("leafs") or []
        return leaves[0] if leaves else None

    @property
    def address(self):
        return f"tcp:127.0.0.1:{self.broker.port}"


def start_sites(stage):
    port = free_port()
    user, password = LOGIN.split(":")
    hub = Site(stage.folder, "hub", f"leafnodes {{ host: 127.0.0.1, port: {port}, authorization {{ user: {user}, "
                                    f"password: {password} }} }}")
    lab = Site(stage.folder, "lab", f'leafnodes {{ remotes: [ {{ url: "nats-leaf://{LOGIN}@127.0.0.1:{port}" }} ] }}')
    stage.wait_for(lambda: hub.leaf() and lab.leaf(), "the leaf node's connection")
    return hub, lab


def sent(lab):
    return lab.leaf()["out_msgs"]


def check_quiet(lab):
    """Nobody at the hub subscribes: no tick goes over the link."""
    before = sent(lab)
    time.sleep(1)
    assert sent(lab) - before <= 5, "100 ticks a second are published at the lab"


def check_same(stage, direct, edge):
    source = {tick["sequence"]: tick for tick in direct.ticks()}
    same = [tick for tick in edge.ticks() if tick["sequence"] in source]
    assert len(same) > 50 and all(tick == source[tick["sequence"]] for tick in same), len(same)
    assert edge.of("welcome")[0]["epoch"] == direct.of("welcome")[0]["epoch"]
    stage.check_missing(stage.sensor, missing(edge))
    print(f"{len(same)} ticks of footingd at the hub's edge")


def check_once(stage, hub, lab, words, edge):
    """A second edge at the hub costs the link nothing."""
    listen = f"unix:{stage.folder}/edge2.sock"
    stage.start("footing-relay", "serve", "--nats", hub.address, "--listen", listen, *words, name="edge2")
    stage.wait_for_socket(listen)
    second = Viewer(listen)
    stage.wait_for(second.ticks, "ticks at the second edge")
    before, seen = sent(lab), len(edge.ticks())
    time.sleep(2)
    messages, ticks = sent(lab) - before, len(edge.ticks()) - seen
    print(f"{messages} messages over the link for {ticks} ticks at each of two edges")
    assert ticks > 50 and messages < 1.3 * ticks + 20, (messages, ticks)
    second.stopping = True
    stage.stop("edge2", signal.SIGKILL)


def check_hub_away(stage, hub, edge):
    for attempt in range(TRIES):
        gaps = len(edge.of("gap"))
        hub.broker.stop()
        time.sleep(1)
        hub.broker.start()
        since_s = time.monotonic()
        stage.wait_for(lambda: returned_after(edge, since_s), "ticks after the hub was away", 20)
        took_s = returned_after(edge, since_s)
        print(f"back {took_s:.2f} s after the hub was")
        assert edge.ended is None and len(edge.of("gap")) > gaps, edge.ended
        if took_s <= MOST_RETURN_S:
            break
    assert took_s <= MOST_RETURN_S
    check_numbers(edge)


def main():
    brokers.skip_without("nats-server")
    with Stage(sys.argv[1]) as stage:
        hub, lab = start_sites(stage)
        with hub.broker, lab.broker:
            start_footingd(stage)
            stage.start_user("walk", "--seconds", 600)
            words = ("--site", SITE, "--rate-hz", 0)
            stage.start("footing-relay", "publish", "--connect", stage.sensor, "--nats", lab.address, "--site", SITE, name="publisher")
            stage.wait_for_devices()
            check_quiet(lab)
            listen = f"unix:{stage.folder}/edge.sock"
            stage.start("footing-relay", "serve", "--nats", hub.address, "--listen", listen, *words, name="edge")
            stage.wait_for_socket(listen)
            direct, edge = Viewer(stage.sensor), Viewer(listen)
            stage.wait_for(lambda: len(edge.ticks()) > 200, "ticks at the hub's edge", 20)
            check_same(stage, direct, edge)
            direct.stopping = True
            check_once(stage, hub, lab, words, edge)
            check_hub_away(stage, hub, edge)
            edge.stopping = True
    return 0


if __name__ == "__main__":
    sys.exit(main())
