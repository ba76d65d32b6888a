#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/units.h"
#include "common/runtime/files.h"
#include "common/virtual/devices/accelerometer.h"
#include "common/virtual/motion/markers.h"
#include "common/virtual/motion/table.h"
#include "daemon/offline/analysis/features_chain.h"
#include "daemon/offline/eval/mounting.h"

namespace footing::eval {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kShortestStrideS = 0.8;
constexpr double kStandS = 4;
constexpr double kStandAgainS = 2;
constexpr double kWalkS = 9;
constexpr double kWalkSettledS = 3.5;
constexpr double kBlendS = 0.1;
const Vector3d kUp_W = Vector3d::UnitY();  // TRC: y is up.

struct Shin {
  Track place_W;                 // Middle of its markers.
  std::vector<Matrix3d> axes_W;  // Columns: the marker frame's axes.
  Track force_mps2;              // Specific force in the marker frame.
};

std::size_t Frames(const motion::MarkerTracks& tracks) {
  return static_cast<std::size_t>(tracks.frames());
}

/// The markers in the file's own axes.
Result<motion::MarkerTracks> ReadTrc(const std::string& path) {
  constexpr std::size_t kMostBytes = 256u << 20;
  const auto text = config::ReadTextFile(path, kMostBytes);
  if (!text) return text.error();
  return motion::ParseTrc(*text, path);
}

Result<Track> Marker(const motion::MarkerTracks& tracks, const std::string& name) {
  const int index = motion::FindMarker(tracks, name);
  if (index < 0) return InvalidData("no marker " + name);
  const Eigen::Matrix3Xd& places = tracks.p[static_cast<std::size_t>(index)];
  Track track;
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    track.push_back(places.col(i));
    if (!motion::Seen(track.back())) {
      return InvalidData("marker " + name + " is not seen in frame " + std::to_string(i + 1));
    }
  }
  return Smoothed(Smoothed(track));
}

Result<Shin> ShinOf(const motion::MarkerTracks& tracks, const std::string& side) {
  const auto knee = Marker(tracks, side + "_knee");
  const auto ankle = Marker(tracks, side + "_ankle");
  const auto front = Marker(tracks, side + "_shank_antsup");
  for (const auto* one : {&knee, &ankle, &front}) {
    if (!*one) return one->error();
  }
  Shin shin;
  for (std::size_t i = 0; i < Frames(tracks); ++i) {
    const Vector3d down = ((*ankle)[i] - (*knee)[i]).normalized();
    const Vector3d side_W = down.cross((*front)[i] - (*knee)[i]).normalized();
    Matrix3d axes;
    axes << down, side_W, down.cross(side_W);
    shin.axes_W.push_back(axes);
    shin.place_W.push_back(((*knee)[i] + (*ankle)[i] + (*front)[i]) / 3);
  }
  // At its ends smoothing is one-sided, which looks like acceleration.
  constexpr std::size_t kEdge = 2 * kSmoothFrames + 1;
  for (std::size_t i = kEdge; i + kEdge < Frames(tracks); ++i) {
    const Vector3d acceleration =
        (shin.place_W[i + 1] - 2 * shin.place_W[i] + shin.place_W[i - 1]) * tracks.rate_hz *
        tracks.rate_hz;
    shin.force_mps2.push_back(shin.axes_W[i].transpose() *
                              (acceleration + kStandardGravityMps2 * kUp_W));
  }
  return shin;
}

/// The wearer's front while standing: from the middle of the rear pelvis markers to the front ones.
Result<Vector3d> FrontOf(const motion::MarkerTracks& tracks) {
  Vector3d front = Vector3d::Zero();
  for (const auto& [name, sign] :
       {std::pair{"L.ASIS", 1}, {"r.ASIS", 1}, {"L.PSIS", -1}, {"r.PSIS", -1}}) {
    const auto marker = Marker(tracks, name);
    if (!marker) return marker.error();
    for (const Vector3d& place : *marker) front += sign * place;
  }
  return Vector3d((front - front.dot(kUp_W) * kUp_W).normalized());
}

/// From the marker frame to M: upright in the mean of the standing, x left, y front, z down.
Matrix3d PerfectMounting(const Shin& standing, const Vector3d& front_W) {
  Matrix3d axes_WM;
  axes_WM << kUp_W.cross(front_W), front_W, -kUp_W;
  return axes_WM.transpose() * standing.axes_W[standing.axes_W.size() / 2];
}

struct Leg {
  Track standing_M;
  Track stride_M;
  double mid_stance = 0;  // Frame.
};

