#include "daemon/offline/eval/gait_options.h"

namespace footing::eval {

void AddOptions(CLI::App& command, GaitOptions& options) {
  command.add_option("--gait", options.gait, "Gait: step, walk, run or jump")->required();
  command.add_option("--speed", options.speed_mps, "Commanded speed, m/s")
      ->check(CLI::Range(0.0, 6.0));
  command
      .add_option("--height", options.height_m,
                  "Jump height, m (default: 0.2, or the height that the pit needs)")
      ->check(CLI::Range(0.05, 0.7));
  command.add_option("--turn", options.turn_deg, "Turn, degrees per step; left positive")
      ->check(CLI::Range(-8.0, 8.0));
  command.add_option("--seconds", options.seconds, "Duration of each trial, s")
      ->check(CLI::Range(0.1, 36000.0));
  command.add_option("--trials", options.trials, "Number of trials")->check(CLI::Range(1, 100000));
  command.add_option("--seed", options.seed, "Seed: a number, or random");
  command.add_option("--push", options.push_ns, "Push impulse, N s (default: 2)")
      ->check(CLI::Range(0.0, 1000.0));
  command.add_option(
      "--push-direction", options.push_direction_deg,
      "Push direction, degrees: 0 pushes forwards, 90 to the left (default: random)");
  command
      .add_option("--push-phase", options.push_phase,
                  "Push time as a fraction of the gait cycle, 0 to 1 (default: random)")
      ->check(CLI::Range(0.0, 1.0));
  command.add_option("--slope", options.slope_deg, "Slope of the ground, degrees; uphill positive")
      ->check(CLI::Range(-20.0, 20.0));
  command
      .add_option(
          "--step", options.step_m,
          "Height of the alternating steps of the ground, m; negative: the first step is down")
      ->check(CLI::Range(-0.3, 0.3));
  command
      .add_option(
          "--push-directions", options.push_directions,
          "Number of push directions of a sweep; each is tried at --push-phases times of the cycle")
      ->check(CLI::Range(1, 360));
  command
      .add_option("--push-phases", options.push_phases,
                  "Number of push times per cycle of a sweep (default: 12)")
      ->check(CLI::Range(1, 1000));
  command.add_option("--pit", options.pit_m, "Width of the pits across the track, m")
      ->check(CLI::Range(0.05, 5.0));
  command
      .add_option("--jump-lead", options.jump_lead_s,
                  "Lead of the jump command before a pit, s (run only)")
      ->check(CLI::Range(0.0, 5.0));
  command.add_flag("--no-jump", options.no_jump, "Give a run no jump commands at pits");
}

}  // namespace footing::eval
