#include "daemon/sensor/setup/setup_store.h"

#include <algorithm>
#include <map>
#include <utility>

#include "daemon/sensor/setup/setup_json.h"

namespace footing::setup {
namespace {

constexpr std::size_t kMostSerials = 256;

// Names of the parts, and so of their files.
constexpr char kRoles[] = "roles";
constexpr char kTares[] = "tares";
constexpr char kMountings[] = "mountings";
constexpr char kLayouts[] = "layouts";
constexpr char kItems[] = "items";
constexpr char kMoved[] = "moved";

/// Sets or erases the entry of a serial; a full map takes no new serial.
template <typename Entry>
void Assign(std::map<std::string, Entry>& entries, const std::string& serial,
            const std::optional<Entry>& entry) {
  if (!entry) {
    entries.erase(serial);
  } else if (entries.size() < kMostSerials || entries.contains(serial)) {
    entries[serial] = *entry;
  }
}

}  // namespace

SetupStore::SetupStore(Storage storage)
    : storage_(std::move(storage)),
      roles_(Load(storage_, kRoles, RolesFromJson).value_or(Roles())),
      tares_(Load(storage_, kTares, TaresFromJson).value_or(Tares())),
      mountings_(Load(storage_, kMountings, MountingsFromJson).value_or(Mountings())),
      layouts_(Load(storage_, kLayouts, LayoutsFromJson).value_or(Layouts())),
      items_(Load(storage_, kItems, ItemsFromJson).value_or(Items())),
      moved_(Load(storage_, kMoved, MovedBoardsFromJson).value_or(MovedBoards())) {}

void SetupStore::Save(const std::string& name, const std::string& content) {
  ++revision_;
  if (storage_.save) storage_.save(name, content);
}

void SetupStore::SetRole(const std::string& serial, const std::string& role) {
  if (role.empty() && !roles_.contains(serial)) return;
  Assign(roles_, serial, role.empty() ? std::nullopt : std::optional(role));
  Save(kRoles, ToJson(roles_));
}

std::optional<StoredTare> SetupStore::TareOf(const std::string& serial) const {
  const auto found = tares_.find(serial);
  return found == tares_.end() ? std::nullopt : std::optional(found->second);
}

void SetupStore::SetTare(const std::string& serial, const std::optional<StoredTare>& tare) {
  Assign(tares_, serial, tare);
  Save(kTares, ToJson(tares_));
}

std::optional<StoredMounting> SetupStore::MountingOf(const std::string& serial,
                                                     const std::string& role) const {
  const auto found = mountings_.find(serial);
  if (found == mountings_.end() || found->second.role != role) return std::nullopt;
  return found->second;
}

void SetupStore::SetMounting(const std::string& serial,
                             const std::optional<StoredMounting>& mounting) {
  Assign(mountings_, serial, mounting);
  Save(kMountings, ToJson(mountings_));
}

bool SetupStore::SetLayout(const stream::BoardLayout& layout) {
  if (layouts_.size() >= kMostRigs && !layouts_.contains(layout.rig)) return false;
  layouts_[layout.rig] = layout;
  Save(kLayouts, ToJson(layouts_));
  return true;
}

stream::BoardLayout SetupStore::LayoutOf(const std::string& rig) const {
  const auto found = layouts_.find(rig);
  return found == layouts_.end() ? stream::BoardLayout{} : found->second;
}

bool SetupStore::LayoutChecked(const std::string& rig) const {
  const auto found = items_.find(rig);
  return found != items_.end() &&
         std::any_of(found->second.begin(), found->second.end(), [](const auto& one) {
           return one.name == "layout" && one.passed && !one.stale;
         });
}

bool SetupStore::Record(const std::string& rig, const stream::SetupItem& item) {
  if (items_.size() >= kMostRigs && !items_.contains(rig)) return false;
  auto& items = items_[rig];
  const auto same = std::find_if(items.begin(), items.end(), [&item](const auto& one) {
    return one.name == item.name && one.serial == item.serial;
  });
  if (same != items.end()) {
    *same = item;
  } else if (items.size() < kMostItems) {
    items.push_back(item);
  } else {
    return false;
  }
  Save(kItems, ToJson(items_));
  return true;
}

void SetupStore::Forget(const std::string& rig, const std::string& name,
                        const std::string& serial) {
  const auto found = items_.find(rig);
  if (found == items_.end()) return;
  std::erase_if(found->second, [&name, &serial](const auto& one) {
    return (name.empty() || one.name == name) && (serial.empty() || one.serial == serial);
  });
  if (found->second.empty()) items_.erase(found);
  Save(kItems, ToJson(items_));
}

void SetupStore::MarkStale(const std::string& rig, const std::string& name,
                           const std::string& serial, const std::string& why) {
  const auto found = items_.find(rig);
  if (found == items_.end()) return;
  bool changed = false;
  for (stream::SetupItem& item : found->second) {
    const bool meant = item.name == name && (serial.empty() || item.serial == serial);
    if (!meant || item.stale) continue;
    item.stale = true;
    item.note = why;
    changed = true;
  }
  if (changed) Save(kItems, ToJson(items_));
}

void SetupStore::SetMoved(const std::string& serial, bool moved) {
  if (moved == Moved(serial)) return;
  if (moved) {
    moved_[serial] = true;
  } else {
    moved_.erase(serial);
  }
  Save(kMoved, ToJson(moved_));
}

std::vector<stream::RigSetup> SetupStore::Rigs() const {
  std::map<std::string, stream::RigSetup> rigs;
  for (const auto& [rig, layout] : layouts_) rigs[rig].layout = layout;
  for (const auto& [rig, items] : items_) rigs[rig].items = items;
  for (const auto& [serial, one] : mountings_) {
    rigs[one.role.substr(0, one.role.find('/'))].mountings.push_back(
        {serial, one.rotation_MS, one.residual_rad});
  }
  std::vector<stream::RigSetup> list;
  for (auto& [rig, setup] : rigs) {
    setup.rig = rig;
    list.push_back(std::move(setup));
  }
  return list;
}

}  // namespace footing::setup
