#include "common/runtime/subject.h"

#include <cmath>

#include "common/base/text.h"
#include "common/runtime/config.h"
#include "common/runtime/files.h"

namespace footing::subject {
namespace {

constexpr double kLeastHeightM = 1.0, kMostHeightM = 2.3;
constexpr double kLeastMassKg = 20, kMostMassKg = 250;
constexpr double kLeastFootM = 0.15, kMostFootM = 0.36;
constexpr double kUnnamedHeightM = 1.72;
constexpr std::size_t kLongestCode = 32;

bool IsCode(const std::string& code) {
  if (code.empty() || code.size() > kLongestCode) return false;
  for (const char c : code) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (!letter && !(c >= '0' && c <= '9') && c != '-' && c != '_') return false;
  }
  return true;
}

Result<void> CheckRange(const std::string& key, double value, double least, double most,
                        bool optional, const std::string& origin) {
  if (optional && value == 0) return {};
  if (std::isfinite(value) && value >= least && value <= most) return {};
  const std::string range = text::Shortest(least) + " to " + text::Shortest(most);
  if (value == 0) return UsageError(origin + ": " + key + " is missing; give " + range);
  return UsageError(origin + ": " + key + " = " + text::Shortest(value) + " is outside " + range);
}

}  // namespace

Subject UnnamedSubject() {
  Subject subject;
  subject.height_m = kUnnamedHeightM;
  return subject;
}

Result<void> CheckSubject(const Subject& subject, const std::string& origin) {
  if (!IsCode(subject.code)) {
    return UsageError(origin + ": code \"" + subject.code +
                      "\" must have 1 to 32 letters, digits, - and _");
  }
  if (const auto ok =
          CheckRange("height_m", subject.height_m, kLeastHeightM, kMostHeightM, false, origin);
      !ok) {
    return ok;
  }
  if (const auto ok =
          CheckRange("mass_kg", subject.mass_kg, kLeastMassKg, kMostMassKg, true, origin);
      !ok) {
    return ok;
  }
  return CheckRange("foot_length_m", subject.foot_length_m, kLeastFootM, kMostFootM, true, origin);
}

Result<Subject> ReadSubject(const std::string& path) {
  Subject subject;
  config::Binder binder("subject file");
  binder.Text("code", subject.code, "The subject's code");
  binder.Number("height_m", subject.height_m, kLeastHeightM, kMostHeightM, "Standing height");
  binder.Number("mass_kg", subject.mass_kg, kLeastMassKg, kMostMassKg, "Checked by the T-pose");
  binder.Number("foot_length_m", subject.foot_length_m, kLeastFootM, kMostFootM, "Heel to tip");
  const auto text = config::ReadTextFile(path);
  if (!text) return text.error();
  if (const auto read = binder.ApplyText(*text, path); !read)
    return InvalidData(read.error().message);
  if (const auto ok = CheckSubject(subject, path); !ok) return InvalidData(ok.error().message);
  return subject;
}

}  // namespace footing::subject
