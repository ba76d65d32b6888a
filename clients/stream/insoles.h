#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "clients/stream/body_stage.h"
#include "clients/stream/plan.h"

namespace footing::stream_client {

/// Errors of an insole's cells.
struct InsoleErrors {
  double noise_kg = 0;     ///< White, of each cell and frame.
  double gain_spread = 0;  ///< Standard deviation of each cell's gain.
};

struct InsolesOptions {
  StageOptions stage;
  std::string hands = "none";  ///< none or move.
  double hand_noise_m = 0.01;  ///< Standard deviation along each axis.
  InsoleErrors errors;
};

/// A pressure insole in each shoe of a body in motion, its true pose, and its hands as a tracker
/// sees them. It may walk anywhere.
Result<Plan> PlanInsoles(const InsolesOptions& options, const Common& common);

/// The cells under one foot, 100 times a second: virtual_sensors::LoadInsole of the motion, with
/// errors.
Feed InsoleFeed(std::shared_ptr<const Stage> stage, std::size_t foot, const InsoleErrors& errors,
                std::uint64_t seed);

}  // namespace footing::stream_client
