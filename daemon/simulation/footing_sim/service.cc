#include "daemon/simulation/footing_sim/service.h"

#include "daemon/simulation/gait_service/gait_line.h"
#include "daemon/simulation/pose_service/pose_line.h"

namespace footing::footing_sim {

Result<serving::Served> StartService(boost::asio::io_context& io, const Config& given,
                                     const std::string& version) {
  Config config = given;
  config.serving.version = version;
  using gait_service::GaitLine;
  using pose_service::PoseLine;
  if (config.engine == "pose") {
    return serving::StartServing<PoseLine>(io, config.serving, [&config](int wake) {
      return PoseLine::Create(config.serving, config.pose, wake);
    });
  }
  return serving::StartServing<GaitLine>(io, config.serving, [&config](int wake) {
    return GaitLine::Create(config.serving, config.gait, wake);
  });
}

}  // namespace footing::footing_sim
