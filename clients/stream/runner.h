#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <vector>

#include "common/stream/track.h"

namespace footing::stream_client {

/// What a person in front of the picture sees of the character.
struct RunnerSight {
  Eigen::Vector2d p_W_m = Eigen::Vector2d::Zero();
  double heading_rad = 0;
  double speed_mps = 0;
};

/// How the hands are swung, alternately.
struct RunnerSwing {
  double frequency_hz = 0;  ///< 0: at rest.
  double amplitude_mps2 = 0;
  double roll_rad = 0;  ///< Left side higher is positive: turn right.
};

/// A synthetic player of the wrist interface who runs along a track that grows: sees the character
/// and the track as they were a reaction time ago, reckons with the turns commanded since, steers
/// for the centre line by inclining both hands, runs where it is straight and walks where it bends.
class Runner {
 public:
  /// Draws the reaction time, 0.2 to 0.3 s, and the favourite speed of running.
  explicit Runner(std::uint64_t seed);

  void SeeTrack(const stream::Track& track);
  void See(double time_s, const RunnerSight& sight);
  /// What the hands do at that time, which never runs back; at rest until there is something to
  /// see.
  RunnerSwing Want(double time_s);

  double reaction_s() const { return reaction_s_; }

 private:
  /// The centre line, in even steps.
  struct Point {
    Eigen::Vector2d p_W_m;
    double heading_rad = 0;
  };
  struct Seen {
    double time_s = 0;
    RunnerSight sight;
  };
  struct Turned {
    double time_s = 0;
    int side = 0;  ///< 1 to the left.
  };

  RunnerSight Reckon(double time_s) const;
  std::size_t NearestTo(const Eigen::Vector2d& p_W_m) const;
  const Point& Ahead(std::size_t from, double ahead_m) const;
  double BendAhead(std::size_t from, double speed_mps) const;

  double reaction_s_;
  double favourite_mps_;
  std::vector<Point> line_;
  std::deque<Seen> seen_;
  std::deque<Turned> turned_;
  int side_ = 0;
  bool runs_ = false;
};

}  // namespace footing::stream_client
