#include <algorithm>
#include <set>

#include "clients/ctl/report/checks.h"

namespace footing::ctl::doctor {
namespace {

using stream::DeviceKind;
using stream::DeviceStatus;

std::string Redo(const stream::RigSetup& rig, const stream::SetupItem& item) {
  return "footing-ctl setup --rig " + rig.rig + " --only " + item.name;
}

template <typename Bad>
std::vector<Symptom> Items(const Facts& facts, Bad bad, const char* state) {
  std::vector<Symptom> found;
  for (const stream::RigSetup& rig : facts.setup) {
    for (const stream::SetupItem& item : rig.items) {
      if (!bad(item)) continue;
      found.push_back(
          {Severity::kWarning,
           "setup: " + item.name + " " + state + (item.note.empty() ? "" : ": " + item.note),
           item.serial.empty() ? rig.rig : rig.rig + " " + item.serial, Redo(rig, item)});
    }
  }
  return found;
}

std::vector<Symptom> Stale(const Facts& facts) {
  return Items(
      facts, [](const stream::SetupItem& item) { return item.passed && item.stale; },
      "is out of date");
}

std::vector<Symptom> Failed(const Facts& facts) {
  return Items(
      facts, [](const stream::SetupItem& item) { return !item.passed; }, "did not pass");
}

std::vector<Symptom> NotTared(const Facts& facts) {
  std::vector<Symptom> found;
  for (const DeviceStatus& device : facts.devices) {
    if (device.kind != DeviceKind::kBalanceBoard || !IsThere(device) || device.tared) continue;
    found.push_back({Severity::kWarning, "the board is not tared: its empty weight counts as load",
                     Place(device), "step off, then footing-ctl tare " + device.serial});
  }
  return found;
}

std::vector<Symptom> NoLayout(const Facts& facts) {
  std::set<std::string> laid;
  for (const stream::RigSetup& rig : facts.setup) {
    if (!rig.layout.preset.empty()) laid.insert(rig.rig);
  }
  std::set<std::string> reported;
  std::vector<Symptom> found;
  for (const DeviceStatus& device : facts.devices) {
    if (device.kind != DeviceKind::kBalanceBoard || !IsThere(device)) continue;
    if (laid.count(device.rig) > 0 || !reported.insert(device.rig).second) continue;
    found.push_back({Severity::kWarning, "the layout of the boards is not set", device.rig,
                     "footing-ctl layout --rig " + device.rig + " --check"});
  }
  return found;
}

std::vector<Symptom> SingleOfTwo(const Facts& facts) {
  std::vector<Symptom> found;
  for (const stream::RigSetup& rig : facts.setup) {
    const auto boards = std::count_if(facts.devices.begin(), facts.devices.end(),
                                      [&rig](const DeviceStatus& device) {
                                        return device.kind == DeviceKind::kBalanceBoard &&
                                               IsThere(device) && device.rig == rig.rig;
                                      });
    if (rig.layout.preset != "single" || boards < 2) continue;
    found.push_back({Severity::kError,
                     "the layout single is for one board, but " + std::to_string(boards) +
                         " are attached: forces and poses would be wrong",
                     rig.rig,
                     "footing-ctl layout --rig " + rig.rig +
                         " --preset one_foot_each --check, or switch the other board off"});
  }
  return found;
}

std::vector<Symptom> Moved(const Facts& facts) {
  std::vector<Symptom> found;
  for (const DeviceStatus& device : facts.devices) {
    if (!device.moved) continue;
    found.push_back({Severity::kWarning, "the board was moved after its place was checked",
                     Place(device), "footing-ctl layout --rig " + device.rig + " --check"});
  }
  return found;
}

std::vector<Symptom> Slipped(const Facts& facts) {
  std::vector<Symptom> found;
  for (const DeviceStatus& device : facts.devices) {
    if (!device.slipped) continue;
    found.push_back({Severity::kWarning, "it has slipped on its wearer: its directions are wrong",
                     Place(device), "footing-ctl setup --rig " + device.rig + " --only mounting"});
  }
  return found;
}

std::vector<Symptom> NotMounted(const Facts& facts) {
  static const std::set<stream::DeviceRole> mounted_roles = {
      stream::DeviceRole::kLeftLeg, stream::DeviceRole::kRightLeg, stream::DeviceRole::kHead,
      stream::DeviceRole::kTrunk};
  std::vector<Symptom> found;
  for (const DeviceStatus& device : facts.devices) {
    if (!IsThere(device) || device.mounted || mounted_roles.count(device.role) == 0) continue;
    found.push_back({Severity::kWarning, "its mounting is not measured", Place(device),
                     "footing-ctl setup --rig " + device.rig + " --only mounting"});
  }
  return found;
}

}  // namespace

std::vector<Check> SetupChecks() {
  return {{"setup_stale", Stale},         {"setup_failed", Failed},
          {"board_not_tared", NotTared},  {"layout_missing", NoLayout},
          {"layout_single", SingleOfTwo}, {"board_moved", Moved},
          {"mounting_slipped", Slipped},  {"mounting_missing", NotMounted}};
}

}  // namespace footing::ctl::doctor
