#pragma once

#include <string>
#include <string_view>

namespace footing::text {

/// The texts with `separator` between them: "walk, run, jump". Empty for none.
template <typename Texts>
std::string Joined(const Texts& texts, std::string_view separator = ", ") {
  std::string all;
  bool first = true;
  for (const auto& one : texts) {
    if (!first) all += separator;
    first = false;
    all += one;
  }
  return all;
}

}  // namespace footing::text
