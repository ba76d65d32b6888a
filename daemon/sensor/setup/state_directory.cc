#include "daemon/sensor/setup/state_directory.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <utility>

#include <zlib.h>
#include <boost/asio/post.hpp>
#include <nlohmann/json.hpp>

#include "common/runtime/clock.h"
#include "common/runtime/files.h"

namespace footing::setup {

DiskWriter::DiskWriter(boost::asio::io_context& io, Write write,
                       std::function<void(const std::string& problem)> on_result)
    : io_(io),
      write_(std::move(write)),
      on_result_(std::move(on_result)),
      disk_(1),
      work_(disk_.get_executor()),
      thread_([this] { disk_.run(); }) {}

DiskWriter::~DiskWriter() {
  if (writing_) waiting_.pop_front();
  for (Text& text : waiting_) {
    boost::asio::post(disk_, [this, text = std::move(text)] { write_(text.name, text.content); });
  }
  work_.reset();
  thread_.join();
}

void DiskWriter::Save(const std::string& name, const std::string& content) {
  ++last_save_;
  const auto first = waiting_.begin() + (writing_ ? 1 : 0);
  const auto same =
      std::find_if(first, waiting_.end(), [&](const Text& text) { return text.name == name; });
  if (same != waiting_.end()) {
    same->content = content;
    return;
  }
  waiting_.push_back({name, content, last_save_});
  if (!writing_) WriteNext();
}

std::optional<std::string> DiskWriter::Waiting(const std::string& name) const {
  const auto found = std::find_if(waiting_.rbegin(), waiting_.rend(),
                                  [&](const Text& text) { return text.name == name; });
  return found == waiting_.rend() ? std::nullopt : std::optional(found->content);
}

void DiskWriter::OnWritten(std::function<void(const std::string& problem)> done) {
  waiters_.push_back({last_save_, "", std::move(done)});
  if (waiting_.empty()) {
    boost::asio::post(io_, [this, alive = std::weak_ptr(alive_)] {
      if (!alive.expired()) CallDone();
    });
  }
}

void DiskWriter::WriteNext() {
  writing_ = true;
  auto write = [this, text = waiting_.front(), alive = std::weak_ptr(alive_)] {
    std::string problem = write_(text.name, text.content);
    boost::asio::post(io_, [this, alive, problem = std::move(problem)] {
      if (!alive.expired()) OnResult(problem);
    });
  };
  // On simulated time nothing goes on beside the threads that have their turns.
  if (clock::OwnFollower() != nullptr) return write();
  boost::asio::post(disk_, std::move(write));
}

void DiskWriter::OnResult(const std::string& problem) {
  waiting_.pop_front();
  writing_ = false;
  if (!waiting_.empty()) WriteNext();
  on_result_(problem);
  for (Waiter& waiter : waiters_) {
    if (!problem.empty()) waiter.problem = problem;
  }
  CallDone();
}

void DiskWriter::CallDone() {
  std::uint64_t oldest = last_save_ + 1;
  for (const Text& text : waiting_) oldest = std::min(oldest, text.first_save);
  while (!waiters_.empty() && waiters_.front().save < oldest) {
    const Waiter waiter = std::move(waiters_.front());
    waiters_.pop_front();
    waiter.done(waiter.problem);
  }
}

namespace {

constexpr int kVersion = 1;
constexpr std::size_t kMostBytes = 1u << 20;
constexpr std::size_t kMostNameBytes = 150;
constexpr std::ptrdiff_t kMostFiles = 300;

std::uint32_t Checksum(const std::string& content) {
  return static_cast<std::uint32_t>(crc32(crc32(0, nullptr, 0),
                                          reinterpret_cast<const Bytef*>(content.data()),
                                          static_cast<uInt>(content.size())));
}

std::string Variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

Storage StorageIn(StateDirectory& directory) {
  return {[&directory](const std::string& name) { return directory.Load(name); },
          [&directory](const std::string& name, const std::string& content) {
            directory.Save(name, content);
          },
          [&directory](const std::string& name, const std::string& why) {
            directory.Refuse(name, why);
          }};
}

Storage StorageIn(StateDirectory& directory, DiskWriter& disk) {
  Storage storage = StorageIn(directory);
  storage.load = [&directory, &disk](const std::string& name) {
    const auto waiting = disk.Waiting(name);
    return waiting ? waiting : directory.Load(name);
  };
  storage.save = [&disk](const std::string& name, const std::string& content) {
    disk.Save(name, content);
  };
  return storage;
}

std::string StatePath(const std::string& configured) {
  if (!configured.empty()) return configured;
  const std::string systemd = Variable("STATE_DIRECTORY");
  if (!systemd.empty()) return systemd.substr(0, systemd.find(':'));  // The first of several.
  const std::string xdg = Variable("XDG_STATE_HOME");
  if (!xdg.empty()) return xdg + "/footing";
  const std::string home = Variable("HOME");
  return home.empty() ? "" : home + "/.local/state/footing";
}

/// A serial may be the part of a name behind its first '-': its ':' become '-', and whatever is
/// neither that nor a letter or digit becomes its code. So two serials never share a file.
std::string StateDirectory::FileOf(const std::string& name) const {
  std::string file;
  bool in_prefix = true;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    const bool first_dash = in_prefix && c == '-';
    in_prefix = in_prefix && c != '-';
    if (plain || first_dash) {
      file += c;
    } else if (c == ':') {
      file += '-';
    } else {
      constexpr char kDigits[] = "0123456789abcdef";
      const auto code = static_cast<unsigned char>(c);
      file += {'_', kDigits[code >> 4], kDigits[code & 15]};
    }
  }
  if (file.size() > kMostNameBytes) {  // The whole name stands in the file, and is compared.
    file = file.substr(0, kMostNameBytes) + "_" + std::to_string(Checksum(name));
  }
  return path_ + "/" + file + ".json";
}

/// Whether one more file may be made: each new serial of a device makes one.
bool StateDirectory::HasPlaceFor(const std::string& path) const {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored)) return true;
  const std::filesystem::directory_iterator files(path_, ignored);
  return std::distance(begin(files), end(files)) < kMostFiles;
}

