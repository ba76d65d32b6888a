#include "clients/log/align.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "clients/log/time_offset.h"
#include "common/base/units.h"
#include "common/board/layout.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/link_model.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/motion/table.h"
#include "common/virtual/options/load.h"
#include "tests/clients/log/temporary_folder.h"
#include "tests/common/made_recording.h"
#include "tests/common/virtual/motion/shared_data.h"

namespace footing::log_client {
namespace {

using testing::HasSubstr;

constexpr double kWeightN = 600;
constexpr double kBarS = 0.010;

/// Standing, with three pushes at unequal times; `at_s` is when the first sample is.
Series Pushes(double at_s, double seconds, double rate_hz, double factor = 1) {
  Series series{rate_hz, 0, Eigen::VectorXd(static_cast<Eigen::Index>(seconds * rate_hz))};
  for (Eigen::Index i = 0; i < series.force_n.size(); ++i) {
    const double t = at_s + static_cast<double>(i) / rate_hz;
    double force = kWeightN;
    for (const auto& [when, how] : {std::pair(3.0, 500.0), {4.1, -300.0}, {5.7, 700.0}}) {
      force += how * std::exp(-0.5 * std::pow((t - when) / 0.12, 2));
    }
    series.force_n(i) = factor * force;
  }
  return series;
}

TEST(FindOffset, IsBelowASampleForPushesThatBothMeasured) {
  // Ours begins 1.2345 s into the world, theirs 0.5 s: a time of theirs is 0.7345 s more than ours.
  const auto found = FindOffset(Pushes(1.2345, 6, 100), Pushes(0.5, 7, 250));
  ASSERT_TRUE(found.has_value());
  EXPECT_TRUE(found->sure) << found->doubt;
  EXPECT_NEAR(found->offset_s, 0.5 - 1.2345, 0.001);
  EXPECT_LT(found->sd_s, 0.003);
}

TEST(FindOffset, StartsOfTheClocksAreInIt) {
  Series ours = Pushes(1, 6, 100), theirs = Pushes(1, 6, 100);
  ours.start_s = 100;
  theirs.start_s = 7;
  const auto found = FindOffset(ours, theirs);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->offset_s, 93, 0.001);
}

TEST(FindOffset, ThePlayOfTheCellsIsNoDelay) {
  Series ours = Pushes(1, 6, 100);
  for (Eigen::Index i = 1; i < ours.force_n.size(); ++i) {  // 20 N of backlash, half its width.
    ours.force_n(i) = std::clamp(ours.force_n(i - 1), ours.force_n(i) - 20, ours.force_n(i) + 20);
  }
  const auto found = FindOffset(ours, Pushes(1, 6, 100));
  ASSERT_TRUE(found.has_value());
  EXPECT_TRUE(found->sure) << found->doubt;
  EXPECT_NEAR(found->offset_s, 0, 0.002);
  EXPECT_NEAR(found->play_n, 20, 6);
}

TEST(FindOffset, WhatRepeatsItselfIsNotSure) {
  Series series{100, 0, Eigen::VectorXd(800)};
  for (Eigen::Index i = 0; i < series.force_n.size(); ++i) {
    series.force_n(i) = kWeightN + 200 * std::sin(2 * M_PI * static_cast<double>(i) / 100);
  }
  Series piece{100, 0, series.force_n.segment(200, 400)};
  const auto found = FindOffset(series, piece);
  ASSERT_TRUE(found.has_value());
  EXPECT_FALSE(found->sure);
  EXPECT_THAT(found->doubt, HasSubstr("fits almost as well"));
}

TEST(FindOffset, StandingStillOrAnotherMovementIsNotSure) {
  const Series still{100, 0, Eigen::VectorXd::Constant(800, kWeightN)};
  EXPECT_FALSE(FindOffset(Pushes(1, 6, 100), still).has_value());
  EXPECT_FALSE(FindOffset(Pushes(1, 6, 100), {100, 0, Eigen::VectorXd()}).has_value());
  Series squats = still;
  for (Eigen::Index i = 0; i < squats.force_n.size(); ++i) {
    squats.force_n(i) += 150 * std::sin(4 * std::sqrt(static_cast<double>(i)));
  }
  const auto other = FindOffset(Pushes(1, 6, 100), squats);
  EXPECT_FALSE(other.has_value() && other->sure);
}

TEST(FindOffset, AWrongUnitIsSaid) {
  const auto found = FindOffset(Pushes(1, 6, 100), Pushes(1, 6, 100, 1 / kStandardGravityMps2));
  ASSERT_TRUE(found.has_value());
  EXPECT_FALSE(found->sure);
  EXPECT_THAT(found->doubt, HasSubstr("unit"));
}

class AlignTest : public TemporaryFolder {
 protected:
  /// Forces of two plates as one board each measures them, cut and with errors: hysteresis of 2 N
  /// half width a cell, gains within 1 %, a sensor at 60 Hz, times within 2 ms, from `from_s` on.
  void WriteBoards(const motion::GroundForces& forces, double from_s, double to_s,
                   noise::Random& random) {
    test::MadeRecording recording(Path("boards.mcap"));
    recording.Begin("footingd");
    std::vector<std::pair<std::int64_t, v1::BoardSample>> samples;
    for (const int side : {0, 1}) {
      // The first plate is under the right foot.
      const motion::PlateForces& plate = forces.plates[static_cast<std::size_t>(1 - side)];
      virtual_sensors::BoardPlace place;
      const Eigen::Index middle = plate.cop_W.cols() / 2;
      place.middle_m = plate.cop_W.col(middle).head<2>();
      virtual_sensors::CellErrors errors(
          {.gain_spread = 0.01,
           .hysteresis_n = 2,
           .noise_kg = 0.05,
           .seed = static_cast<std::uint64_t>(random.Integer(1, 1 << 20))});
      virtual_devices::LinkModel link(
          virtual_devices::BoardLink(virtual_devices::LinkQuality::kGood,
                                     static_cast<std::uint64_t>(random.Integer(1, 1 << 20))),
          0);
      std::int64_t last_ns = -1;
      for (auto arrival = link.Next();; arrival = link.Next()) {
        const double time_s = NanosecondsToSeconds(arrival.sampled_ns) + from_s;
        if (time_s > to_s) break;
        if (arrival.sampled_ns <= last_ns) continue;
        const double place_of = time_s * forces.rate_hz;
        const auto i = static_cast<Eigen::Index>(place_of);
        const double share = place_of - static_cast<double>(i);
        const auto at = [&](const Eigen::Matrix3Xd& values) -> Eigen::Vector3d {
          return (1 - share) * values.col(i) + share * values.col(i + 1);
        };
        const double load_n = std::max(at(plate.force_W).z(), 0.0);
        const auto corners = errors.Advance(
            virtual_sensors::LoadBoard(place, {load_n, at(plate.cop_W).head<2>()}).corners_n,
            last_ns < 0 ? 0.01 : NanosecondsToSeconds(arrival.sampled_ns - last_ns));
        last_ns = arrival.sampled_ns;
        v1::BoardSample sample;
        sample.set_device(static_cast<std::uint32_t>(side + 1));
        sample.set_sampled_ns(arrival.sampled_ns + kBootNs +
                              static_cast<std::int64_t>(2e6 * random.Normal()));
        const board::CornerForces cells{corners[0], corners[1], corners[2], corners[3]};
        sample.set_total_n(board::Total(cells));
        if (sample.total_n() > 20) {
          const auto cop = board::CentreOfPressure(cells, sample.total_n(), board::kBalanceBoard);
          sample.set_cop_valid(true);
          sample.set_cop_x_m(cop.x_m);
          sample.set_cop_y_m(cop.y_m);
        }
        samples.emplace_back(arrival.arrives_ns + kBootNs, sample);
      }
      poses_[static_cast<std::size_t>(side)] = place;
    }
    std::stable_sort(samples.begin(), samples.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    WriteTicks(samples, recording);
  }

  /// A tick for each sample, the first one with the layout and the roles at kBootNs.
  void WriteTicks(const std::vector<std::pair<std::int64_t, v1::BoardSample>>& samples,
                  test::MadeRecording& recording) {
    v1::Tick tick;
    tick.set_host_ns(kBootNs);
    tick.set_sequence(1);
    v1::RigSetup& rig = *tick.mutable_setup()->add_rigs();
    rig.set_rig("main");
    rig.mutable_layout()->set_preset("custom");
    for (const int side : {0, 1}) {
      v1::DeviceStatus& status = *tick.mutable_status()->add_devices();
      status.set_device(static_cast<std::uint32_t>(side + 1));
      status.set_rig("main");
      status.set_role(side == 0 ? v1::DEVICE_ROLE_LEFT_BOARD : v1::DEVICE_ROLE_RIGHT_BOARD);
      v1::BoardPose& pose = side == 0 ? *rig.mutable_layout()->mutable_left()
                                      : *rig.mutable_layout()->mutable_right();
      pose.set_x_m(poses_[static_cast<std::size_t>(side)].middle_m.x());
      pose.set_y_m(poses_[static_cast<std::size_t>(side)].middle_m.y());
    }
    recording.Add(tick);
    for (const auto& [time_ns, sample] : samples) {
      const std::uint64_t sequence = tick.sequence() + 1;
      tick.Clear();
      tick.set_sequence(sequence);
      tick.set_host_ns(time_ns);
      *tick.mutable_boards()->add_samples() = sample;
      recording.Add(tick);
    }
  }

  /// Rows of a table or of tracks, on a clock of their own that begins at `start_s`.
  void WriteCut(const motion::Table& table, double from_s, double to_s, double start_s) {
    motion::Table cut = table;
    const auto first = std::lround(from_s * 100);
    const auto count = static_cast<Eigen::Index>(std::floor((to_s - from_s) * 100 + 1e-6));
    cut.values = table.values.middleRows(first, count).eval();
    for (Eigen::Index i = 0; i < count; ++i)
      cut.values(i, 0) = start_s + 0.01 * static_cast<double>(i);
    Save(Path("theirs.mot"), motion::WriteTable(cut));
  }
  void WriteCut(const motion::MarkerTracks& tracks, double from_s, double to_s, double start_s) {
    motion::MarkerTracks cut = tracks;
    const auto first = std::lround(from_s * 100);
    const auto count = static_cast<Eigen::Index>(std::floor((to_s - from_s) * 100 + 1e-6));
    for (Eigen::Matrix3Xd& track : cut.p) track = track.middleCols(first, count).eval();
    cut.start_s = start_s;
    Save(Path("theirs.trc"), motion::WriteTrc(cut, "theirs.trc"));
  }

  AlignOptions With(const std::string& name) const {
    AlignOptions options;
    options.file = Path("boards.mcap");
    options.with = Path(name);
    return options;
  }

  static constexpr std::int64_t kBootNs = 5'000'000'000'000;
  std::array<virtual_sensors::BoardPlace, 2> poses_;
};

/// One of OpenCap's trials.
struct Trial {
  motion::GroundForces forces;
  motion::Table table;
  motion::MarkerTracks tracks;

