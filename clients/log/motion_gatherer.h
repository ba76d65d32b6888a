#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "clients/log/opensim.h"
#include "common/base/result.h"
#include "common/virtual/motion/motion.h"
#include "footing/v1/character.pb.h"

namespace footing::log_client {

/// Gathers frames of one reconstructed body into a motion.
///
/// Lengths are those of the first frame taken (links are rigid); every joint turns about three
/// axes. Frames before the T-pose are left out; where a frame is missing the one before stands.
class MotionGatherer {
 public:
  explicit MotionGatherer(const v1::Skeleton& skeleton) : skeleton_(skeleton) {}

  void Add(const v1::CharacterFrame& frame, std::uint64_t log_time_ns = 0);
  /// Nothing where no frame was taken. InvalidData where frames and skeleton do not fit, or time
  /// does not go on.
  Result<motion::Motion> Finish() const;
  /// The loads of the feet at the instants of the poses of Finish(). A foot has none where its
  /// centre of pressure is not known, or while the boards or its insole measure nothing: the engine
  /// repeats the last load then.
  Result<std::vector<FootForces>> Forces() const;
  /// Whether the engine reported each pose of Finish() as valid.
  Result<std::vector<bool>> Valid() const;
  bool empty() const { return frames_.empty(); }
  const std::string& subject() const { return subject_; }
  /// How much older than its frame a pose is.
  double lag_s() const;
  /// Log time of the first frame taken.
  std::uint64_t begin_ns() const { return begin_ns_; }

 private:
  /// At equal steps, the newest frame of each.
  struct Grid {
    double step_s = 0;
    std::vector<std::size_t> frames;
  };
  Result<Grid> MakeGrid() const;

  v1::Skeleton skeleton_;
  std::vector<v1::CharacterFrame> frames_;
  std::string subject_;
  std::uint64_t begin_ns_ = 0;
};

}  // namespace footing::log_client
