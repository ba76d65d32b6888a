#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "clients/ctl/report/sway_report.h"
#include "clients/ctl/report/sway_trial.h"
#include "common/base/json_text.h"
#include "common/base/units.h"

namespace footing::sway {
namespace {

using Phase = TrialGuide::Phase;
using stream::DeviceRole;

constexpr double kWeightN = 700;
constexpr std::int64_t kTickNs = 10'000'000;

Board BoardAs(DeviceRole role, double y_m = 0) {
  return {stream::Name(role), role, {0, y_m, 0}, board::kBalanceBoard};
}

/// A trial of 2 s after 1 s of standing; loads of the boards are set between ticks of 10 ms.
class Guided {
 public:
  explicit Guided(std::vector<Board> boards, bool wait_for_start = false)
      : loads_n(boards.size(), 0),
        silent(boards.size(), false),
        guide({1, 2, wait_for_start}, boards, {"open", "firm", "shoulder"}) {}

  Phase For(double seconds, bool start = false) {
    for (std::int64_t end_ns = now_ns + SecondsToNanoseconds(seconds); now_ns < end_ns;) {
      now_ns += kTickNs;
      now_.resize(loads_n.size());
      for (std::size_t i = 0; i < loads_n.size(); ++i) {
        if (!silent[i]) now_[i] = {now_ns - 5'000'000, loads_n[i]};
      }
      guide.Advance(now_ns, now_, start);
    }
    return guide.phase();
  }

  std::vector<double> loads_n;
  std::vector<bool> silent;
  std::int64_t now_ns = 5'000'000'000;
  TrialGuide guide;

