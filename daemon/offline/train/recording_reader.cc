#include "daemon/offline/train/recording_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "common/board/geometry.h"
#include "common/board/layout.h"
#include "common/runtime/log.h"
#include "common/recording/walk.h"
#include "common/recording/mapped_file.h"
#include "common/stream/setup.h"
#include "common/base/units.h"
#include "common/wire/wire.h"

namespace footing::train {
namespace {

constexpr double kLeastHandSdM = 0.002;  // As live: no tracker is believed more.
constexpr double kMostHandSdM = 1;
constexpr double kLongestS = 2 * 3600;

template <typename Value>
struct Stamped {
  std::int64_t sampled_ns = 0;
  Value value;
};

/// What one rig's devices sent.
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

/// 0 left, 1 right; nothing for another role.
std::optional<std::size_t> SideOf(v1::DeviceRole role, v1::DeviceRole left, v1::DeviceRole right) {
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
    for (auto& [name, rig] : rigs) rig.layout = layouts_[name];
    return end;
  }

  /// By the server's name and their own.
  std::map<std::pair<std::string, std::string>, Rig> rigs;
  bool boards_channel = false;

 private:
  struct Bound {
    std::string rig;
    std::size_t side = 0;
  };

  void Take(const mcap::Message& message) {
    const auto& [server, channel] = topics_[message.channel_id];
    if (channel == "status") {
      TakeAll<v1::DeviceStatusList>(message, [&](const auto& list) {
        for (const v1::DeviceStatus& status : list.devices()) TakeStatus(server, status);
      });
    } else if (channel == "setup") {
      TakeAll<v1::SetupState>(message, [&](const auto& setup) {
        for (const v1::RigSetup& rig : setup.rigs()) {
          if (!rig.has_layout()) continue;
          layouts_[{server, rig.rig()}] = wire::FromProto(rig).layout;
        }
      });
    } else if (channel == "boards") {
      boards_channel = true;
      TakeAll<v1::BoardSamples>(message, [&](const auto& samples) {
        for (const v1::BoardSample& sample : samples.samples()) TakeBoard(server, sample);
      });
    } else if (channel == "hands") {
      TakeAll<v1::HandSamples>(message, [&](const auto& samples) {
        for (const v1::HandSample& sample : samples.samples()) TakeHand(server, sample);
      });
    }
  }

  template <typename Message, typename Use>
  void TakeAll(const mcap::Message& message, const Use& use) {
    Message parsed;
    if (parsed.ParseFromArray(message.data.data(), static_cast<int>(message.data.size()))) {
      use(parsed);
    }
  }

  void TakeStatus(const std::string& server, const v1::DeviceStatus& status) {
    const auto side =
        SideOf(status.role(), v1::DEVICE_ROLE_LEFT_BOARD, v1::DEVICE_ROLE_RIGHT_BOARD);
    if (side) {
      bound_[{server, status.device()}] = {status.rig(), *side};
    } else {
      bound_.erase({server, status.device()});
    }
  }

  void TakeBoard(const std::string& server, const v1::BoardSample& sample) {
    const auto bound = bound_.find({server, sample.device()});
    if (bound == bound_.end()) return;
    const std::array<double, 4> corners_n{sample.top_left_n(), sample.top_right_n(),
                                          sample.bottom_left_n(), sample.bottom_right_n()};
    for (const double corner_n : corners_n) {
      if (!std::isfinite(corner_n)) return;
    }
    Rig& rig = rigs[{server, bound->second.rig}];
    rig.uncalibrated = rig.uncalibrated || sample.uncalibrated();
    Append(sample.sampled_ns(), corners_n, rig.boards[bound->second.side]);
  }

  void TakeHand(const std::string& server, const v1::HandSample& sample) {
    const auto side = SideOf(sample.role(), v1::DEVICE_ROLE_LEFT_HAND, v1::DEVICE_ROLE_RIGHT_HAND);
    const Eigen::Vector3d p_m = wire::FromProto(sample.position_m());
    const Eigen::Vector3d sd_m = wire::FromProto(sample.sd_m());
    if (!side || !(sample.confidence() > 0) || !p_m.allFinite() || !sd_m.allFinite()) return;
    learning::HandReading reading;
    reading.p_W_m = p_m;
    reading.sd_m = sd_m.cwiseMax(kLeastHandSdM).cwiseMin(kMostHandSdM);
    Append(sample.sampled_ns(), reading, rigs[{server, sample.rig()}].hands[*side]);
  }

  std::map<std::uint16_t, std::pair<std::string, std::string>> topics_;
  std::map<std::pair<std::string, std::string>, stream::BoardLayout> layouts_;
  std::map<std::pair<std::string, std::uint32_t>, Bound> bound_;
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
