#pragma once

#include <array>
#include <cstdint>

#include "daemon/simulation/gait_service/frame.h"
#include "footing/v1/character.pb.h"

namespace footing::gait_service {

/// Stamps of the features that arrived, by their number.
struct FeatureStamps {
  std::uint64_t number = 0;
  std::int64_t report_received_ns = 0;
  std::int64_t decoded_ns = 0;
  std::int64_t computed_ns = 0;
  std::int64_t received_ns = 0;
};

/// Follows each change of gait from the user's report to the first frame that shows it.
class Responses {
 public:
  void Received(const FeatureStamps& stamps) { Slot(stamps.number) = stamps; }

  /// Looks at a frame about to be published at `now_ns`; true when it is the first to show a new
  /// gait, with the stages in `stages`.
  bool Complete(const Frame& frame, std::int64_t now_ns, v1::ResponseStages& stages);

 private:
  static constexpr std::size_t kRemembered = 1024;
  FeatureStamps& Slot(std::uint64_t number) { return stamps_[number % kRemembered]; }

  std::array<FeatureStamps, kRemembered> stamps_{};
  std::uint64_t shown_step_ = 0;
  stream::Gait from_ = stream::Gait::kStep;
};

}  // namespace footing::gait_service