 private:
  std::vector<BoardNow> now_;
};

TEST(TrialGuide, SettlesAndMeasuresAfterTheStepOntoTheBoard) {
  Guided run({BoardAs(DeviceRole::kLeftBoard)});
  EXPECT_EQ(run.For(3), Phase::kWaiting);
  EXPECT_EQ(run.guide.prompt(),
            "Stand on the board, feet at shoulder width, arms hanging, eyes on a mark.");
  run.loads_n = {kWeightN};
  EXPECT_EQ(run.For(0.9), Phase::kSettling);
  EXPECT_NEAR(run.guide.left_s(), 0.11, 1e-9);
  EXPECT_EQ(run.For(0.2), Phase::kMeasuring);
  const std::int64_t from_ns = run.guide.from_ns();
  EXPECT_EQ(from_ns, 9'010'000'000);
  EXPECT_EQ(run.guide.to_ns(), from_ns + 2'000'000'000);
  EXPECT_EQ(run.For(1.5), Phase::kMeasuring);
  // The end is where the samples reach it, one tick after the time is over.
  EXPECT_EQ(run.For(0.5), Phase::kDone);
}

TEST(TrialGuide, StartsByEnterWhereSomebodyIsAtATerminal) {
  Guided run({BoardAs(DeviceRole::kLeftBoard)}, true);
  EXPECT_EQ(run.For(0.1, true), Phase::kWaiting);  // Nobody stands there.
  run.loads_n = {kWeightN};
  EXPECT_EQ(run.For(1), Phase::kWaiting);
  EXPECT_NE(run.guide.prompt().find("Then press Enter."), std::string::npos);
  EXPECT_EQ(run.For(0.01, true), Phase::kSettling);
}

TEST(TrialGuide, ASubjectWhoStepsOffWhileSettlingBeginsAgain) {
  Guided run({BoardAs(DeviceRole::kLeftBoard)});
  run.loads_n = {kWeightN};
  EXPECT_EQ(run.For(0.8), Phase::kSettling);
  run.loads_n = {3};
  EXPECT_EQ(run.For(0.1), Phase::kWaiting);
  run.loads_n = {kWeightN};
  EXPECT_EQ(run.For(0.8), Phase::kSettling);
  EXPECT_EQ(run.For(0.3), Phase::kMeasuring);
}

/// Reason for which an attempt with these loads in its middle is rejected; empty: it is not.
std::string RejectedAfter(std::vector<double> loads_n, double seconds) {
  Guided run({BoardAs(DeviceRole::kLeftBoard, 0.2), BoardAs(DeviceRole::kRightBoard, -0.2)});
  run.loads_n = {0.5 * kWeightN, 0.5 * kWeightN};
  EXPECT_EQ(run.For(1.5), Phase::kMeasuring);
  run.loads_n = std::move(loads_n);
  run.For(seconds);
  run.loads_n = {0.5 * kWeightN, 0.5 * kWeightN};
  run.For(3);
  EXPECT_EQ(run.guide.phase(), run.guide.rejected().empty() ? Phase::kDone : Phase::kRejected);
  return run.guide.rejected();
}

TEST(TrialGuide, StepsAndSupportsEndAnAttempt) {
  EXPECT_EQ(RejectedAfter({0.5 * kWeightN, 0.5 * kWeightN}, 1), "");
  EXPECT_EQ(RejectedAfter({0.4 * kWeightN, 0.55 * kWeightN}, 1), "");  // It sways.
  EXPECT_EQ(RejectedAfter({0, 0}, 0.5), "the subject stepped off");
  EXPECT_EQ(RejectedAfter({0, 0}, 0.2), "");  // Too short for a step: noise of the link.
  EXPECT_EQ(RejectedAfter({0, kWeightN}, 0.5), "a foot left the left board");
  EXPECT_EQ(RejectedAfter({0.3 * kWeightN, 0.4 * kWeightN}, 0.5).substr(0, 43),
            "the load changed by more than a quarter: th");
}

TEST(TrialGuide, OnOneLegTheOtherBoardMustStayFree) {
  Guided run({BoardAs(DeviceRole::kLeftBoard), BoardAs(DeviceRole::kRightBoard)});
  run.loads_n = {kWeightN, 0};
  EXPECT_EQ(run.For(1.5), Phase::kMeasuring);
  run.loads_n = {0.85 * kWeightN, 0.15 * kWeightN};
  EXPECT_EQ(run.For(0.5), Phase::kRejected);
  EXPECT_EQ(run.guide.rejected(), "a foot came onto the right board");
}

TEST(TrialGuide, ALostBoardEndsAnAttemptAndIsAskedFor) {
  Guided run({BoardAs(DeviceRole::kLeftBoard), BoardAs(DeviceRole::kRightBoard)});
  run.loads_n = {0.5 * kWeightN, 0.5 * kWeightN};
  EXPECT_EQ(run.For(1.5), Phase::kMeasuring);
  run.silent[1] = true;
  EXPECT_EQ(run.For(0.9), Phase::kMeasuring);
  EXPECT_EQ(run.For(0.2), Phase::kRejected);
  EXPECT_EQ(run.guide.rejected(), "the right board sent nothing for 1 s");
  run.guide = TrialGuide({1, 2, false},
                         {BoardAs(DeviceRole::kLeftBoard), BoardAs(DeviceRole::kRightBoard)}, {});
  EXPECT_EQ(run.For(1), Phase::kWaiting);
  EXPECT_EQ(run.guide.prompt(), "The right board sends nothing: press its button.");
}

/// Samples of a person whose COP goes around the middle of a board in a circle of 10 mm once in
/// two seconds, 100 a second. The board bears `share` of the weight.
std::vector<stream::BoardSample> Circling(double seconds, double share = 1) {
  std::vector<stream::BoardSample> samples;
  for (int k = 0; k < static_cast<int>(seconds * 100); ++k) {
    const double right = 0.010 * std::cos(kPi * k / 100) / 0.433;
    const double front = 0.010 * std::sin(kPi * k / 100) / 0.238;
    const double weight_n = share * kWeightN;
    stream::BoardSample& sample = samples.emplace_back();
    sample.sampled_ns = kTickNs * (k + 1);
    sample.tared = sample.simulated = true;
    sample.top_left_n = weight_n * (0.25 - right / 2 + front / 2);
    sample.top_right_n = weight_n * (0.25 + right / 2 + front / 2);
    sample.bottom_left_n = weight_n * (0.25 - right / 2 - front / 2);
    sample.bottom_right_n = weight_n * (0.25 + right / 2 - front / 2);
  }
  return samples;
}

const posturography::CopFilter kFilter{50, 10, 0};

Trial TrialOf(double from_s, double to_s) {
  Trial trial;
  trial.condition = {"open", "firm", "shoulder"};
  trial.from_ns = SecondsToNanoseconds(from_s);
  trial.to_ns = SecondsToNanoseconds(to_s);
  return trial;
}

TEST(MeasureTrial, TheOrderInWhichSamplesComeDoesNotCount) {
  const std::vector<Board> boards = {BoardAs(DeviceRole::kLeftBoard)};
  std::vector<stream::BoardSample> samples = Circling(30);
  Trial trial = TrialOf(2, 27);
  MeasureTrial(boards, {samples}, kFilter, trial);
  ASSERT_TRUE(trial.measures) << trial.rejected;
  EXPECT_NEAR(trial.weight_n, kWeightN, 1e-6);
  EXPECT_TRUE(trial.simulated && trial.tared && trial.calibrated && !trial.left_share);
  // pi 10 mm/s on the circle.
  EXPECT_NEAR(trial.measures->mean_velocity_mps, kPi * 0.010, 0.02 * kPi * 0.010);
  EXPECT_NEAR(*trial.measures->ml.median_frequency_hz, 0.5, 0.02);
  // Late ones, and some twice.
  std::rotate(samples.begin() + 1000, samples.begin() + 1100, samples.begin() + 1300);
  samples.insert(samples.end(), samples.begin() + 500, samples.begin() + 700);
  Trial again = TrialOf(2, 27);
  MeasureTrial(boards, {samples}, kFilter, again);
  EXPECT_EQ(again.measures->path_m, trial.measures->path_m);
  EXPECT_EQ(again.cop.size(), 1u);
}

TEST(MeasureTrial, TwoBoardsAreOnePlate) {
  const std::vector<Board> boards = {BoardAs(DeviceRole::kLeftBoard, 0.2),
                                     BoardAs(DeviceRole::kRightBoard, -0.2)};
  Trial trial = TrialOf(0, 25);
  MeasureTrial(boards, {Circling(30, 0.6), Circling(30, 0.4)}, kFilter, trial);
  ASSERT_TRUE(trial.measures) << trial.rejected;
  EXPECT_NEAR(*trial.left_share, 0.6, 1e-9);
  EXPECT_NEAR(trial.weight_n, kWeightN, 1e-6);
  EXPECT_NEAR(trial.measures->rms_radial_m, 0.010, 0.0001);
  double x_m = 0;  // 20 % of the weight more on the left: 0.2 * 0.2 m to the left.
  for (const auto& sample : trial.cop[0]) x_m += sample.x_m;
  EXPECT_NEAR(x_m / static_cast<double>(trial.cop[0].size()), -0.04, 0.001);
}

TEST(MeasureTrial, SaysWhyATrialDoesNotCount) {
  const std::vector<Board> boards = {BoardAs(DeviceRole::kLeftBoard)};
  Trial none = TrialOf(0, 20);
  MeasureTrial(boards, {{}}, kFilter, none);
  EXPECT_EQ(none.rejected, "nobody stood on the boards");
  Trial shorter = TrialOf(0, 20);
  MeasureTrial(boards, {Circling(15)}, kFilter, shorter);
  EXPECT_EQ(shorter.rejected, "only 15.0 of 20 s have samples of a standing person");
  std::vector<stream::BoardSample> gap = Circling(20);
  gap.erase(gap.begin() + 500, gap.begin() + 700);
  Trial holes = TrialOf(0, 20);
  MeasureTrial(boards, {gap}, kFilter, holes);
  EXPECT_NE(holes.rejected.find("missing for up to 2.0 s"), std::string::npos) << holes.rejected;
  gap = Circling(20);
  gap.erase(gap.begin() + 500, gap.begin() + 540);
  Trial small = TrialOf(0, 20);
  MeasureTrial(boards, {gap}, kFilter, small);
  EXPECT_EQ(small.gaps.count, 1u);
  EXPECT_EQ(small.rejected, "");
}

/// Two trials with open eyes and one with closed ones, on a circle half as large again.
Session Measured() {
  Session session;
  session.subject = "<P01>, \"one\"";
  session.boards = {BoardAs(DeviceRole::kLeftBoard)};
  session.seconds = 20;
  session.filter = kFilter;
  session.planned = 4;
  for (int i = 0; i < 3; ++i) {
    Trial trial = TrialOf(1, 21);
    std::vector<stream::BoardSample> samples = Circling(22);
    if (i == 2) {
      trial.condition.eyes = "closed";
      for (auto& sample : samples) {
        for (double* force : {&sample.top_left_n, &sample.top_right_n, &sample.bottom_left_n,
                              &sample.bottom_right_n}) {
          *force = kWeightN / 4 + 1.5 * (*force - kWeightN / 4);
        }
      }
    }
    trial.repeat = i == 1 ? 2 : 1;
    MeasureTrial(session.boards, {samples}, kFilter, trial);
    session.trials.push_back(std::move(trial));
  }
  Trial rejected = TrialOf(1, 2);
  rejected.rejected = "the subject stepped off";
  session.trials.push_back(rejected);
  return session;
}

TEST(SwayReport, RatiosAreOfMeansOfTheTrialsThatCount) {
  const Session session = Measured();
  const auto summaries = Summaries(session.trials);
  ASSERT_EQ(summaries.size(), 2u);
  EXPECT_EQ(summaries[0].trials, 2u);
  EXPECT_EQ(summaries[1].trials, 1u);
  const auto ratios = RombergRatios(summaries);
  ASSERT_EQ(ratios.size(), 1u);
  EXPECT_NEAR(ratios[0].path, 1.5, 1e-9);
  EXPECT_NEAR(ratios[0].ellipse95, 1.5 * 1.5, 1e-9);
  const auto json = ToJson(session);
  EXPECT_EQ(json["missing"], 1);
  EXPECT_EQ(json["trials"].size(), 4u);
  EXPECT_EQ(json["conditions"][0]["sd"]["path_length_mm"], 0);
  EXPECT_TRUE(json["conditions"][1]["sd"]["path_length_mm"].is_null());
  EXPECT_FALSE(json["conditions"][0]["mean"].contains("axis_major_angle_deg"));
}

TEST(SwayReport, RowsAreAsLongAsTheHeader) {
  const std::string csv = ToCsv(Measured());
  std::size_t lines = 0;
  std::vector<std::size_t> commas;
  bool quoted = false;
  std::size_t count = 0;
  for (const char c : csv) {
    if (c == '"') quoted = !quoted;
    if (c == ',' && !quoted) ++count;
    if (c == '\n') {
      commas.push_back(std::exchange(count, 0));
      ++lines;
    }
  }
  EXPECT_EQ(lines, 5u);
  EXPECT_EQ(commas, std::vector<std::size_t>(5, commas[0]));
  EXPECT_NE(csv.find("\"<P01>, \"\"one\"\"\",1,open,firm,shoulder,1,1,true,,"), std::string::npos)
      << csv;
}

TEST(SwayReport, ThePageIsEscapedAndNeedsNoOtherFile) {
  const std::string html = ToHtml(Measured());
  EXPECT_NE(html.find("&lt;P01&gt;"), std::string::npos);
  EXPECT_EQ(html.find("<P01>"), std::string::npos);
  for (const char* outside : {"src=", "href=", "url(", "nan", "inf'"}) {
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
  }
  EXPECT_NE(html.find("1 of 4 trials are missing"), std::string::npos);
  EXPECT_NE(ToHtml({}).find("</html>"), std::string::npos);
}

TEST(SwayReport, ARecordingsPartsAreReadAsTheyWereWritten) {
  const Session session = Measured();
  const auto plan = PlanFromJson(text::ToText(PlanToJson(session)));
  ASSERT_TRUE(plan.ok()) << plan.error().message;
  EXPECT_EQ(PlanToJson(*plan), PlanToJson(session));
  const auto trial = TrialFromJson(text::ToText(TrialToJson(session.trials[3])));
  ASSERT_TRUE(trial.ok()) << trial.error().message;
  EXPECT_EQ(TrialToJson(*trial), TrialToJson(session.trials[3]));
}

TEST(SwayReport, OtherRecordsAreRefused) {
  auto json = PlanToJson(Measured());
  json["boards"][0]["sensor_distance_x_m"] = 0;
  EXPECT_NE(PlanFromJson(json.dump()).error().message.find("sensor_distance_x_m is 0"),
            std::string::npos);
  json["boards"] = nlohmann::ordered_json::array();
  EXPECT_NE(PlanFromJson(json.dump()).error().message.find("0 boards"), std::string::npos);
  for (const char* text : {"", "{}", "[1]", "{\"subject\": 3}"}) {
    EXPECT_EQ(PlanFromJson(text).error().kind, ErrorKind::kInvalidData) << text;
    EXPECT_EQ(TrialFromJson(text).error().kind, ErrorKind::kInvalidData) << text;
  }
  auto trial = TrialToJson(TrialOf(2, 1));
  EXPECT_NE(TrialFromJson(trial.dump()).error().message.find("before it begins"),
            std::string::npos);
  trial["feet"] = "none";
  EXPECT_NE(TrialFromJson(trial.dump()).error().message.find("feet is"), std::string::npos);
}

}  // namespace
}  // namespace footing::sway
