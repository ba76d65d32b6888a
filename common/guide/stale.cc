#include <algorithm>

#include "common/guide/set_up.h"

namespace footing::guide {
namespace {

const stream::SetupItem* Find(const std::vector<stream::SetupItem>& items, Item item,
                              const std::string& serial) {
  for (const auto& one : items) {
    if (one.name == Name(item) && one.serial == serial) return &one;
  }
  return nullptr;
}

bool IsBalanceBoard(const stream::DeviceStatus& device) {
  return device.kind == stream::DeviceKind::kBalanceBoard;
}

/// Why the devices of now contradict an item that passed; empty when they do not.
std::string Contradiction(const stream::SetupItem& item,
                          const std::vector<stream::SetupItem>& items,
                          const std::vector<stream::DeviceStatus>& devices) {
  if (item.name == Name(Item::kLayout)) {
    for (const auto& device : devices) {
      if (!IsBalanceBoard(device)) continue;
      if (device.moved) return "a board was moved";
      const auto* roles = Find(items, Item::kRoles, device.serial);
      if (roles != nullptr && roles->wall_time_ns > item.wall_time_ns) {
        return "a board has a new role";
      }
    }
    return "";
  }
  if (item.serial.empty()) return "";
  const auto device = std::find_if(devices.begin(), devices.end(),
                                   [&](const auto& one) { return one.serial == item.serial; });
  if (device == devices.end()) return "this device is not on the rig any more";
  const auto* roles = Find(items, Item::kRoles, item.serial);
  if (item.name == Name(Item::kMounting)) {
    if (device->slipped) return "it slipped";
    if (!device->mounted) return "its mounting is not known any more";
    if (roles != nullptr && roles->wall_time_ns > item.wall_time_ns) return "its role is new";
  }
  if (item.name == Name(Item::kTare)) {
    if (device->moved) return "the board was moved";
    if (!device->tared) return "its tare is not known any more";
  }
  return "";
}

}  // namespace

std::vector<stream::SetupItem> Merged(const std::vector<stream::SetupItem>& recorded,
                                      const std::vector<stream::SetupItem>& results,
                                      const std::vector<stream::DeviceStatus>& rig_devices) {
  std::vector<stream::SetupItem> merged = recorded;
  for (const auto& result : results) {
    const auto same = std::find_if(merged.begin(), merged.end(), [&](const auto& one) {
      return one.name == result.name && one.serial == result.serial;
    });
    if (same == merged.end()) {
      merged.push_back(result);
    } else {
      *same = result;
    }
  }
  std::vector<stream::SetupItem> marked = merged;
  for (auto& item : marked) {
    if (!item.passed || item.stale) continue;
    const std::string why = Contradiction(item, merged, rig_devices);
    if (why.empty()) continue;
    item.stale = true;
    item.note = why + ": footing-ctl setup --only " + item.name;
  }
  std::stable_sort(marked.begin(), marked.end(), [](const auto& a, const auto& b) {
    return ItemNamed(a.name).value_or(Item::kChecks) < ItemNamed(b.name).value_or(Item::kChecks);
  });
  return marked;
}

bool Ready(const std::vector<stream::SetupItem>& items,
           const std::vector<stream::DeviceStatus>& rig_devices,
           std::vector<std::string>* missing) {
  std::vector<std::string> rest;
  const auto need = [&](Item item, const std::string& serial) {
    const auto* found = Find(items, item, serial);
    const std::string name = std::string(Name(item)) + (serial.empty() ? "" : " " + serial);
    if (found == nullptr) {
      rest.push_back(name + ": not done");
    } else if (!found->passed) {
      rest.push_back(name + ": " + found->note);
    } else if (found->stale) {
      rest.push_back(name + ": stale, " + found->note);
    }
  };
  bool boards = false;
  bool any = false;
  need(Item::kAdapter, "");
  for (const auto& device : rig_devices) {
    if (device.state == stream::DeviceState::kLost) continue;
    any = true;
    boards = boards || IsBalanceBoard(device);
    need(Item::kPairing, device.serial);
    need(Item::kRoles, device.serial);
    if (IsBalanceBoard(device)) need(Item::kTare, device.serial);
    const bool was_mounted =
        CanBeMounted(device.role) && Find(items, Item::kMounting, device.serial) != nullptr;
    if (was_mounted || NeedsMounting(device.role)) need(Item::kMounting, device.serial);
    need(Item::kChecks, device.serial);
  }
  if (boards) {
    need(Item::kLayout, "");
    need(Item::kWeigh, "");
  }
  if (!any) rest.push_back("no device is attached to this rig");
  const bool ready = rest.empty();
  if (missing != nullptr) *missing = std::move(rest);
  return ready;
}

}  // namespace footing::guide
