#include "clients/log/smoothed.h"

#include <filesystem>
#include <map>

#include "common/recording/mcap_reader.h"
#include "common/recording/recording_writer.h"
#include "footing/v1/character.pb.h"

namespace footing::log_client {
namespace {

/// Whether the recording's first character is a body whose poses have no lag.
bool HasLivePoses(const std::string& recording) {
  const auto file = recording::MappedFile::Open(recording);
  if (!file) return false;
  std::map<std::uint16_t, bool> shows_characters;
  bool found = false, live = false;
  mcap::Visitor visitor;
  visitor.channel = [&](const mcap::Channel& channel) {
    shows_characters[channel.id] = channel.topic.ends_with("/characters");
  };
  visitor.message = [&](const mcap::Message& message) {
    if (found || !shows_characters[message.channel_id]) return;
    v1::CharacterFrame frame;
    const auto size = static_cast<int>(message.data.size());
    if (!frame.ParseFromArray(message.data.data(), size) || frame.characters_size() == 0) return;
    found = true;
    live = frame.characters(0).has_body() && frame.characters(0).body().lag_s() == 0;
  };
  mcap::Walk(file->bytes(), visitor, mcap::WalkMode::kStrict);
  return live;
}

}  // namespace

SmoothedCopy::SmoothedCopy(const std::string& recording, int lag_ms, const std::string& folder)
    : path_(recording) {
  if (lag_ms == 0 || !HasLivePoses(recording)) return;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  folder_.emplace(folder);
  const std::string copy = folder_->path() + "/smooth.mcap", log = folder_->path() + "/smooth.log";
  auto smoother = process::Child::Start(
      {.program = "footing-eval",
       .words = {"smooth", recording, "--out", copy, "--lag-ms", std::to_string(lag_ms)},
       .environment = {},
       .log = log});
  if (!smoother) {
    why_live_ = smoother.error().message;
    return;
  }
  if (smoother->Wait() != 0) {
    why_live_ = process::LastLine(log);
    return;
  }
  path_ = copy;
}

}  // namespace footing::log_client
