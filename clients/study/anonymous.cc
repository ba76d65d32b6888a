#include "clients/study/anonymous.h"

#include <algorithm>
#include <utility>

#include "clients/study/plan/draw.h"
#include "common/base/csv.h"
#include "common/base/lines.h"
#include "common/base/number.h"

namespace footing::study::bundle {
namespace {

constexpr const char* kHeader = "number,code";

}  // namespace

Result<ParticipantKey> ParticipantKey::Parse(std::string_view text, const std::string& file) {
  text::Lines lines(text, file);
  const auto header = lines.NextFull();
  if (!header || *header != kHeader) {
    return lines.Fault(std::string("the first line must be \"") + kHeader + "\"");
  }
  ParticipantKey key;
  std::map<std::size_t, bool> taken;
  while (const auto line = lines.NextFull()) {
    const auto cells = text::Cells(*line);
    const auto number = cells.size() == 2 ? text::ToCount(cells[0]) : std::nullopt;
    if (!number || *number == 0) return lines.Fault("it must have a number and a code");
    const bool fresh = taken.emplace(*number, true).second &&
                       key.number_of_.emplace(std::string(cells[1]), *number).second;
    if (!fresh) return lines.Fault("its number or its code stands above, too");
  }
  return key;
}

void ParticipantKey::Add(std::vector<std::string> codes, std::uint64_t seed) {
  std::erase_if(codes, [this](const std::string& code) { return number_of_.count(code) != 0; });
  plan::Draw(seed, "numbers of participants").Shuffle(codes);
  std::size_t last = 0;
  for (const auto& [code, number] : number_of_) last = std::max(last, number);
  for (const std::string& code : codes) number_of_[code] = ++last;
}

std::string ParticipantKey::SubjectOf(const std::string& code) const {
  const std::string number = std::to_string(number_of_.at(code));
  return "sub-" + (number.size() < 2 ? "0" + number : number);
}

std::string ParticipantKey::Text() const {
  std::string text = std::string(kHeader) + "\n";
  for (const auto& [code, number] : number_of_) text += std::to_string(number) + "," + code + "\n";
  return text;
}

}  // namespace footing::study::bundle
