#include "common/virtual/motion/c3d_parameters.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "common/base/lines.h"

namespace footing::motion {
namespace {

constexpr std::size_t kMostEntries = 10'000;

std::string Upper(const C3dReader& reader, std::size_t at, std::size_t length) {
  std::string text;
  for (std::size_t i = 0; i < length; ++i) {
    text += static_cast<char>(std::toupper(reader.Byte(at + i)));
  }
  return text;
}

struct Values {
  std::vector<double> numbers;
  std::vector<std::string> texts;
};

/// Type, dimensions and values of one parameter, from byte `at` on.
bool ParseValues(const C3dReader& reader, std::size_t at, Values& out) {
  if (!reader.Has(at, 2)) return false;
  const int type = static_cast<std::int8_t>(reader.Byte(at));
  const std::size_t dimensions = reader.Byte(at + 1);
  const std::size_t size = static_cast<std::size_t>(std::abs(type));
  if ((type != -1 && type != 1 && type != 2 && type != 4) || dimensions > 7) return false;
  at += 2;
  if (!reader.Has(at, dimensions)) return false;
  std::size_t count = 1, width = 1;
  for (std::size_t i = 0; i < dimensions; ++i) {
    const std::size_t length = reader.Byte(at + i);
    if (i == 0) width = length;
    count *= length;
    if (count > 1u << 20) return false;
  }
  at += dimensions;
  if (!reader.Has(at, count * size)) return false;
  if (type == -1) {
    if (dimensions == 0) width = 1;
    for (std::size_t i = 0; width > 0 && i + width <= count; i += width) {
      std::string text;
      for (std::size_t k = 0; k < width; ++k) text += static_cast<char>(reader.Byte(at + i + k));
      text.resize(std::min(text.size(), text.find('\0')));
      out.texts.emplace_back(text::Trim(text));
    }
    return true;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t here = at + i * size;
    const double value = type == 4   ? static_cast<double>(reader.Float(here))
                         : type == 2 ? reader.Signed(here)
                                     : reader.Byte(here);
    out.numbers.push_back(std::isfinite(value) ? value : 0);
  }
  return true;
}

}  // namespace

double C3dParameters::Number(const std::string& name, double otherwise) const {
  const auto found = numbers.find(name);
  return found == numbers.end() || found->second.empty() ? otherwise : found->second[0];
}

std::string C3dParameters::Text(const std::string& name) const {
  const auto found = texts.find(name);
  return found == texts.end() || found->second.empty() ? "" : found->second[0];
}

std::vector<std::string> C3dParameters::Labels(const std::string& group) const {
  std::vector<std::string> labels;
  for (int part = 1; part < 100; ++part) {
    const auto found = texts.find(group + ":LABELS" + (part == 1 ? "" : std::to_string(part)));
    if (found == texts.end()) break;
    labels.insert(labels.end(), found->second.begin(), found->second.end());
  }
  return labels;
}

Result<C3dParameters> ParseC3dParameters(const C3dReader& reader, std::size_t begin,
                                         const std::string& file) {
  // Names of groups may come after their parameters.
  std::map<int, std::string> groups;
  std::vector<std::pair<std::pair<int, std::string>, Values>> found;
  std::size_t at = begin + 4;
  for (std::size_t entry = 0;; ++entry) {
    const auto fault = [&](const std::string& what) {
      return InvalidData(file + ", byte " + std::to_string(at) + ": " + what);
    };
    if (entry > kMostEntries) return fault("more than 10000 parameters");
    if (!reader.Has(at, 2)) return fault("the parameters end before their end mark");
    const auto length = static_cast<std::size_t>(
        std::abs(static_cast<int>(static_cast<std::int8_t>(reader.Byte(at)))));
    const int group = static_cast<std::int8_t>(reader.Byte(at + 1));
    if (length == 0 || group == 0) break;
    if (!reader.Has(at + 2, length + 2)) return fault("a parameter is cut off");
    std::string name = Upper(reader, at + 2, length);
    const std::size_t link = at + 2 + length;
    const std::size_t next = reader.Unsigned(link);
    if (group < 0) {
      groups[-group] = std::move(name);
    } else {
      Values values;
      if (!ParseValues(reader, link + 2, values)) {
        return fault("parameter " + text::Quoted(name) + " is of no known type or size");
      }
      found.push_back({{group, std::move(name)}, std::move(values)});
    }
    if (next == 0) break;
    at = link + next;
  }
  C3dParameters parameters;
  for (auto& [key, values] : found) {
    const std::string name = groups[key.first] + ":" + key.second;
    if (!values.texts.empty()) parameters.texts[name] = std::move(values.texts);
    if (!values.numbers.empty()) parameters.numbers[name] = std::move(values.numbers);
  }
  return parameters;
}

}  // namespace footing::motion
