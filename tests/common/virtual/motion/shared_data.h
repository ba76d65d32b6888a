#pragma once

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace footing::motion::test {

/// Folder of the shared recordings, or nothing: then a test skips.
inline std::string SharedData() {
  const char* folder = std::getenv("FOOTING_TEST_DATA");
  return folder == nullptr ? "" : folder;
}

inline std::string ReadShared(const std::string& path) {
  std::ifstream file(SharedData() + "/" + path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace footing::motion::test

#define SKIP_WITHOUT_SHARED_DATA() \
  if (footing::motion::test::SharedData().empty()) GTEST_SKIP() << "needs FOOTING_TEST_DATA"
