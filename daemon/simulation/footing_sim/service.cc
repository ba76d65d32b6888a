#include "daemon/simulation/footing_sim/service.h"

#include "daemon/simulation/gait_service/gait_line.h"
#include "daemon/simulation/pose_service/pose_line.h"

namespace footing::footing_sim {
namespace {

using gait_service::GaitLine;
using pose_service::PoseLine;

auto MakePoseLine(const Config& config) {
  return [&config](int wake) { return PoseLine::Create(config.serving, config.pose, wake); };
}

auto MakeGaitLine(const Config& config) {
  return [&config](int wake) { return GaitLine::Create(config.serving, config.gait, wake); };
}

}  // namespace

Result<serving::Served> StartService(boost::asio::io_context& io, const Config& given,
                                     const std::string& version) {
  Config config = given;
  config.serving.version = version;
  if (config.engine == "pose") {
    return serving::StartServing<PoseLine>(io, config.serving, MakePoseLine(config));
  }
  return serving::StartServing<GaitLine>(io, config.serving, MakeGaitLine(config));
}

Result<void> CheckService(const Config& config) {
  if (config.engine == "pose") {
    return serving::CheckServing<PoseLine>(config.serving, MakePoseLine(config));
  }
  return serving::CheckServing<GaitLine>(config.serving, MakeGaitLine(config));
}

}  // namespace footing::footing_sim
