#pragma once

#include <cstdint>

#include "clients/view/scene/model.h"

/// A made stream in place of both servers: a body that runs along a straight track, two hand-held
/// controllers and a balance board, all of them flagged simulated.
namespace footing::scene::made {

struct Wish {
  stream::Gait gait = stream::Gait::kRun;
  double speed_mps = 2;
  bool board = true;
  bool simulated = true;
  stream::UserInterface interface = stream::UserInterface::kWrist;
  std::uint32_t missing_roles = 0;  ///< The interface is without them; the character steps.
};

/// Foot and hip heights of the made body: hips at 0.95 m, feet on the ground while they stand.
inline constexpr double kHipHeightM = 0.95;

stream::Track StraightTrack(double length_m);
stream::Skeleton Biped();

/// The tick at `time_s`, as it would arrive 1 ms after its stamp. The first one (time 0) carries
/// what a snapshot carries.
Update TickAt(double time_s, const Wish& wish);

/// A model after `seconds` of it, at 100 Hz from time 0.
Model ModelAfter(double seconds, const Wish& wish);

/// The viewer's clock at that time of the stream.
std::int64_t ClockAt(double time_s);

}  // namespace footing::scene::made
