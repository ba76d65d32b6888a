#include "daemon/offline/train/own_recordings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "common/runtime/log.h"
#include "common/base/units.h"
#include "daemon/offline/learning/alignment.h"
#include "daemon/offline/train/recording_reader.h"

namespace footing::train {
namespace {

constexpr int kMostWeight = 100;

Result<void> CheckPairs(const OwnOptions& options) {
  const std::size_t pairs = options.recordings.size();
  if (options.motions.size() != pairs) {
    return UsageError("--recording is given " + std::to_string(pairs) + " times and --motion " +
                      std::to_string(options.motions.size()) +
                      " times; each recording goes with the motion captured beside it");
  }
  if (options.skeletons.size() > 1 && options.skeletons.size() != pairs) {
    return UsageError("--skeleton is given " + std::to_string(options.skeletons.size()) +
                      " times; give none, one for all motions, or one for each");
  }
  return {};
}

void PrintAlignment(const OwnRecording& own) {
  const learning::TimeAlignment& at = own.take.alignment;
  char text[320];
  std::snprintf(text, sizeof text,
                "%s beside %s: offset %.4f s, drift %.1f ppm, residual %.2f ms of %d pieces, %d "
                "stomps in both "
                "(recording %d, motion %d), correlation %.3f over %.1f s; %.1f kg; feet within "
                "%.1f cm",
                own.file.name.c_str(), own.clip.name.c_str(), at.offset_s, 1e6 * at.drift,
                1e3 * at.residual_s, at.pieces, at.stomps_both, at.stomps_recording,
                at.stomps_motion, at.correlation, at.overlap_s, own.take.t_pose.mass_kg,
                100 * own.take.placement.rms_m);
  log::Info(text);
}

/// The engine runs the standard person's layout; another is fitted to it, unless the others'
/// motions are of the same. Returns the residual, m.
Result<double> MakeStandard(const std::vector<Clip>& others, Clip& clip) {
  if (!others.empty() &&
      body::DofNames(others.front().motion.skeleton) == body::DofNames(clip.motion.skeleton)) {
    return 0.0;
  }
  return FitToStandardLayout(clip);
}

Result<OwnRecording> ReadPair(const OwnOptions& options, std::size_t i,
                              const std::vector<Clip>& others) {
  log::Info("reading " + options.recordings[i] + " and " + options.motions[i]);
  auto recording = ReadRecording(options.recordings[i], options.rig);
  if (!recording) return recording.error();
  if (!recording->has_layout) {
    log::Warning(recording->session.name +
                 ": has no layout; the boards are taken to lie one foot each, 2 cm apart");
  }
  const std::string skeleton = options.skeletons.empty()       ? ""
                               : options.skeletons.size() == 1 ? options.skeletons[0]
                                                               : options.skeletons[i];
  auto clip = ReadClip(options.motions[i], skeleton);
  if (!clip) return clip.error();
  const auto skeleton_rms_m = MakeStandard(others, *clip);
  if (!skeleton_rms_m) return skeleton_rms_m.error();
  auto take = learning::MakeOwnTake(std::move(recording->session), clip->motion, clip->body,
                                    options.motions[i]);
  if (!take) return take.error();
  OwnRecording own{*std::move(clip), *skeleton_rms_m, *std::move(take), recording->file};
  PrintAlignment(own);
  return own;
}

double Seconds(const std::vector<Clip>& clips) {
  double seconds = 0;
  for (const Clip& clip : clips) seconds += clip.motion.duration_s();
  return seconds;
}

double OwnSeconds(const std::vector<OwnRecording>& own) {
  double seconds = 0;
  for (const OwnRecording& one : own) seconds += one.take.alignment.overlap_s;
  return seconds;
}

/// The number of times that makes own seconds nearest to that share of all.
int Weight(double others_s, double own_s, double share) {
  if (others_s <= 0 || own_s <= 0) return 1;
  const double times = share / (1 - share) * others_s / own_s;
  return static_cast<int>(std::clamp<double>(std::round(times), 1, kMostWeight));
}

/// A motion of the own ones is not others' too.
void WithoutOwn(const std::vector<OwnRecording>& own, std::vector<Clip>& clips) {
  std::erase_if(clips, [&own](const Clip& clip) {
    return std::any_of(own.begin(), own.end(), [&clip](const OwnRecording& one) {
      return one.clip.file.sha256 == clip.file.sha256;
    });
  });
}

}  // namespace

void AddOwnOptions(CLI::App& command, OwnOptions& options) {
  command
      .add_option(
          "--recording", options.recordings,
          "Recording of your boards, MCAP, made together with the next --motion; may be repeated")
      ->allow_extra_args(false);
  command
      .add_option(
          "--motion", options.motions,
          "Motion captured together with --recording: BVH, AMC, TRC or C3D; may be repeated")
      ->allow_extra_args(false);
  command
      .add_option("--skeleton", options.skeletons,
                  "Skeleton of the AMC motions, ASF file: one for all, or one for each")
      ->allow_extra_args(false);
  command.add_option("--rig", options.rig, "Rig of the boards, when a recording has several");
  command
      .add_option("--own-share", options.share,
                  "Share of your recordings in the training data, reached by repetition, 0 to 0.95")
      ->check(CLI::Range(0.0, 0.95));
}

std::vector<Clip> TrainingSet::AllClips() const {
  std::vector<Clip> all = clips.train;
  for (int i = 0; i < weight; ++i) {
    for (const OwnRecording& one : own) all.push_back(one.clip);
  }
  return all;
}

std::vector<model::DataFile> TrainingSet::DataFiles() const {
  std::vector<model::DataFile> files = train::DataFiles(clips.train);
  for (const OwnRecording& one : own) {
    files.push_back(one.clip.file);
    files.push_back(one.file);
  }
  return files;
}

Result<TrainingSet> ReadTrainingSet(const MotionOptions& motions, const OwnOptions& own,
                                    double enough_s, const std::string& enough_for) {
  if (motions.folders.empty() && own.recordings.empty() && own.motions.empty()) {
    return UsageError(
        "nothing to train on: give --motions DIR, or --recording FILE.mcap with --motion FILE, or "
        "both");
  }
  if (auto pairs = CheckPairs(own); !pairs) return pairs.error();
  TrainingSet set;
  auto clips = ReadClips(motions);
  if (!clips) return clips.error();
  set.clips = *std::move(clips);
  for (std::size_t i = 0; i < own.recordings.size(); ++i) {
    auto one = ReadPair(own, i, set.clips.train);
    if (!one) return one.error();
    set.own.push_back(*std::move(one));
  }
  if (set.own.empty()) return set;
  WithoutOwn(set.own, set.clips.train);
  WithoutOwn(set.own, set.clips.excluded);
  std::set<std::string> subjects(set.clips.subjects.begin(), set.clips.subjects.end());
  for (const OwnRecording& one : set.own) subjects.insert(one.clip.subject);
  set.clips.subjects = {subjects.begin(), subjects.end()};
  const double own_s = OwnSeconds(set.own);
  set.weight = Weight(Seconds(set.clips.train), own_s, own.share);
  if (own_s < enough_s) {
    char text[160];
    std::snprintf(text, sizeof text, "your recordings last %.0f s; the paper took %.0f s ", own_s,
                  enough_s);
    log::Warning(text + enough_for);
  }
  return set;
}

void AppendOwn(const TrainingSet& set, nlohmann::ordered_json& report) {
  if (set.own.empty()) return;
  auto takes = nlohmann::ordered_json::array();
  for (const OwnRecording& one : set.own) {
    const learning::TimeAlignment& at = one.take.alignment;
    const bool hands = !one.take.session.hands[0].empty() && !one.take.session.hands[1].empty();
    takes.push_back({{"recording", one.file.name},
                     {"motion", one.clip.name},
                     {"offset_s", at.offset_s},
                     {"drift_ppm", 1e6 * at.drift},
                     {"residual_ms", 1e3 * at.residual_s},
                     {"pieces", at.pieces},
                     {"correlation", at.correlation},
                     {"overlap_s", at.overlap_s},
                     {"stomps_both", at.stomps_both},
                     {"stomps_recording", at.stomps_recording},
                     {"stomps_motion", at.stomps_motion},
                     {"mass_kg", one.take.t_pose.mass_kg},
                     {"floor_yaw_deg", RadiansToDegrees(one.take.placement.yaw_rad)},
                     {"floor_rms_cm", 100 * one.take.placement.rms_m},
                     {"skeleton_rms_mm", 1e3 * one.skeleton_rms_m},
                     {"hands", hands ? "recorded" : "made"}});
  }
  report["own"] = {{"seconds", OwnSeconds(set.own)}, {"weight", set.weight}, {"takes", takes}};
}

}  // namespace footing::train
