#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "clients/view/scene/update.h"

namespace footing::scene {

/// Latencies of the last 100 000 ticks.
class Latencies {
 public:
  void Add(std::int64_t latency_ns);
  /// The value that a share of the ticks stay below, ms; 0 without ticks. `share` in [0, 1].
  double QuantileMs(double share) const;
  double LastMs() const;
  std::size_t count() const { return values_ns_.size(); }

 private:
  std::vector<std::int64_t> values_ns_;
  std::size_t next_ = 0;
  std::int64_t last_ns_ = 0;
};

/// What one run has seen: the numbers that the program prints at its end.
///
/// A gait counts as seen once the first character has run it without a break for 2 s of simulation
/// time and three full cycles: six steps, or three jumps, commanded by received features all the
/// while.
class Tally {
 public:
  void Add(const WorldFrame& frame);
  /// A response whose stamps say where its time went.
  void Add(const stream::ResponseStages& response);

  std::uint64_t frames() const { return frames_; }
  /// Published by the server from the first frame to the last, received or not.
  std::uint64_t frames_published() const { return frames_published_; }
  std::vector<stream::Gait> GaitsSeen() const;
  /// Since the first frame; a restarted server goes on counting.
  std::uint64_t falls() const { return falls_; }
  const stream::FailureCounts& failures() const { return failures_; }
  std::uint64_t operator_put_backs() const { return operator_put_backs_; }
  /// Simulation time in which the first character was beside its track, s.
  double off_track_s() const { return off_track_s_; }
  double distance_m() const { return distance_m_; }

  Latencies publish_to_view;
  std::map<std::string, Latencies> response_stages;  ///< By the names of stream::ResponseTimes.
  Latencies response_without_contact;  ///< All stages but the wait for the right contact.
  std::uint64_t frames_drawn = 0;

 private:
  struct Stretch {
    stream::Gait gait = stream::Gait::kUnspecified;
    double start_s = 0;
    std::uint64_t start_steps = 0;
  };

  std::uint64_t frames_ = 0;
  std::uint64_t frames_published_ = 0;
  std::uint64_t last_sequence_ = 0;
  Stretch stretch_;
  stream::GaitState last_;
  double last_time_s_ = 0;
  std::uint64_t falls_ = 0;
  stream::FailureCounts failures_;
  std::uint64_t operator_put_backs_ = 0;
  double distance_m_ = 0;
  double off_track_s_ = 0;
  std::vector<stream::Gait> seen_;
};

}  // namespace footing::scene
