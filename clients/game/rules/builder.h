#pragma once

#include <cstdint>
#include <optional>

#include "clients/game/rules/piece.h"

namespace footing::game {

/// When a piece is laid: as soon as less track lies ahead of the runner than it covers in 3 s (6 to
/// 12 m), so that ground always lies ahead and the builder still decides late. What the hand holds
/// then is laid, as the ghost showed it.
class Builder {
 public:
  /// What is known of the runner and the track, at one instant.
  struct Sight {
    double time_s = 0;      ///< Simulation time.
    double distance_m = 0;  ///< Of the runner, along the track.
    double speed_mps = 0;
    const stream::Track& track;  ///< As published last; not empty.
  };

  explicit Builder(bool pits) : pits_(pits) {}

  /// The piece to append now; nothing while enough lies ahead, or while one is on its way.
  std::optional<Piece> Advance(const Sight& sight, const Hand& hand);
  /// The track did not take the last piece: a plain one follows, whatever the hand holds.
  void OnRefused();
  /// A new track: what was on its way is void.
  void Restart();

  /// What would be laid now.
  const Piece& ghost() const { return ghost_; }
  std::uint32_t refused() const { return refused_; }

 private:
  bool pits_;
  Piece ghost_;
  std::optional<double> sent_s_;     ///< When a piece went out that has not shown yet.
  std::uint64_t sent_revision_ = 0;  ///< Of the track at that time.
  bool plain_ = false;
  std::uint32_t refused_ = 0;
};

/// How much track is kept ahead of a runner of that speed, m.
double LookAheadM(double speed_mps);

}  // namespace footing::game
