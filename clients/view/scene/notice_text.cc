#include "clients/view/scene/notice_text.h"

#include "common/base/units.h"

namespace footing::scene {
namespace {

constexpr double kScreenS = 30;
constexpr double kLogLineS = 3;

std::string NewerThan(double seconds, const Note& note, std::int64_t now_ns) {
  return NanosecondsToSeconds(now_ns - note.received_ns) < seconds ? note.text : "";
}

}  // namespace

std::string NoticeText(const Model& model, int source, std::int64_t now_ns) {
  const auto found = model.last.server.find(source);
  return found == model.last.server.end() ? "" : NewerThan(kScreenS, found->second, now_ns);
}

std::string NoticesOfLogLine(const Model& model, std::int64_t now_ns) {
  std::string text;
  for (const auto& [source, note] : model.last.server) {
    const std::string notice = NewerThan(kLogLineS, note, now_ns);
    if (!notice.empty()) text += "  NOTICE: " + notice;
  }
  return text;
}

}  // namespace footing::scene
