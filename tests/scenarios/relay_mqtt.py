"""footing-relay: a server's channels through an MQTT broker, a topic each.

Usage: relay_mqtt.py BINARY_FOLDER

The relay is started before the broker. What a subscriber gets is footingd's, with its numbers; who subscribes later gets
the retained channels at once; a broker that is killed and comes back, empty, has them again.
"""
import statistics
import sys
import time

import brokers
import decode_stream
import relay
from harness import Stage
from ports import free_port

SITE = "lab-1"
RATE_HZ = 10
MOST_RETURN_S = 2
TRIES = 3  # Other work on the machine may delay one return.


def ticks_of(port, topic, seconds):
    """(topic's last part, tick, whether the broker had kept it)"""
    for name, payload, kept in brokers.MqttReader(port, topic).messages(seconds):
        envelope = decode_stream.decode("envelope", payload)
        yield name, envelope["tick"], kept


def check_same(stage, port):
    direct = relay.Viewer(stage.sensor)
    stage.wait_for(direct.ticks, "ticks of footingd")
    got = list(ticks_of(port, f"footing/{SITE}/footingd/#", 4))
    direct.stopping = True
    by_sequence = {tick["sequence"]: tick for tick in direct.ticks()}
    compared = 0
    for topic, tick, _ in got:
        channel = topic.rsplit("/", 1)[1]
        source = by_sequence.get(tick["sequence"])
        if channel not in relay.SAMPLED or channel not in (source or {}):
            continue  # A sample may come with a later tick.
        assert tick["epoch"] == source["epoch"] and tick["host_ns"] == source["host_ns"], (tick, source)
        assert tick[channel] == source[channel], (channel, tick["sequence"])
        compared += 1
    stamps = [tick["host_ns"] for topic, tick, _ in got if topic.endswith("/motion")]
    # The median of five intervals each, so that ticks that footingd leaves out on a machine that stalls do not count.
    rate_hz = 5e9 / statistics.median(b - a for a, b in zip(stamps, stamps[5:]))
    print(f"{compared} messages are footingd's; motion at {rate_hz:.1f} Hz")
    assert compared > 40 and 0.9 * RATE_HZ < rate_hz < 1.05 * RATE_HZ, (compared, rate_hz)


def retained(port, seconds=1):
    return {topic.rsplit("/", 1)[1]: tick for topic, tick, kept in ticks_of(port, f"footing/{SITE}/footingd/+", seconds)
            if kept}


def check_retained(stage, port):
    kept = stage.wait_for(lambda: (found := retained(port)).get("status") and found, "the retained channels")
    assert kept["status"]["status"]["devices"], kept
    assert "motion" not in kept, kept
    print(f"kept by the broker: {', '.join(sorted(kept))}")


def check_broker_killed(stage, mosquitto):
    for _ in range(TRIES):
        mosquitto.stop()
        time.sleep(0.5)
        mosquitto.start()
        since_s = time.monotonic()
        next(ticks_of(mosquitto.port, f"footing/{SITE}/footingd/motion", 30))
        took_s = time.monotonic() - since_s
        print(f"back {took_s:.2f} s after mosquitto was")
        if took_s <= MOST_RETURN_S:
            break
    assert took_s <= MOST_RETURN_S, took_s
    stage.wait_for(lambda: "status" in retained(mosquitto.port, 0.3), "the retained channels")


def main():
    brokers.skip_without("mosquitto")
    with Stage(sys.argv[1]) as stage:
        relay.start_footingd(stage)
        stage.start_user("walk", "--seconds", 600)
        port = free_port()
        stage.start("footing-relay", "publish", "--connect", stage.sensor, "--mqtt", f"127.0.0.1:{port}", "--site", SITE,
                    "--mqtt-rate-hz", RATE_HZ, name="publisher")
        stage.wait_for_devices()
        with brokers.mosquitto(stage.folder, port=port) as mosquitto:
            stage.wait_for(lambda: "publishing in MQTT" in (stage.folder / "publisher.log").read_text(), "the link")
            check_same(stage, port)
            check_retained(stage, port)
            check_broker_killed(stage, mosquitto)
            assert stage.stop("publisher") == 0
    return 0


if __name__ == "__main__":
    sys.exit(main())
