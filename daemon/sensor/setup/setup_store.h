#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/stream/setup.h"
#include "daemon/sensor/setup/storage.h"
#include "daemon/sensor/setup/stored_setup.h"

namespace footing::setup {

/// The set-up of all rigs: roles assigned, tares, mountings, layouts, what was done when, and what
/// is stale since. Every change is saved at once, one text per part (setup_json.h).
class SetupStore {
 public:
  explicit SetupStore(Storage storage);

  /// Roles assigned by command.
  const Roles& roles() const { return roles_; }
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

}  // namespace footing::setup
