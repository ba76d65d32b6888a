#include "daemon/sensor/setup/setup_store.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include <nlohmann/json.hpp>

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

namespace {

std::string NameOf(const std::string& serial) { return "calibration-" + serial; }

}  // namespace

std::optional<std::vector<std::uint8_t>> CalibrationStore::Load(const std::string& serial) const {
  auto stored = setup::Load(storage_, NameOf(serial), CalibrationFromJson);
  if (!stored) return std::nullopt;
  if (stored->serial == serial) return std::move(stored->bytes);
  if (storage_.refuse) storage_.refuse(NameOf(serial), "it is of another device");
  return std::nullopt;
}

void CalibrationStore::Save(const std::string& serial,
                            const std::vector<std::uint8_t>& bytes) const {
  if (storage_.save) storage_.save(NameOf(serial), ToJson(StoredCalibration{serial, bytes}));
}

namespace {

using Json = nlohmann::json;

/// Text may come from a client or a device: what is not UTF-8 is replaced, not thrown.
std::string Dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

template <typename Part>
Result<Part> Parse(const std::string& text, Part (*read)(const Json& json)) {
  try {
    return read(Json::parse(text));
  } catch (const Json::exception& error) {
    return InvalidData(error.what());
  }
}

double Finite(const Json& json, const char* key) {
  const double value = json.at(key).get<double>();
  return std::isfinite(value) ? value : 0;
}

Json PoseJson(const stream::BoardPose& pose) {
  return {{"x_m", pose.x_m}, {"y_m", pose.y_m}, {"yaw_rad", pose.yaw_rad}};
}

stream::BoardPose PoseFrom(const Json& json) {
  return {Finite(json, "x_m"), Finite(json, "y_m"), Finite(json, "yaw_rad")};
}

stream::BoardLayout LayoutFrom(const Json& json) {
  return {json.at("rig"), PoseFrom(json.at("left")), PoseFrom(json.at("right")),
          Finite(json, "gap_mm"), json.at("preset")};
}

Json ItemJson(const stream::SetupItem& item) {
  return {{"name", item.name},
          {"serial", item.serial},
          {"passed", item.passed},
          {"wall_time_ns", item.wall_time_ns},
          {"residual", std::isfinite(item.residual) ? item.residual : 0},
          {"unit", item.unit},
          {"note", item.note},
          {"stale", item.stale}};
}

stream::SetupItem ItemFrom(const Json& json) {
  stream::SetupItem item;
  item.name = json.at("name");
  item.serial = json.at("serial");
  item.passed = json.at("passed");
  item.wall_time_ns = json.at("wall_time_ns");
  item.residual = Finite(json, "residual");
  item.unit = json.at("unit");
  item.note = json.at("note");
  item.stale = json.at("stale");
  return item;
}

bool IsHex(const std::string& text) {
  return !text.empty() && text.size() % 2 == 0 &&
         text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

}  // namespace

std::string ToJson(const Roles& roles) { return Dump(Json(roles)); }

Result<Roles> RolesFromJson(const std::string& text) {
  return Parse<Roles>(text, [](const Json& json) { return json.get<Roles>(); });
}

std::string ToJson(const Tares& tares) {
  Json json = Json::object();
  for (const auto& [serial, one] : tares) {
    json[serial] = {{"top_left_n", one.offset.top_left_n},
                    {"top_right_n", one.offset.top_right_n},
                    {"bottom_left_n", one.offset.bottom_left_n},
                    {"bottom_right_n", one.offset.bottom_right_n},
                    {"residual_n", one.residual_n}};
  }
  return Dump(json);
}

Result<Tares> TaresFromJson(const std::string& text) {
  return Parse<Tares>(text, [](const Json& json) {
    Tares tares;
    for (const auto& [serial, one] : json.items()) {
      tares[serial] = {{Finite(one, "top_left_n"), Finite(one, "top_right_n"),
                        Finite(one, "bottom_left_n"), Finite(one, "bottom_right_n")},
                       Finite(one, "residual_n")};
    }
    return tares;
  });
}

std::string ToJson(const Mountings& mountings) {
  Json json = Json::object();
  for (const auto& [serial, one] : mountings) {
    json[serial] = {{"role", one.role},         {"w", one.rotation_MS.w()},
                    {"x", one.rotation_MS.x()}, {"y", one.rotation_MS.y()},
                    {"z", one.rotation_MS.z()}, {"residual_rad", one.residual_rad},
                    {"slipped", one.slipped}};
  }
  return Dump(json);
}

Result<Mountings> MountingsFromJson(const std::string& text) {
  return Parse<Mountings>(text, [](const Json& json) {
    Mountings mountings;
    for (const auto& [serial, one] : json.items()) {
      const Eigen::Quaterniond rotation(Finite(one, "w"), Finite(one, "x"), Finite(one, "y"),
                                        Finite(one, "z"));
      if (std::abs(rotation.norm() - 1) > 0.01) continue;
      mountings[serial] = {one.at("role"), rotation.normalized(), Finite(one, "residual_rad"),
                           one.at("slipped")};
    }
    return mountings;
  });
}

std::string ToJson(const Layouts& layouts) {
  Json json = Json::object();
  for (const auto& [rig, one] : layouts) {
    json[rig] = {{"rig", one.rig},
                 {"left", PoseJson(one.left)},
                 {"right", PoseJson(one.right)},
                 {"gap_mm", one.gap_mm},
                 {"preset", one.preset}};
  }
  return Dump(json);
}

Result<Layouts> LayoutsFromJson(const std::string& text) {
  return Parse<Layouts>(text, [](const Json& json) {
    Layouts layouts;
    for (const auto& [rig, one] : json.items()) layouts[rig] = LayoutFrom(one);
    return layouts;
  });
}

std::string ToJson(const Items& items) {
  Json json = Json::object();
  for (const auto& [rig, list] : items) {
    json[rig] = Json::array();
    for (const auto& one : list) json[rig].push_back(ItemJson(one));
  }
  return Dump(json);
}

Result<Items> ItemsFromJson(const std::string& text) {
  return Parse<Items>(text, [](const Json& json) {
    Items items;
    for (const auto& [rig, list] : json.items()) {
      for (const Json& one : list) items[rig].push_back(ItemFrom(one));
    }
    return items;
  });
}

std::string ToJson(const MovedBoards& boards) { return Dump(Json(boards)); }

Result<MovedBoards> MovedBoardsFromJson(const std::string& text) {
  return Parse<MovedBoards>(text, [](const Json& json) { return json.get<MovedBoards>(); });
}

std::string ToJson(const StoredCalibration& calibration) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string hex;
  for (const std::uint8_t byte : calibration.bytes) {
    hex += kDigits[byte >> 4];
    hex += kDigits[byte & 15];
  }
  return Dump(Json{{"serial", calibration.serial}, {"hex", hex}});
}

Result<StoredCalibration> CalibrationFromJson(const std::string& text) {
  auto calibration = Parse<StoredCalibration>(text, [](const Json& json) {
    StoredCalibration read{json.at("serial"), {}};
    const std::string hex = json.at("hex");
    for (std::size_t i = 0; IsHex(hex) && i < hex.size(); i += 2) {
      read.bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
    }
    return read;
  });
  if (calibration && calibration->bytes.empty()) return InvalidData("it is not a calibration");
  return calibration;
}

}  // namespace footing::setup
