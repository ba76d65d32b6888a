#include <algorithm>
#include <optional>
#include <utility>

#include "common/base/lines.h"
#include "common/base/number.h"
#include "common/base/units.h"
#include "common/virtual/motion/asf.h"
#include "common/virtual/motion/rate.h"
#include "common/virtual/motion/value.h"

namespace footing::motion {
namespace {

/// One frame's numbers as they come in: which bones have been seen.
class Frame {
 public:
  Frame(const AsfSkeleton& asf, double radians)
      : asf_(asf), radians_(radians), seen_(asf.bones.size()), root_(3) {
    root_.setZero();
  }

  void Begin() {
    std::fill(seen_.begin(), seen_.end(), false);
    root_seen_ = false;
  }

  /// One line "BONE number ...". `q` is the frame's column.
  Result<void> Take(std::string_view line, const text::Lines& lines, Eigen::VectorXd& q) {
    const std::string_view name = text::TakeWord(line);
    if (name == "root") {
      if (std::exchange(root_seen_, true)) return lines.Fault("a second root in one frame");
      return TakeRoot(line, lines, q);
    }
    std::size_t bone = next_;  // Mostly the next of the last frame.
    if (bone >= asf_.bones.size() || asf_.bones[bone].name != name) {
      for (bone = 0; bone < asf_.bones.size() && asf_.bones[bone].name != name; ++bone) {
      }
      if (bone == asf_.bones.size()) {
        return lines.Fault("bone " + text::Quoted(name) +
                           " is not in the skeleton, or does not turn");
      }
    }
    next_ = bone + 1;
    if (seen_[bone]) return lines.Fault("a second " + std::string(name) + " in one frame");
    seen_[bone] = true;
    for (const int dof : asf_.bones[bone].dofs) {
      const auto number = Next(line, lines, name);
      if (!number) return number.error();
      q(dof) = *number * radians_;
    }
    return End(line, lines, name);
  }

  /// Nothing, or the name of what the frame lacks.
  std::string Missing() const {
    if (!root_seen_) return "root";
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      if (!seen_[i]) return asf_.bones[i].name;
    }
    return {};
  }

 private:
  Result<double> Next(std::string_view& line, const text::Lines& lines,
                      std::string_view name) const {
    const std::string_view word = text::TakeWord(line);
    const auto number = ToValue(word);
    if (number) return *number;
    return lines.Fault("expected a number of " + std::string(name) + " within +-1e9, found " +
                       (word.empty() ? "the end of the line" : text::Quoted(word)));
  }
  Result<void> End(std::string_view line, const text::Lines& lines, std::string_view name) const {
    if (text::Trim(line).empty()) return {};
    return lines.Fault("more numbers than " + std::string(name) + " has degrees of freedom");
  }

  Result<void> TakeRoot(std::string_view line, const text::Lines& lines, Eigen::VectorXd& q) {
    body::Joint file_root = asf_.file_root;
    file_root.first_dof = 0;
    for (const auto& which : asf_.root_numbers) {
      const auto number = Next(line, lines, "root");
      if (!number) return number.error();
      if (which.rotation) {
        root_(which.index) = *number * radians_;
      } else {
        q(which.index) = *number * asf_.unit_m + asf_.root_position_m(which.index);
      }
    }
    // R A, not the C A C^T of a bone: the root's orientation is where it starts.
    const Eigen::Matrix3d R = body::JointRotation(file_root, root_) * file_root.axes;
    body::SetJointRotation(asf_.skeleton.joint(0), R, q);
    return End(line, lines, "root");
  }

  const AsfSkeleton& asf_;
  double radians_;
  std::vector<bool> seen_;
  bool root_seen_ = false;
  std::size_t next_ = 0;
  Eigen::VectorXd root_;
};

}  // namespace

Result<Motion> ParseAmc(std::string_view text, const std::string& file, const AsfSkeleton& asf,
                        double rate_hz) {
  if (!IsRate(rate_hz)) return UsageError("a rate of " + std::to_string(rate_hz) + " Hz");
  text::Lines lines(text, file);
  double radians = asf.radians_per_angle;
  auto line = lines.NextFull();
  for (; line; line = lines.NextFull()) {
    const std::string_view word = text::Trim(*line);
    if (word[0] == '#') continue;
    if (word[0] != ':') break;
    if (word == ":DEGREES") radians = kPi / 180;
    if (word == ":RADIANS") radians = 1;
  }
  std::vector<double> values;
  const auto dof = static_cast<std::size_t>(asf.skeleton.dof);
  Frame frame(asf, radians);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(asf.skeleton.dof);
  std::size_t frames = 0;
  std::optional<std::uint64_t> last;  // Its number.
  while (line) {
    const std::string_view word = text::Trim(*line);
    const auto number = text::ToCount(word);
    if (!number) {
      return lines.Fault("expected the number of a frame, found " + text::Quoted(word));
    }
    if (last && *number != *last + 1) {
      return lines.Fault("frame " + std::to_string(*number) + " follows frame " +
                         std::to_string(*last) + "; frames are missing or in another order");
    }
    last = *number;
    if (values.size() + dof > kMostValues) {
      return lines.Fault("over " + std::to_string(kMostValues) + " values");
    }
    frame.Begin();
    for (line = lines.NextFull(); line && !text::ToCount(text::Trim(*line));
         line = lines.NextFull()) {
      const auto done = frame.Take(*line, lines, q);
      if (!done) return done.error();
    }
    if (const std::string missing = frame.Missing(); !missing.empty()) {
      return lines.Fault("frame " + std::to_string(*number) + " ends without " + missing);
    }
    values.insert(values.end(), q.data(), q.data() + q.size());
    ++frames;
  }
  if (frames == 0) return lines.Fault("no frame in the file");
  Motion motion{asf.skeleton, rate_hz, 0, {}};
  motion.q = Eigen::Map<const Eigen::MatrixXd>(values.data(), asf.skeleton.dof,
                                               static_cast<Eigen::Index>(frames));
  return motion;
}

}  // namespace footing::motion