struct Recording {
  double rate_hz = 100;
  Leg legs[2];
  double StrideS() const { return static_cast<double>(legs[0].stride_M.size()) / rate_hz; }
};

Vector3d Standing(const Recording& recording, int side, double t_s) {
  const Track& track = recording.legs[side].standing_M;
  // To and fro, so that it has no end.
  const double last = static_cast<double>(track.size() - 1);
  const double frame = std::fmod(t_s * recording.rate_hz, 2 * last);
  return At(track, frame <= last ? frame : 2 * last - frame);
}

/// A leg that stands, walks from its mid-stance at `from_s` to that of `to_s`, and stands.
Vector3d Stepping(const Recording& recording, int side, double t_s, double from_s, double to_s) {
  const Vector3d standing = Standing(recording, side, t_s);
  if (t_s <= from_s || t_s >= to_s) return standing;
  const Leg& leg = recording.legs[side];
  const Vector3d walking = At(leg.stride_M, leg.mid_stance + (t_s - from_s) * recording.rate_hz);
  const double share = std::min({1.0, (t_s - from_s) / kBlendS, (to_s - t_s) / kBlendS});
  return share * walking + (1 - share) * standing;
}

Result<Recording> ReadRecording(const std::string& standing_path, const std::string& walking_path) {
  const auto standing = ReadTrc(standing_path);
  if (!standing) return standing.error();
  const auto walking = ReadTrc(walking_path);
  if (!walking) return walking.error();
  const auto front_W = FrontOf(*standing);
  if (!front_W) return InvalidData(standing_path + ": " + front_W.error().message);
  Recording recording;
  recording.rate_hz = walking->rate_hz;
  Track walks[2];
  for (int side = 0; side < 2; ++side) {
    const char* name = side == 0 ? "L" : "r";
    const auto stands = ShinOf(*standing, name);
    if (!stands) return InvalidData(standing_path + ": " + stands.error().message);
    const auto walks_S = ShinOf(*walking, name);
    if (!walks_S) return InvalidData(walking_path + ": " + walks_S.error().message);
    const Matrix3d rotation_MS = PerfectMounting(*stands, *front_W);
    for (const Vector3d& force : stands->force_mps2) {
      recording.legs[side].standing_M.push_back(rotation_MS * force);
    }
    for (const Vector3d& force : walks_S->force_mps2) walks[side].push_back(rotation_MS * force);
  }
  const auto shortest = static_cast<std::size_t>(kShortestStrideS * recording.rate_hz);
  std::size_t period = shortest;
  const auto mismatch = [&walks](std::size_t frames) {
    return Mismatch(walks[0], frames) + Mismatch(walks[1], frames);
  };
  for (std::size_t frames = shortest; frames < walks[0].size(); ++frames) {
    if (mismatch(frames) < mismatch(period)) period = frames;
  }
  if (mismatch(period) >= kWorstMismatch) {
    return InvalidData(walking_path + ": no whole stride in it");
  }
  for (int side = 0; side < 2; ++side) {
    Leg& leg = recording.legs[side];
    leg.stride_M = Loop(walks[side], period);
    leg.mid_stance = static_cast<double>(
        MidStance(leg.stride_M, leg.standing_M[leg.standing_M.size() / 2], recording.rate_hz));
  }
  return recording;
}

}  // namespace

