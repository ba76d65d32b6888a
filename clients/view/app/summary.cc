#include "clients/view/app/summary.h"

#include <nlohmann/json.hpp>

namespace footing::view {

std::string Summary(const scene::Model& model, double seconds) {
  nlohmann::ordered_json gaits = nlohmann::ordered_json::array();
  for (const stream::Gait gait : model.tally.GaitsSeen()) gaits.push_back(stream::Name(gait));
  const nlohmann::ordered_json summary{
      {"seconds", seconds},
      {"frames_received", model.tally.frames()},
      {"frames_drawn", model.tally.frames_drawn},
      {"publish_to_view_p50_ms", model.tally.publish_to_view.QuantileMs(0.5)},
      {"publish_to_view_p99_ms", model.tally.publish_to_view.QuantileMs(0.99)},
      {"gaits_seen", gaits},
      {"falls", model.tally.falls()},
      {"distance_m", model.tally.distance_m()},
      {"simulated", scene::IsSimulated(model)}};
  return summary.dump();
}

}  // namespace footing::view
