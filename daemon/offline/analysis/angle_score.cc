#include "daemon/offline/analysis/angle_score.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/virtual/motion/joint_angles.h"

namespace footing::eval {
namespace {

using body::Landmark;
using nlohmann::ordered_json;

/// Which frame an error belongs to.
struct FrameKind {
  bool valid = false, bent = false;
};

/// The errors of one angle.
class Errors {
 public:
  void Add(double error_deg, FrameKind kind) {
    all_.Add(error_deg);
    if (kind.valid) valid_.Add(error_deg);
    (kind.bent ? bent_ : upright_).Add(error_deg);
  }
  /// With its stated deviation.
  void AddStated(double error_deg, double sd_deg, FrameKind kind) {
    sd_.Add(sd_deg);
    const double off = error_deg / sd_deg;
    off_.Add(off);
    (kind.bent ? off_bent_ : off_upright_).Add(off);
  }
  void WriteTo(ordered_json& json) const {
    json["rmse_deg"] = all_.Rms();
    if (sd_.count > 0) {
      json["sd_deg"] = sd_.Rms();
      json["nees"] = off_.MeanSquare();
      if (off_bent_.count > 0) json["nees_bent"] = off_bent_.MeanSquare();
      if (off_upright_.count > 0) json["nees_upright"] = off_upright_.MeanSquare();
    }
    if (valid_.count > 0) json["rmse_valid_deg"] = valid_.Rms();
    if (upright_.count > 0) json["rmse_upright_deg"] = upright_.Rms();
    if (bent_.count > 0) json["rmse_bent_deg"] = bent_.Rms();
  }
  double count() const { return all_.count; }
  double mean_deg() const { return all_.count > 0 ? all_.sum / all_.count : 0; }

