#include "clients/view/scene/tally.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/stream/trial.h"

namespace footing::scene {
namespace {

using Eigen::Matrix3f;
using Eigen::Matrix4f;
using Eigen::Vector3f;

// Sizes in metres: chosen by eye for a body whose hips are 1 m over the ground.
const Vector3f kTrunkHalfAxes(0.34f, 0.215f, 0.225f);
const Vector3f kTrunkCentre(0.0f, 0.0f, 0.07f);
const Vector3f kRumpHalfAxes(0.27f, 0.175f, 0.165f);
const Vector3f kRumpCentre(-0.16f, 0.0f, 0.10f);
constexpr float kToeM = 0.17f;
constexpr float kBackToeM = 0.09f;

Matrix3f TurnAbout(const Vector3f& axis, float angle_rad) {
  return Eigen::AngleAxisf(angle_rad, axis.normalized()).toRotationMatrix();
}

void AddTrunk(const Matrix4f& X_WB, const BirdMotion& motion, const Plumage& plumage,
              PartList& parts) {
  const Matrix3f pitch_up = TurnAbout(Vector3f::UnitY(), -0.10f);
  parts.AddBall(X_WB * Ellipsoid(kTrunkCentre, pitch_up, kTrunkHalfAxes), plumage.back,
                plumage.belly, 0.15f);
  parts.AddBall(X_WB * Ellipsoid(kRumpCentre, pitch_up, kRumpHalfAxes), plumage.back, plumage.belly,
                0.15f);
  // Behind the root of the tail up is a turn the other way than ahead of it.
  const Matrix3f tail =
      TurnAbout(Vector3f::UnitZ(), static_cast<float>(-motion.tail_yaw.value)) *
      TurnAbout(Vector3f::UnitY(), 0.5f + static_cast<float>(motion.tail_pitch.value));
  for (int feather = -2; feather <= 2; ++feather) {
    const auto side = static_cast<float>(feather);
    const Matrix3f turn = TurnAbout(Vector3f::UnitZ(), -0.24f * side) * tail;
    const Vector3f centre =
        kRumpCentre + Vector3f(-0.19f, 0, 0.05f) + turn * Vector3f(-0.16f, 0, 0);
    parts.AddBall(X_WB * Ellipsoid(centre, turn, {0.19f, 0.055f, 0.022f}), plumage.tail,
                  plumage.wing, 0.1f);
  }
}

/// Folded, a wing is a drop along the flank; spread, it opens outwards and shows its rows.
void AddWings(const Matrix4f& X_WB, double spread, const Plumage& plumage, PartList& parts) {
  const auto open = static_cast<float>(spread);
  for (const float side : {1.0f, -1.0f}) {
    const Vector3f shoulder(0.13f, side * 0.178f, 0.19f);
    for (int row = 0; row < 3; ++row) {
      const auto low = static_cast<float>(row);
      const Matrix3f turn =
          TurnAbout(Vector3f::UnitX(), side * (-0.16f + (1.55f - 0.12f * low) * open)) *
          TurnAbout(Vector3f::UnitZ(), side * (0.16f - 0.05f * low)) *
          TurnAbout(Vector3f::UnitY(), -0.20f + 0.10f * low);
      const Vector3f half(0.25f - 0.045f * low, 0.032f - 0.005f * low, 0.10f + 0.05f * open);
      const Vector3f centre =
          shoulder + turn * Vector3f(-0.17f - 0.02f * low, side * (0.030f - 0.006f * low),
                                     -0.055f - (0.045f + 0.075f * open) * low);
      const Colour colour = row == 1 ? plumage.tail : plumage.wing;
      parts.AddBall(X_WB * Ellipsoid(centre, turn, half), colour, colour, 0.2f);
    }
  }
}

/// Toes lie on the ground and spread while the foot touches; they fold and hang in flight, as far
/// as the floor lets them.
void AddToes(const Vector3f& foot, const Vector3f& forward, double spread, float floor_m,
             const Colour& skin, PartList& parts) {
  const auto open = static_cast<float>(spread);
  const Vector3f level = Vector3f(forward.x(), forward.y(), 0).normalized();
  const auto on_floor = [floor_m](Vector3f p, float radius) {
    p.z() = std::max(p.z(), floor_m + radius);
    return p;
  };
  for (int toe = -1; toe <= 1; ++toe) {
    const float angle = static_cast<float>(toe) * (0.14f + 0.42f * open);
    const Vector3f ahead = TurnAbout(Vector3f::UnitZ(), angle) * level;
    const Vector3f bent(0, 0, 0.12f - 0.55f * (1 - open)), hung(0, 0, -0.14f - 1.1f * (1 - open));
    const Vector3f knuckle = on_floor(foot + 0.5f * kToeM * (ahead + bent), 0.017f);
    const Vector3f tip = on_floor(knuckle + 0.5f * kToeM * (ahead + hung), 0.008f);
    parts.AddLimb(foot, knuckle, 0.021f, 0.017f, skin);
    parts.AddLimb(knuckle, tip, 0.017f, 0.008f, skin);
  }
  const Vector3f back = -level + Vector3f(0, 0, -0.05f - 0.8f * (1 - open));
  parts.AddLimb(foot, on_floor(foot + kBackToeM * back, 0.008f), 0.017f, 0.008f, skin);
}

void AddLeg(const stream::LinkPose& hip, const Eigen::Vector3d& foot_m, double toe_spread,
            float floor_m, const Plumage& plumage, PartList& parts) {
  const Eigen::Vector3d forward = hip.orientation * Eigen::Vector3d::UnitX();
  const LegPose leg = SolveLeg(hip.position_m, foot_m, forward);
  const Vector3f a = leg.hip_m.cast<float>(), b = leg.ankle_m.cast<float>(),
                 c = leg.foot_m.cast<float>();
  // The drumstick ends in feathers; below them is bare skin.
  const Vector3f hock = a + 0.72f * (b - a);
  const Vector3f calf = a + 0.30f * (b - a);
  parts.AddLimb(a, calf, 0.118f, 0.098f, plumage.tail, 0.12f);
  parts.AddLimb(calf, hock, 0.098f, 0.040f, plumage.tail, 0.12f);
  parts.AddLimb(hock, b, 0.034f, 0.036f, plumage.skin, 0.25f);
  parts.AddLimb(b, c, 0.034f, 0.024f, plumage.skin, 0.25f);
  AddToes(c, forward.cast<float>(), toe_spread, floor_m, plumage.skin, parts);
}

}  // namespace

Plumage PlumageOf(std::uint32_t character) {
  static const std::array<Plumage, 3> kPlumages{{
      {Rgb(0x2f7f9e), Rgb(0xf4ead6), Rgb(0x1d5470), Rgb(0x2a6c8c), Rgb(0xf06449), Rgb(0xf0a04b),
       Rgb(0xf7b538)},
      {Rgb(0x8d5a97), Rgb(0xf3e6ee), Rgb(0x5a3a68), Rgb(0x6f4880), Rgb(0x3aa69b), Rgb(0xd9a066),
       Rgb(0xf2c14e)},
      {Rgb(0x6a994e), Rgb(0xf2eecb), Rgb(0x386641), Rgb(0x4d7c43), Rgb(0xbc4749), Rgb(0xe0a458),
       Rgb(0xf4a259)},
  }};
  // Characters count from 1.
  return kPlumages[(character + kPlumages.size() - 1) % kPlumages.size()];
}

void AddBird(const BirdSkeleton& skeleton, const CharacterPose& pose, const BirdMotion& motion,
             double floor_m, PartList& parts) {
  const auto links = static_cast<int>(pose.links.size());
  const auto contacts = static_cast<int>(pose.contacts.size());
  for (std::size_t leg = 0; leg < 2; ++leg) {
    if (skeleton.hips[leg] >= links || skeleton.feet[leg] >= contacts) return;
  }
  if (skeleton.body >= links) return;
  const stream::LinkPose& body = pose.links[static_cast<std::size_t>(skeleton.body)];
  Matrix4f X_WB = Matrix4f::Identity();
  X_WB.topLeftCorner<3, 3>() = body.orientation.toRotationMatrix().cast<float>();
  X_WB.topRightCorner<3, 1>() = body.position_m.cast<float>();

  const Plumage plumage = PlumageOf(pose.character);
  AddTrunk(X_WB, motion, plumage, parts);
  AddWings(X_WB, motion.wing_spread, plumage, parts);
  AddHead(X_WB, motion, plumage, parts);
  for (std::size_t leg = 0; leg < 2; ++leg) {
    const auto hip = static_cast<std::size_t>(skeleton.hips[leg]);
    const auto foot = static_cast<std::size_t>(skeleton.feet[leg]);
    AddLeg(pose.links[hip], pose.contacts[foot].position_m + motion.feet[leg].shift_m,
           motion.toe_spread[leg], static_cast<float>(floor_m), plumage, parts);
  }
}

namespace {

// Metres, chosen by eye.
const Vector3f kNeckBase(0.20f, 0, 0.13f);
constexpr float kHeadAheadM = 0.40f;
constexpr float kHeadAboveM = 0.60f;
constexpr float kHeadRadiusM = 0.098f;
constexpr int kNeckPieces = 12;

/// Yaw about z, then pitch; positive pitch looks up.
Matrix3f HeadAxes(const BirdMotion& motion) {
  const auto yaw = static_cast<float>(motion.head_yaw_rad);
  const auto pitch = static_cast<float>(motion.head_pitch_rad);
  return (Eigen::AngleAxisf(yaw, Vector3f::UnitZ()) *
          Eigen::AngleAxisf(-0.6f * pitch, Vector3f::UnitY()))
      .toRotationMatrix();
}

/// An S-shaped neck: a cubic from the trunk forwards and up into the head.
void AddNeck(const Vector3f& base, const Vector3f& base_forward, const Vector3f& head,
             const Matrix3f& axes, const Plumage& plumage, PartList& parts) {
  const Vector3f bend = base + 0.22f * base_forward + Vector3f(0, 0, 0.04f);
  const Vector3f nape = head - axes * Vector3f(0.07f, 0, 0.24f);
  Vector3f before = base;
  float radius_before = 0.14f;
  for (int piece = 1; piece <= kNeckPieces; ++piece) {
    const float t = static_cast<float>(piece) / kNeckPieces, s = 1 - t;
    const Vector3f at =
        s * s * s * base + 3 * s * s * t * bend + 3 * s * t * t * nape + t * t * t * head;
    const float radius = 0.056f + 0.084f * s * s;
    parts.AddLimb(before, at, radius_before, radius, plumage.back, 0.12f);
    before = at;
    radius_before = radius;
  }
}

/// The pupil turns about the eye's middle; a lid in the colour of the head closes over both.
void AddEye(const Matrix4f& X_WH, float side, const BirdMotion& motion, const Colour& lid,
            PartList& parts) {
  const Matrix3f axes = Matrix3f::Identity();
  const Colour white = Rgb(0xffffff), dark = Rgb(0x16130f);
  const auto ball = [&](const Vector3f& centre, float radius) {
    return Matrix4f(X_WH * Ellipsoid(centre, axes, Vector3f::Constant(radius)));
  };
  const Vector3f middle(0.044f, side * 0.064f, 0.034f);
  const Matrix3f gaze = TurnAbout(Vector3f::UnitZ(), static_cast<float>(motion.gaze_yaw_rad)) *
                        TurnAbout(Vector3f::UnitY(), static_cast<float>(-motion.gaze_pitch_rad));
  parts.AddBall(ball(middle, 0.038f), white, white, 0.6f);
  parts.AddBall(ball(middle + gaze * Vector3f(0.012f, side * 0.017f, 0.003f), 0.024f), dark, dark,
                0.9f);
  parts.AddBall(ball(middle + gaze * Vector3f(0.024f, side * 0.032f, 0.015f), 0.0075f), white,
                white, 0);
  const auto closed = static_cast<float>(motion.lid);
  if (closed <= 0) return;
  const Vector3f over = middle + Vector3f(0.006f, side * 0.008f, 0.030f * (1 - closed));
  parts.AddBall(ball(over, 0.042f), lid, lid, 0.2f);
}

void AddBeakAndCrest(const Vector3f& head, const Matrix3f& axes, const Plumage& plumage,
                     PartList& parts) {
  const auto at = [&](float x, float y, float z) -> Vector3f {
    return head + axes * Vector3f(x, y, z);
  };
  parts.AddRod(at(0.070f, 0, 0.004f), at(0.225f, 0, -0.022f), 0.044f, 0.005f, plumage.beak, 0.5f);
  parts.AddRod(at(0.066f, 0, -0.024f), at(0.185f, 0, -0.036f), 0.030f, 0.004f, plumage.skin, 0.3f);
  for (int plume = 0; plume < 3; ++plume) {
    const auto back = static_cast<float>(plume);
    const Vector3f root = at(0.01f - 0.035f * back, 0, 0.085f - 0.008f * back);
    const Vector3f middle = at(-0.02f - 0.065f * back, 0, 0.15f - 0.02f * back);
    const Vector3f tip = at(-0.075f - 0.085f * back, 0, 0.185f - 0.035f * back);
    parts.AddLimb(root, middle, 0.022f, 0.017f, plumage.crest, 0.2f);
    parts.AddLimb(middle, tip, 0.017f, 0.010f, plumage.crest, 0.2f);
  }
}

}  // namespace

void AddHead(const Matrix4f& X_WB, const BirdMotion& motion, const Plumage& plumage,
             PartList& parts) {
  const Matrix3f axes = HeadAxes(motion);
  const Vector3f level_forward(axes(0, 0), axes(1, 0), 0);
  const Vector3f place = X_WB.topRightCorner<3, 1>();
  const Vector3f base = place + X_WB.topLeftCorner<3, 3>() * kNeckBase;
  const float ahead_m = kHeadAheadM + static_cast<float>(motion.head_ahead.value);
  const Vector3f head = place + ahead_m * level_forward.normalized() +
                        Vector3f(0, 0, kHeadAboveM + static_cast<float>(motion.head_lift_m));
  AddNeck(base, X_WB.block<3, 1>(0, 0), head, axes, plumage, parts);

  const Matrix4f X_WH = Ellipsoid(head, axes, Vector3f::Ones());
  parts.AddBall(Ellipsoid(head, axes, {kHeadRadiusM * 1.12f, kHeadRadiusM, kHeadRadiusM}),
                plumage.back, plumage.belly, 0.2f);
  for (const float side : {1.0f, -1.0f}) AddEye(X_WH, side, motion, plumage.back, parts);
  AddBeakAndCrest(head, axes, plumage, parts);
}

namespace {

constexpr double kTiny = 1e-9;

/// The part of `forward` square to `along`, of length 1; any square direction if there is none.
Eigen::Vector3d Across(const Eigen::Vector3d& along, const Eigen::Vector3d& forward) {
  const Eigen::Vector3d across = forward - forward.dot(along) * along;
  if (across.norm() > kTiny) return across.normalized();
  return along.unitOrthogonal();
}

}  // namespace

LegPose SolveLeg(const Eigen::Vector3d& hip_m, const Eigen::Vector3d& foot_m,
                 const Eigen::Vector3d& forward) {
  const Eigen::Vector3d line_m = foot_m - hip_m;
  const double length_m = line_m.norm();
  const Eigen::Vector3d along =
      length_m > kTiny ? Eigen::Vector3d(line_m / length_m) : Eigen::Vector3d(0, 0, -1);
  const double half_m = length_m / 2;
  const double behind_m = std::sqrt(std::max(0.0, kLegSegmentM * kLegSegmentM - half_m * half_m));
  return {hip_m, hip_m + half_m * along - behind_m * Across(along, forward), foot_m};
}

namespace {

constexpr std::size_t kMaxLatencies = 100'000;
constexpr double kSeenS = 2.0;
constexpr std::uint64_t kSeenSteps = 6;
constexpr std::uint64_t kSeenJumps = 3;

std::uint64_t Increase(std::uint64_t before, std::uint64_t now) {
  return now > before ? now - before : 0;
}

}  // namespace

void Latencies::Add(std::int64_t latency_ns) {
  if (values_ns_.size() < kMaxLatencies) {
    values_ns_.push_back(latency_ns);
    return;
  }
  values_ns_[next_] = latency_ns;
  next_ = (next_ + 1) % kMaxLatencies;
}

double Latencies::QuantileMs(double share) const {
  if (values_ns_.empty()) return 0;
  const auto rank = static_cast<std::size_t>(std::llround(share * (values_ns_.size() - 1.0)));
  return NanosecondsToMilliseconds(text::OfRank(values_ns_, rank));
}

void Tally::Add(const WorldFrame& frame) {
  ++frames_;
  if (frame.characters.empty()) return;
  const stream::GaitState& now = frame.characters.front().gait;
  const bool restarted = frame.time_s < last_time_s_;
  if (frames_ > 1 && !restarted) {
    falls_ += Increase(last_.falls, now.falls);
    for (const stream::FailureCause cause : stream::kFailureCauses) {
      *stream::MutableCountOf(cause, failures_) +=
          Increase(stream::CountOf(cause, last_.failures), stream::CountOf(cause, now.failures));
    }
    operator_put_backs_ += Increase(last_.operator_put_backs, now.operator_put_backs);
    distance_m_ += std::max(0.0, now.distance_m - last_.distance_m);
    const auto& trial = frame.characters.front().trial;
    if (trial && !trial->progress.on_track) off_track_s_ += frame.time_s - last_time_s_;
  }
  // A restarted server counts from 1 again.
  frames_published_ += frame.sequence > last_sequence_ && frames_ > 1 && !restarted
                           ? frame.sequence - last_sequence_
                           : 1;
  last_sequence_ = frame.sequence;
  if (frames_ == 1 || restarted || now.gait != stretch_.gait || now.falls != last_.falls ||
      !now.commanded_by_stream) {
    stretch_ = {now.gait, frame.time_s, now.steps};
  }
  last_ = now;
  last_time_s_ = frame.time_s;

  const std::uint64_t needed = now.gait == stream::Gait::kJump ? kSeenJumps : kSeenSteps;
  const bool long_enough =
      frame.time_s - stretch_.start_s >= kSeenS && now.steps >= stretch_.start_steps + needed;
  if (!long_enough || now.gait == stream::Gait::kUnspecified) return;
  if (std::find(seen_.begin(), seen_.end(), now.gait) == seen_.end()) seen_.push_back(now.gait);
}

void Tally::Add(const stream::ResponseStages& response) {
  double without_contact_ms = 0;
  const std::vector<stream::ResponseStage> stages = stream::ResponseTimes(response);
  if (stages.empty()) return;
  for (const stream::ResponseStage& stage : stages) {
    response_stages[stage.name].Add(static_cast<std::int64_t>(stage.ms * 1e6));
    if (stage.name != std::string(stream::kContactStage)) without_contact_ms += stage.ms;
  }
  response_without_contact.Add(static_cast<std::int64_t>(without_contact_ms * 1e6));
}

std::vector<stream::Gait> Tally::GaitsSeen() const {
  std::vector<stream::Gait> gaits = seen_;
  std::sort(gaits.begin(), gaits.end());
  return gaits;
}

namespace {

using body::Landmark;

constexpr std::int64_t kNearNs = 50'000'000;
constexpr Landmark kTips[] = {Landmark::kLeftHandEnd, Landmark::kRightHandEnd,
                              Landmark::kLeftToeEnd, Landmark::kRightToeEnd};

bool IsTip(Landmark landmark) {
  for (const Landmark tip : kTips) {
    if (landmark == tip) return true;
  }
  return false;
}

const ReferencePose* Nearest(const std::deque<ReferencePose>& references, std::int64_t at_ns) {
  const ReferencePose* nearest = nullptr;
  std::int64_t least_ns = kNearNs;
  for (const ReferencePose& reference : references) {
    const std::int64_t away_ns = std::abs(reference.sampled_ns - at_ns);
    if (away_ns > least_ns) continue;
    least_ns = away_ns;
    nearest = &reference;
  }
  return nearest;
}

}  // namespace

void PoseTally::Add(const CharacterPose& pose, const Anatomy& anatomy, std::int64_t host_ns,
                    const std::deque<ReferencePose>& references) {
  if (!pose.body) return;
  ++frames_;
  if (pose.body->calibrated && !last_.calibrated) ++calibrations_;
  last_ = *pose.body;
  if (!last_.calibrated) return;
  ++calibrated_frames_;
  const ReferencePose* reference = Nearest(references, host_ns - SecondsToNanoseconds(last_.lag_s));
  if (reference == nullptr || !Fits(anatomy, reference->parents)) return;
  if (pose.links.size() != reference->positions_m.size()) return;
  Compare(pose, anatomy, *reference);
  invalid_ += pose.valid ? 0 : 1;
}

void PoseTally::Compare(const CharacterPose& pose, const Anatomy& anatomy,
                        const ReferencePose& reference) {
  const auto error_m = [&](Landmark landmark) -> Eigen::Vector3d {
    const auto joint = static_cast<std::size_t>(anatomy.landmarks[landmark]);
    return pose.links[joint].position_m - reference.positions_m[joint];
  };
  const auto error_cm = [&](Landmark landmark) { return 100 * error_m(landmark).norm(); };
  const Eigen::Vector3d root_m = error_m(Landmark::kHips);
  double sum_cm = 0, relative_cm = 0;
  int joints = 0;
  for (int i = 0; i < body::kLandmarkCount; ++i) {
    const auto landmark = static_cast<Landmark>(i);
    if (anatomy.landmarks[landmark] < 0 || IsTip(landmark)) continue;
    sum_cm += error_cm(landmark);
    relative_cm += 100 * (error_m(landmark) - root_m).norm();
    ++joints;
  }
  ++compared_;
  all_cm_ += sum_cm / joints;
  relative_cm_ += relative_cm / joints;
  wrists_cm_ += 0.5 * (error_cm(Landmark::kLeftWrist) + error_cm(Landmark::kRightWrist));
  ankles_cm_ += 0.5 * (error_cm(Landmark::kLeftAnkle) + error_cm(Landmark::kRightAnkle));
}

}  // namespace footing::scene
