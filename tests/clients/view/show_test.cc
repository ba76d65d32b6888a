#include "clients/view/scene/stage.h"

#include <gtest/gtest.h>

#include "tests/clients/view/made_stream.h"

namespace footing::scene {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

void TakeUntil(Show& show, int from_tick, int to_tick) {
  for (int i = from_tick; i < to_tick; ++i) {
    show.Take(made::TickAt(0.01 * i, {}), made::ClockAt(0.01 * i));
  }
}

float NewestMagnitude(const Model& model) {
  return model.strips.devices.begin()->second.magnitude_mps2.points().back().value;
}

TEST(Show, WhatSlidesWithTimeFreezesWithTheScene) {
  Show show;
  TakeUntil(show, 0, 300);
  const std::int64_t frozen_ns = made::ClockAt(3);
  const auto before = show.At(frozen_ns, true, {});
  const float value = NewestMagnitude(before.past);
  TakeUntil(show, 300, 1800);  // Longer than the strips reach back.
  const auto later = show.At(made::ClockAt(18), true, {});
  EXPECT_EQ(later.past_ns, frozen_ns);
  EXPECT_EQ(later.past.strips.newest_ns, before.past.strips.newest_ns);
  EXPECT_EQ(NewestMagnitude(later.past), value);
  EXPECT_EQ(later.frame.time_s, before.frame.time_s);
  const auto again = show.At(made::ClockAt(18.01), false, {});
  EXPECT_EQ(again.past_ns, made::ClockAt(18.01));
  EXPECT_EQ(&again.past, &show.model());
}

TEST(Strips, StandStillWhileNothingComes) {
  EXPECT_EQ(ShownTime(5 * kSecondNs, 5 * kSecondNs + 10'000'000), 5 * kSecondNs + 10'000'000);
  const std::int64_t stopped_ns = ShownTime(5 * kSecondNs, 8 * kSecondNs);
  EXPECT_EQ(ShownTime(5 * kSecondNs, 60 * kSecondNs), stopped_ns);
  EXPECT_GT(stopped_ns, 5 * kSecondNs + kCurrentNs);  // The last values no longer count as present.
  Model model;
  Apply(model, made::TickAt(1, {}));
  EXPECT_EQ(model.strips.newest_ns, made::TickAt(1, {}).received_ns);
  EXPECT_EQ(model.playout.newest_ns(), made::TickAt(1, {}).received_ns);
}

}  // namespace
}  // namespace footing::scene
