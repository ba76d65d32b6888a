#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "common/base/units.h"
#include "tests/sensor/service/fixture.h"

namespace footing::sensor {

/// State that is kept between two benches, as on a disk.
class Kept {
 public:
  setup::Storage storage() {
    return {[this](const std::string& name) {
              const auto found = pieces_.find(name);
              return found == pieces_.end() ? std::nullopt : std::optional(found->second);
            },
            [this](const std::string& name, const std::string& text) { pieces_[name] = text; },
            [this](const std::string& name, const std::string&) { pieces_.erase(name); }};
  }

 private:
  std::map<std::string, std::string> pieces_;
};

inline stream::BoardLayout OneFootEach() {
  stream::BoardLayout layout;
  layout.rig = "main";
  layout.preset = "one_foot_each";
  layout.gap_mm = 20;
  layout.left = {0, 0.168, -kPi / 2};
  layout.right = {0, -0.168, kPi / 2};
  return layout;
}

inline stream::SetupItem Passed(const std::string& name, const std::string& serial = "") {
  stream::SetupItem item;
  item.name = name;
  item.serial = serial;
  item.passed = true;
  return item;
}

inline const stream::SetupItem& ItemOf(const Bench& bench, const std::string& name) {
  for (const auto& rig : bench.content.setup) {
    for (const auto& item : rig.items) {
      if (item.name == name) return item;
    }
  }
  ADD_FAILURE() << "no item " << name;
  static const stream::SetupItem kNone;
  return kNone;
}

}  // namespace footing::sensor