  explicit Trial(const std::string& name) {
    const std::string folder = "forces/opencap_s4/";
    table = motion::ParseTable(motion::test::ReadShared(folder + "ID/" + name + "_grf.mot"), name)
                .value();
    forces = motion::ToGroundForces(table, name).value();
    tracks =
        motion::ParseTrc(motion::test::ReadShared(folder + "MarkerData/" + name + ".trc"), name)
            .value();
  }
  double seconds() const { return static_cast<double>(tracks.frames() - 1) / 100; }
};

TEST_F(AlignTest, OpenCapTrialsCutAtRandomAreWithinTenMillisecondsOrNotSure) {
  if (motion::test::SharedData().empty()) GTEST_SKIP() << "needs FOOTING_TEST_DATA";
  int sure_of_plates = 0, sure_of_markers = 0;
  for (const char* name : {"squats1", "static1", "STS1", "DJ1", "DJ2"}) {
    const Trial trial(name);
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      noise::Random random(seed);
      const double cut_s = std::min(3.0, 0.25 * trial.seconds());
      const double ours_s = random.Uniform(0.05, cut_s),
                   theirs_s = 0.01 * random.Integer(0, static_cast<int>(100 * cut_s));
      const double start_s = 0.01 * random.Integer(0, 2000);
      WriteBoards(trial.forces, ours_s, trial.seconds() - random.Uniform(0.05, cut_s), random);
      const double to_s = trial.seconds() - random.Uniform(0.05, cut_s);
      WriteCut(trial.table, theirs_s, to_s, start_s);
      WriteCut(trial.tracks, theirs_s, to_s, start_s);
      // Time `start_s` of the file is `theirs_s` of the trial, and `theirs_s - ours_s` of ours.
      const double expected_s = theirs_s - ours_s - start_s;
      for (const char* file : {"theirs.mot", "theirs.trc"}) {
        const auto alignment = Align(With(file));
        ASSERT_TRUE(alignment.ok()) << alignment.error().message;
        if (!alignment->offset) continue;
        const TimeOffset& at = *alignment->offset;
        const double error_s = at.offset_s - expected_s;
        std::printf("%s %s %d: %s, %.2f ms off, sd %.2f ms, play %.0f N, %.1f s %s\n", name, file,
                    static_cast<int>(seed), at.sure ? "sure" : "not sure", 1e3 * error_s,
                    1e3 * at.sd_s, at.play_n, at.overlap_s, at.doubt.c_str());
        if (!at.sure) continue;
        EXPECT_LT(std::abs(error_s), kBarS) << name << " " << file << " " << seed;
        EXPECT_STRNE(name, "static1");
        (alignment->method == "forces" ? sure_of_plates : sure_of_markers) += 1;
      }
    }
  }
  EXPECT_GE(sure_of_plates, 10);  // There are 12 in which the person moves.
  std::printf("sure: %d of plates, %d of markers\n", sure_of_plates, sure_of_markers);
}

TEST_F(AlignTest, AnotherTrialIsNotSure) {
  if (motion::test::SharedData().empty()) GTEST_SKIP() << "needs FOOTING_TEST_DATA";
  const std::pair<const char*, const char*> kPairs[] = {
      {"DJ1", "DJ2"}, {"squats1", "STS1"}, {"STS1", "squats1"}, {"DJ2", "squats1"}};
  for (const auto& [ours, theirs] : kPairs) {
    noise::Random random(7);
    const Trial trial(ours), other(theirs);
    WriteBoards(trial.forces, 0.1, trial.seconds() - 0.1, random);
    WriteCut(other.table, 0.1, other.seconds() - 0.1, 0);
    WriteCut(other.tracks, 0.1, other.seconds() - 0.1, 0);
    for (const char* file : {"theirs.mot", "theirs.trc"}) {
      const auto alignment = Align(With(file));
      ASSERT_TRUE(alignment.ok()) << alignment.error().message;
      EXPECT_FALSE(alignment->offset && alignment->offset->sure) << ours << " " << theirs << file;
    }
  }
}

TEST_F(AlignTest, ForcesOnTheClockAndFloorOfAVideo) {
  if (motion::test::SharedData().empty()) GTEST_SKIP() << "needs FOOTING_TEST_DATA";
  noise::Random random(3);
  const Trial trial("squats1");
  WriteBoards(trial.forces, 1, 12, random);
  WriteCut(trial.tracks, 2, 10, 30);
  AlignOptions options = With("theirs.trc");
  options.most_sd_s = 0.02;
  options.out = Path("out");
  const auto alignment = Align(options);
  ASSERT_TRUE(alignment.ok()) << alignment.error().message;
  ASSERT_EQ(alignment->files.size(), 2u) << alignment->offset->doubt;
  EXPECT_EQ(alignment->frames, 800u);
  EXPECT_EQ(alignment->unmeasured_frames, 0u);
  ASSERT_TRUE(alignment->placement_rms_m.has_value());
  EXPECT_LT(*alignment->placement_rms_m, 0.05);
  const std::string text = Bytes(Path("out/theirs_grf.mot"));
  EXPECT_THAT(text, HasSubstr("shear forces and free moments are not measured"));
  EXPECT_THAT(Bytes(Path("out/theirs_loads.xml")), HasSubstr("theirs_grf.mot"));
  const auto table = motion::ParseTable(text, "grf");
  ASSERT_TRUE(table.ok()) << table.error().message;
  EXPECT_NEAR(table->values(0, 0), 30, 1e-9);
  const int right = motion::FindColumn(*table, "ground_force_r_vy");
  const int left = motion::FindColumn(*table, "ground_force_l_vy");
  const auto ours = motion::ToGroundForces(*table, "grf");
  ASSERT_TRUE(ours.ok()) << ours.error().message;
  double sum = 0, cop = 0;
  for (Eigen::Index i = 0; i < 800; ++i) {  // Time 30 s is 2 s of the trial.
    double plates_n = 0;
    for (const auto& plate : trial.forces.plates) plates_n += plate.force_W(2, 200 + i);
    sum += std::pow(table->values(i, right) + table->values(i, left) - plates_n, 2);
    cop += (ours->plates[1].cop_W.col(i) - trial.forces.plates[1].cop_W.col(200 + i))
               .head<2>()
               .squaredNorm();
  }
  EXPECT_LT(std::sqrt(sum / 800), 20);    // N, with 16 N of hysteresis and 1 % of gain.
  EXPECT_LT(std::sqrt(cop / 800), 0.08);  // m: feet are only so well known.
}

TEST_F(AlignTest, AMarkerOrTheClockOfLslGiveTheOffset) {
  noise::Random random(1);
  {
    test::MadeRecording recording(Path("boards.mcap"));
    recording.Begin("footingd");
    std::vector<std::pair<std::int64_t, v1::BoardSample>> samples;
    for (int k = 0; k < 400; ++k) {
      v1::BoardSample sample;
      sample.set_device(1 + static_cast<std::uint32_t>(k % 2));
      sample.set_sampled_ns(kBootNs + 10'000'000LL * k);
      sample.set_total_n(300);
      samples.emplace_back(sample.sampled_ns(), sample);
    }
    WriteTicks(samples, recording);
    v1::Tick tick;
    tick.set_host_ns(kBootNs + 2'000'000'000);
    tick.set_sequence(1000);
    v1::Event& event = *tick.mutable_events()->add_events();
    event.set_kind(v1::Event::KIND_MARKER);
    event.set_text("clap");
    event.set_host_ns(kBootNs + 1'500'000'000);
    recording.Add(tick);
  }
  std::string csv = "time_s,force_n\n";
  for (int i = 0; i < 200; ++i) csv += std::to_string(10 + 0.01 * i) + ",600\n";
  Save(Path("theirs.csv"), csv);
  AlignOptions options = With("theirs.csv");
  options.marker = "clap";
  options.at_s = 10.2;
  const auto by_marker = Align(options);
  ASSERT_TRUE(by_marker.ok()) << by_marker.error().message;
  EXPECT_TRUE(by_marker->offset->sure);
  EXPECT_NEAR(by_marker->offset->offset_s, 1.5 - 10.2, 1e-9);

  options.at_s = 1000;
  const auto apart = Align(options);
  ASSERT_FALSE(apart.ok());
  EXPECT_THAT(apart.error().message, HasSubstr("do not overlap"));
  options.marker = "no such";
  EXPECT_THAT(Align(options).error().message, HasSubstr("has 0 markers"));

  csv = "time_s,force_n\n";  // The host booted 5000 s before.
  for (int i = 0; i < 200; ++i) csv += std::to_string(5001 + 0.01 * i) + ",600\n";
  Save(Path("theirs.csv"), csv);
  options = With("theirs.csv");
  options.lsl_clock = true;
  const auto by_lsl = Align(options);
  ASSERT_TRUE(by_lsl.ok()) << by_lsl.error().message;
  EXPECT_NEAR(by_lsl->offset->offset_s, -5000, 1e-9);
}

TEST_F(AlignTest, FilesThatCannotBeRightAreErrors) {
  const auto error = [this](const std::string& name, const std::string& text) {
    Save(Path(name), text);
    const auto read = ReadForeign(Path(name), kWeightN);
    return read.ok() ? std::string("none") : read.error().message;
  };
  EXPECT_THAT(error("a.csv", "time,force\n0,1\n"), HasSubstr("time_s and force_n"));
  EXPECT_THAT(error("b.csv", "time_s,force_n\n0,1\n0.1,1\n0.5,1\n"), HasSubstr("equal steps"));
  EXPECT_THAT(error("c.txt", ""), HasSubstr(".trc"));
  EXPECT_THAT(error("d.mot",
                    "d\nversion=1\nnRows=3\nnColumns=2\ninDegrees=no\nendheader\n"
                    "time\tx\n0\t1\n0.01\t1\n0.02\t1\n"),
              HasSubstr("d.mot"));
  motion::MarkerTracks tracks;
  tracks.rate_hz = 100;
  tracks.names = {"top", "bottom"};
  tracks.p.assign(2, Eigen::Matrix3Xd::Constant(3, 50, 0.001));
  tracks.p[0].row(1).setConstant(0.0018);  // A person of 1.8 mm.
  const std::string trc = motion::WriteTrc(tracks, "e.trc");
  EXPECT_THAT(error("e.trc", trc), HasSubstr("unit"));
  EXPECT_THAT(error("f.trc", trc.substr(0, trc.size() / 2)), HasSubstr("f.trc"));
}

}  // namespace
}  // namespace footing::log_client
