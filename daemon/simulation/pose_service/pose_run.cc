#include "daemon/simulation/pose_service/pose_run.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "common/base/text.h"
#include "common/body/kinematics.h"
#include "common/runtime/clock.h"

namespace footing::pose_service {
namespace {

constexpr double kHeightMargin = 0.18;  // Part of the T-pose's height of the hands.
constexpr double kLeastSpan = 0.7;      // Part of the T-pose's span.
constexpr double kMostSdM = 0.1;

Eigen::Vector3d FistOf(const body::Body& body, const body::Kinematics& at, int side) {
  return body::Place(body::Fist(body, side), at);
}

bool IsJudged(const reconstruction::HandInput& hand) {
  return hand.valid && hand.sd_m.maxCoeff() <= kMostSdM;
}

}  // namespace

TPoseHands TPoseHandsOf(const body::Body& body) {
  body::Kinematics at(body.skeleton);
  body::ComputeKinematics(body.skeleton, body::TPose(body.skeleton, body.landmarks), at);
  const Eigen::Vector3d left_m = FistOf(body, at, 0), right_m = FistOf(body, at, 1);
  return {0.5 * (left_m.z() + right_m.z()), (left_m - right_m).norm()};
}

std::array<bool, reconstruction::kHands> HandsOffTPose(
    const TPoseHands& expected,
    const std::array<reconstruction::HandInput, reconstruction::kHands>& hands) {
  std::array<bool, reconstruction::kHands> off{};
  for (std::size_t side = 0; side < off.size(); ++side) {
    const double error_m = hands[side].p_W_m.z() - expected.height_m;
    off[side] = IsJudged(hands[side]) && std::abs(error_m) > kHeightMargin * expected.height_m;
  }
  if (off[0] || off[1] || !IsJudged(hands[0]) || !IsJudged(hands[1])) return off;
  const double span_m = (hands[0].p_W_m - hands[1].p_W_m).head<2>().norm();
  if (span_m < kLeastSpan * expected.span_m) off.fill(true);
  return off;
}

namespace {

/// Where there is enough to play, the boards' cells get their mean loads of the next step in place
/// of their newest samples.
void PlayLoads(double step_s, board::LoadPlayer& player,
               std::array<momentum::FootLoads, momentum::kFeet>& feet) {
  if (feet[0].count != board::kCorners || feet[1].count != board::kCorners) {
    player.Restart();
    return;
  }
  const auto loads_n = player.Advance(step_s);
  for (std::size_t f = 0; loads_n && f < feet.size(); ++f) {
    for (std::size_t i = 0; i < board::kCorners; ++i) feet[f].cells[i].load_n = (*loads_n)[f][i];
  }
}

/// FNV-1a over the bits of a pose.
std::uint64_t HashOf(const Eigen::VectorXd& q) {
  std::uint64_t hash = text::kFnvBasis;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &q[i], sizeof(bits));
    hash = text::AddFnv(hash, bits);
  }
  return hash;
}

reconstruction::Inputs WithoutFeet(reconstruction::Inputs inputs) {
  for (auto& foot : inputs.loads.feet) foot.valid = false;
  return inputs;
}

bool Measures(const auto& feet) { return feet[0].valid || feet[1].valid; }

reconstruction::InsoleInputs WithoutFeet(reconstruction::InsoleInputs inputs) {
  for (auto& foot : inputs.feet) foot.valid = false;
  return inputs;
}

}  // namespace

Result<std::unique_ptr<SubjectRun>> MakeSubjectRun(std::uint64_t number, const body::Body& body,
                                                   const reconstruction::Models& models,
                                                   const reconstruction::Options& options) {
  auto made = reconstruction::Reconstruction::Create(body, models, options);
  if (!made) return made.error();
  if (made->body().skeleton.joints.size() > kMaxLinks) {
    return InvalidData("the skeleton has more joints than a frame can hold");
  }
  auto run = std::make_unique<SubjectRun>(SubjectRun{number, std::move(made).value()});
  if (auto walk = reconstruction::InsoleWalk::Create(body, models, options)) {
    run->walk = std::move(walk).value();
  }
  return run;
}

PoseRun::PoseRun(std::unique_ptr<SubjectRun> subject, double rate_hz, SubjectExchange& subjects)
    : subject_(std::move(subject)), rate_hz_(rate_hz), subjects_(&subjects) {}

void PoseRun::ApplyRequests(const PoseInputs& inputs) {
  std::unique_ptr<SubjectRun> next;
  while (subject_->number != inputs.subject_number && subjects_->next.Pop(next)) {
    if (next->same_person) next->reconstruction.ContinueFrom(subject_->reconstruction);
    subject_.swap(next);
    subjects_->done.Push(std::move(next));  // It has space for all that are on their way.
    calibrate_number_ = inputs.calibrate_number;
  }
  if (inputs.calibrate_number == calibrate_number_) return;
  calibrate_number_ = inputs.calibrate_number;
  subject_->reconstruction.Recalibrate();
  if (subject_->walk) subject_->walk->Recalibrate();
}

void PoseRun::ChooseSource() {
  const bool on_boards = Measures(sensors_.loads.feet);
  // Insoles that come after the T-pose take one of their own before they are followed.
  if (InsolesAwaitTPose() && on_boards) {
    source_ = PoseSource::kBoards;
  } else if (subject_->walk && Measures(insoles_.feet)) {
    source_ = PoseSource::kInsoles;
  } else if (!subject_->walk || on_boards) {
    source_ = PoseSource::kBoards;
  }
}

