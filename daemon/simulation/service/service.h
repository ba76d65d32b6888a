#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <string>

#include "common/result/result.h"
#include "daemon/simulation/service/config.h"

namespace footing::simulation {

/// footing-sim: subscribes to footingd, runs the engine on its thread, publishes frames.
class Service {
 public:
  /// Reads the data files, builds the engine, opens the listeners and starts.
  static Result<std::unique_ptr<Service>> Start(boost::asio::io_context& io, const Config& config,
                                                const std::string& version);
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// Says goodbye to every client and stops the simulation thread.
  void Stop(const std::string& reason);

 private:
  class Implementation;
  explicit Service(std::shared_ptr<Implementation> implementation);
  std::shared_ptr<Implementation> implementation_;
};

}  // namespace footing::simulation
