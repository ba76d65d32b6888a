#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include "common/base/result.h"
#include "common/model/model.h"
#include "daemon/offline/learning/own_take.h"
#include "daemon/offline/learning/time_alignment.h"
#include "daemon/offline/train/motions.h"

namespace footing::train {

/// Recordings of one's own boards beside motion capture.
struct OwnOptions {
  std::vector<std::string> recordings;  ///< footing-log's, one a motion.
  std::vector<std::string> motions;
  std::vector<std::string> skeletons;  ///< Skeletons of AMC: none, one for all, or one a motion.
  std::string rig;
  double share = 0.7;  ///< Share of all seconds; chosen on CMU 13_30 (docs/evaluation/models.md).
};

void AddOwnOptions(CLI::App& command, OwnOptions& options);

/// One pair, aligned.
struct OwnRecording {
  Clip clip;                  ///< The motion, for its poses.
  double skeleton_rms_m = 0;  ///< Residual of its fit to the standard layout; 0: it has it.
  learning::OwnTake take;
  model::DataFile file;  ///< The recording.
};

/// All that is trained on: `clips` of others and `own`, which counts `weight` times.
struct TrainingSet {
  Clips clips;  ///< Without the motions that are in `own`; its subjects with theirs.
  std::vector<OwnRecording> own;
  int weight = 1;

  /// For poses: the clips, then the own ones `weight` times.
  std::vector<Clip> AllClips() const;
  std::vector<model::DataFile> DataFiles() const;
};

/// Reads and aligns everything, reporting progress on standard error. An own motion whose skeleton
/// has neither the standard person's layout nor the others' is fitted to the former. The own
/// recordings count the whole number of times that comes nearest to `share` of all seconds. Fewer
/// of them than `enough_s` are a warning that says so: the paper took so many `enough_for`.
Result<TrainingSet> ReadTrainingSet(const MotionOptions& motions, const OwnOptions& own,
                                    double enough_s, const std::string& enough_for);

/// {"own": {...}} into the report of a command; nothing where there is none of it.
void AppendOwn(const TrainingSet& set, nlohmann::ordered_json& report);

/// A session read from a recording.
struct Recording {
  learning::RecordedSession session;
  model::DataFile file;
  bool has_layout = false;  ///< Else the boards are taken to lie as board::DefaultLayout.
};

/// The boards and hands of one rig in a recording of footingd, on the devices' own clock. `rig`
/// empty: the only one with two boards. InvalidData: no such boards, two people's, a board without
/// its calibration. A recording that was cut is read as far as it goes.
Result<Recording> ReadRecording(const std::string& path, const std::string& rig);

}  // namespace footing::train
