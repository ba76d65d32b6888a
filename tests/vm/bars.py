"""The bars: each a function of the results, named as its CTest test is. It returns the line of figures
to print, and raises AssertionError with what is wrong.
"""
RATE_HZ = 100
DELIVERED = 0.99
REPLUG_S = 1.0


def device_of(results, scenario, key="device"):
    client, made = results[f"{scenario}.client"], results[f"{scenario}.{key}"]
    assert client and made, f"{scenario}: nothing was measured"
    assert client["counted"], f"{scenario}: the devices were not live in time: {client}"
    found = [one for one in client["devices"] if one["serial"] == made["serial"]]
    assert len(found) == 1, f"{scenario}: {made['serial']} should be one device: {client['devices']}"
    return client, made, found[0]


def judge_delivery(results, scenario, key="device"):
    client, made, device = device_of(results, scenario, key)
    # Later than 5 ms, through the machine's own doing; they are sent all the same.
    late = made["late_samples"] / made["samples"]
    wanted = RATE_HZ * client["seconds"]
    delivered = device["samples"] / wanted
    line = (f"{device['samples']} of {wanted:.0f} samples in {client['seconds']:.0f} s "
            f"({100 * delivered:.2f} %), {device['missing']} missing in between, longest silence "
            f"{device['longest_silence_ms']:.1f} ms, mode set again {device['mode_reasserts']} times, "
            f"by the driver {made['foreign_modes']} times; the machine idled "
            f"{100 * results[f'{scenario}.machine']['idle_fraction']:.0f} % and was late for "
            f"{100 * late:.2f} % of the samples, at worst {made['late_worst_ms']:.1f} ms")
    assert delivered >= DELIVERED, line
    # Reports that queued up while the machine stood still may fall into the window from outside it.
    assert device["samples"] + device["missing"] <= wanted + 0.1 * made["late_worst_ms"] + 2, line
    assert device["twice"] == 0 and device["foreign"] == 0, f"{device['twice']} came twice: {line}"
    assert client["gaps"] == 0 and device["undecodable"] == 0, f"{client['gaps']} gaps: {line}"
    return line


def judge_driver(results, scenario, driver):
    for node in results[f"{scenario}.nodes"]:
        assert node["driver"] == driver, f"{node}: {driver} should be bound"
        assert node["rights"] == "660 root footing", f"{node}: the udev rule did not work"
    assert results[f"{scenario}.nodes"], "there is no node"


def DeliversBesideTheKernelsDriver(results):
    judge_driver(results, "steady", "wiimote")
    return judge_delivery(results, "steady")


def DeliversWithAStatusRequestEvery5Seconds(results):
    judge_driver(results, "status", "wiimote")
    line = judge_delivery(results, "status")
    made = results["status.device"]
    # Else nothing was proved: 6 requests in 30 s, each followed by the driver's mode.
    assert made["inputs"]["20"] >= 6, f"only {made['inputs']['20']} status reports"
    assert made["foreign_modes"] >= 6, "the driver never took the mode away"
    return line


def DeliversWhileADesktopHoldsTheInputNodes(results):
    assert results["desktop.input"]["held"] > 0, "there is no input node"
    return judge_delivery(results, "desktop")


def ReattachesBySerialWithinASecond(results):
    client, made, device = device_of(results, "replug")
    times_s = []
    for start_ns in made["starts_ns"][1:]:
        after = [resumed for resumed in device["resumed_ns"] if resumed > start_ns]
        assert after, f"never came back after {len(times_s) + 1} times: {device}"
        times_s.append((min(after) - start_ns) * 1e-9)
    assert len(times_s) == 5, f"came back {len(times_s)} times of 5"
    line = "from node to first sample at a client: " + \
        ", ".join(f"{1e3 * time_s:.0f} ms" for time_s in times_s)
    assert max(times_s) <= REPLUG_S, line
    return line


def DeliversFromTwoBoardsAtOnce(results):
    judge_driver(results, "boards", "wiimote")
    lines = []
    for key in ("left", "right"):
        _, _, device = device_of(results, "boards", key)
        assert device["kind"] == "balance_board", device
        lines.append(judge_delivery(results, "boards", key))
    return "; ".join(lines)


def SaysWhichRuleIsMissingWhenTheNodeIsRoots(results):
    for node in results["rights.nodes"]:
        assert node["rights"] == "600 root root", f"{node}: should be root's alone"
    log = results["rights.log_shut"]
    assert "cannot open /dev/hidraw" in log and "Permission denied" in log, log
    assert results["udev_rule"] in log, f"the rule of systemd/70-footing.rules is not named: {log}"
    findings = [finding["id"] for finding in results["rights.doctor"]["findings"]]
    assert "node_without_permission" in findings, f"footing-ctl doctor does not see it: {findings}"
    return next(line for line in log.splitlines() if "cannot open" in line)


def AttachesOnceTheRuleIsThere(results):
    client, made, device = device_of(results, "rights")
    assert device["samples"] > 0, device
    time_s = (min(device["resumed_ns"]) - made["starts_ns"][-1]) * 1e-9
    line = f"from node to first sample at a client: {1e3 * time_s:.0f} ms"
    assert 0 < time_s <= REPLUG_S, line
    return line


def DeliversThroughTheGenericDriver(results):
    judge_driver(results, "generic", "hid-generic")
    line = judge_delivery(results, "generic")
    assert results["generic.device"]["foreign_modes"] == 0, line
    return line


def EndsOrderlyOnSigterm(results):
    codes = {name: value["exit_code"] for name, value in results.items() if name.endswith(".footingd")}
    assert codes and not any(codes.values()), codes
    return f"{len(codes)} times"


BARS = {name: value for name, value in list(globals().items())
        if callable(value) and name[0].isupper()}
