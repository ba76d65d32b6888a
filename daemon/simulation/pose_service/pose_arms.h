#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "daemon/simulation/pose/arm_tracker.h"
#include "daemon/simulation/pose_service/pose_frame.h"
#include "footing/v1/sensor.pb.h"

namespace footing::pose_service {

/// How both arms are held by what the Wiimotes in the fists, or strapped on upper arms and
/// forearms, measure (docs/hands.md), on the io thread: the same arms::ArmTracker that footing-eval
/// runs. A Wiimote in a fist points forward with its buttons up in the T-pose, a strapped one along
/// the arm to the hand.
///
/// The gyroscope's own bias of the T-pose is taken off, not what footingd holds for it: a hand that
/// turns slowly and evenly looks like one at rest to footingd. A Wiimote that is not heard for
/// longer than kTimeoutS may have turned anywhere: it counts for nothing until the next T-pose.
class PoseArms {
 public:
  static constexpr double kTimeoutS = 0.2;

  /// Without a model there is no estimate from the fists.
  explicit PoseArms(std::optional<arms::ArmModel> model);

  /// Whether the rig has a Wiimote there, and which device it is.
  void Bind(std::size_t side, std::optional<std::uint32_t> device,
            arms::Place place = arms::Place::kFist);
  void Take(const v1::MotionSample& sample, std::int64_t now_ns);
  /// What the engine says of its T-pose.
  void Follow(bool calibrated, double calibration_progress);
  /// Puts the arms and what is wrong with them into the inputs; times go forward.
  void Report(std::int64_t now_ns, PoseInputs& inputs);

 private:
  struct Device {
    std::optional<std::uint32_t> device;
    bool seen = false, turns = false;  ///< A sample has come; one with an angular velocity.
    std::int64_t seen_ns = 0, turned_ns = 0;
    std::int64_t sampled_ns = 0;  ///< Of the last one with an angular velocity.
    bool simulated = false;
  };
  void Take(const v1::MotionSample& sample, std::int64_t now_ns, std::size_t side,
            std::size_t place);
  HandTrouble TroubleOf(std::size_t side, std::size_t place, std::int64_t now_ns) const;
  /// Of the devices that the arm has.
  HandTrouble TroubleOf(std::size_t side, std::int64_t now_ns) const;

  std::optional<arms::ArmModel> model_;
  arms::ArmTracker tracker_;
  std::array<std::array<Device, arms::kPlaces>, arms::kArms> devices_{};  ///< By arms::Place.
  bool calibrated_ = false;
  double progress_ = 0;
  std::int64_t reported_ns_ = 0;
};

}  // namespace footing::pose_service
