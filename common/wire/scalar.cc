#include "common/wire/scalar.h"

#include <cmath>
#include <cstddef>

#include "common/base/text.h"

namespace footing::wire {

double Finite(double value) { return std::isfinite(value) ? value : 0.0; }

std::string Utf8(const std::string& text) {
  std::string valid;
  valid.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = text::SequenceLength(text, at);
    if (length == 0) {
      valid.push_back('?');
      ++at;
    } else {
      valid.append(text, at, length);
      at += length;
    }
  }
  return valid;
}

}  // namespace footing::wire
