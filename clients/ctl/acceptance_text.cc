#include "clients/ctl/acceptance_text.h"

#include <nlohmann/json.hpp>

#include "common/wire/wire.h"

namespace footing::ctl {
namespace {

using nlohmann::ordered_json;

stream::BoardPose PoseOf(const ordered_json& json) {
  return {json.at("x_m").get<double>(), json.at("y_m").get<double>(),
          json.at("yaw_rad").get<double>()};
}

}  // namespace

ordered_json BoardPoseJson(const stream::BoardPose& pose) {
  return {{"x_m", pose.x_m}, {"y_m", pose.y_m}, {"yaw_rad", pose.yaw_rad}};
}

void TakeTick(const v1::Tick& tick, guide::Acceptance& acceptance) {
  if (tick.has_status()) {
    std::vector<stream::DeviceStatus> devices;
    for (const auto& device : tick.status().devices()) devices.push_back(wire::FromProto(device));
    acceptance.Take(devices, tick.host_ns());
  }
  for (const auto& sample : tick.motion().samples()) {
    acceptance.Take(wire::FromProto(sample), tick.host_ns());
  }
  for (const auto& sample : tick.boards().samples()) {
    acceptance.Take(wire::FromProto(sample), tick.host_ns());
  }
  for (const auto& rig : tick.features().rigs()) {
    acceptance.Take(wire::FromProto(rig), tick.host_ns());
  }
}

std::map<std::string, std::string> AcceptanceMetadata(const std::string& rig,
                                                      const stream::BoardLayout& layout,
                                                      const std::vector<guide::Span>& spans,
                                                      const std::vector<guide::Check>& checks) {
  ordered_json phases = ordered_json::array();
  for (const guide::Span& span : spans) {
    phases.push_back(
        {{"phase", guide::Name(span.phase)}, {"from_ns", span.from_ns}, {"to_ns", span.to_ns}});
  }
  ordered_json list = ordered_json::array();
  for (const guide::Check& check : checks) {
    list.push_back({{"name", check.name},
                    {"passed", check.passed},
                    {"value", check.value},
                    {"bar", check.bar},
                    {"unit", check.unit},
                    {"note", check.note}});
  }
  const ordered_json lies{{"preset", layout.preset},
                          {"gap_mm", layout.gap_mm},
                          {"left", BoardPoseJson(layout.left)},
                          {"right", BoardPoseJson(layout.right)}};
  return {{"rig", rig},
          {"layout", lies.dump()},
          {"phases", phases.dump()},
          {"checks", list.dump()},
          {"verdict", guide::Passed(checks) ? "pass" : "fail"}};
}

Result<AcceptancePlan> ReadAcceptanceMetadata(const std::map<std::string, std::string>& metadata) {
  AcceptancePlan plan;
  try {
    plan.rig = metadata.at("rig");
    const auto lies = ordered_json::parse(metadata.at("layout"));
    plan.layout.preset = lies.at("preset").get<std::string>();
    plan.layout.gap_mm = lies.at("gap_mm").get<double>();
    plan.layout.left = PoseOf(lies.at("left"));
    plan.layout.right = PoseOf(lies.at("right"));
    for (const auto& json : ordered_json::parse(metadata.at("phases"))) {
      const auto phase = guide::PhaseNamed(json.at("phase").get<std::string>());
      if (!phase) return InvalidData("its phase " + json.at("phase").dump() + " is not known");
      plan.spans.push_back(
          {*phase, json.at("from_ns").get<std::int64_t>(), json.at("to_ns").get<std::int64_t>()});
    }
  } catch (const std::out_of_range& error) {
    return InvalidData(std::string("its metadata lacks a part: ") + error.what());
  } catch (const ordered_json::exception& error) {
    return InvalidData(std::string("its metadata is invalid: ") + error.what());
  }
  return plan;
}

}  // namespace footing::ctl
