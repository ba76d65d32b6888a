#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/runtime/clock.h"
#include "daemon/offline/analysis/gait_style.h"
#include "daemon/offline/eval/gait.h"
#include "daemon/offline/eval/gait_trial.h"
#include "daemon/offline/eval/report.h"
#include "daemon/simulation/biped/body_state.h"

namespace footing::eval {
namespace {

constexpr double kStyleSettleS = 6;  ///< And a second for each m/s.

struct StyleOptions {
  std::string gait = "walk";
  std::vector<double> speeds_mps{0.5, 0.8, 1.2, 1.75};
  double height_m = 0.2;
  double seconds = 20;
  std::string seed = "1";
};

nlohmann::ordered_json ToJson(const style::Swing& swing) {
  return {{"amplitude_deg", RadiansToDegrees(swing.amplitude_rad)},
          {"peak_phase", swing.peak_phase}};
}

double Deviation(double value, double reference) {
  return reference > 0 ? value / reference - 1 : 0;
}

nlohmann::ordered_json RowOf(const biped::GaitCommand& command, const style::GaitStyle& style,
                             double weight_n, bool fell) {
  const double cadence_hz = style::AlexanderCadence(style.speed_mps, style::kHipHeightM);
  nlohmann::ordered_json row{{"gait", stream::Name(command.gait)},
                             {"speed_mps", command.speed_mps},
                             {"fell", fell},
                             {"steps", style.steps},
                             {"speed_mean_mps", style.speed_mps},
                             {"cadence_hz", style.cadence_hz},
                             {"step_length_m", style.step_length_m},
                             {"reference_cadence_hz", cadence_hz},
                             {"cadence_deviation", Deviation(style.cadence_hz, cadence_hz)},
                             {"step_width_m", style.step_width_m},
                             {"bob_m", style.bob_m},
                             {"bob_low_phase", style.bob_low_phase},
                             {"sway_m", style.sway_m},
                             {"lean_deg", RadiansToDegrees(style.lean_rad)},
                             {"pitch", ToJson(style.pitch)},
                             {"roll", ToJson(style.roll)},
                             {"yaw", ToJson(style.yaw)},
                             {"double_support_share", style.double_support_share},
                             {"flight_share", style.flight_share},
                             {"slide_mean_m", style.slide_mean_m},
                             {"slide_max_m", style.slide_max_m},
                             {"penetration_m", style.penetration_m},
                             {"jerk_rms_mps3", style.jerk_rms_mps3},
                             {"cost_of_transport", style.work_n / weight_n},
                             {"asymmetry", style.asymmetry}};
  if (command.gait == stream::Gait::kWalk) {
    row["reference_bob_m"] = style::OrendurffBob(command.speed_mps);
  }
  return row;
}

/// A settled gait, kicked once on the way, as in the trials of `gait`.
Result<nlohmann::ordered_json> Measure(const StyleOptions& options,
                                       const biped::GaitCommand& command, std::uint64_t seed) {
  constexpr double kKickNs = 2, kKickS = 3;
  Result<engine::GaitEngine> engine = NewEngine();
  if (!engine) return engine.error();
  const Result<physics::World> world = NewWorld();
  if (!world) return world.error();
  Random random(seed);
  Walker walker(*engine);
  walker.Command(command);
  const double from_s = kStyleSettleS + command.speed_mps;
  const double kick_s = kKickS + random.Uniform(0, 1), kick_rad = random.Uniform(-kPi, kPi);
  style::StyleMeter meter(engine::EngineConfig{}.step_s);
  bool kicked = false;
  while (!walker.fell()) {
    const engine::EngineOutput& output = walker.Advance();
    if (output.time_s >= from_s + options.seconds) break;
    if (output.time_s >= from_s) meter.Add(output);
    if (!kicked && output.time_s >= kick_s) walker.Push(kKickNs, kick_rad);
    kicked = output.time_s >= kick_s;
  }
  return RowOf(command, meter.Report(), world->mass_kg() * kStandardGravityMps2, walker.fell());
}

Result<nlohmann::ordered_json> MeasureAll(const StyleOptions& options) {
  const Result<std::uint64_t> seed = ParseSeed(options.seed);
  if (!seed) return seed.error();
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  Progress progress("style", "speeds", static_cast<double>(options.speeds_mps.size()),
                    clock::MonotonicNs());
  for (const double speed_mps : options.speeds_mps) {
    const biped::GaitCommand wanted{.gait = stream::GaitNamed(options.gait),
                                    .speed_mps = speed_mps,
                                    .height_m = options.height_m};
    const biped::GaitCommand command = biped::Limited(wanted);
    if (command.speed_mps < speed_mps) {
      return UsageError("--speeds: the limit of " + options.gait + " is " +
                        text::Shortest(command.speed_mps) + " m/s; choose lower speeds");
    }
    Result<nlohmann::ordered_json> row =
        Measure(options, command, TrialSeed(*seed, static_cast<int>(rows.size())));
    if (!row) return row.error();
    rows.push_back(std::move(*row));
    progress.Done(static_cast<double>(rows.size()), clock::MonotonicNs(), std::cerr);
  }
  return nlohmann::ordered_json{{"seed", *seed}, {"seconds", options.seconds}, {"rows", rows}};
}

/// A line a row, for people.
void PrintRows(const nlohmann::ordered_json& report) {
  std::printf("gait  m/s   steps/s (curve)  bob mm  roll deg  yaw deg  slide mm  CoT\n");
  for (const auto& row : report["rows"]) {
    const auto of = [&row](const char* name) { return row[name].get<double>(); };
    std::printf("%-5s %.2f  %7.2f (%+3.0f %%)  %6.0f  %8.1f  %7.1f  %8.1f  %.2f%s\n",
                row["gait"].get<std::string>().c_str(), of("speed_mps"), of("cadence_hz"),
                100 * of("cadence_deviation"), 1000 * of("bob_m"),
                row["roll"]["amplitude_deg"].get<double>(),
                row["yaw"]["amplitude_deg"].get<double>(), 1000 * of("slide_max_m"),
                of("cost_of_transport"), row["fell"].get<bool>() ? "  fell" : "");
  }
}

int RunStyle(const StyleOptions& options, bool json) {
  const Result<nlohmann::ordered_json> report = MeasureAll(options);
  if (!report || json) return PrintResult(report, json);
  PrintRows(*report);
  return 0;
}

}  // namespace

void AddStyleCommand(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand(
      "style", "Motion of settled gaits over speed, beside curves of people and birds");
  auto options = std::make_shared<StyleOptions>();
  command->add_option("--gait", options->gait, "Gait: step, walk, run or jump (default: walk)")
      ->check(CLI::IsMember({"step", "walk", "run", "jump"}));
  command
      ->add_option("--speeds", options->speeds_mps,
                   "Speeds, m/s, separated by commas (default: 0.5,0.8,1.2,1.75)")
      ->check(CLI::Range(0.0, 6.0))
      ->delimiter(',');
  command->add_option("--height", options->height_m, "Jump height, m")
      ->check(CLI::Range(0.05, 0.7));
  command->add_option("--seconds", options->seconds, "Measured duration of each, s")
      ->check(CLI::Range(1.0, 36000.0));
  command->add_option("--seed", options->seed, "Seed: a number, or random");
  command->callback([options, &shared] { shared.exit_code = RunStyle(*options, shared.json); });
}

}  // namespace footing::eval
