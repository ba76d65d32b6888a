#include <cmath>

#include "clients/ctl/guided.h"
#include "common/guide/set_up.h"
#include "common/base/utc.h"
#include "common/base/units.h"

namespace footing::ctl {
namespace {

using nlohmann::ordered_json;

/// "2026-11-21T10:30:00Z"; empty when there is none.
std::string Date(std::int64_t wall_time_ns) {
  if (wall_time_ns <= 0) return "";
  return text::Utc(wall_time_ns);
}

std::string RoundedText(double value) {
  const double rounded = std::round(value * 100) / 100;
  return ordered_json(rounded).dump();
}

}  // namespace

ordered_json ToJson(const stream::SetupItem& item) {
  return {{"name", item.name},         {"serial", item.serial}, {"passed", item.passed},
          {"residual", item.residual}, {"unit", item.unit},     {"date", Date(item.wall_time_ns)},
          {"stale", item.stale},       {"note", item.note}};
}

std::string ToText(const stream::SetupItem& item) {
  std::string text = item.name;
  if (!item.serial.empty()) text += " " + item.serial;
  text += item.passed ? (item.stale ? ": stale" : ": ok") : ": FAILED";
  if (!item.unit.empty()) text += ", " + RoundedText(item.residual) + " " + item.unit;
  if (!item.note.empty()) text += ", " + item.note;
  return text;
}

Result<void> PrintItems(const Session& session, const std::string& rig,
                        const std::vector<stream::SetupItem>& items, bool need_ready,
                        const Shared& shared) {
  std::vector<std::string> missing;
  const bool ready = guide::Ready(items, DevicesOf(session, rig), &missing);
  ordered_json out{{"rig", rig}, {"items", ordered_json::array()}, {"ready", ready}};
  std::string text = "rig " + rig + (ready ? " is ready" : " is not ready");
  for (const auto& item : items) {
    out["items"].push_back(ToJson(item));
    text += "\n  " + Date(item.wall_time_ns) + "  " + ToText(item);
  }
  out["missing"] = missing;
  if (!missing.empty()) text += "\nmissing:";
  for (const std::string& one : missing) text += "\n  " + one;
  Print(out, text, shared);
  if (need_ready && !ready) return Failure("rig " + rig + " is not ready; " + missing.front());
  return {};
}

}  // namespace footing::ctl
