#include "daemon/offline/tune/texts.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "common/runtime/data_file.h"

namespace footing::tune {

Result<gait::GainTable> TableOf(const engine::EngineTexts& texts,
                                const std::vector<std::string>& paths) {
  gait::GainTable table;
  for (const engine::GainText& gains : texts.gains) {
    if (const auto added = table.Add(gains.text, gains.origin); !added) return added.error();
  }
  for (const std::string& path : paths) {
    const Result<std::string> text = config::ReadTextFile(path);
    if (!text) return text.error();
    if (const auto added = table.Add(*text, path); !added) return added.error();
  }
  return table;
}

Result<void> ReplaceFile(const std::string& path, const std::string& text) {
  const std::string beside = path + ".new";
  {
    std::ofstream file(beside, std::ios::binary | std::ios::trunc);
    file << text;
    file.close();
    if (!file) return Failure("cannot write " + beside + ": " + std::strerror(errno));
  }
  if (std::rename(beside.c_str(), path.c_str()) != 0) {
    return Failure("cannot rename " + beside + " to " + path + ": " + std::strerror(errno));
  }
  return {};
}

}  // namespace footing::tune
