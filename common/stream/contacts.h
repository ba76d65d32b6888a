#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace footing::stream {

/// What a contact source's cells move with. Foot frame: x from the heel to the toes along the sole,
/// y left, z up; origin under the middle of the heel.
enum class ContactBody { kUnspecified = 0, kLeftFoot = 1, kRightFoot = 2 };

/// One load cell, in the frame of what its source sits on.
struct ContactCell {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double load_n = 0;  ///< Downwards positive.
};

/// What a pressure insole sends: all cells at one time.
struct ContactFrame {
  std::string source;
  std::string rig;
  std::int64_t age_ns = 0;  ///< Since the cells were read, when it was sent.
  ContactBody body = ContactBody::kUnspecified;
  std::vector<ContactCell> cells;
  bool simulated = false;
  std::int64_t sent_ns = 0;  ///< By the monotonic clock of footingd's host; 0: not known.
};

/// The same as footingd publishes it.
struct ContactSample {
  std::string rig;
  std::string source;
  ContactBody body = ContactBody::kUnspecified;
  std::int64_t received_ns = 0;
  std::int64_t sampled_ns = 0;
  std::vector<ContactCell> cells;
  bool simulated = false;
};

}  // namespace footing::stream
