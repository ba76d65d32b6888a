#pragma once

#include <functional>

#include "daemon/simulation/engine/engine.h"
#include "tests/simulation/test_world.h"

namespace footing::engine {

inline EngineTexts Texts() {
  EngineTexts texts{.biped = test::DataFile(kBipedFile),
                    .track = test::DataFile(kPlainTrackFile),
                    .mapping = test::DataFile(mapping::kWristMappingFile),
                    .gains = {},
                    .style = {},
                    .choices = {}};
  for (const char* name : kGainFiles) texts.gains.push_back({name, test::DataFile(name)});
  return texts;
}

inline GaitEngine NewEngine() {
  Result<GaitEngine> engine = GaitEngine::Create(Texts());
  EXPECT_TRUE(engine.ok()) << (engine.ok() ? "" : engine.error().message);
  return std::move(engine).value();
}

inline biped::GaitCommand Command(stream::Gait gait, double speed_mps, double height_m = 0.2,
                                  double turn_per_step_rad = 0) {
  return {gait, speed_mps, height_m, turn_per_step_rad};
}

/// Advances by so many seconds; `see` gets every step's output.
inline void Simulate(GaitEngine& engine, const EngineInputs& inputs, double seconds,
                     const std::function<void(const EngineOutput&)>& see = nullptr) {
  const auto steps = static_cast<int>(seconds / EngineConfig{}.step_s + 0.5);
  for (int i = 0; i < steps; ++i) {
    engine.Advance(inputs);
    if (see) see(engine.Output());
  }
}

inline EngineInputs Direct(const biped::GaitCommand& command) {
  EngineInputs inputs;
  inputs.direct = true;
  inputs.direct_command = command;
  return inputs;
}

inline void Push(EngineInputs& inputs, double x_ns, double y_ns) {
  ++inputs.push_number;
  inputs.push_impulse_W_ns = {x_ns, y_ns};
}

}  // namespace footing::engine
