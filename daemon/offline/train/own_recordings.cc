#include "daemon/offline/train/own_recordings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/board/geometry.h"
#include "common/board/layout.h"
#include "common/recording/mcap_reader.h"
#include "common/recording/recorded_session.h"
#include "common/recording/recording_writer.h"
#include "common/rig/follower.h"
#include "common/runtime/log.h"
#include "common/stream/setup.h"
#include "common/wire/wire.h"
#include "daemon/offline/learning/time_alignment.h"

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

namespace {

using stream::DeviceRole;

constexpr double kLeastHandSdM = 0.002;  // As live: no tracker is believed more.
constexpr double kMostHandSdM = 1;
constexpr double kLongestS = 2 * 3600;

template <typename Value>
struct Stamped {
  std::int64_t sampled_ns = 0;
  Value value;
};

/// Messages of one rig's devices.
struct Rig {
  std::array<std::vector<Stamped<std::array<double, 4>>>, 2> boards;
  std::array<std::vector<Stamped<learning::HandReading>>, 2> hands;
  stream::BoardLayout layout;
  bool uncalibrated = false;

  bool complete() const { return !boards[0].empty() && !boards[1].empty(); }
};

/// The part of a topic behind its last '/', and what is before it: the server's name.
std::pair<std::string, std::string> SplitTopic(const std::string& topic) {
  const auto slash = topic.rfind('/');
  if (slash == std::string::npos) return {"", topic};
  return {topic.substr(0, slash), topic.substr(slash + 1)};
}

/// The channels that are read, and their fields in a tick.
const std::map<std::string, std::uint32_t> kChannels{{"status", v1::Tick::kStatusFieldNumber},
                                                     {"setup", v1::Tick::kSetupFieldNumber},
                                                     {"boards", v1::Tick::kBoardsFieldNumber},
                                                     {"hands", v1::Tick::kHandsFieldNumber}};

/// 0 left, 1 right; nothing for another role.
std::optional<std::size_t> SideOf(DeviceRole role, DeviceRole left, DeviceRole right) {
  if (role == left) return 0;
  if (role == right) return 1;
  return std::nullopt;
}

/// Appends what is later than the last.
template <typename Value>
void Append(std::int64_t sampled_ns, const Value& value, std::vector<Stamped<Value>>& to) {
  if (to.empty() || sampled_ns > to.back().sampled_ns) to.push_back({sampled_ns, value});
}

class Reader {
 public:
  mcap::WalkEnd Run(std::string_view bytes) {
    mcap::Visitor visitor;
    visitor.channel = [this](const mcap::Channel& channel) {
      topics_[channel.id] = SplitTopic(channel.topic);
    };
    visitor.message = [this](const mcap::Message& message) { Take(message); };
    const mcap::WalkEnd end = mcap::Walk(bytes, visitor, mcap::WalkMode::kSalvage);
    for (auto& [name, rig] : rigs) {
      for (const stream::RigSetup& setup : sensors_[name.first].setup()) {
        if (setup.rig == name.second) rig.layout = setup.layout;
      }
    }
    return end;
  }

  /// By the server's name and their own.
  std::map<std::pair<std::string, std::string>, Rig> rigs;
  bool boards_channel = false;

 private:
  void Take(const mcap::Message& message) {
    const auto& [server, channel] = topics_[message.channel_id];
    const auto field = kChannels.find(channel);
    if (field == kChannels.end()) return;
    boards_channel = boards_channel || channel == "boards";
    const auto parsed = recording::ReadTick({.channels = {{field->second, message.data}}});
    if (!parsed) return;
    const rig::Tick tick = wire::SensorTick(*parsed);
    sensors_[server].Take(tick);
    for (const stream::BoardSample& sample : tick.boards) TakeBoard(server, sample);
    for (const stream::HandSample& sample : tick.hands) TakeHand(server, sample);
  }

  void TakeBoard(const std::string& server, const stream::BoardSample& sample) {
    const stream::DeviceStatus* device = sensors_[server].Find(sample.device);
    if (device == nullptr) return;
    const auto side = SideOf(device->role, DeviceRole::kLeftBoard, DeviceRole::kRightBoard);
    if (!side) return;
    Rig& rig = rigs[{server, device->rig}];
    rig.uncalibrated = rig.uncalibrated || sample.uncalibrated;
    const std::array<double, 4> corners_n{sample.top_left_n, sample.top_right_n,
                                          sample.bottom_left_n, sample.bottom_right_n};
    Append(sample.sampled_ns, corners_n, rig.boards[*side]);
  }

