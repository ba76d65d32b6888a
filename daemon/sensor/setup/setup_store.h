#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/result.h"
#include "common/board/geometry.h"
#include "common/stream/setup.h"

namespace footing::setup {

/// Texts kept by name between two runs. Null functions: nothing is kept.
struct Storage {
  /// None if nothing was saved under this name.
  std::function<std::optional<std::string>(const std::string& name)> load;
  std::function<void(const std::string& name, const std::string& content)> save;
  /// For content that its reader does not understand.
  std::function<void(const std::string& name, const std::string& why)> refuse;
};

/// Reads the text saved under this name with `read`. None if there is none; text that it cannot
/// read is refused and none as well.
template <typename Content>
std::optional<Content> Load(const Storage& storage, const std::string& name,
                            Result<Content> (*read)(const std::string& text)) {
  if (!storage.load) return std::nullopt;
  const std::optional<std::string> text = storage.load(name);
  if (!text) return std::nullopt;
  Result<Content> content = read(*text);
  if (content) return std::move(content).value();
  if (storage.refuse) storage.refuse(name, content.error().message);
  return std::nullopt;
}

/// A mounting as stored (mounting::Mounting).
struct StoredMounting {
  std::string role;  ///< "rig/role" that it was found for; stale on another.
  Eigen::Quaterniond rotation_MS = Eigen::Quaterniond::Identity();
  double residual_rad = 0;
  bool slipped = false;  ///< Since it was found.
};

/// A tare as stored (tare::Tare).
struct StoredTare {
  board::CornerForces offset;
  double residual_n = 0;
};

/// Calibration that a device reports of itself.
struct StoredCalibration {
  std::string serial;
  std::vector<std::uint8_t> bytes;
};

/// The parts of a stored set-up. Roles ("rig/role"), tares, mountings and moved boards are by
/// serial, layouts and items by rig.
using Roles = std::map<std::string, std::string>;
using Tares = std::map<std::string, StoredTare>;
using Mountings = std::map<std::string, StoredMounting>;
using Layouts = std::map<std::string, stream::BoardLayout>;
using Items = std::map<std::string, std::vector<stream::SetupItem>>;
using MovedBoards = std::map<std::string, bool>;

/// The set-up of all rigs: roles assigned, tares, mountings, layouts, what was done when, and what
/// is stale since. Every change is saved at once, one text per part.
class SetupStore {
 public:
  explicit SetupStore(Storage storage);

  /// Roles assigned by command.
  const Roles& roles() const { return roles_; }
  /// An empty role forgets it.
  void SetRole(const std::string& serial, const std::string& role);

  /// Tare of the board; none if none is stored.
  std::optional<StoredTare> TareOf(const std::string& serial) const;
  /// Stores the tare; none forgets it.
  void SetTare(const std::string& serial, const std::optional<StoredTare>& tare);

  /// Only when it was found for this "rig/role".
  std::optional<StoredMounting> MountingOf(const std::string& serial,
                                           const std::string& role) const;
  /// Stores the mounting; none forgets it.
  void SetMounting(const std::string& serial, const std::optional<StoredMounting>& mounting);

  /// False when there are too many rigs already.
  bool SetLayout(const stream::BoardLayout& layout);
  /// Replaces the item of that name and serial. False when there are too many already.
  bool Record(const std::string& rig, const stream::SetupItem& item);
  /// Removes the item of that name and serial.
  void Forget(const std::string& rig, const std::string& name, const std::string& serial);
  /// Marks items of that name (of all serials if `serial` is empty) as to be redone.
  void MarkStale(const std::string& rig, const std::string& name, const std::string& serial,
                 const std::string& why);
  /// The layout was checked, passed, and is not stale.
  bool LayoutChecked(const std::string& rig) const;
  /// The rig's layout; its preset is empty while none is set.
  stream::BoardLayout LayoutOf(const std::string& rig) const;
  /// A board that was moved since its layout was checked; kept over restarts.
  bool Moved(const std::string& serial) const { return moved_.contains(serial); }
  void SetMoved(const std::string& serial, bool moved);

  /// The set-up of all rigs, to be published.
  std::vector<stream::RigSetup> Rigs() const;
  /// Grows with every change: what was published before is old.
  std::uint64_t revision() const { return revision_; }

 private:
  static constexpr std::size_t kMostItems = 256;
  static constexpr std::size_t kMostRigs = 64;

  void Save(const std::string& name, const std::string& content);

  Storage storage_;
  Roles roles_;
  Tares tares_;
  Mountings mountings_;
  Layouts layouts_;
  Items items_;
  MovedBoards moved_;
  std::uint64_t revision_ = 1;
};

/// The calibrations of devices that cannot always be read from the device, each by its serial.
class CalibrationStore {
 public:
  explicit CalibrationStore(Storage storage) : storage_(std::move(storage)) {}

  /// None if none was saved for this device, or what was saved is refused.
  std::optional<std::vector<std::uint8_t>> Load(const std::string& serial) const;
  /// Saves the calibration in place of an earlier one.
  void Save(const std::string& serial, const std::vector<std::uint8_t>& bytes) const;

 private:
  Storage storage_;
};

/// The stored set-up as JSON text, each part a file of its own. A part is read as a whole or not at
/// all: a missing key or a wrong type is an error. Numbers that are not finite are read as 0.
std::string ToJson(const Roles& roles);
std::string ToJson(const Tares& tares);
std::string ToJson(const Mountings& mountings);
std::string ToJson(const Layouts& layouts);
std::string ToJson(const Items& items);
std::string ToJson(const MovedBoards& boards);
std::string ToJson(const StoredCalibration& calibration);

Result<Roles> RolesFromJson(const std::string& text);
Result<Tares> TaresFromJson(const std::string& text);
/// Without the mountings whose quaternion is not a rotation.
Result<Mountings> MountingsFromJson(const std::string& text);
Result<Layouts> LayoutsFromJson(const std::string& text);
Result<Items> ItemsFromJson(const std::string& text);
Result<MovedBoards> MovedBoardsFromJson(const std::string& text);
/// At least one byte, in hex.
Result<StoredCalibration> CalibrationFromJson(const std::string& text);

}  // namespace footing::setup
