#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <signal.h>
#include <sys/wait.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <set>

#include "common/runtime/clock.h"
#include "tests/device_faults/bench.h"

namespace footing::device_faults {

/// One fault against the shipped footingd. Whatever it is: every number published is finite, time
/// runs forwards, and footingd ends in order.
class Fault : public testing::Test {
 protected:
  void TearDown() override {
    bench.EndFaults();
    for (const std::string& wrong : bench.seen().wrongs()) ADD_FAILURE() << wrong;
    EXPECT_EQ(bench.Stop(), 0) << "footingd's end";
    EXPECT_EQ(bench.LogLines("ERROR: "), 0u);  // Errors of a sanitizer.
    EXPECT_EQ(bench.LogLines("runtime error"), 0u);
    if (HasFailure()) std::cerr << bench.Log();
  }

  /// At rest face up: within 2 % of gravity along -z, as sent with 9 bits.
  static bool AtRest(const v1::MotionSample& sample) {
    const auto& force = sample.specific_force_mps2();
    return std::abs(force.x()) < 0.2 && std::abs(force.y()) < 0.2 &&
           std::abs(force.z() + 9.80665) < 0.2;
  }
  const v1::DeviceStatus& Status(const Device& device) {
    static const v1::DeviceStatus kNone;
    const v1::DeviceStatus* status = bench.seen().Status(device.serial());
    return status == nullptr ? kNone : *status;
  }
  const std::vector<v1::MotionSample>& Motion(const Device& device) {
    return bench.seen().Motion(device.serial());
  }
  const std::vector<v1::BoardSample>& Boards(const Device& device) {
    return bench.seen().Boards(device.serial());
  }
  void ExpectAllAtRest(const Device& device, std::size_t at_least) {
    EXPECT_GE(Motion(device).size(), at_least);
    for (const auto& sample : Motion(device)) {
      ASSERT_TRUE(AtRest(sample)) << sample.ShortDebugString();
    }
  }

  Bench bench;
};

/// The name of the fault is that of its CTest test.
#define FOOTING_FAULT(name)     \
  class name : public Fault {}; \
  TEST_F(name, IsSurvived)

}  // namespace footing::device_faults