  void TakeHand(const std::string& server, const stream::HandSample& sample) {
    const auto side = SideOf(sample.role, DeviceRole::kLeftHand, DeviceRole::kRightHand);
    if (!side || !(sample.confidence > 0)) return;
    learning::HandReading reading;
    reading.p_W_m = sample.position_m;
    reading.sd_m = sample.sd_m.cwiseMax(kLeastHandSdM).cwiseMin(kMostHandSdM);
    Append(sample.sampled_ns, reading, rigs[{server, sample.rig}].hands[*side]);
  }

  std::map<std::uint16_t, std::pair<std::string, std::string>> topics_;
  std::map<std::string, rig::Follower> sensors_;  ///< By the server's name.
};

learning::RecordedSession ToSession(const Rig& rig, const std::string& name) {
  learning::RecordedSession session;
  session.name = name;
  const std::int64_t start_ns =
      std::min(rig.boards[0].front().sampled_ns, rig.boards[1].front().sampled_ns);
  const auto seconds = [start_ns](std::int64_t ns) { return NanosecondsToSeconds(ns - start_ns); };
  const stream::BoardLayout layout = board::LayoutOr(rig.layout);
  session.cells_W_m = {board::SensorPlaces(layout.left, board::GeometryOr(layout.left_geometry)),
                       board::SensorPlaces(layout.right, board::GeometryOr(layout.right_geometry))};
  for (std::size_t side = 0; side < 2; ++side) {
    for (const auto& sample : rig.boards[side]) {
      session.boards[side].push_back({seconds(sample.sampled_ns), sample.value});
    }
    for (const auto& sample : rig.hands[side]) {
      learning::HandReading reading = sample.value;
      reading.time_s = seconds(sample.sampled_ns);
      if (reading.time_s >= 0) session.hands[side].push_back(reading);
    }
    session.duration_s = std::max(session.duration_s, session.boards[side].back().time_s);
  }
  return session;
}

/// The rig that was asked for, or the only one with two boards.
Result<const Rig*> Choose(const Reader& reader, const std::string& path,
                          const std::string& wanted) {
  const Rig* chosen = nullptr;
  std::string names;
  int complete = 0;
  for (const auto& [key, rig] : reader.rigs) {
    if (!rig.complete()) continue;
    names += (names.empty() ? "" : ", ") + key.second;
    if (!wanted.empty() && key.second != wanted) continue;
    ++complete;
    chosen = &rig;
  }
  if (complete == 1) return chosen;
  if (complete > 1) {
    return InvalidData(path + ": boards of " + std::to_string(complete) + " people (rigs " + names +
                       "); say whose with --rig NAME");
  }
  if (!names.empty()) {
    return InvalidData(path + ": no rig " + wanted + " with two boards; there are " + names);
  }
  return InvalidData(
      path +
      (reader.boards_channel ? ": no left and right board of one rig in it"
                             : ": no boards channel in it") +
      "; record footingd's with both boards assigned: footing-log record --connect ADDRESS --out "
      "FILE.mcap");
}

}  // namespace

Result<Recording> ReadRecording(const std::string& path, const std::string& rig) {
  const auto file = recording::MappedFile::Open(path);
  if (!file) return file.error();
  const std::string_view magic = file->bytes().substr(0, mcap::kMagic.size());
  if (magic != mcap::kMagic) {
    return InvalidData(path + " is not a recording: it does not begin as an MCAP file does");
  }
  Reader reader;
  const mcap::WalkEnd end = reader.Run(file->bytes());
  if (!end.complete) log::Warning(path + " is read as far as it goes: " + end.problem);
  const auto chosen = Choose(reader, path, rig);
  if (!chosen) return chosen.error();
  if ((*chosen)->uncalibrated) {
    return InvalidData(path +
                       ": a board sent forces without its calibration, which cannot be used; pair "
                       "it again (footing-ctl doctor) and record again");
  }
  Recording recording;
  recording.session = ToSession(**chosen, path);
  if (recording.session.duration_s > kLongestS) {
    return InvalidData(path + ": its boards' samples span " +
                       std::to_string(std::lround(recording.session.duration_s / 60)) +
                       " minutes, more than two hours; record what is beside the motion capture");
  }
  recording.has_layout = !(*chosen)->layout.preset.empty();
  recording.file = {.name = std::filesystem::path(path).filename().string(),
                    .sha256 = model::Sha256(file->bytes())};
  return recording;
}

}  // namespace footing::train
