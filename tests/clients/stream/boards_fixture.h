#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "clients/stream/boards.h"
#include "tests/common/temporary_folder.h"

namespace footing::stream_client {

/// A short script as a file.
class BoardsTest : public testing::Test {
 protected:
  BoardsTest() {
    std::ofstream(path_) << R"({"keys": [{"seconds": 1.5}, {"seconds": 1, "both_raise_deg": -80},
        {"seconds": 1}, {"seconds": 0.7, "crouch_m": 0.2, "weight": 0.4},
        {"seconds": 0.7, "crouch_m": 0, "weight": 0}, {"seconds": 1, "both_raise_deg": 0}]})";
    options_.stage.motion = path_;
    options_.stage.mass_kg = 60;
  }

  const test::TemporaryFolder folder_;
  const std::string path_ = folder_.Path("script.json");
  BoardsOptions options_;
};

}  // namespace footing::stream_client
