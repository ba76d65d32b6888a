#include <cstdlib>
#include <string>

#include "common/base/result.h"

extern "C" long write(int, const void*, unsigned long);  // From libc: all that an abort needs.

namespace footing {

void CheckFailed(const char* condition, const char* file, int line) {
  const std::string text =
      std::string("CHECK failed: ") + condition + " at " + file + ":" + std::to_string(line) + "\n";
  if (write(2, text.data(), text.size()) < 0) std::abort();
  std::abort();
}

}  // namespace footing
