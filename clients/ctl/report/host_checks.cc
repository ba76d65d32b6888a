#include <algorithm>

#include "clients/ctl/report/checks.h"
#include "common/base/joined.h"

namespace footing::ctl::doctor {
namespace {

/// In Footing's folder. A rule that names a group that does not exist is ignored by udev.
std::string InstallRule(const Facts& facts) {
  return std::string(facts.footing_gid ? "" : "sudo groupadd --system footing && ") +
         "sudo cp systemd/70-footing.rules /etc/udev/rules.d/ && sudo udevadm control --reload && "
         "sudo udevadm trigger --subsystem-match=hidraw";
}

std::string NeverBlacklist() {
  return std::string(
             "never blacklist or unbind hid_wiimote: without it there is no hidraw at "
             "all; to keep it away: ") +
         kIgnoreSpecialDrivers;
}

bool MayOpen(const User& who, const HidDevice& hid) {
  if (who.uid == 0) return true;
  constexpr std::uint32_t kReadWrite = 6;
  const bool in_group = std::find(who.gids.begin(), who.gids.end(), hid.node_gid) != who.gids.end();
  const unsigned shift = who.uid == hid.node_uid ? 6 : in_group ? 3 : 0;
  return (hid.node_mode >> shift & kReadWrite) == kReadWrite;
}

bool IsNintendo(const HidDevice& hid) { return hid.sysfs_id.find(":057E:") != std::string::npos; }

/// Or needs no group.
bool InGroup(const Facts& facts) {
  const auto& gids = facts.user.gids;
  return !facts.footing_gid || facts.user.uid == 0 ||
         std::find(gids.begin(), gids.end(), *facts.footing_gid) != gids.end();
}

std::vector<Symptom> NotRunning(const Facts& facts) {
  if (facts.footingd_reached) return {};
  const bool elsewhere = !facts.daemons.empty();
  if (elsewhere && !InGroup(facts)) {
    return {{Severity::kError,
             "a footingd runs, but " + facts.user.name + " may not reach its socket",
             facts.footingd_address,
             "sudo usermod -aG footing " + facts.user.name + ", then log in again"}};
  }
  return {{Severity::kError,
           elsewhere ? "a footingd runs, but not at this address: " + facts.footingd_trouble
                     : "footingd is not running: " + facts.footingd_trouble,
           facts.footingd_address,
           elsewhere
               ? "footing-ctl --connect ADDRESS doctor, with an address that footingd listens "
                 "on"
               : "sudo systemctl start footingd.service, or run footingd in a terminal"}};
}

std::vector<Symptom> SecondDaemon(const Facts& facts) {
  if (facts.daemons.size() < 2) return {};
  std::vector<std::string> owners, numbers;
  bool foreign = false;
  for (const auto& [number, user] : facts.daemons) {
    owners.push_back(std::to_string(number) + " of " + user.name);
    numbers.push_back(std::to_string(number));
    foreign = foreign || user.uid != facts.user.uid;
  }
  // Without a device there is nothing to fight over yet.
  const bool fight = !facts.hid.empty();
  return {{fight ? Severity::kError : Severity::kWarning,
           std::to_string(facts.daemons.size()) + " footingd run; they " + (fight ? "" : "would ") +
               "write to the same devices and undo each other's settings",
           "processes " + text::Joined(owners),
           std::string(foreign ? "sudo " : "") + "kill " + text::Joined(numbers, " ") +
               ", without the number of the one to keep"}};
}

std::vector<Symptom> OtherVersion(const Facts& facts) {
  if (!facts.footingd_reached || facts.footingd_version == facts.own_version) return {};
  return {{Severity::kNote,
           "footingd is version " + facts.footingd_version + ", footing-ctl " + facts.own_version,
           facts.footingd_address, "sudo systemctl restart footingd.service, after an upgrade"}};
}

std::vector<Symptom> NoPermission(const Facts& facts) {
  std::vector<Symptom> found;
  const User& opener = OpenerOfNodes(facts);
  for (const HidDevice& hid : facts.hid) {
    if (hid.node.empty() || !hid.node_exists || MayOpen(opener, hid)) continue;
    const bool rule = !facts.udev_rules.empty();
    const bool group = facts.footing_gid && *facts.footing_gid == hid.node_gid;
    found.push_back({Severity::kError, opener.name + " may not open " + hid.name + " " + hid.serial,
                     hid.node,
                     group  ? "sudo usermod -aG footing " + opener.name + ", then log in again"
                     : rule ? "sudo udevadm trigger --subsystem-match=hidraw (the rule " +
                                  facts.udev_rules.front() + " was not applied to it)"
                            : InstallRule(facts)});
  }
  return found;
}

std::vector<Symptom> RuleMissing(const Facts& facts) {
  if (!facts.udev_rules.empty() || OpenerOfNodes(facts).uid == 0) return {};
  return {{facts.hid.empty() ? Severity::kNote : Severity::kWarning,
           "no udev rule gives the devices' nodes to the group footing", "/etc/udev/rules.d",
           InstallRule(facts)}};
}

std::vector<Symptom> NotInGroup(const Facts& facts) {
  if (InGroup(facts)) return {};
  if (facts.user_listed_in_group) {
    return {{Severity::kWarning,
             facts.user.name + " is in the group footing, but this login is older", "groups",
             "log out and in again, or: newgrp footing"}};
  }
  return {{Severity::kWarning,
           facts.user.name + " is not in the group footing, which owns footingd's socket",
           "/etc/group", "sudo usermod -aG footing " + facts.user.name + ", then log in again"}};
}

std::vector<Symptom> NodeMissing(const Facts& facts) {
  std::vector<Symptom> found;
  for (const HidDevice& hid : facts.hid) {
    if (!hid.node.empty()) continue;
    const bool none = hid.driver.empty();
    found.push_back(
        {Severity::kError,
         hid.name + " " + hid.serial + " has no hidraw node: " +
             (none ? "no kernel driver is bound to it" : "the driver " + hid.driver + " hides it"),
         "/sys/bus/hid/devices/" + hid.sysfs_id,
         IsNintendo(hid) ? std::string("sudo modprobe hid_wiimote, then switch the device off and "
                                       "on; ") +
                               NeverBlacklist()
                         : "sudo modprobe hid_sony, then switch the device off and on"});
  }
  return found;
}

std::vector<Symptom> Blacklisted(const Facts& facts) {
  if (facts.ignore_special_drivers) return {};
  std::vector<Symptom> found;
  for (const std::string& file : facts.blacklists) {
    found.push_back({Severity::kError,
                     "hid_wiimote is blacklisted, so Wiimotes and boards get no hidraw node", file,
                     "sudo sed -i '/hid.wiimote/d' " + file +
                         " && sudo modprobe hid_wiimote, then switch the device off and on; " +
                         NeverBlacklist()});
  }
  return found;
}

std::vector<Symptom> WrongDriver(const Facts& facts) {
  static const std::vector<std::string> right = {"wiimote", "hid-generic", "sony", "playstation"};
  std::vector<Symptom> found;
  for (const HidDevice& hid : facts.hid) {
    if (hid.driver.empty()) continue;
    if (std::find(right.begin(), right.end(), hid.driver) != right.end()) continue;
    found.push_back({Severity::kWarning, hid.name + " is bound to the driver " + hid.driver,
                     "/sys/bus/hid/devices/" + hid.sysfs_id,
                     "stop the program that installed that driver; " + NeverBlacklist()});
  }
  return found;
}

std::vector<Symptom> DriverInTheWay(const Facts& facts) {
  std::vector<Symptom> found;
  for (const HidDevice& hid : facts.hid) {
    if (hid.driver != "wiimote") continue;
    found.push_back({Severity::kNote,
                     "hid_wiimote is bound beside footingd; it changes the report mode after every "
                     "status report, and footingd sets it again",
                     hid.name + " " + hid.serial,
                     "nothing, as long as rates are good; else " + NeverBlacklist() +
                         " (it keeps other special drivers away, too)"});
  }
  return found;
}

}  // namespace

std::vector<Check> HostChecks() {
  return {{"footingd_not_running", NotRunning}, {"second_daemon", SecondDaemon},
          {"other_version", OtherVersion},      {"node_without_permission", NoPermission},
          {"udev_rule_missing", RuleMissing},   {"user_not_in_group", NotInGroup},
          {"hidraw_missing", NodeMissing},      {"driver_blacklisted", Blacklisted},
          {"wrong_driver", WrongDriver},        {"driver_in_the_way", DriverInTheWay}};
}

}  // namespace footing::ctl::doctor
