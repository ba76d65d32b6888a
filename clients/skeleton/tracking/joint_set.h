#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "clients/skeleton/tracking/joints.h"

namespace footing::skeleton {

/// Computes an absent neck (between the shoulders) and torso (between shoulders and hips).
void FillTrunk(Skeleton& skeleton);

/// The 15 joints out of any set of named ones: OSCeleton ("l_hand"), Kinect ("HandLeft"), Azure
/// Kinect ("HAND_LEFT"), MediaPipe ("left_wrist"), OpenNI ("LEFT_HAND"). Case, '_', '-' and spaces
/// do not matter. Of two names for one joint the better one counts whatever their order: an ankle
/// before the tip of a foot, a hand before a wrist. Joints that no name gives are taken from their
/// neighbours: a neck between the shoulders, a torso between shoulders and hips, a head between the
/// ears.
class JointSet {
 public:
  /// What Add did with a name.
  enum class Taken : std::uint8_t {
    kUnknown,  ///< No name of a joint.
    kBeside,   ///< Of a joint that the 15 do without, or that a better name has given.
    kAdded,
    kRepeated,  ///< The same name was added before: nothing is changed.
  };

  Taken Add(std::string_view name, const JointReading& reading);
  /// With what follows from neighbours.
  Skeleton Finish() const;
  /// How many of the 15 have been given by their best name.
  std::size_t best() const;
  /// How many names have given something.
  std::size_t size() const { return added_; }
  bool empty() const { return added_ == 0; }

 private:
  struct Given {
    JointReading reading;
    int rank = kNone;
  };
  static constexpr int kNone = 100;

  std::array<Given, kJoints> joints_;
  std::array<JointReading, 3> face_;     // Left ear, right ear, nose.
  std::array<std::uint64_t, 2> seen_{};  // A bit for each row of the table of names: left, right.
  std::size_t added_ = 0;
};

}  // namespace footing::skeleton