 private:
  struct Sum {
    double count = 0, sum = 0, squares = 0;
    void Add(double value) {
      ++count;
      sum += value;
      squares += value * value;
    }
    double MeanSquare() const { return count > 0 ? squares / count : 0; }
    double Rms() const { return std::sqrt(MeanSquare()); }
  };
  Sum all_, valid_, upright_, bent_;
  Sum sd_, off_, off_bent_, off_upright_;  ///< Off: error over stated deviation.
};

struct Range {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  void Add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

struct Coordinate {
  Errors errors;
  Range estimated, truth;
  double frames = 0;  ///< Known or not, of both sides.
};

motion::Motion MotionOf(const body::Body& body, const std::vector<Eigen::VectorXd>& q,
                        double rate_hz) {
  motion::Motion motion;
  motion.skeleton = body.skeleton;
  motion.rate_hz = rate_hz;
  motion.q.resize(body.skeleton.dof, static_cast<Eigen::Index>(q.size()));
  for (std::size_t i = 0; i < q.size(); ++i) motion.q.col(static_cast<Eigen::Index>(i)) = q[i];
  return motion;
}

/// Both sides of a limb are one coordinate; nothing where the column is not an angle.
std::optional<std::string> NameOf(const std::string& column) {
  if (column == "time" || column.rfind("pelvis_t", 0) == 0) {
    if (column != "pelvis_tilt") return std::nullopt;
  }
  const bool sided = column.ends_with("_l") || column.ends_with("_r");
  return sided ? column.substr(0, column.size() - 2) : column;
}

std::vector<FrameKind> KindsOf(const motion::Table& estimated, const std::vector<bool>& valid) {
  const int left = motion::FindColumn(estimated, "knee_angle_l");
  const int right = motion::FindColumn(estimated, "knee_angle_r");
  std::vector<FrameKind> kinds(valid.size());
  for (std::size_t i = 0; i < valid.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double bend_deg = (estimated.values(row, left) + estimated.values(row, right)) / 2;
    kinds[i] = {valid[i], bend_deg >= AngleScore::kBentDeg};
  }
  return kinds;
}

struct LinkKind {
  const char* name;
  Landmark left;
};
constexpr LinkKind kLinks[] = {
    {"pelvis", Landmark::kHips},       {"chest", Landmark::kChest},
    {"head", Landmark::kHead},         {"upper_arm", Landmark::kLeftShoulder},
    {"forearm", Landmark::kLeftElbow}, {"hand", Landmark::kLeftWrist},
    {"thigh", Landmark::kLeftHip},     {"shank", Landmark::kLeftKnee},
    {"foot", Landmark::kLeftAnkle}};

/// NameOf(), without the angles of the arms, which do not change from standing.
std::optional<std::string> NameOfTrunkOrLeg(const std::string& column) {
  const bool arm = column.rfind("arm_", 0) == 0 || column.rfind("elbow_", 0) == 0;
  return arm ? std::nullopt : NameOf(column);
}

/// Every coordinate that is an angle, in the order of the columns; `since_standing`: those of trunk
/// and legs alone, in the frames in which they are known.
void WriteCoordinates(const motion::Table& estimated, const motion::Table& truth,
                      const std::vector<FrameKind>& kinds, bool since_standing,
                      const std::vector<reconstruction::AngleSd>& stated, ordered_json& json) {
  std::map<std::string, Coordinate> coordinates;
  std::vector<std::string> order;
  for (std::size_t column = 0; column < estimated.columns.size(); ++column) {
    const std::string& label = estimated.columns[column];
    const auto name = since_standing ? NameOfTrunkOrLeg(label) : NameOf(label);
    if (!name || motion::FindColumn(truth, label) < 0) continue;
    if (!coordinates.contains(*name)) order.push_back(*name);
    Coordinate& coordinate = coordinates[*name];
    const auto index = static_cast<Eigen::Index>(column);
    const int true_index = motion::FindColumn(truth, label);
    const auto angle = body::StatedAngle(label);
    for (Eigen::Index row = 0; row < estimated.values.rows(); ++row) {
      ++coordinate.frames;
      if (since_standing && !joint_angles::IsKnown(estimated, label, row)) continue;
      const double is_deg = estimated.values(row, index);
      const double should_deg = truth.values(row, true_index);
      const double error_deg = std::remainder(is_deg - should_deg, 360.0);
      const auto at = static_cast<std::size_t>(row);
      coordinate.errors.Add(error_deg, kinds[at]);
      if (at < stated.size() && angle) {
        coordinate.errors.AddStated(error_deg, RadiansToDegrees(stated[at][*angle]), kinds[at]);
      }
      coordinate.estimated.Add(is_deg);
      coordinate.truth.Add(should_deg);
    }
  }
  for (const std::string& name : order) {
    const Coordinate& coordinate = coordinates.at(name);
    ordered_json& entry = json[name];
    const double known = coordinate.errors.count();
    if (known < coordinate.frames) entry["known_share"] = known / coordinate.frames;
    if (known == 0) continue;
    coordinate.errors.WriteTo(entry);
    entry["mean_error_deg"] = coordinate.errors.mean_deg();
    entry["range_deg"] = coordinate.estimated.most - coordinate.estimated.least;
    entry["true_range_deg"] = coordinate.truth.most - coordinate.truth.least;
  }
}

double RotationDeg(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return RadiansToDegrees(std::acos(std::clamp(((a.transpose() * b).trace() - 1) / 2, -1.0, 1.0)));
}

}  // namespace

Result<ordered_json> CompareAngles(const motion::Table& estimated, const motion::Table& truth,
                                   const std::vector<bool>& valid, Eigen::Index first,
                                   const std::vector<reconstruction::AngleSd>& stated) {
  ordered_json json;
  const std::vector<FrameKind> kinds = KindsOf(estimated, valid);
  WriteCoordinates(estimated, truth, kinds, false, {}, json["joint_angles"]);
  const auto standing = joint_angles::FindStanding(truth, first);
  if (standing.empty()) return json;
  const auto change = joint_angles::SinceStanding(estimated, standing);
  if (!change) return change.error();
  const auto true_change = joint_angles::SinceStanding(truth, standing);
  if (!true_change) return true_change.error();
  WriteCoordinates(*change, *true_change, kinds, true, stated, json["angles_since_standing"]);
  return json;
}

void AngleScore::Add(const reconstruction::Output& output, const Eigen::VectorXd& true_q,
                     bool valid) {
  q_.push_back(output.q);
  stated_.push_back(output.angle_sd_rad);
  true_q_.push_back(true_q);
  valid_.push_back(valid);
}

Result<void> AngleScore::WriteTo(ordered_json& json) const {
  if (q_.empty()) return {};
  const motion::Motion estimate = MotionOf(body_, q_, rate_hz_);
  const auto estimated = joint_angles::JointAngles(estimate);
  if (!estimated) return estimated.error();
  const auto truth = joint_angles::JointAngles(MotionOf(body_, true_q_, rate_hz_), &estimate);
  if (!truth) return truth.error();
  const auto compared = CompareAngles(*estimated, *truth, valid_, first_, stated_);
  if (!compared) return compared.error();
  json.update(*compared);
  const std::vector<FrameKind> kinds = KindsOf(*estimated, valid_);
  std::array<Errors, std::size(kLinks)> links;
  body::Kinematics at(body_.skeleton), true_at(body_.skeleton);
  for (std::size_t i = 0; i < q_.size(); ++i) {
    body::ComputeKinematics(body_.skeleton, q_[i], at);
    body::ComputeKinematics(body_.skeleton, true_q_[i], true_at);
    for (std::size_t link = 0; link < links.size(); ++link) {
      const Landmark left = kLinks[link].left;
      for (int side = 0; side < (body::Mirrored(left) == left ? 1 : 2); ++side) {
        const int joint = body_.landmarks[body::OfSide(left, side)];
        if (joint < 0) continue;
        const auto index = static_cast<std::size_t>(joint);
        links[link].Add(RotationDeg(at.R_WJ[index], true_at.R_WJ[index]), kinds[i]);
      }
    }
  }
  for (std::size_t link = 0; link < links.size(); ++link) {
    links[link].WriteTo(json["link_orientations"][kLinks[link].name]);
  }
  json["bent_frames"] =
      std::count_if(kinds.begin(), kinds.end(), [](FrameKind kind) { return kind.bent; });
  return {};
}

}  // namespace footing::eval
