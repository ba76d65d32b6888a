#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/board/plate.h"
#include "common/stream/device.h"
#include "common/stream/setup.h"

namespace footing::setup {

struct StoredMounting {
  std::string role;  ///< "rig/role" that it was found for; stale on another.
  Eigen::Quaterniond rotation_MS = Eigen::Quaterniond::Identity();
  double residual_rad = 0;
  bool slipped = false;  ///< Since it was found.
};

struct StoredTare {
  board::CornerForces offset;
  double residual_n = 0;
};

/// Where the book is kept between runs. Null functions: in memory only.
struct Shelf {
  std::function<std::optional<std::string>(const std::string& name)> load;
  std::function<void(const std::string& name, const std::string& content)> save;
  std::function<void(const std::string& name, const std::string& why)> refuse;
};

/// The set-up of all rigs: who was assigned what, tares, mountings, layouts, what was done when,
/// and what is stale since. Every change is saved at once. Content is JSON, one piece per concern.
class Book {
 public:
  explicit Book(Shelf shelf);

  /// Roles assigned by command, serial to "rig/role".
  const std::map<std::string, std::string>& roles() const { return roles_; }
  /// An empty role forgets it.
  void SetRole(const std::string& serial, const std::string& role);

  std::optional<StoredTare> TareOf(const std::string& serial) const;
  void SetTare(const std::string& serial, const std::optional<StoredTare>& tare);

  /// Only when it was found for this "rig/role".
  std::optional<StoredMounting> MountingOf(const std::string& serial,
                                           const std::string& role) const;
  void SetMounting(const std::string& serial, const std::optional<StoredMounting>& mounting);

  /// False when there are too many rigs already.
  bool SetLayout(const stream::BoardLayout& layout);
  /// Replaces the item of that name and serial. False when there are too many already.
  bool Record(const std::string& rig, const stream::SetupItem& item);
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

  std::vector<stream::RigSetup> Rigs() const;
  /// Grows with every change: what was published before is old.
  std::uint64_t revision() const { return revision_; }

 private:
  static constexpr std::size_t kMostItems = 256;
  static constexpr std::size_t kMostRigs = 64;
  static constexpr std::size_t kMostSerials = 256;

  void SaveRoles();
  void SaveTares();
  void SaveMountings();
  void SaveLayouts();
  void SaveItems();
  void SaveMoved();
  void Save(const std::string& name, const std::string& content);

  Shelf shelf_;
  std::map<std::string, std::string> roles_;
  std::map<std::string, StoredTare> tares_;
  std::map<std::string, StoredMounting> mountings_;
  std::map<std::string, stream::BoardLayout> layouts_;           // By rig.
  std::map<std::string, std::vector<stream::SetupItem>> items_;  // By rig.
  std::map<std::string, bool> moved_;                            // Serials.
  std::uint64_t revision_ = 1;
};

/// A device's own calibration, kept by its serial: hex beside the serial and its CRC.
class CalibrationShelf {
 public:
  explicit CalibrationShelf(Shelf shelf) : shelf_(std::move(shelf)) {}
  std::optional<std::vector<std::uint8_t>> Load(const std::string& serial) const;
  void Save(const std::string& serial, const std::vector<std::uint8_t>& bytes) const;

 private:
  Shelf shelf_;
};

}  // namespace footing::setup