bool PoseRun::InsolesAwaitTPose() const {
  return subject_->walk && Measures(insoles_.feet) && !subject_->walk->output().calibrated &&
         subject_->reconstruction.output().calibrated;
}

void PoseRun::Advance() {
  hands_off_t_pose_ = HandsOffTPose(subject_->t_pose, sensors_.hands);
  const bool awaits = hands_off_t_pose_[0] || hands_off_t_pose_[1];
  const bool walks = source_ == PoseSource::kInsoles;
  reconstruction::Reconstruction& boards = subject_->reconstruction;
  if (!boards.output().calibrated) {
    boards.Advance(awaits ? WithoutFeet(sensors_) : sensors_);
  } else if (!walks) {
    boards.Advance(sensors_);
  }
  if (!subject_->walk) return;
  if (!subject_->walk->output().calibrated) {
    subject_->walk->Advance(awaits ? WithoutFeet(insoles_) : insoles_);
  } else if (walks) {
    subject_->walk->Advance(insoles_);
  }
}

const reconstruction::Output& PoseRun::output() const {
  return source_ == PoseSource::kInsoles ? subject_->walk->output()
                                         : subject_->reconstruction.output();
}

void PoseRun::StepOnSimThread(exchange::Latest<Inputs>& inputs, Frame& frame) {
  const std::int64_t begun_ns = clock::ThreadCpuNs();
  ++step_;
  if (frame.applied_count < kMaxPoseApplied && inputs.Refresh()) {
    PoseApplied& applied = frame.applied[static_cast<std::size_t>(frame.applied_count++)];
    applied.step = step_;
    applied.inputs = inputs.Front();
    quiet_steps_ = 0;
    for (std::size_t f = 0; f < momentum::kFeet; ++f) player_.Take(f, inputs.Front().impulses[f]);
    ApplyRequests(inputs.Front());
  } else {
    ++quiet_steps_;
  }
  sensors_ = inputs.Front().sensors;
  PlayLoads(1 / rate_hz_, player_, sensors_.loads.feet);
  insoles_.feet = inputs.Front().insoles;
  simulated_ = inputs.Front().simulated;
  hand_trouble_ = inputs.Front().hand_trouble;
  turn_awaits_ = inputs.Front().turn_awaits;
  sensors_.loads.time_s = static_cast<double>(step_) / rate_hz_;
  if (static_cast<double>(quiet_steps_) > kStreamLostS * rate_hz_) {
    for (auto& foot : sensors_.loads.feet) foot.valid = false;
    for (auto& foot : insoles_.feet) foot.valid = false;
    for (auto& hand : sensors_.hands) hand.valid = false;
    for (auto& arm : sensors_.arms) arm.valid = false;
    for (auto& joint : sensors_.joints) joint.valid = false;
  }
  insoles_.time_s = sensors_.loads.time_s;
  insoles_.hands = sensors_.hands;
  insoles_.arms = sensors_.arms;
  ChooseSource();
  Advance();
  solve_ns_ = clock::ThreadCpuNs() - begun_ns;
}

void PoseRun::FillOnSimThread(Frame& frame) const {
  const reconstruction::Output& output = this->output();
  frame.step = step_;
  frame.time_s = static_cast<double>(step_) / rate_hz_;
  frame.subject_number = subject_->number;
  frame.state_hash = HashOf(output.q);
  PoseInputStatus& input = frame.input;
  input.simulated = simulated_;
  input.source = source_;
  input.insoles_idle = !subject_->walk && Measures(insoles_.feet);
  input.insoles_await = source_ == PoseSource::kBoards && InsolesAwaitTPose();
  const bool walks = source_ == PoseSource::kInsoles;
  for (std::size_t side = 0; side < momentum::kFeet; ++side) {
    input.feet_measured[side] = walks ? insoles_.feet[side].valid : sensors_.loads.feet[side].valid;
    input.load_n[side] = walks ? reconstruction::TotalLoadN(insoles_.feet[side])
                               : momentum::PressureOf(sensors_.loads.feet[side], 1).total_n;
    input.at_edge[side] = !walks && momentum::AtEdge(sensors_.loads.feet[side]);
    input.hands_valid[side] = sensors_.hands[side].valid;
    input.arms_valid[side] = sensors_.arms[side].valid;
  }
  input.hand_trouble = hand_trouble_;
  input.turn_awaits = turn_awaits_;
  input.hands_off_t_pose = hands_off_t_pose_;
  frame.valid = output.valid;
  frame.t_pose.complete = output.calibrated;
  frame.t_pose.progress = output.calibration_progress;
  frame.t_pose.restarts = output.calibration_restarts;
  frame.lag_s = output.lag_s;
  frame.resets = output.resets;
  frame.t_pose.mass_kg = output.calibrated ? output.mass_kg : 0;  // As weighed, or nothing.
  frame.momentum = output.momentum;
  frame.momentum.p_WC_m = output.com_W_m;
  frame.momentum.position_variance_m2 = output.com_variance_m2;
  frame.links.count = std::min(output.p_WJ_m.size(), kMaxLinks);
  for (std::size_t i = 0; i < frame.links.count; ++i) {
    frame.links.pose[i].position_m = output.p_WJ_m[i];
    frame.links.pose[i].orientation = Eigen::Quaterniond(output.R_WJ[i]);
    frame.links.sd_m[i] = i < output.joint_sd_m.size() ? output.joint_sd_m[i] : 0;
  }
  frame.links.angle_sd_rad = output.angle_sd_rad;
  frame.solve_us = static_cast<double>(solve_ns_) * 1e-3;
}

}  // namespace footing::pose_service