std::optional<std::string> StateDirectory::Load(const std::string& name) {
  const std::string path = FileOf(name);
  std::error_code ignored;
  if (path_.empty() || !std::filesystem::exists(path, ignored)) return std::nullopt;
  const auto text = config::ReadTextFile(path, kMostBytes);
  if (!text) {
    say_("saved " + name + " is not used: " + text.error().message);
    return std::nullopt;
  }
  const auto file = nlohmann::json::parse(*text, nullptr, false);
  std::string why;
  if (!file.is_object() || !file.contains("version") || !file.contains("name") ||
      !file.contains("content") || !file.contains("crc32")) {
    why = "truncated or no state of footingd";
  } else if (file["version"] != kVersion) {
    why = "unknown version " + file["version"].dump();
  } else if (file["name"] != name) {
    why = "it is of " + file["name"].dump();
  } else if (file["crc32"] != Checksum(file["content"].dump())) {
    why = "its checksum is wrong";
  }
  if (why.empty()) return file["content"].dump();
  Refuse(name, why);
  return std::nullopt;
}

void StateDirectory::Refuse(const std::string& name, const std::string& why) {
  const std::string path = FileOf(name);
  std::error_code error;
  std::filesystem::rename(path, path + ".damaged", error);
  say_("saved " + name + " is not used: " + path + ": " + why +
       (error ? "; it cannot be moved aside" : "; moved aside to " + path + ".damaged") +
       "; redo that part of the set-up");
}

std::string StateDirectory::Write(const std::string& name, const std::string& content) const {
  if (path_.empty()) return "no directory is known; set state_directory";
  std::error_code error;
  std::filesystem::create_directories(path_, error);
  if (error) return error.message();
  if (!HasPlaceFor(FileOf(name))) {
    return "it has " + std::to_string(kMostFiles) +
           " files already; remove calibrations of old devices";
  }
  const auto json = nlohmann::json::parse(content, nullptr, false);
  const nlohmann::json file = {
      {"version", kVersion}, {"name", name}, {"crc32", Checksum(json.dump())}, {"content", json}};
  const auto written = config::ReplaceFile(FileOf(name), file.dump(2) + "\n");
  return written ? "" : written.error().message;
}

void StateDirectory::SayWritten(const std::string& problem) {
  if (problem.empty()) {
    unwritable_said_ = false;
    return;
  }
  if (unwritable_said_) return;
  unwritable_said_ = true;
  say_("cannot save to " + (path_.empty() ? std::string("disk") : path_) + ": " + problem +
       "; the set-up lasts until footingd ends");
}

}  // namespace footing::setup
