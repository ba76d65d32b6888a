#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>

#include "common/result/result.h"
#include "daemon/simulation/serving/config.h"

namespace footing::footing_sim {

/// footing-sim: subscribes to footingd, runs the configured engine on its thread, publishes frames.
class Service {
 public:
  /// Reads the engine's files, builds it, opens the listeners and starts.
  static Result<std::unique_ptr<Service>> Start(boost::asio::io_context& io,
                                                const serving::Config& config,
                                                const std::string& version);
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// Says goodbye to every client and stops the simulation thread.
  void Stop(const std::string& reason);

 private:
  explicit Service(std::function<void(const std::string&)> stop);
  std::function<void(const std::string&)> stop_;
};

}  // namespace footing::footing_sim
