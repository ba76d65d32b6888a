#include <gtest/gtest.h>

#include <string>

#include "daemon/simulation/biped/track.h"

namespace footing::terrain {
namespace {

/// Why a track of these segments, with these further keys, is refused; empty when it is not.
std::string Refusal(const std::string& segments, const std::string& keys = "") {
  const auto track =
      ParseTrack(R"({"version": 1, )" + keys + R"("segments": [)" + segments + "]}", "lab.json");
  return track ? "" : track.error().message;
}

TEST(TrackFile, HasGroundUnderTheCharacterBeforeTheFirstPit) {
  EXPECT_EQ(Refusal(R"({"length_m": 2, "pit": true}, {"length_m": 20})"),
            "lab.json, segment 0: the pit begins 0.00 m from the start of the track, where the "
            "character stands; put at least 1 m of ground before it");
  const std::string near =
      Refusal(R"({"length_m": 0.3, "repeat": 3}, {"length_m": 1, "pit": true}, {"length_m": 20})");
  EXPECT_NE(near.find("lab.json, segment 1: the pit begins 0.90 m"), std::string::npos) << near;
  EXPECT_EQ(Refusal(R"({"length_m": 1}, {"length_m": 1, "pit": true}, {"length_m": 20})"), "");
  // A later pit may follow shorter ground.
  EXPECT_EQ(Refusal(R"({"length_m": 6}, {"length_m": 1, "pit": true}, {"length_m": 0.5},
                       {"length_m": 1, "pit": true}, {"length_m": 20})"),
            "");
}

TEST(TrackFile, HasItsStartLineOnGroundThatGoesOn) {
  const char* pit = R"({"length_m": 4}, {"length_m": 2, "pit": true}, {"length_m": 20})";
  EXPECT_EQ(Refusal(pit, R"("start_m": 5, )"),
            "lab.json: start_m is 5, in a pit; put the start line on the ground");
  EXPECT_EQ(Refusal(pit, R"("start_m": 3, )"), "");
  EXPECT_EQ(Refusal(R"({"length_m": 1.5})", R"("finish_m": 0, )"),
            "lab.json: the track is 1.50 m long, its start line is at 1 m; at least 1 m of track "
            "must follow it");
  EXPECT_EQ(Refusal(R"({"length_m": 2})", R"("finish_m": 0, )"), "");
}

TEST(TrackFile, IsLongEnoughForItsFinishLine) {
  EXPECT_EQ(
      Refusal(R"({"length_m": 6})"),
      "lab.json: the track is 6.00 m long, too short for a finish line 5 m before its end; make "
      "it longer than 6 m, or set finish_m");
  EXPECT_NE(Refusal(R"({"length_m": 0.5})"), "");
  for (const char* keys : {R"("finish_m": 0, )", R"("finish_m": 4, )", R"("open": true, )",
                           R"("extendable": true, )", R"("endless": true, )"}) {
    EXPECT_EQ(Refusal(R"({"length_m": 6})", keys), "") << keys;
  }
  EXPECT_EQ(Refusal(R"({"length_m": 6.1})"), "");
}

TEST(TrackFile, BendsBesideItsPits) {
  EXPECT_EQ(Refusal(R"({"length_m": 10}, {"length_m": 1, "pit": true, "curve_deg": 30},
                       {"length_m": 20})"),
            "lab.json, segment 1: a pit has no curve_deg; put the curve before or after it");
  EXPECT_EQ(Refusal(R"({"length_m": 10}, {"length_m": 1, "pit": true},
                       {"length_m": 20, "curve_deg": 30})"),
            "");
}

TEST(TrackFile, RefusesNumbersOutOfRangeByName) {
  for (const char* text :
       {R"({"version": 1, "segments": [{"length_m": -3}]})", R"({"version": 1, "segments": []})",
        R"({"version": 2, "segments": [{"length_m": 3}]})",
        R"({"version": 1, "segments": [{"length_m": 3, "slope_deg": 80}]})", "[1, 2]",
        R"({"version": 1, "segments": [{"length_m": 3, "repeat": 1001}]})",
        R"({"version": 1, "segments": [{"length_m": 3, "lenght_m": 3}]})",
        R"({"version": 1, "help_over_pit": false, "segments": [{"length_m": 3}]})",
        R"({"version": 1, "start_m": 20, "finish_m": 10, "segments": [{"length_m": 30}]})",
        R"({"version": 1, "mark": {"at_m": 9}, "segments": [{"length_m": 30}]})",
        R"({"version": 1, "mark": {"at_m": 29, "tasks": [{"name": "a", "after": "run"}]},
            "segments": [{"length_m": 30}]})",
        R"({"version": 1, "mark": {"at_m": 9, "tasks": [{"name": "a", "after": "fly"}]},
            "segments": [{"length_m": 30}]})",
        R"({"version": 1, "mark": {"at_m": 9, "tasks": [{"name": "a", "before": "run",
            "after": "run"}]}, "segments": [{"length_m": 30}]})",
        R"({"version": 1, "endless": true, "segments": [{"length_m": 5, "slope_deg": 1}]})",
        R"({"version": 1, "endless": true, "extendable": true, "segments": [{"length_m": 5}]})",
        R"({"version": 1, "extendable": true, "help_over_pits": false,
            "segments": [{"length_m": 5}]})"}) {
    const auto track = ParseTrack(text, "bad.json");
    ASSERT_FALSE(track.ok()) << text;
    EXPECT_NE(track.error().message.find("bad.json"), std::string::npos);
  }
}

}  // namespace
}  // namespace footing::terrain
