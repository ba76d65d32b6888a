#pragma once

#include <gtest/gtest.h>

#include <string>

#include "common/runtime/files.h"
#include "daemon/simulation/biped/model.h"

/// The product's own data, for tests of the simulation.
namespace footing::test {

inline std::string DataFile(const std::string& name) {
  const Result<std::string> text = config::ReadDataFile(name);
  EXPECT_TRUE(text.ok()) << (text.ok() ? "" : text.error().message);
  return text.ok() ? text.value() : "";
}

inline biped::BipedParameters Biped() {
  return biped::ParseBiped(DataFile("biped.json"), "biped.json").value();
}

/// The biped over a plane at z = 0.
inline physics::World LevelWorld(double step_s = 0.001) {
  const char* plane = "<geom name='plane' type='plane' contype='1' conaffinity='2' size='0 0 1'/>";
  const std::string world = biped::WriteMjcf(Biped(), plane, {"plane"}, step_s);
  return std::move(physics::World::FromMjcf(world, biped::Names())).value();
}

}  // namespace footing::test
