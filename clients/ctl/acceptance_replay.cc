#include <map>
#include <optional>

#include "clients/ctl/acceptance_run.h"
#include "clients/ctl/acceptance_text.h"
#include "common/recording/records.h"
#include "common/recording/recorded_session.h"

namespace footing::ctl {
namespace {

using v1::Tick;

const std::vector<std::uint32_t>& JudgedFields() {
  static const std::vector<std::uint32_t> fields = {
      Tick::kStatusFieldNumber, Tick::kMotionFieldNumber, Tick::kBoardsFieldNumber,
      Tick::kFeaturesFieldNumber};
  return fields;
}

/// What RunAcceptance kept beside the ticks.
std::optional<std::map<std::string, std::string>> KeptPlan(
    const recording::RecordedSession& session) {
  for (const mcap::Metadata& one : session.metadata()) {
    if (one.name == "acceptance") return std::map(one.values.begin(), one.values.end());
  }
  return std::nullopt;
}

}  // namespace

Result<AcceptanceVerdict> ReplayAcceptance(const std::string& path) {
  const auto session = recording::RecordedSession::Open(path);
  if (!session) {
    return Error{session.error().kind,
                 session.error().message + "; a run that did not end has no verdict to compute"};
  }
  const auto metadata = KeptPlan(*session);
  if (!metadata) {
    return InvalidData(path +
                       " is not an acceptance recording; record one with: footing-ctl "
                       "acceptance --out FILE.mcap");
  }
  const auto plan = ReadAcceptanceMetadata(*metadata);
  if (!plan) return InvalidData(path + ": " + plan.error().message);
  guide::Acceptance acceptance(plan->rig, plan->layout);
  auto span = plan->spans.begin();
  const recording::RecordedServer* server = session->Find("footingd");
  if (server == nullptr) return InvalidData(path + " has no ticks of footingd");
  const auto ticks = recording::ReadTicks(*server, JudgedFields());
  if (!ticks) return InvalidData(path + ": " + ticks.error().message);
  for (const v1::Tick& tick : *ticks) {
    if (span != plan->spans.end() && tick.host_ns() >= span->from_ns) {
      acceptance.Begin(span->phase, span->from_ns);
      ++span;
    }
    if (span == plan->spans.end() && !plan->spans.empty() &&
        tick.host_ns() >= plan->spans.back().to_ns) {
      acceptance.End(plan->spans.back().to_ns);
    }
    TakeTick(tick, acceptance);
  }
  return AcceptanceVerdict{acceptance.Checks(), path};
}

}  // namespace footing::ctl