Result<MountingWalk> RecordedWalk(const std::string& standing, const std::string& walking) {
  auto read = ReadRecording(standing, walking);
  if (!read) return read.error();
  const auto recording = std::make_shared<Recording>(std::move(read).value());
  const double stride_s = recording->StrideS();
  // The right leg leaves its mid-stance when the left one comes to stand: as far later as in the
  // recording.
  const auto apart =
      static_cast<std::ptrdiff_t>(recording->legs[1].mid_stance - recording->legs[0].mid_stance);
  const auto size = static_cast<std::ptrdiff_t>(recording->legs[0].stride_M.size());
  const double right_later_s =
      static_cast<double>((apart % size + size) % size) / recording->rate_hz;
  MountingWalk walk;
  walk.what = "two shins of a recorded walk, one stride of " +
              std::to_string(std::lround(stride_s * 1e3)) + " ms repeated";
  walk.roles[0] = stream::DeviceRole::kLeftLeg;
  walk.roles[1] = stream::DeviceRole::kRightLeg;
  walk.still_from_s = kStandS - 2.2;
  walk.still_to_s = kStandS;
  walk.steps_to_s = kStandS + 2 * stride_s + 0.5;
  walk.walk_from_s = kStandS + 2 * stride_s + kStandAgainS;
  walk.end_s = walk.walk_from_s + kWalkS;
  walk.force_M_mps2 = [recording, stride_s, right_later_s, walk_from_s = walk.walk_from_s](
                          int side, double t_s) -> Vector3d {
    const double later_s = side == 1 ? right_later_s : 0;
    // Left, right, left: three steps.
    const double strides = side == 1 ? 1 : 2;
    if (t_s < walk_from_s) {
      return Stepping(*recording, side, t_s, kStandS + later_s,
                      kStandS + later_s + strides * stride_s);
    }
    return Stepping(*recording, side, t_s, walk_from_s + later_s, kWorstMismatch);
  };
  // Features of the same walk without noise and counts, every 10 ms.
  auto truths = std::make_shared<std::vector<WalkTruth>>();
  Chain chain(true);
  const auto first = static_cast<std::int64_t>(walk.walk_from_s * 100);
  const auto last = static_cast<std::int64_t>(walk.end_s * 100);
  for (std::int64_t tick = first; tick <= last; ++tick) {
    const double t_s = static_cast<double>(tick) * 0.01;
    chain.Add(kLeftDevice, tick * 10'000'000, walk.force_M_mps2(0, t_s));
    chain.Add(kRightDevice, tick * 10'000'000, walk.force_M_mps2(1, t_s));
    const auto features = chain.Compute(tick * 10'000'000);
    WalkTruth truth;
    truth.frequency_hz = 1 / stride_s;
    truth.phase_rad = features.pairs.front().phase_rad;
    for (std::size_t side = 0; side < 2; ++side) {
      truth.amplitude_mps2[side] = features.devices[side].amplitude_mps2;
      truth.roll_rad[side] = features.devices[side].roll_rad;
      truth.pitch_rad[side] = features.devices[side].pitch_rad;
    }
    truths->push_back(truth);
  }
  walk.truth = [truths, first, from_s = walk.walk_from_s + kWalkSettledS](double t_s) {
    const auto index = static_cast<std::size_t>(std::llround(t_s * 100) - first);
    return t_s < from_s || index >= truths->size() ? std::nullopt : std::optional((*truths)[index]);
  };
  return walk;
}

MountingWalk SyntheticWalk() {
  using wrists::Segment;
  constexpr double kStillS = 2.5;
  constexpr double kStepHz = 0.9;
  const auto degrees = DegreesToRadians;
  // Three steps are a cycle and a half of the arms.
  const std::vector<Segment> script = {
      {kStillS, kStepHz, kPi, 0, 0, 0},
      {1.5 / kStepHz, kStepHz, kPi, 7, 0, 0},
      {1.5, kStepHz, kPi, 0, 0, 0},
      {5, 0.9, kPi, 6, 0, 0},
      {4, 1.2, kPi, 9, degrees(5), degrees(-10)},
      {3.5, 1.6, 2.6, 13, degrees(-8), degrees(15)},
  };
  // The left arm begins backwards: its swing falls from half a turn on.
  const double start_rad = kPi - 2 * kPi * kStepHz * kStillS;
  auto motion = std::make_shared<wrists::HandMotion>(script, wrists::WristShape(), 0.3, start_rad);
  MountingWalk walk;
  walk.what = "two wrists of common/virtual/devices";
  walk.roles[0] = stream::DeviceRole::kLeftHand;
  walk.roles[1] = stream::DeviceRole::kRightHand;
  walk.still_from_s = 0.2;
  walk.still_to_s = kStillS;
  walk.steps_to_s = kStillS + script[1].duration_s + 0.5;
  walk.walk_from_s = kStillS + script[1].duration_s + script[2].duration_s;
  walk.end_s = motion->DurationSeconds();
  walk.force_M_mps2 = [motion](int side, double t_s) {
    const wrists::Hands hands = motion->At(t_s);
    return side == 0 ? hands.left_mps2 : hands.right_mps2;
  };
  walk.truth = [script](double t_s) -> std::optional<WalkTruth> {
    double begin_s = 0;
    for (std::size_t i = 0; i < script.size(); ++i) {
      const Segment& segment = script[i];
      const double settled_s = begin_s + 0.5 + 3 / segment.frequency_hz;
      if (i >= 3 && t_s >= settled_s && t_s < begin_s + segment.duration_s) {
        return WalkTruth{segment.frequency_hz,
                         segment.phase_rad,
                         {segment.amplitude_mps2, segment.amplitude_mps2},
                         {segment.roll_rad, segment.roll_rad},
                         {segment.pitch_rad, segment.pitch_rad}};
      }
      begin_s += segment.duration_s;
    }
    return std::nullopt;
  };
  return walk;
}

}  // namespace footing::eval
