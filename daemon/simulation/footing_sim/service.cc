#include "daemon/simulation/footing_sim/service.h"

#include <utility>

#include "daemon/simulation/gait_service/gait_line.h"
#include "daemon/simulation/pose_service/pose_line.h"
#include "daemon/simulation/serving/serving.h"

namespace footing::footing_sim {

Service::Service(std::function<void(const std::string&)> stop) : stop_(std::move(stop)) {}

Service::~Service() = default;

Result<std::unique_ptr<Service>> Service::Start(boost::asio::io_context& io,
                                                const serving::Config& config,
                                                const std::string& version) {
  if (const auto built = serving::CheckBuilt(config); !built) return built.error();
  auto stop = config.engine == "pose"
                  ? serving::StartServing<pose_service::PoseLine>(io, config, version)
                  : serving::StartServing<gait_service::GaitLine>(io, config, version);
  if (!stop) return stop.error();
  return std::unique_ptr<Service>(new Service(std::move(stop).value()));
}

void Service::Stop(const std::string& reason) { stop_(reason); }

}  // namespace footing::footing_sim
