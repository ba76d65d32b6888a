#include <map>
#include <memory>
#include <utility>

#include "common/wire/wire.h"
#include "daemon/offline/eval/replay.h"
#include "daemon/simulation/engine/state.h"
#include "daemon/simulation/gait_service/applied_input.h"
#include "daemon/simulation/gait_service/config.h"

namespace footing::eval {
namespace {

constexpr std::size_t kMaxInputs = 1'000'000;

/// The recorded messages of footing-sim.
struct BipedRecording {
  std::map<std::uint64_t, engine::EngineInputs> inputs;  ///< By step.
  std::map<std::uint64_t, std::uint64_t> hashes;         ///< By step.
  std::map<std::uint64_t, stream::Track> tracks;         ///< By number, as they were at first.
  std::vector<v1::EffectiveConfig> configs;              ///< The first one and its changes.

  /// The recorded table of the interface of that number; empty: an older footing-sim made it.
  std::string TableOf(std::uint64_t interface_number) const {
    for (const v1::EffectiveConfig& config : configs) {
      const std::string table = gait_service::TableIn(config, interface_number);
      if (!table.empty()) return table;
    }
    return "";
  }
};

BipedRecording GatherBiped(const std::vector<v1::Tick>& ticks) {
  BipedRecording recording;
  for (const v1::Tick& tick : ticks) {
    for (const v1::AppliedInput& message : tick.inputs().inputs()) {
      const gait_service::Applied applied = gait_service::FromAppliedInput(message);
      recording.inputs[applied.step] = applied.inputs.engine;
    }
    if (tick.has_track() && tick.track().number() > 0) {
      const stream::Track track = wire::FromProto(tick.track());
      const auto [known, fresh] = recording.tracks.emplace(track.number, track);
      if (!fresh && track.revision < known->second.revision) known->second = track;
    }
    if (tick.has_config()) recording.configs.push_back(tick.config());
    if (!tick.has_characters()) continue;
    recording.hashes[tick.characters().step()] = tick.characters().state_hash();
  }
  return recording;
}

/// The gait engine, driven step by step by recorded inputs.
class BipedRerun {
 public:
  BipedRerun(const BipedRecording& recording, const biped::BipedParameters& biped,
             std::string data_folder, engine::GaitEngine engine)
      : recording_(recording),
        biped_(biped),
        data_folder_(std::move(data_folder)),
        engine_(std::move(engine)) {}

  Result<void> Step(std::uint64_t step) {
    const auto found = recording_.inputs.find(step);
    if (found != recording_.inputs.end()) {
      current_ = found->second;
      if (const auto done = UseTrack(current_.trial.track_number); !done) return done;
      if (const auto done = UseInterface(current_.interface); !done) return done;
    }
    engine_.Advance(current_);
    return {};
  }

  std::uint64_t state_hash() { return engine_.Output().state_hash; }

 private:
  Result<void> UseTrack(std::uint64_t number) {
    if (number == 0 || engine_.track().number == number) return {};
    const auto track = recording_.tracks.find(number);
    if (track == recording_.tracks.end()) {
      return InvalidData("the recording lacks track " + std::to_string(number) + " of a trial");
    }
    auto world = engine::MakeTrackWorld(track->second, biped_, engine::EngineConfig{}.step_s);
    if (!world) return world.error();
    engine_.UseTrack(**world);
    return {};
  }

  Result<void> UseInterface(engine::InterfaceInputs& wanted) {
    if (wanted.number == interface_number_) return {};
    interface_number_ = wanted.number;
    const std::string table = recording_.TableOf(wanted.number);
    const auto made = table.empty() ? engine_files::ReadInterface(wanted.options, data_folder_)
                                    : mapping::AnyInterface::Create(wanted.options, table);
    if (!made) return made.error();
    wanted.made = *made;
    return {};
  }

  const BipedRecording& recording_;
  const biped::BipedParameters biped_;
  const std::string data_folder_;
  engine::GaitEngine engine_;
  engine::EngineInputs current_;
  std::uint64_t interface_number_ = 0;
};

Result<engine::GaitEngine> FirstEngine(const BipedRecording& recording,
                                       const BipedReplayOptions& options) {
  engine::EngineTexts texts = options.texts;
  if (std::string table = recording.TableOf(0); !table.empty()) texts.mapping = std::move(table);
  if (options.named_track) return engine::GaitEngine::Create(texts, options.config);
  const auto first = recording.tracks.find(1);
  if (first == recording.tracks.end()) {
    return InvalidData(
        "the recording does not hold its whole track (an older footing-sim made it); name the "
        "track with --track");
  }
  return engine::GaitEngine::CreateOn(first->second, texts, options.config);
}

}  // namespace

Result<EngineReplay> ReplayBiped(const std::vector<v1::Tick>& ticks,
                                 const BipedReplayOptions& options) {
  const BipedRecording recording = GatherBiped(ticks);
  if (recording.inputs.size() > kMaxInputs) {
    return InvalidData("the recording holds too many inputs");
  }
  EngineReplay result;
  if (recording.hashes.empty()) return result;
  if (const auto whole = CheckFirstStep(recording.hashes.begin()->first); !whole) {
    return whole.error();
  }
  const auto biped = biped::ParseBiped(options.texts.biped, engine::kBipedFile);
  if (!biped) return biped.error();
  auto engine = FirstEngine(recording, options);
  if (!engine) return engine.error();
  BipedRerun rerun(recording, *biped, options.data_folder, std::move(engine).value());
  for (const auto& [frame_step, hash] : recording.hashes) {
    while (result.last_step < frame_step) {
      if (const auto done = rerun.Step(++result.last_step); !done) return done.error();
    }
    ++result.frames;
    result.state_hash = rerun.state_hash();
    if (result.state_hash == hash) {
      ++result.equal;
    } else if (result.first_difference_step == 0) {
      result.first_difference_step = frame_step;
    }
  }
  return result;
}

}  // namespace footing::eval
