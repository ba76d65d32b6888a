#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "common/base/result.h"
#include "common/net/limits.h"
#include "common/net/server.h"
#include "daemon/sensor/service/config.h"

namespace footing::sensor {

/// footingd without its command line: device sources, the hub, and the server that publishes a tick
/// every 10 ms. Everything but the readers of real devices runs on the io_context's one thread.
class Service {
 public:
  /// Opens everything; an error is one line (an address in use, a wrong source).
  static Result<std::unique_ptr<Service>> Start(boost::asio::io_context& io, const Config& config,
                                                const std::string& version);
  ~Service();

  /// Motors off, no device any more; each client gets what waits for it, and goodbye. `done` is
  /// called when the last one has ended.
  void Stop(const std::string& reason, std::function<void()> done);

  /// Takes of another config what needs no restart, and logs what changed and what does. An error
  /// changes nothing.
  Result<void> Reload(const Config& wanted);
  /// Name of the thread that is stuck in a call to the kernel; empty: none.
  std::string Stuck() const;

  /// Where it listens for clients.
  std::vector<std::string> listening_on() const;

 private:
  class Implementation;
  explicit Service(std::shared_ptr<Implementation> implementation);
  std::shared_ptr<Implementation> implementation_;
};

/// A line for the log, the serial of the device that it is about, if any, and how much it matters.
struct LogLine {
  std::string text;
  std::string device = {};
  bool warning = false;
};

void Log(const LogLine& line);
void LogOverload(const transport::OverloadLine& line);

/// Lines for the log that others cause, limited to 20 at once and 2 a second: a device that comes
/// and goes in a loop fills neither the disk nor the loop's time. The first line after some were
/// left out says how many.
class LimitedLog {
 public:
  explicit LimitedLog(std::function<void(const LogLine&)> say) : say_(std::move(say)) {}

  void Say(LogLine line, std::int64_t now_ns) {
    if (!bucket_.Spend(now_ns)) {
      ++left_out_;
      return;
    }
    const auto before = std::exchange(left_out_, 0);
    if (before != 0) line.text += " (" + std::to_string(before) + " lines before were left out)";
    say_(line);
  }

 private:
  std::function<void(const LogLine&)> say_;
  transport::TokenBucket bucket_{2, 20};
  std::uint64_t left_out_ = 0;
};

}  // namespace footing::sensor
