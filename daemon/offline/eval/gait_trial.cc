#include "daemon/offline/eval/gait_trial.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "daemon/offline/analysis/leg_gap.h"
#include "daemon/simulation/biped/mjcf.h"
#include "daemon/simulation/gait_service/engine_files.h"
#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/biped/track.h"

namespace footing::eval {
namespace {

std::vector<std::string>& MoreGains() {
  static std::vector<std::string> paths;
  return paths;
}

Result<engine::EngineTexts> ReadTexts(
    stream::UserInterface interface = stream::UserInterface::kWrist,
    const std::string& mapping_table = "") {
  return engine_files::ReadTexts(
      {.interface = interface, .mapping_table = mapping_table, .more_gains = MoreGains()});
}

}  // namespace

void ReadGainsToo(std::vector<std::string> paths) { MoreGains() = std::move(paths); }

std::uint64_t TrialSeed(std::uint64_t seed, int trial) {
  return seed * 1000003u + static_cast<std::uint64_t>(trial);
}

Result<std::uint64_t> ParseSeed(const std::string& text) {
  if (text == "random") {
    const std::uint64_t seed = std::random_device{}();
    std::fprintf(stderr, "seed %llu\n", static_cast<unsigned long long>(seed));
    return seed;
  }
  std::uint64_t seed = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, seed);
  if (read.ec != std::errc() || read.ptr != end) {
    return UsageError("--seed " + text + ": must be a number, or random");
  }
  return seed;
}

Result<engine::GaitEngine> NewEngine() {
  Result<engine::EngineTexts> texts = ReadTexts();
  if (!texts) return texts.error();
  return engine::GaitEngine::Create(*texts);
}

Result<engine::GaitEngine> NewEngineOn(const std::string& track,
                                       const mapping::InterfaceOptions& interface,
                                       const std::string& mapping_table) {
  Result<engine::EngineTexts> texts = ReadTexts(interface.interface, mapping_table);
  if (!texts) return texts.error();
  texts->track = track;
  return engine::GaitEngine::Create(*texts, {.interface = interface});
}

Result<physics::World> NewWorld(const std::optional<std::string>& track_text) {
  Result<engine::EngineTexts> texts = ReadTexts();
  if (!texts) return texts.error();
  Result<biped::BipedParameters> biped = biped::ParseBiped(texts->biped, engine::kBipedFile);
  if (!biped) return biped.error();
  Result<stream::Track> track =
      terrain::ParseTrack(track_text.value_or(texts->track), engine::kPlainTrackFile);
  if (!track) return track.error();
  const terrain::GroundText ground = terrain::GroundMjcf(*track);
  return physics::World::FromMjcf(
      biped::WriteMjcf(*biped, ground.mjcf, {}, engine::EngineConfig{}.step_s), biped::Names());
}

void Walker::Command(const biped::GaitCommand& command) {
  inputs_.direct = true;
  inputs_.direct_command = command;
}

void Walker::Push(double impulse_ns, double direction_rad) {
  Push(impulse_ns, direction_rad, inputs_.push_number + 1);
}

void Walker::Push(double impulse_ns, double direction_rad, std::uint64_t number) {
  inputs_.push_number = number;
  inputs_.push_impulse_W_ns =
      impulse_ns * Eigen::Vector2d(std::cos(direction_rad), std::sin(direction_rad));
}

const engine::EngineOutput& Walker::Advance() {
  engine_.Advance(inputs_);
  output_ = &engine_.Output();
  if (!fell()) leg_gap_min_m_ = std::min(leg_gap_min_m_, legs::LegGap(*output_));
  return *output_;
}

}  // namespace footing::eval
