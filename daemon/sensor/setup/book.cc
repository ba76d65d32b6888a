#include "daemon/sensor/setup/book.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace footing::setup {
namespace {

using Json = nlohmann::json;

/// Text may come from a client or a device: what is no UTF-8 is replaced, not thrown.
std::string Text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

double Finite(const Json& json, const char* key) {
  const double value = json.at(key).get<double>();
  return std::isfinite(value) ? value : 0;
}

Json ToJson(const stream::BoardPose& pose) {
  return {{"x_m", pose.x_m}, {"y_m", pose.y_m}, {"yaw_rad", pose.yaw_rad}};
}

stream::BoardPose PoseFrom(const Json& json) {
  return {Finite(json, "x_m"), Finite(json, "y_m"), Finite(json, "yaw_rad")};
}

Json ToJson(const stream::BoardLayout& layout) {
  return {{"rig", layout.rig},
          {"left", ToJson(layout.left)},
          {"right", ToJson(layout.right)},
          {"gap_mm", layout.gap_mm},
          {"preset", layout.preset}};
}

stream::BoardLayout LayoutFrom(const Json& json) {
  return {json.at("rig"), PoseFrom(json.at("left")), PoseFrom(json.at("right")),
          Finite(json, "gap_mm"), json.at("preset")};
}

Json ToJson(const stream::SetupItem& item) {
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

/// Reads one piece; what does not have the form is refused by name and not used at all.
template <typename Read>
void Open(const Shelf& shelf, const char* name, Read read) {
  if (!shelf.load) return;
  const auto content = shelf.load(name);
  if (!content) return;
  try {
    read(Json::parse(*content));
  } catch (const Json::exception& error) {
    if (shelf.refuse) shelf.refuse(name, error.what());
  }
}

}  // namespace

Book::Book(Shelf shelf) : shelf_(std::move(shelf)) {
  Open(shelf_, "roles",
       [this](const Json& json) { roles_ = json.get<std::map<std::string, std::string>>(); });
  Open(shelf_, "tares", [this](const Json& json) {
    std::map<std::string, StoredTare> tares;
    for (const auto& [serial, one] : json.items()) {
      tares[serial] = {{Finite(one, "top_left_n"), Finite(one, "top_right_n"),
                        Finite(one, "bottom_left_n"), Finite(one, "bottom_right_n")},
                       Finite(one, "residual_n")};
    }
    tares_ = std::move(tares);
  });
  Open(shelf_, "mountings", [this](const Json& json) {
    std::map<std::string, StoredMounting> mountings;
    for (const auto& [serial, one] : json.items()) {
      Eigen::Quaterniond rotation(Finite(one, "w"), Finite(one, "x"), Finite(one, "y"),
                                  Finite(one, "z"));
      if (std::abs(rotation.norm() - 1) > 0.01) continue;  // No rotation: not mounted.
      mountings[serial] = {one.at("role"), rotation.normalized(), Finite(one, "residual_rad"),
                           one.at("slipped")};
    }
    mountings_ = std::move(mountings);
  });
  Open(shelf_, "layouts", [this](const Json& json) {
    std::map<std::string, stream::BoardLayout> layouts;
    for (const auto& [rig, one] : json.items()) layouts[rig] = LayoutFrom(one);
    layouts_ = std::move(layouts);
  });
  Open(shelf_, "items", [this](const Json& json) {
    std::map<std::string, std::vector<stream::SetupItem>> items;
    for (const auto& [rig, list] : json.items()) {
      for (const Json& one : list) items[rig].push_back(ItemFrom(one));
    }
    items_ = std::move(items);
  });
  Open(shelf_, "moved",
       [this](const Json& json) { moved_ = json.get<std::map<std::string, bool>>(); });
}

void Book::Save(const std::string& name, const std::string& content) {
  ++revision_;
  if (shelf_.save) shelf_.save(name, content);
}

void Book::SetRole(const std::string& serial, const std::string& role) {
  if (role.empty()) {
    if (roles_.erase(serial) == 0) return;
  } else if (roles_.size() < kMostSerials || roles_.contains(serial)) {
    roles_[serial] = role;
  }
  SaveRoles();
}
void Book::SaveRoles() { Save("roles", Text(Json(roles_))); }

std::optional<StoredTare> Book::TareOf(const std::string& serial) const {
  const auto found = tares_.find(serial);
  return found == tares_.end() ? std::nullopt : std::optional(found->second);
}

void Book::SetTare(const std::string& serial, const std::optional<StoredTare>& tare) {
  if (!tare) {
    tares_.erase(serial);
  } else if (tares_.size() < kMostSerials || tares_.contains(serial)) {
    tares_[serial] = *tare;
  }
  SaveTares();
}

void Book::SaveTares() {
  Json json = Json::object();
  for (const auto& [serial, one] : tares_) {
    json[serial] = {{"top_left_n", one.offset.top_left_n},
                    {"top_right_n", one.offset.top_right_n},
                    {"bottom_left_n", one.offset.bottom_left_n},
                    {"bottom_right_n", one.offset.bottom_right_n},
                    {"residual_n", one.residual_n}};
  }
  Save("tares", Text(json));
}

std::optional<StoredMounting> Book::MountingOf(const std::string& serial,
                                               const std::string& role) const {
  const auto found = mountings_.find(serial);
  if (found == mountings_.end() || found->second.role != role) return std::nullopt;
  return found->second;
}

void Book::SetMounting(const std::string& serial, const std::optional<StoredMounting>& mounting) {
  if (!mounting) {
    mountings_.erase(serial);
  } else if (mountings_.size() < kMostSerials || mountings_.contains(serial)) {
    mountings_[serial] = *mounting;
  }
  SaveMountings();
}

void Book::SaveMountings() {
  Json json = Json::object();
  for (const auto& [serial, one] : mountings_) {
    json[serial] = {{"role", one.role},         {"w", one.rotation_MS.w()},
                    {"x", one.rotation_MS.x()}, {"y", one.rotation_MS.y()},
                    {"z", one.rotation_MS.z()}, {"residual_rad", one.residual_rad},
                    {"slipped", one.slipped}};
  }
  Save("mountings", Text(json));
}

bool Book::SetLayout(const stream::BoardLayout& layout) {
  if (layouts_.size() >= kMostRigs && !layouts_.contains(layout.rig)) return false;
  layouts_[layout.rig] = layout;
  SaveLayouts();
  return true;
}

stream::BoardLayout Book::LayoutOf(const std::string& rig) const {
  const auto found = layouts_.find(rig);
  return found == layouts_.end() ? stream::BoardLayout{} : found->second;
}

bool Book::LayoutChecked(const std::string& rig) const {
  const auto found = items_.find(rig);
  return found != items_.end() &&
         std::any_of(found->second.begin(), found->second.end(), [](const auto& one) {
           return one.name == "layout" && one.passed && !one.stale;
         });
}

void Book::SaveLayouts() {
  Json json = Json::object();
  for (const auto& [rig, one] : layouts_) json[rig] = ToJson(one);
  Save("layouts", Text(json));
}

bool Book::Record(const std::string& rig, const stream::SetupItem& item) {
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
  SaveItems();
  return true;
}

void Book::Forget(const std::string& rig, const std::string& name, const std::string& serial) {
  const auto found = items_.find(rig);
  if (found == items_.end()) return;
  std::erase_if(found->second, [&name, &serial](const auto& one) {
    return (name.empty() || one.name == name) && (serial.empty() || one.serial == serial);
  });
  if (found->second.empty()) items_.erase(found);
  SaveItems();
}

void Book::MarkStale(const std::string& rig, const std::string& name, const std::string& serial,
                     const std::string& why) {
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
  if (changed) SaveItems();
}

void Book::SaveItems() {
  Json json = Json::object();
  for (const auto& [rig, list] : items_) {
    json[rig] = Json::array();
    for (const auto& one : list) json[rig].push_back(ToJson(one));
  }
  Save("items", Text(json));
}

void Book::SetMoved(const std::string& serial, bool moved) {
  if (moved == Moved(serial)) return;
  if (moved) {
    moved_[serial] = true;
  } else {
    moved_.erase(serial);
  }
  SaveMoved();
}
void Book::SaveMoved() { Save("moved", Text(Json(moved_))); }

std::vector<stream::RigSetup> Book::Rigs() const {
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

std::optional<std::vector<std::uint8_t>> CalibrationShelf::Load(const std::string& serial) const {
  std::optional<std::vector<std::uint8_t>> bytes;
  const std::string name = "calibration-" + serial;
  Open(shelf_, name.c_str(), [&](const Json& json) {
    const std::string hex = json.at("hex");
    const bool whole =
        hex.size() % 2 == 0 && hex.find_first_not_of("0123456789abcdef") == std::string::npos;
    if (json.at("serial") != serial || !whole || hex.empty()) {
      if (shelf_.refuse) shelf_.refuse(name, "it is of another device, or no calibration");
      return;
    }
    bytes.emplace();
    for (std::size_t i = 0; i < hex.size(); i += 2) {
      bytes->push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
    }
  });
  return bytes;
}

void CalibrationShelf::Save(const std::string& serial,
                            const std::vector<std::uint8_t>& bytes) const {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string hex;
  for (const std::uint8_t byte : bytes) {
    hex += kDigits[byte >> 4];
    hex += kDigits[byte & 15];
  }
  if (shelf_.save) {
    shelf_.save("calibration-" + serial, Text(Json{{"serial", serial}, {"hex", hex}}));
  }
}

}  // namespace footing::setup
