#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "common/body/body.h"
#include "common/runtime/exchange.h"
#include "daemon/simulation/pose_service/publish.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::pose_service {

/// Where a subject's fists are in the T-pose.
struct TPoseHands {
  double height_m = 0;  ///< Over the ground.
  double span_m = 0;    ///< From one to the other.
};

/// Allocates.
TPoseHands TPoseHandsOf(const body::Body& body);

/// Which tracked hands, left and right, cannot be those of a T-pose: more than 18 % of its height
/// above or below, or both together less than 70 % of its span apart. The margins allow for a
/// subject whose height is not known. A hand that is not tracked, or only to 10 cm, is not checked.
std::array<bool, reconstruction::kHands> HandsOffTPose(
    const TPoseHands& expected,
    const std::array<reconstruction::HandInput, reconstruction::kHands>& hands);

/// One subject's reconstruction: made and destroyed by the io thread, advanced by the other one.
struct SubjectRun {
  SubjectRun(std::uint64_t subject_number, reconstruction::Reconstruction on_boards,
             std::optional<reconstruction::InsoleWalk> in_insoles = std::nullopt)
      : number(subject_number),
        reconstruction(std::move(on_boards)),
        walk(std::move(in_insoles)),
        t_pose(TPoseHandsOf(reconstruction.body())) {}

  std::uint64_t number;
  reconstruction::Reconstruction reconstruction;
  /// The same person in insoles; none where the mode or the lag has none.
  std::optional<reconstruction::InsoleWalk> walk;
  TPoseHands t_pose;
  /// Another mode for the person before, whose T-pose holds.
  bool same_person = false;
};

/// The subject's reconstruction, and the one in insoles where the options have it. InvalidData when
/// the body has more joints than a frame can hold.
Result<std::unique_ptr<SubjectRun>> MakeSubjectRun(std::uint64_t number, const body::Body& body,
                                                   const reconstruction::Models& models,
                                                   const reconstruction::Options& options);

/// How subjects come to the simulation thread and go back: it never allocates or frees.
struct SubjectExchange {
  static constexpr std::size_t kMost = 4;  ///< On their way at one time.

  exchange::BoundedQueue<std::unique_ptr<SubjectRun>> next{kMost};
  exchange::BoundedQueue<std::unique_ptr<SubjectRun>> done{kMost};
};

/// The pose engine on the simulation thread (see SimulationThread).
///
/// Boards and insoles have a reconstruction each. That of the source which is followed is advanced;
/// the other one rests, but takes its T-pose along as long as it has none. Insoles that fall silent
/// are followed on, unless boards measure something: the pose coasts.
///
/// No T-pose is taken while a tracked hand is elsewhere than it has it: with hanging arms, every
/// pose after it would be wrong.
///
/// A subject takes effect with the first inputs that carry its number; it was queued before them.
class PoseRun {
 public:
  using Inputs = PoseInputs;
  using Frame = PoseFrame;

  /// Without new inputs for this time, all that they said has become unknown.
  static constexpr double kStreamLostS = 0.25;

  PoseRun(std::unique_ptr<SubjectRun> subject, double rate_hz, SubjectExchange& subjects);

  /// One step, with new inputs where there are any.
  void StepOnSimThread(exchange::Latest<Inputs>& inputs, Frame& frame);
  void FillOnSimThread(Frame& frame) const;
  void TakenOnSimThread(Frame& frame) const { frame.applied_count = 0; }

 private:
  void ApplyRequests(const PoseInputs& inputs);
  void ChooseSource();
  bool InsolesAwaitTPose() const;
  void Advance();
  const reconstruction::Output& output() const;

  std::unique_ptr<SubjectRun> subject_;
  double rate_hz_;
  SubjectExchange* subjects_;
  std::uint64_t step_ = 0;
  std::uint64_t quiet_steps_ = 0;  ///< Since the last inputs.
  std::uint64_t calibrate_number_ = 0;
  reconstruction::Inputs sensors_;
  reconstruction::InsoleInputs insoles_;
  board::LoadPlayer player_;
  PoseSource source_ = PoseSource::kBoards;
  bool simulated_ = false;
  std::array<HandTrouble, reconstruction::kHands> hand_trouble_{};
  std::array<bool, reconstruction::kBodySites> turn_awaits_{};
  std::array<bool, reconstruction::kHands> hands_off_t_pose_{};
  std::int64_t solve_ns_ = 0;
};

}  // namespace footing::pose_service
