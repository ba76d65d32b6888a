#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/base/result.h"
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

  /// Takes of another config what needs no restart, and logs what changed and what does.
  void Reload(const Config& wanted);
  /// What a thread of a device is stuck in; empty: nothing.
  std::string Stuck() const;

  /// Where it listens for clients.
  std::vector<std::string> listening_on() const;

 private:
  class Implementation;
  explicit Service(std::shared_ptr<Implementation> implementation);
  std::shared_ptr<Implementation> implementation_;
};

}  // namespace footing::sensor
