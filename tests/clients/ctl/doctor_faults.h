#pragma once

#include <functional>
#include <vector>

#include "clients/ctl/report/doctor.h"

/// A healthy host, and every fault that the doctor finds.
namespace footing::ctl::doctor {

inline constexpr std::uint32_t kFootingGid = 990;

/// A host on which all is well: one Wiimote in the left hand, one tared board whose place is known.
inline Facts HealthyHost() {
  Facts facts;
  facts.user = {"ann", 1000, {1000, kFootingGid}};
  facts.daemons[321] = {"footing", 995, {kFootingGid}};
  facts.footing_gid = kFootingGid;
  facts.user_listed_in_group = true;
  facts.hid = {{"0005:057E:0306.0001", "Nintendo RVL-CNT-01", "00:1f:32:aa:bb:cc", "hid-generic",
                "/dev/hidraw0", true, 0, kFootingGid, 0660}};
  facts.udev_rules = {"/usr/lib/udev/rules.d/70-footing.rules"};
  facts.adapters = {{"hci0", false, false, true, 2}};
  facts.bluetoothd_running = true;
  facts.bluez_version = "5.66";
  facts.known = {{"00:1F:32:AA:BB:CC", "Nintendo RVL-CNT-01", true, true, true, true}};
  facts.footingd_reached = true;
  facts.footingd_address = "unix:/run/footing/sensor.sock";
  facts.footingd_version = facts.own_version = "0.1.0";
  stream::DeviceStatus wiimote;
  wiimote.device = 1;
  wiimote.serial = "00:1f:32:aa:bb:cc";
  wiimote.kind = stream::DeviceKind::kWiimote;
  wiimote.rig = "main";
  wiimote.role = stream::DeviceRole::kLeftHand;
  wiimote.state = stream::DeviceState::kLive;
  wiimote.calibration = stream::CalibrationOrigin::kDevice;
  wiimote.report_rate_hz = 100;
  wiimote.jitter_ms = 3;
  wiimote.reports = 10'000;
  wiimote.battery_fraction = 0.8;
  stream::DeviceStatus board = wiimote;
  board.device = 2;
  board.serial = "00:22:4c:11:22:33";
  board.kind = stream::DeviceKind::kBalanceBoard;
  board.role = stream::DeviceRole::kLeftBoard;
  board.tared = true;
  facts.devices = {wiimote, board};
  stream::RigSetup rig;
  rig.rig = "main";
  rig.layout.preset = "single";
  rig.items = {{"tare", board.serial, true, 1, 0.1, "N", "", false}};
  facts.setup = {rig};
  return facts;
}

inline stream::DeviceStatus& Wiimote(Facts& facts) { return facts.devices[0]; }
inline stream::DeviceStatus& Board(Facts& facts) { return facts.devices[1]; }

/// A fault of a host, and the finding that it makes.
struct Case {
  const char* id;
  Severity severity;
  const char* remedy;  ///< A part of it.
  std::function<void(Facts&)> fault;
};

inline std::vector<Case> Cases() {
  using S = Severity;
  return {
      {"footingd_not_running", S::kError, "systemctl start",
       [](Facts& f) {
         f.footingd_reached = false;
         f.daemons.clear();
       }},
      {"second_daemon", S::kError, "kill 321 400, without",
       [](Facts& f) { f.daemons[400] = f.user; }},
      {"other_version", S::kNote, "restart", [](Facts& f) { f.footingd_version = "0.0.9"; }},
      {"node_without_permission", S::kError, "70-footing.rules",
       [](Facts& f) {
         f.hid[0].node_gid = 0;
         f.udev_rules.clear();
       }},
      {"udev_rule_missing", S::kWarning, "udevadm", [](Facts& f) { f.udev_rules.clear(); }},
      {"user_not_in_group", S::kWarning, "usermod -aG footing ann",
       [](Facts& f) {
         f.user.gids = {1000};
         f.user_listed_in_group = false;
       }},
      {"hidraw_missing", S::kError, "ignore_special_drivers=1",
       [](Facts& f) {
         f.hid[0].node.clear();
         f.hid[0].driver.clear();
       }},
      {"driver_blacklisted", S::kError,
       "sed -i '/hid.wiimote/d' /etc/modprobe.d/no-wii.conf && sudo modprobe hid_wiimote",
       [](Facts& f) { f.others.blacklists = {"/etc/modprobe.d/no-wii.conf"}; }},
      {"wrong_driver", S::kWarning, "stop the program",
       [](Facts& f) { f.hid[0].driver = "steam"; }},
      {"driver_in_the_way", S::kNote, "update-initramfs",
       [](Facts& f) { f.hid[0].driver = "wiimote"; }},
      {"steam_writes", S::kNote, "Controller",
       [](Facts& f) {
         f.hid[0].sysfs_id = "0005:057E:2006.0001";
         f.others.steam_running = true;
       }},
      {"joycond_rule", S::kWarning, "90-footing.rules",
       [](Facts& f) {
         f.hid[0].sysfs_id = "0005:057E:2009.0001";
         f.others.joycond_rules = {"/usr/lib/udev/rules.d/89-joycond.rules"};
       }},
      {"no_adapter", S::kError, "lsusb",
       [](Facts& f) {
         f.adapters.clear();
         f.devices.clear();
       }},
      {"adapter_blocked", S::kError, "rfkill unblock",
       [](Facts& f) { f.adapters[0].blocked_soft = true; }},
      {"adapter_off", S::kError, "power on", [](Facts& f) { f.adapters[0].powered = false; }},
      {"bluetoothd_missing", S::kError, "enable --now bluetooth",
       [](Facts& f) { f.bluetoothd_running = false; }},
      {"unbonded_refused", S::kWarning, "ClassicBondedOnly=false",
       [](Facts& f) { f.known[0].bonded = f.known[0].connected = false; }},
      {"unbonded_allowed", S::kNote, "remove the line",
       [](Facts& f) { f.input_config["ClassicBondedOnly"] = "false"; }},
      {"nodes_persist", S::kWarning, "UserspaceHID=true",
       [](Facts& f) { f.input_config["UserspaceHID"] = "persist"; }},
      {"bluez_pairing_regression", S::kWarning, "red button",
       [](Facts& f) {
         f.bluez_version = "5.77";
         f.devices.clear();
       }},
      {"paired_not_connected", S::kWarning, "connect 00:1F:32:AA:BB:CC",
       [](Facts& f) { f.known[0].connected = false; }},
      {"paired_not_trusted", S::kWarning, "trust 00:1F:32:AA:BB:CC",
       [](Facts& f) { f.known[0].trusted = false; }},
      {"connected_without_hid", S::kError, "modprobe -a uhid hidp",
       [](Facts& f) { f.hid.clear(); }},
      {"too_many_devices", S::kError, "second adapter", [](Facts& f) { f.adapters[0].links = 8; }},
      {"no_device", S::kWarning, "pair wiimote", [](Facts& f) { f.devices.clear(); }},
      {"device_silent", S::kError, "all four",
       [](Facts& f) { Board(f).state = stream::DeviceState::kStale; }},
      {"device_lost", S::kWarning, "press a button",
       [](Facts& f) { Wiimote(f).state = stream::DeviceState::kLost; }},
      {"battery_low", S::kWarning, "two AA", [](Facts& f) { Wiimote(f).battery_low = true; }},
      {"uncalibrated", S::kWarning, "off and on",
       [](Facts& f) { Wiimote(f).calibration = stream::CalibrationOrigin::kDefaults; }},
      {"poor_link", S::kWarning, "nearer", [](Facts& f) { Wiimote(f).report_rate_hz = 31; }},
      {"mode_stolen", S::kWarning, "fuser", [](Facts& f) { Wiimote(f).mode_reasserts = 100; }},
      {"reports_dropped", S::kWarning, "top", [](Facts& f) { Wiimote(f).queue_drops = 3; }},
      {"writes_failed", S::kWarning, "off and on", [](Facts& f) { Wiimote(f).writes_failed = 2; }},
      {"undecodable", S::kWarning, "--connect unix:/run/footing/sensor.sock",
       [](Facts& f) { Wiimote(f).undecodable = 500; }},
      {"loose_plug", S::kWarning, "plug", [](Facts& f) { Wiimote(f).extension_changes = 40; }},
      {"unknown_extension", S::kNote, "pull",
       [](Facts& f) { Wiimote(f).extension = stream::Extension::kUnknown; }},
      {"clock_uncertain", S::kWarning, "10 s", [](Facts& f) { Wiimote(f).clock_offset_sd_ms = 9; }},
      {"no_role", S::kWarning, "assign 00:1f:32:aa:bb:cc",
       [](Facts& f) { Wiimote(f).role = stream::DeviceRole::kUnspecified; }},
      {"device_note", S::kNote, "watch", [](Facts& f) { Wiimote(f).note = "odd"; }},
      {"setup_stale", S::kWarning, "--only tare",
       [](Facts& f) { f.setup[0].items[0].stale = true; }},
      {"setup_failed", S::kWarning, "--only tare",
       [](Facts& f) { f.setup[0].items[0].passed = false; }},
      {"board_not_tared", S::kWarning, "tare 00:22:4c:11:22:33",
       [](Facts& f) { Board(f).tared = false; }},
      {"layout_missing", S::kWarning, "layout --rig main", [](Facts& f) { f.setup.clear(); }},
      {"layout_single", S::kError, "--preset one_foot_each",
       [](Facts& f) {
         f.devices.push_back(Board(f));
         f.devices.back().device = 3;
         f.devices.back().serial = "00:22:4c:11:22:44";
         f.devices.back().role = stream::DeviceRole::kRightBoard;
       }},
      {"board_moved", S::kWarning, "--check", [](Facts& f) { Board(f).moved = true; }},
      {"mounting_slipped", S::kWarning, "--only mounting",
       [](Facts& f) { Wiimote(f).slipped = true; }},
      {"mounting_missing", S::kWarning, "--only mounting",
       [](Facts& f) { Wiimote(f).role = stream::DeviceRole::kLeftLeg; }},
  };
}

}  // namespace footing::ctl::doctor
