#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/base/result.h"
#include "daemon/offline/eval/replay.h"
#include "daemon/offline/eval/report.h"
#include "footing/v1/session.pb.h"

namespace footing::eval {

/// The ticks are of the pose engine.
bool IsPoseRecording(const std::vector<v1::Tick>& ticks);

/// Where the pose engine's models are.
struct ModelFolders {
  std::string data;      ///< Empty: the installed ones.
  std::string subjects;  ///< Subjects' own models, CODE.fmodel; empty: without.
};

/// Gives the applied inputs of footing-sim's ticks to a new pose engine at their steps, and
/// compares whole frames: everything but the CPU time, the overruns and the texts for people. Mode,
/// lag and subjects are those of the recording; the models come from `folders`. InvalidData when
/// the recording does not begin with the engine's first step.
Result<EngineReplay> ReplayPose(const std::vector<v1::Tick>& ticks, const ModelFolders& folders);

/// The ticks of one server out of a recording, in their order, without snapshots.
struct Recorded {
  std::vector<v1::Tick> sensor;      ///< From footingd: status, raw and features.
  std::vector<v1::Tick> simulation;  ///< From footing-sim: characters, inputs, tracks and tables.
};

/// Reads the topics that a replay needs. Of a tick that is there twice (the recorder reconnected)
/// the first is taken.
Result<Recorded> ReadRecorded(const std::string& path);

/// Writes a copy of a recording of the pose engine, in which the engine has run again with this
/// lag: the pose of a frame is that of `lag_s` before it and uses all that was measured until then,
/// as with footing-sim --lag-ms. Returns the number of its frames. InvalidData as of ReplayPose.
Result<std::uint64_t> SmoothPose(const std::string& path, const std::string& out, double lag_s,
                                 const ModelFolders& folders, bool replace);

/// `footing-eval smooth FILE.mcap --out FILE.mcap`.
void AddSmoothCommand(CLI::App& app, Shared& shared);

/// `footing-eval replay FILE.mcap`: runs a recording's raw reports and engine inputs again, at
/// their stamps, and compares the features and the biped's state hashes with the recorded ones bit
/// for bit. Exit code 1 when something differs, 4 when the recording holds nothing to run again.
void AddReplayCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
